"""The order of convergence of a fixed-step answer: read where it shows."""

from __future__ import annotations

import numpy as np
import pytest
from builders.integrators import fixed_step, rk4
from builders.scenes import asked_at
from builders.steps import by_step
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.records.observed_order import convergence
from taylor_verify.scenes.scene import Scene

HALVED = [2.0**-k for k in range(1, 11)]
FLOOR = 1e-14


def errors_of(order: float) -> list[float]:
    return [h**order / 10 for h in HALVED]


# What a sweep of numbers shows.


@given(st.integers(1, 6), st.integers(0, 2**32))
def test_rounding_hides_no_order(order: int, seed: int) -> None:
    """The order is read from the steps above the floor, with noise of the floor added to every error."""
    noise = np.random.default_rng(seed).uniform(0, FLOOR, len(HALVED))
    fit = convergence(HALVED, list(errors_of(order) + noise), FLOOR)
    assert fit.order is not None
    # Ten floors of error have a tenth of noise at most: log2(1.1) over one halving.
    assert fit.order == pytest.approx(order, abs=0.14)


# Small fixed-step integrators of the test's own.


def short(name: str) -> Scene:
    """A shipped scene asked at every unit of a short time."""
    return asked_at(name, *range(5))


COARSE = [2.0**-k for k in range(1, 7)]


def test_only_the_vector_in_space_sees_it() -> None:
    """Conserved quantities in body axes are of omega's order; H in space is not."""
    averaged = by_step(short("euler/with-attitude"), fixed_step(rk4), COARSE)
    orders = {name: quantity.order for name, quantity in averaged.items()}
    assert orders["H_space"] == pytest.approx(2, abs=0.25)
    # Of energy and momentum RK4 loses one order less than of the state.
    assert min(orders["T"], orders["H2"]) >= 3.75


def test_errors_that_fall_faster_and_faster_have_not_stalled() -> None:
    """Steps that are too large for a method show a low order first: no error is left that none removes."""
    fit = convergence([0.2, 0.1, 0.05, 0.025], [0.233, 0.199, 0.14, 0.0838])
    assert fit.stalls_at is None
    noise = convergence([0.2, 0.1, 0.05, 0.025], [1e-12, 1.1e-12, 0.9e-12, 1e-12])
    assert noise.stalls_at == 0.2
