"""Sheets of measurements have every row of the data, and every digit."""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

from builders import reports
from builders.studies.hard import study as hard_study

from taylor_verify_reports.studies.growth import growth_page as growth
from taylor_verify_reports.studies.hard.hard_scenes import HARD


@cache
def measured_report() -> Path:
    """A report with the documents of some measurements, all of them short."""
    place = reports.folder()
    reports.write_growth(place)
    HARD.write(place, hard_study())
    return place


def read(text: str) -> list[dict[str, str]]:
    """The rows, each with as many cells as there are headings, of which no two are alike."""
    lines = list(csv.reader(text.splitlines()))
    assert len(set(lines[0])) == len(lines[0])
    assert {len(line) for line in lines} == {len(lines[0])}
    return list(csv.DictReader(text.splitlines()))


def number(cell: str) -> float | None:
    return float(cell) if cell else None


def test_growth_has_a_row_for_every_exponent() -> None:
    """The sheet has each quantity of each ensemble, with its interval and its gate, to the last bit."""
    study = growth.GROWTH.load(measured_report())
    runs, lines = study.runs, read(growth.sheet(study))
    asked = [(run, row) for run in runs for row in run.quantities]
    assert len(lines) == len(asked)
    for cells, (run, row) in zip(lines, asked, strict=True):
        assert (cells["scene"], cells["rung"], cells["quantity"]) == (
            run.scene,
            run.rung,
            row.quantity,
        )
        numbers = [number(cells[name]) for name in ("exponent", "low", "high", "rms_last")]
        assert numbers == [row.exponent, row.low, row.high, row.rms[-1]]
        assert tuple(number(cells[f"late{end}"]) for end in ("", "_low", "_high")) == row.late
        assert cells["gate"] == (row.gate.verdict.value if row.gate else "")
