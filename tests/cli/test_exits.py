"""A solver of one's own that ends the program has failed: its caller lives on, and says so."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest

import taylor_verify
from taylor_verify.judge.judgement import Judgement
from taylor_verify.models.problem import Problem
from taylor_verify.records.status import Status
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory

CODES = [0, None, "no licence"]


@dataclass(frozen=True)
class Leaving(Solver):
    """A Solver of one's own, which may break its contract."""

    leave: Callable[[Problem], Any]
    name: str = "leaving"

    def solve(self, problem: Problem) -> Trajectory:
        self.leave(problem)
        raise AssertionError("it left")


WAYS: dict[str, Callable[[Callable[[Problem], Any]], Judgement]] = {
    "check": lambda solve: taylor_verify.check("euler/rest", solve),
    "run": lambda solve: taylor_verify.run("euler/rest", Callback(solve)),
    "solver": lambda solve: taylor_verify.run("euler/rest", Leaving(solve)),
}


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS.keys())
@pytest.mark.parametrize("code", CODES)
def test_sys_exit_is_a_failed_solver(way: Any, code: Any) -> None:
    """The verdict is a fail whose reason names the exit, whatever the code."""
    (verdict,) = way(lambda problem: sys.exit(code)).verdicts
    assert verdict.verdict is Status.FAIL
    assert verdict.outcome == Outcome.RAISED.value
    sentence = "SystemExit" if code is None else f"SystemExit: {code}"
    assert f"({sentence})" in verdict.because


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS.keys())
def test_an_interrupt_stays_an_interrupt(way: Any) -> None:
    """Ctrl-C in the middle of a callable is heard by its caller."""

    def interrupted(problem: Problem) -> Any:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        way(interrupted)


def test_a_script_whose_solver_leaves_comes_to_its_end() -> None:
    """The exit status of a script is its own, and not that of the solver it judges."""
    script = (
        "import sys, taylor_verify\n"
        "judged = taylor_verify.check('euler/rest', lambda problem: sys.exit(0))\n"
        "sys.exit(0 if judged.verdicts[0].verdict == 'pass' else 7)\n"
    )
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 7
