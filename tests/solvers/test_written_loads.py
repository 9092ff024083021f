"""Solvers under loads that a scene writes down."""

from __future__ import annotations

import pytest
from builders.written_loads import euler

from taylor_verify.models.problem import pose
from taylor_verify.scenes.precision import rung
from taylor_verify.solvers.registry import solver_named, solver_names
from taylor_verify.solvers.trajectory import Outcome

SPIN = euler(("0.1*sin(2*t)", "-w2/20", "cos(t/3)*w1"))
NUMBERS = {"NUMBER": "1e-2"}
TAKING = ("taylor", "scipy", "mpmath")


def names() -> list[str]:
    """A name of every solver that no program of the user makes, with its settings left out."""
    return [
        name.partition("?")[0] + ("?step=1e-2" if "geometric" in name else "")
        for name in solver_names()
        if not name.startswith("fmu")
    ]


@pytest.mark.parametrize("name", [name for name in names() if not name.startswith(TAKING)])
def test_a_solver_that_cannot_take_written_loads_says_so(name: str) -> None:
    """It answers for no body but the one it is asked about, and so not at all."""
    f64, solver = rung("f64"), solver_named(name)
    problem = pose(SPIN, f64)
    assert "does not take loads that a scene writes down" in solver.unsuited(problem)


@pytest.mark.parametrize("name", ["taylor", "scipy:DOP853", "mpmath:odefun", "process:true"])
def test_a_refusal_is_an_outcome(name: str) -> None:
    """Also where a solver is asked straight away."""
    ended = solver_named(name).solve(pose(SPIN, rung("f64")))
    assert ended.outcome is Outcome.UNSUITED
    assert "loads that a scene writes down" in ended.detail
