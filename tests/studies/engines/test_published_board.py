"""The published board: its rows agree with today's judgement of its trajectories."""

from __future__ import annotations

import argparse
from functools import cache
from pathlib import Path

import pytest

from taylor_verify.records.quantities import COLUMNS, state_groups
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.engines import stored, trajectories
from taylor_verify_reports.studies.engines.document import Board, EngineRow
from taylor_verify_reports.studies.engines.entry import BOARDS, entry_list
from taylor_verify_reports.studies.engines.replay import errors_of, judged
from taylor_verify_reports.verbs import board as verb

REPORTS = Path(__file__).resolve().parents[3] / "reports"
MEGABYTE = 1_000_000
# An error is that of stored numbers against the exact motion: all digits that are printed, but the last.
DIGITS = 2e-3


@cache
def board() -> Board:
    published = stored.find(REPORTS)
    assert published is not None
    return published


def rows() -> list[EngineRow]:
    """The rows whose trajectories are stored: those of the newest version of each engine."""
    return [row for row in board().study.rows if row.is_stored]


def is_still_so(row: EngineRow) -> bool:
    """True if the stored trajectory of a row has its errors, its cause and its start."""
    states = trajectories.states_of(trajectories.load(REPORTS), row)
    assert states is not None
    errors = errors_of(judged(row.scene, row.rung, row.solver, states, row.steps), row.scene)
    assert errors.errors == pytest.approx(row.errors, rel=DIGITS)
    assert errors.floors == pytest.approx(row.floors, rel=0.1)
    assert errors.start == pytest.approx(row.start, rel=DIGITS)
    return errors.cause == row.cause


def test_rows_of_some_engines_are_judged_again() -> None:
    """The first row of every eighth engine on the shortest scene has the published errors."""
    first = {row.engine: row for row in reversed(rows()) if row.scene == "engines/oblique"}
    assert len(first) >= 3
    assert all(is_still_so(row) for row in list(first.values())[::8])


@pytest.mark.slow
def test_every_row_is_judged_again() -> None:
    """Every number of the board is that of today's judge."""
    assert [row.key for row in rows() if not is_still_so(row)] == []


def test_every_trajectory_has_its_row() -> None:
    """The file has a block for each row, with the samples and columns of its scene, in two megabytes."""
    arrays = trajectories.load(REPORTS)
    assert sum(map(len, arrays.values())) == len(rows())
    newest = {row.engine: row.version for row in reversed(board().study.rows)}
    assert {row.engine for row in rows() if row.version != newest[row.engine]} == set()
    assert len({(row.array, row.place) for row in rows()}) == len(rows())
    for row in rows():
        scene = load(row.scene)
        wide = sum(len(COLUMNS[name]) for name in state_groups(scene.model, scene.track))
        assert arrays[row.array][row.place].shape == (len(scene.clock.elapsed), wide)
    assert (REPORTS / stored.TRAJECTORIES).stat().st_size <= 2 * MEGABYTE


def test_the_first_row_of_every_trajectory_is_the_start() -> None:
    """The first row is the start to the rounding of the arithmetic, so that conventions are right.

    Orekit takes no step: it evaluates the first row like any other, and a thousandth beside the separatrix
    the motion magnifies its roundings a thousandfold.
    """
    roundoff = {"f64": 2.0**-53, "f32": 2.0**-24}
    magnified = {("outside:orekit", "engines/flip"): 1000}
    wrong = [
        row.key
        for row in rows()
        if not (row.start or 0.0)
        <= 16 * roundoff[row.rung] * magnified.get((row.solver, row.scene), 1)
    ]
    assert wrong == []


def test_no_engine_is_lost() -> None:
    """A run without a trajectory has a reason."""
    assert [row.key for row in board().study.rows if not row.is_judged and not row.detail] == []


@pytest.mark.parametrize("name", BOARDS)
def test_the_verb_shows_every_published_board(name: str) -> None:
    """A board has its advice for each job, and each stored row a place of its own in a file."""
    parser = argparse.ArgumentParser()
    verb.add(parser)
    asked = parser.parse_args(["--from", str(REPORTS), "--board", name])
    (document,) = verb.run(asked).document["boards"]
    jobs = entry_list(name).jobs
    assert [job for job in jobs if not any(f"or {job} take" in a for a in document["advice"])] == []
    placed = [row for row in document["rows"] if row["array"]]
    place = stored.places(name).trajectories
    assert {row["file"] for row in placed} == {place if (REPORTS / place).is_file() else None}
    assert len({(row["array"], row["place"]) for row in placed}) == len(placed) > 100
