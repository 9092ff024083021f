"""Tables on a console of any width: no number loses a character."""

from __future__ import annotations

import pytest
from rich.text import Text

from taylor_verify.cli.console import EscapingConsole, print_table

HEADINGS = (
    *("scene", "rung", "verdict", ">error", ">at t", ">allowed", ">/floor", ">steps", "unit"),
)
ROWS = [
    *(("euler/generic", "f64", Text("pass", "green"), "2.17e-17", "0", "1.73e-15", "0.126"),),
    *(("a/very/long/" * 9, "mp2370", "undecided", "-1.23e-300", "1e+09", "inf", "4.56e+17"),),
]
CELLS = [(*row, "123456789", "scale of H_space") for row in ROWS]


def lines(width: int) -> list[str]:
    console = EscapingConsole(width=width, markup=False, emoji=False, highlight=False)
    with console.capture() as captured:
        print_table(console, HEADINGS, CELLS, keys=2)
    return captured.get().splitlines()


def test_no_character_of_a_number_is_lost() -> None:
    """Every cell but a long key stands whole in one line, none is beyond the width, none is cut."""
    cells = [str(cell) for row in CELLS for cell in row[1:]]
    for width in range(40, 201, 3):
        shown = lines(width)
        assert all(len(line) <= width for line in shown), width
        assert "…" not in "".join(shown)
        assert [cell for cell in cells if not any(cell in line for line in shown)] == [], width


@pytest.mark.parametrize("width", [40, 80, 200])
def test_a_long_key_is_folded_and_whole(width: int) -> None:
    """The parts of a path that is longer than the line, put together, are the path."""
    first = "".join(line.split(" ")[0] for line in lines(width) if line[:1] not in (" ", ""))
    assert "a/very/long/" * 9 in first.replace("mp2370", "")


def test_a_part_below_repeats_its_keys() -> None:
    """Where columns do not fit, every part begins with the scene and the precision of each row."""
    shown = lines(60)
    heads = [line for line in shown if line.startswith("scene")]
    assert len(heads) > 1
    assert all("rung" in line for line in heads)
    assert sum(line.count("mp2370") for line in shown) == len(heads)
