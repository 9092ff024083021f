"""A small engine board: two engines that are solvers of this project, and rows that are made up."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from taylor_verify.records.provenance import Machine
from taylor_verify_reports.studies.engines.answer import Answer, answered, row_of
from taylor_verify_reports.studies.engines.document import (
    STATES,
    Board,
    EngineRow,
    EnginesStudy,
    EnginesTimings,
    Standing,
)
from taylor_verify_reports.studies.engines.entry import BoardScene, Entry, EntryList
from taylor_verify_reports.studies.engines.measure import board_of

SCENE = "engines/oblique"
# An engine of fourth order, one of second order, and a plain solver.
SPINNER = Entry("spinner", "Spinner", "geometric:lie-rk4", ("0.1", "0.05", "0.025"))
WOBBLER = Entry("wobbler", "Wobbler", "geometric:splitting", ("0.1", "0.05", "0.025"))
PLAIN = Entry("scipy", "SciPy", "scipy:DOP853", ("1e-3",), knob="rtol", plain=True)
ENTRIES = EntryList((BoardScene(SCENE, job="free rotation"),), (SPINNER, WOBBLER, PLAIN))


@cache
def answers() -> tuple[Answer, ...]:
    """The runs of the small list, really run."""
    return tuple(answered(ENTRIES.runs()))


@cache
def board() -> Board:
    """The board of the small list."""
    return board_of(answers(), 1)


def made_up(entry: Entry, errors: dict[str, float], **others: object) -> list[EngineRow]:
    """Rows of an entry with the same errors at every value."""
    rows, floors = [], {name: 1e-15 for name in errors if name in STATES}
    for run in entry.runs(ENTRIES.scene):
        row = row_of(run, Standing.JUDGED, errors=dict(errors), floors=floors)
        rows.append(replace(row, **others))  # type: ignore[arg-type]
    return rows


def board_with(*rows: EngineRow, seconds: dict[str, float] | None = None) -> Board:
    """A board of rows."""
    spans = dict.fromkeys((row.scene for row in rows), 20.0)
    times = {row.key: 1.0 for row in rows} if seconds is None else seconds
    return Board(EnginesStudy({}, spans, rows), EnginesTimings(2, Machine(), times))
