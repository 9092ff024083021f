"""The README tells the truth: what it names is there, what it says to type can be typed."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w*)\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
USES = {
    "Check my simulator": "docs/tutorials/check-my-simulator.md",
    "Gate my CI": "docs/tutorials/gate-my-ci.md",
    "Choose my precision": "docs/tutorials/choose-my-precision.md",
}


def test_what_comes_first() -> None:
    """The order is title, two commands, one table, one picture, the three uses; all on a few screens."""
    places = [
        README.index("# taylor-verify"),
        *(README.index(command) for command in ("make verify ", "make test ")),
        README.index("<!-- controls:"),
        README.index("!["),
        *(README.index(f"## {use}\n") for use in USES),
    ]
    assert places == sorted(places)
    assert README.count("![") == 1
    assert len(README.splitlines()) <= 200


@pytest.mark.parametrize("use", USES)
def test_a_use_leads_to_its_tutorial(use: str) -> None:
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
    told = set(re.findall(r"`?make ([a-z-]+)[` ]", README))
    assert {"verify", "test", "docs"} <= told <= rules


def test_the_python_shown_is_python() -> None:
    """Every block of Python compiles, and there is one to judge a solver and one for pytest."""
    python = [text for language, text in BLOCKS if language == "python"]
    for text in python:
        compile(text, "README.md", "exec")
    assert any("taylor_verify.check(" in text for text in python)
    assert any("verify_solver" in text for text in python)
