"""The README tells the truth: what it names is there, what it says to type can be typed."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from taylor_verify.scenes.reading.reader import load

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w*)\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
# Each use, and the pages where it is worked or listed.
USES = {
    "Check my file": "docs/tutorials/check-my-simulator.md",
    "Gate my CI": "docs/tutorials/gate-my-ci.md",
    "Look up a truth": "reports/reference/README.md",
}
# Words of the docs, which a reader of the first page does not know yet.
UNEXPLAINED = (
    *(
        "rung",
        "ball",
        "attainable",
        "floor",
        "vacuous",
        "separatrix",
        "polhode",
        "impulse",
        "theta",
    ),
    *("enclosure", "enclosed", "conditioning", "manufactured", "washboard", "roundoff", "orbit"),
)


def test_what_comes_first() -> None:
    """The order is title, picture, what it is and is not, installing, the three uses, on two screens."""
    places = [
        README.index("# taylor-verify"),
        README.index("![A body"),
        README.index("It is **not**"),
        README.index("pip install"),
        *(README.index(f"## {use}\n") for use in USES),
        *(README.index(command) for command in ("make verify ", "make test ")),
    ]
    assert places == sorted(places)
    assert README.count("![") == 1
    assert len(README.splitlines()) <= 150


def test_no_word_is_used_before_it_is_explained() -> None:
    """Words of the docs stay in the docs; `scene`, which the first page needs, is explained there."""
    prose = re.sub(r"```.*?```|`[^`]*`|\]\([^)]*\)", "", README, flags=re.DOTALL).lower()
    assert [word for word in UNEXPLAINED if re.search(rf"\b{word}s?\b", prose)] == []
    assert README.index("A **scene** is") < README.index("## Install")


def test_the_scene_shown_is_a_scene(tmp_path: Path) -> None:
    """The file that the page shows is read, and is the shipped scene of the uses below it."""
    (shown,) = (text for language, text in BLOCKS if language == "toml")
    file = tmp_path / "shown.toml"
    file.write_text(shown, encoding="utf-8")
    scene, shipped = load(file), load("euler/generic")
    assert (scene.body, scene.initial, scene.clock.instants) == (
        shipped.body,
        shipped.initial,
        shipped.clock.instants,
    )


@pytest.mark.parametrize("use", USES)
def test_a_use_leads_further(use: str) -> None:
    """Each of the three uses shows a command and links to the page where it is worked."""
    section = README.split(f"## {use}\n")[1].split("\n## ")[0]
    assert f"]({USES[use]})" in section
    assert "\ntaylor-verify " in section


@pytest.mark.parametrize("use", USES)
def test_what_a_use_quotes_is_in_its_tutorial(use: str) -> None:
    """Words of the suite that a use quotes are printed in its tutorial, which the tests work through."""
    section = " ".join(README.split(f"## {use}\n")[1].split("\n## ")[0].split())
    page = (ROOT / USES[use]).read_text(encoding="utf-8")
    # Quotes of code and of the shell are no words of the suite.
    prose = re.sub(r"```.*?```|`[^`]*`", "", section)
    assert [quote for quote in re.findall(r'"([^"]+)"', prose) if quote not in page] == []


def test_every_target_of_make_exists() -> None:
    """Every target that the README names has a rule in the Makefile."""
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    rules = {
        name for line in re.findall(r"^([a-z][a-z -]*):", makefile, re.M) for name in line.split()
    }
    targets = set(re.findall(r"`?make ([a-z-]+)[` ]", README))
    assert {"verify", "test", "site"} <= targets <= rules


def test_the_python_shown_is_python() -> None:
    """Every block of Python compiles, and there is one to judge a solver and one for pytest."""
    python = [text for language, text in BLOCKS if language == "python"]
    for text in python:
        compile(text, "README.md", "exec")
    assert any("taylor_verify.check(" in text for text in python)
    assert any("verify_solver" in text for text in python)
