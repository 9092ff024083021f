"""The published boards: what their rows say, and what the verb shows of them."""

from __future__ import annotations

import argparse
from functools import cache
from pathlib import Path

import pytest

from taylor_verify_reports.studies.engines.document import Board, EngineRow, find
from taylor_verify_reports.studies.engines.entry import BOARDS, entry_list
from taylor_verify_reports.verbs import board as verb

REPORTS = Path(__file__).resolve().parents[3] / "reports"


@cache
def board() -> Board:
    published = find(REPORTS)
    assert published is not None
    return published


def rows() -> list[EngineRow]:
    """The rows of runs that ended with a trajectory."""
    return [row for row in board().study.rows if row.is_judged]


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
    """A board has its advice for each job, and each row its number and the command that makes it."""
    parser = argparse.ArgumentParser()
    verb.add(parser)
    asked = parser.parse_args(["--from", str(REPORTS), "--board", name])
    (document,) = verb.run(asked).document["boards"]
    jobs = entry_list(name).jobs
    assert [job for job in jobs if not any(f"or {job} take" in a for a in document["advice"])] == []
    assert [row["row"] for row in document["rows"]] == [*range(len(document["rows"]))]
    assert all(row["command"].startswith("taylor-verify run ") for row in document["rows"])
