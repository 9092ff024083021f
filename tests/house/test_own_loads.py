"""The page "Your own loads": scenes that are read, refusals that happen, lists of the parser."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from taylor_verify.records.faults import Refused
from taylor_verify.scenes.loads import grammar, piece, states, steps, vocabulary
from taylor_verify.scenes.reading import loads
from taylor_verify.scenes.reading.reader import read

PAGE = Path(__file__).resolve().parents[2] / "docs" / "your-own-loads.md"
TEXT = PAGE.read_text(encoding="utf-8")
SCENES = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
LONGEST = 900


def parser_lists() -> list[str]:
    """The rows of the page's last table that follow from the parser."""
    euler, kirchhoff = vocabulary.names("euler"), vocabulary.names("kirchhoff")
    return [
        f"| functions | `{' '.join(grammar.ALL_FUNCTIONS)}` |",
        f"| names of both models | `{' '.join(sorted(euler & kirchhoff))}` |",
        f"| names of euler | `{' '.join(sorted(euler - kirchhoff))}` |",
        f"| names of kirchhoff | `{' '.join(sorted(kirchhoff - euler))}` |",
        f"| limits of a text | {grammar.MOST_CHARACTERS} characters, "
        f"{grammar.MOST_DEPTH} levels of brackets, a level for each sign of a sum |",
        f"| limits of a scene | {steps.MOST_STEPS} elementary steps, {piece.MOST_SWITCHES} switches, "
        f"{states.MOST_INSTANTS} instants of held states |",
        f"| limits of a number | whole powers up to {steps.MOST_POWER}, {steps.MOST_BITS} bits |",
        f"| limits of a table | {loads.MOST_ROWS} rows |",
    ]


@pytest.mark.parametrize("row", parser_lists(), ids=lambda row: row.split("|")[1].strip())
def test_the_lists_are_those_of_the_parser(row: str) -> None:
    """Functions, names and limits stand on the page as the parser has them."""
    assert row in TEXT.splitlines()


@pytest.mark.parametrize("scene", SCENES, ids=["satellite", "vehicle"])
def test_a_scene_of_the_page_is_read(scene: str) -> None:
    """Both scenes are read as they stand, and have loads."""
    assert read(scene, "a page").body.loads is not None


@pytest.mark.parametrize("text", re.findall(r"^\| `([^`]+)` \| .* \| .* \|$", TEXT, re.MULTILINE))
def test_what_the_page_calls_refused_is_refused(text: str) -> None:
    """Each text of the table is refused with its column."""
    scene = SCENES[0].replace("- k*w1", f"+ {text}")
    with pytest.raises(Refused, match=r"body.moment\[0\], column"):
        read(scene, "a page")


@pytest.mark.parametrize("text", ["clip(w1/0.001, -1, 1)", "0.02*(step(t - 5) - step(t - 7))"])
def test_what_the_page_puts_in_its_place_is_read(text: str) -> None:
    """The texts that the page offers instead are loads."""
    assert text in TEXT
    assert read(SCENES[0].replace("- k*w1", f"+ {text}"), "a page").body.loads is not None


def test_the_page_is_short() -> None:
    """A newcomer reads at most nine hundred words, tables and scenes among them."""
    assert len(TEXT.split()) <= LONGEST
