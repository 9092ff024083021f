"""The README tells the truth: what it names is there, what it says to type does what it shows."""

from __future__ import annotations

import re
from pathlib import Path

from builders.worked import ROOT, work

README = (ROOT / "README.md").read_text(encoding="utf-8")
PROSE = re.sub(r"```.*?```|`[^`]*`|\]\([^)]*\)", "", README, flags=re.DOTALL).lower()
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


def test_no_word_is_used_before_it_is_explained() -> None:
    """Words of the docs stay in the docs."""
    assert [word for word in UNEXPLAINED if re.search(rf"\b{word}s?\b", PROSE)] == []


def test_what_the_page_says_to_type_works(tmp_path: Path) -> None:
    """From an empty folder, each block does what is shown, and the gate passes in the end."""
    gate = "```console\n$ pytest -q test_my_simulator.py\n...\n1 passed in ...\n```\n"
    page = tmp_path / "README.md"
    page.write_text(f"{README}\n<!-- numbers: measured -->\n{gate}", encoding="utf-8")
    (tmp_path / "mine").mkdir()
    assert work(page, tmp_path / "mine") >= 6


def test_every_target_of_make_exists() -> None:
    """Every target that the README names has a rule in the Makefile."""
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    rules = {
        name for line in re.findall(r"^([a-z][a-z -]*):", makefile, re.M) for name in line.split()
    }
    targets = set(re.findall(r"`?make ([a-z-]+)[` ]", README))
    assert {"verify", "test"} <= targets <= rules
