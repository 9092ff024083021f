"""The order of convergence of a fixed-step answer: read where it shows."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from builders.integrators import Floats, fixed_step, rk4
from builders.scenes import asked_at
from builders.steps import by_step, has_order
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.models.problem import Problem
from taylor_verify.records.observed_order import Convergence, convergence
from taylor_verify.scenes.scene import Scene

HALVED = [2.0**-k for k in range(1, 11)]
FLOOR = 1e-14


def errors_of(order: float, steps: list[float] = HALVED, constant: float = 0.1) -> list[float]:
    return [constant * h**order for h in steps]


# What a sweep of numbers shows.


@given(st.integers(1, 6), st.integers(0, 2**32))
def test_rounding_hides_no_order(order: int, seed: int) -> None:
    """The order is read from the steps above the floor, with noise of the floor added to every error."""
    noise = np.random.default_rng(seed).uniform(0, FLOOR, len(HALVED))
    fit = convergence(HALVED, list(errors_of(order) + noise), FLOOR)
    assert fit.order is not None
    # Ten floors of error have a tenth of noise at most: log2(1.1) over one halving.
    assert fit.order == pytest.approx(order, abs=0.14)


@pytest.mark.parametrize("steps", [[0.1, 0.1, 0.2], [0.1, 0.0, 0.2], [0.1, -0.1, 0.2]])
def test_steps_are_positive_and_distinct(steps: list[float]) -> None:
    """Else the call is wrong, and says so."""
    with pytest.raises(ValueError, match="expected positive steps, no two the same"):
        convergence(steps, [1.0, 1.0, 1.0])


def test_every_step_has_an_error() -> None:
    """Unlike lengths are a wrong call."""
    with pytest.raises(ValueError, match="got 2 errors and 3 floors"):
        convergence([0.1, 0.2, 0.4], [1.0, 2.0])


# Small fixed-step integrators of the test's own.


def short(name: str) -> Scene:
    """A shipped scene asked at every unit of a short time."""
    return asked_at(name, *range(5))


COARSE = [2.0**-k for k in range(1, 7)]


@pytest.fixture(scope="module")
def averaged() -> dict[str, Convergence]:
    scene = short("euler/with-attitude")
    return by_step(scene, fixed_step(rk4, attitude=True), COARSE)


def test_only_the_vector_in_space_sees_it(averaged: dict[str, Convergence]) -> None:
    """Conserved quantities in body axes are of omega's order; H in space is not."""
    orders = {name: quantity.order for name, quantity in averaged.items()}
    assert orders["H_space"] == pytest.approx(2, abs=0.25)
    # Of energy and momentum RK4 loses one order less than of the state.
    assert min(orders["T"], orders["H2"]) >= 3.75


def test_arithmetic_in_float32_stops_above_the_rounding_of_float64() -> None:
    """The level is no rounding on f64; on f32, whose floor is as high, it is."""
    solve, scene = fixed_step(rk4, np.float32), short("euler/generic")
    steps = [2.0**-k for k in range(0, 8)]
    leak = by_step(scene, solve, steps, "f64")["omega"]
    assert leak.stalls_at is not None
    assert not leak.by_rounding
    assert 1e-9 < leak.level < 1e-5
    honest = by_step(scene, solve, steps, "f32")["omega"]
    assert honest.by_rounding


def test_a_solver_that_breaks_at_large_steps_is_judged_by_the_others() -> None:
    """A raised error at one step leaves the order to the rest."""
    sound = fixed_step(rk4)

    def fragile(problem: Problem, step: float) -> Floats:
        if step > 0.3:
            raise ArithmeticError("the step is too large")
        return sound(problem, step)

    omega = by_step(short("euler/generic"), fragile, COARSE)["omega"]
    assert has_order(omega, 4)
    assert 0.5 not in omega.steps


def test_a_wrong_equation_converges_to_something_else() -> None:
    """A solver of another body has no order: its error is the same at every step."""
    sound = fixed_step(rk4)

    def other(problem: Problem, step: float) -> Floats:
        body = replace(problem.given.body, inertia=((1, 0, 0), (0, 2, 0), (0, 0, Fraction("3.01"))))
        return sound(replace(problem, given=replace(problem.given, body=body)), step)

    omega = by_step(short("euler/generic"), other, COARSE[2:])["omega"]
    assert not has_order(omega, 4)
    assert omega.stalls_at is not None
    assert not omega.by_rounding


def test_errors_that_fall_faster_and_faster_have_not_stalled() -> None:
    """Steps that are too large for a method show a low order first: no error is left that none removes."""
    fit = convergence([0.2, 0.1, 0.05, 0.025], [0.233, 0.199, 0.14, 0.0838])
    assert fit.stalls_at is None
    noise = convergence([0.2, 0.1, 0.05, 0.025], [1e-12, 1.1e-12, 0.9e-12, 1e-12])
    assert noise.stalls_at == 0.2
