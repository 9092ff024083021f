"""The equations as straight-line code: the same numbers, each operation once."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import pytest
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.straight_line import straight_line

SCENES = (
    *("euler/full-tensor", "euler/with-attitude", "euler/constant-moment", "euler/spherical"),
    *("kirchhoff/whole-motion", "kirchhoff/general-body", "kirchhoff/constant-loads"),
)


@cache
def problem_of(scene: str) -> Problem:
    return pose(load(scene), rung("f64"))


def plain(problem: Problem) -> list[float]:
    return [float(value) for value in problem.parameters]


@pytest.mark.parametrize("scene", SCENES)
@given(st.lists(st.floats(-4, 4), min_size=13, max_size=13))
def test_the_rates_are_the_same_to_the_last_bit(scene: str, numbers: list[float]) -> None:
    """In floats nothing may be summed or multiplied in another order."""
    problem = problem_of(scene)
    state = numbers[: len(problem.form.states)]
    rates = straight_line(problem.form, plain(problem))(0.0, state)
    assert rates == problem.form.rates(state, plain(problem))


@pytest.mark.parametrize("scene", SCENES)
def test_any_arithmetic_passes_through(scene: str) -> None:
    """With rationals in, the rates are rationals, and the exact ones."""
    problem = problem_of(scene)
    state = [Fraction(k + 1, 7) for k in range(len(problem.form.states))]
    rates = straight_line(problem.form, problem.parameters)(0, state)
    exact = problem.form.rates(state, list(problem.parameters))
    # A rate that is absent is the integer 0, which is a rational too.
    assert rates == exact
    assert all(isinstance(value, Fraction | int) for value in rates)
