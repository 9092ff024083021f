"""The page of speed against accuracy says what is stored, and nothing that is not."""

from __future__ import annotations

import csv
import re
from dataclasses import replace
from pathlib import Path

from builders.studies.tradeoff import NUMBERS_MADE, POINTS, TIMES_MADE

from taylor_verify.words.cells import NOTHING
from taylor_verify_reports.studies.tradeoff.tradeoff_page import page, sheet
from taylor_verify_reports.studies.tradeoff.trades import Trades


def section(text: str, heading: str) -> str:
    return text.partition(f"## {heading}\n")[2].partition("\n## ")[0]


def line(text: str, *words: str) -> list[str]:
    """The cells of the only line that has all these words."""
    (matching,) = [row for row in text.splitlines() if all(word in row for word in words)]
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", matching)[1:-1]]


def test_a_peer_that_is_ahead_is_named(tmp_path: Path) -> None:
    """The fastest stands before the times with its lead; level are two whose intervals meet."""
    name = "outside:cvode-bdf?rtol=1e-9&atol=1e-9"
    lines = {}
    for ratio in (0.2, 0.7, 2.0):
        low, high = ratio * 0.9, ratio * 1.2
        timings = tuple(
            replace(one, ratio=ratio, low=low, high=high, setup_seconds=7.0)
            if one.solver == name
            else one
            for one in TIMES_MADE.timings
        )
        made = Trades(NUMBERS_MADE, replace(TIMES_MADE, timings=timings))
        table = section(page(made, tmp_path), "Beside compiled integrators of other libraries")
        assert "7.00 s" in table
        lines[ratio] = line(table, "`euler/generic`", " 6 |")
        twelve = line(table, " 12 |")
    # taylor at 1e-6 takes 0.8, from 0.72 to 0.96.
    cells = ["**cvode-bdf**, 4.0 times", "**0.800** @ 1e-06", NOTHING, "**0.200** @ 1e-09"]
    assert lines[0.2][2:] == cells
    assert lines[0.7][2] == "level: cvode-bdf and taylor"
    assert lines[2.0][2] == "taylor, 2.5 times"
    # The yardstick takes two milliseconds, one of them in heyoka.
    assert twelve[2:] == ["taylor, alone", "**1.00**", "0.500", "not reached"]


def test_a_failure_is_listed_and_nowhere_else(tmp_path: Path) -> None:
    """A false success is no digit and no cell of a cost; its reason cannot break the table."""
    text = page(Trades(NUMBERS_MADE, TIMES_MADE), tmp_path)
    listed = section(text, "What failed, and what was not run")
    assert "false success" in line(listed, "RK45?rtol=1e-3")
    assert r"size \| of the motion" in listed
    assert "it would take minutes" in listed
    assert "rtol=1e-3" not in section(text, "What so many digits cost")
    assert "false success" in line(section(text, "Asked for and achieved"), "SciPy RK45")


def test_the_sheet_has_a_row_for_every_setting() -> None:
    """The sheet has every setting with every digit, the failed ones included."""
    rows = list(csv.DictReader(sheet(Trades(NUMBERS_MADE, TIMES_MADE)).splitlines()))
    assert [row["solver"] for row in rows] == [p.solver for p in POINTS]
    assert rows[1]["ratio"] == "1.0"
    assert rows[6]["standing"] == "false success"
