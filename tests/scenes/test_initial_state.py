"""The row of the start: an answer that is wrong there says so before anything else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
from builders.turns import by_turns

import taylor_verify
from taylor_verify.models.problem import Problem
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.taylor.driver import Taylor

SCENES = ["euler/generic", "euler/later-start", "euler/full-tensor", "kirchhoff/whole-motion"]
Rows = np.ndarray[Any, Any]


def answered(change: Callable[[Rows], Rows]) -> Callable[[Problem], Any]:
    """A sound solver of free bodies whose rows are changed."""

    def solve(problem: Problem) -> Any:
        trajectory = Taylor().solve(problem)
        return change(trajectory.quantities["omega"].astype(float))

    return solve


def first_moved(rows: Rows) -> Rows:
    """The first row is wrong by a millionth, and no other."""
    moved = rows.copy()
    moved[0] *= 1 + 1e-6
    return moved


def last_moved(rows: Rows) -> Rows:
    moved = rows.copy()
    moved[-1] *= 1 + 1e-6
    return moved


@pytest.mark.parametrize(("scene", "on"), by_turns(product(SCENES, ["f32", "f64", "mp237"]), 5))
def test_a_sound_run_starts_where_it_was_told(scene: str, on: str) -> None:
    """The first row of every run is that of the start, and passes."""
    first, *others = run(scene, "taylor", on).verdicts
    assert (first.quantity, first.verdict) == (INITIAL, Status.PASS)
    assert first.at == float(load(scene).clock.start)
    assert first.bound == GATE_FACTOR * first.attainable
    assert "is the scene's initial state" in first.because
    assert "one rounding of each component of the start on the rung" in first.because
    assert all(verdict.quantity != INITIAL for verdict in others)


def test_a_wrong_start_is_said_first() -> None:
    """The row fails with the size of the error, and so does the state at that sample."""
    first, omega, *_ = taylor_verify.check("euler/generic", answered(first_moved)).verdicts
    assert (first.quantity, first.verdict) == (INITIAL, Status.FAIL)
    assert first.max == pytest.approx(1e-6, rel=0.05)
    assert "is not the scene's initial state: its omega is off by 9.79e-07" in first.because
    assert (omega.verdict, omega.at) == (Status.FAIL, 0.0)


def test_a_wrong_end_is_no_wrong_start() -> None:
    """Rows that are wrong later only fail later."""
    first, omega, *_ = taylor_verify.check("euler/generic", answered(last_moved)).verdicts
    assert (first.verdict, omega.verdict) == (Status.PASS, Status.FAIL)


def test_a_start_of_nan_fails() -> None:
    """No comparison with a number that is none is a pass."""

    def spoil(rows: Rows) -> Rows:
        return np.where(np.arange(len(rows))[:, None] == 0, np.nan, rows)

    first, *_ = taylor_verify.check("euler/generic", answered(spoil)).verdicts
    assert (first.quantity, first.verdict) == (INITIAL, Status.FAIL)


def test_a_run_that_is_not_asked_at_its_start_has_no_such_row() -> None:
    """Without a sample at the start there is nothing to compare there."""
    scene = load("euler/generic")
    late = replace(scene, clock=Clock(scene.clock.start, scene.clock.instants[1:]))
    assert INITIAL not in {verdict.quantity for verdict in run(late).verdicts}


def test_a_callback_of_the_exact_start_passes_with_no_error() -> None:
    """The rung's own numbers of the start leave no more than their rounding."""

    def still(problem: Problem) -> Any:
        return [[float(w) for w in problem.given.initial.omega]] * len(problem.times)

    first, omega, *_ = run("euler/generic", Callback(still)).verdicts
    assert first.max is not None
    assert first.attainable is not None
    assert first.max <= first.attainable
    assert (first.verdict, omega.verdict) == (Status.PASS, Status.FAIL)
