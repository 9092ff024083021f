"""The two sides of a ratio of `make bench` do the work that the ratio names."""

from __future__ import annotations

from fractions import Fraction

import pytest
from benches.judging import FAILING, PASSING, chunks
from benches.propagation import plain

from taylor_verify.batch.sweeps.chunk import judge
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Postponed


@pytest.mark.parametrize(("tolerance", "status"), [(PASSING, "pass"), (FAILING, "fail")])
def test_satellites_of_the_two_tolerances_pass_and_fail(tolerance: float, status: str) -> None:
    """Every body of a chunk has the status that its ratio names."""
    columns = judge(next(chunks(tolerance))).columns
    of_omega = zip(columns["quantity"], columns["verdict"], strict=True)
    assert {verdict for quantity, verdict in of_omega if quantity == "omega"} == {status}


@pytest.mark.parametrize("name", ["euler/with-attitude", "kirchhoff/general-body"])
def test_heyokas_own_call_solves_what_the_driver_solves(name: str) -> None:
    """The yardstick does the same work: its states are the driver's, to roundings."""
    problem = pose(load(name), rung("f64"))
    rows = Postponed(problem, plain(problem)()[5], Fraction)
    for quantity, states in Taylor().solve(problem).quantities.items():
        assert abs(rows[quantity] - states).max() <= 1e-12 * abs(states).max()
