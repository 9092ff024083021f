"""Solvers by name, and functions of a user: what they may return, and names that are wrong."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from builders.scenes import text_of
from scipy.optimize import OptimizeResult as OdeResult

import taylor_verify
from taylor_verify import solve
from taylor_verify.judge.judgement import Judgement
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory

TOP = text_of({"inertia": [1, 1, 2]}, {"omega": [0.5, 0, 2]}, 1, 5)


@cache
def scene() -> Scene:
    return read(TOP, "top")


def omega(t: Any) -> Any:
    """omega of a symmetric top in closed form: it precesses by (I3 - I1)/I1 omega3 = 2."""
    t = np.asarray(t)
    return np.array([0.5 * np.cos(2 * t), 0.5 * np.sin(2 * t), np.full_like(t, 2.0)])


def times(problem: Problem) -> Any:
    return np.array([float(t) for t in problem.given.clock.instants])


def rows(problem: Problem) -> Any:
    return omega(times(problem)).T


def result(problem: Problem, **more: Any) -> Any:
    return SimpleNamespace(t=times(problem), y=omega(times(problem)), **more)


def other_times(problem: Problem) -> dict[str, Any]:
    del problem
    t = np.linspace(0, 1, 8)
    return {"t": t, "omega": omega(t).T}


ANSWERS: dict[str, Callable[[Problem], Any]] = {
    "(t, y) with a row for each time": lambda p: (times(p), rows(p)),
    "(t, y) with a row for each state": lambda p: (times(p), rows(p).T),
    "a result": result,
    "a result at steps, with a dense output": lambda p: SimpleNamespace(
        t=np.array([0.0, 1.0]), y=omega([0.0, 1.0]), sol=omega
    ),
    "a result that is a dict": lambda p: OdeResult(t=times(p), y=omega(times(p))),
    "a dense output": lambda p: omega,
    "the trajectory of a solver": lambda p: solve(scene(), rows),
    "a dict": lambda p: {"t": times(p), "omega": rows(p)},
    "a dict without times": lambda p: {"omega": rows(p)},
    "columns by name": lambda p: dict(
        zip(("t", "w1", "w2", "w3"), (times(p), *rows(p).T), strict=True)
    ),
    "nested lists": lambda p: rows(p).tolist(),
}


@pytest.mark.parametrize("answer", ANSWERS.values(), ids=ANSWERS)
def test_whatever_a_function_returns_is_the_same_answer(answer: Callable[[Problem], Any]) -> None:
    """The states at the scene's times are those of the array, number by number."""
    problem = pose(scene(), rung("f64"))
    expected, got = (Callback(each).solve(problem) for each in (rows, answer))
    assert got.outcome is Outcome.FINISHED
    assert np.array_equal(got.quantities["omega"], expected.quantities["omega"])


WRONG: dict[str, tuple[Callable[[Problem], Any], Outcome, str]] = {
    "as many states as times": (
        lambda p: ([0, 1, 2], np.zeros((3, 3))),
        Outcome.MISSHAPEN,
        "hand over y alone",
    ),
    "a result without success": (
        lambda p: result(p, success=False, message="step size too small"),
        Outcome.INTERRUPTED,
        "step size too small",
    ),
    "a dict of nothing": (lambda p: {}, Outcome.MISSHAPEN, "expected"),
    "masked numbers": (
        lambda p: np.ma.masked_less(rows(p), 0),
        Outcome.MISSHAPEN,
        "without a mask",
    ),
    "None": (lambda p: None, Outcome.MISSHAPEN, "expected states of shape (5, 3), got ()"),
}


@pytest.mark.parametrize(("answer", "outcome", "sentence"), WRONG.values(), ids=WRONG)
def test_what_is_no_answer_is_an_outcome(
    answer: Callable[[Problem], Any], outcome: Outcome, sentence: str
) -> None:
    """The run is not scored, and the sentence says what came."""
    trajectory = Callback(answer).solve(pose(scene(), rung("f64")))
    assert trajectory.outcome is outcome
    assert sentence in trajectory.detail


def test_rows_at_times_of_their_own_are_judged_there() -> None:
    """They pass where they are right, a wrong one fails, and names that mean nothing are misshapen."""
    judged = taylor_verify.run(scene(), other_times, tolerance=1e-12)
    assert judged.passed
    assert judged.verdicts[0].solver == "other_times"
    late = taylor_verify.run(
        scene(), lambda p: {**other_times(p), "t": np.linspace(0, 1.1, 8)}, tolerance=1e-9
    )
    assert not late.passed
    (named,) = taylor_verify.run(scene(), lambda p: {"a": [1.0, 2.0]}).verdicts
    assert "expected w1 w2 w3" in named.because


SOURCE = """
import numpy as np
class Top:
    def __call__(self, problem, rate=2.0):
        t = np.array([float(t) for t in problem.given.clock.instants])
        return np.array([np.cos(rate * t) / 2, np.sin(rate * t) / 2, 0 * t + 2]).T
top = Top()
"""


def test_a_name_finds_a_function_in_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Settings behind ? are keyword arguments: with the wrong rate the same function fails."""
    (tmp_path / "top_of_a_test.py").write_text(SOURCE)
    monkeypatch.chdir(tmp_path)
    right, wrong = (
        taylor_verify.check(scene(), f"python:top_of_a_test:top{query}", tolerance=1e-9)
        for query in ("", "?rate=2.5")
    )
    assert right.passed
    assert not wrong.passed
    assert {v.solver for v in wrong.verdicts} == {"python:top_of_a_test:top?rate=2.5"}


def test_several_scenes_are_judged_by_a_function_in_one_call() -> None:
    """`check` of a list is `run_many`, whose solver may be an object."""
    judged = taylor_verify.check([scene()], rows, tolerance=1e-9)
    assert judged.passed
    assert [each.verdicts[0].scene for each in judged] == ["top"]
    assert judged.solver == "rows"


# A function that ends the program has failed: its caller lives on, and says so.


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


# Wrong names


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("taylor?tol=0", r"expected a positive number, got '0' @ tol"),
        ("taylor?tol=many", r"got 'many' @ tol"),
        ("taylor?", r"expected \?tol=NUMBER after taylor, got none"),
        ("taylor?rtol=1e-6", r"got 'rtol'; did you mean tol\?"),
        ("taylor?tol=1&tol=2", r"got tol twice"),
        ("scipy:RK45?stop=never", r"expected yes or no, got 'never' @ stop"),
        ("taylor?code=fast", r"expected optimised, got 'fast' @ code"),
        ("taylor?code=optimised&tol=0", r"expected a positive number, got '0' @ tol"),
        ("taylor:tol=1e-6", r"expected a solver"),
        ("scipy:extra:RK45", r"expected a method"),
        ("geometric:spliting?step=1", r"got 'spliting'; did you mean splitting\?"),
        ("geometric:splitting", r"expected \?step=NUMBER after splitting, got none"),
        ("geometric:splitting?step=", r"expected \?step=NUMBER after splitting, got none"),
        ("geometric:splitting?step=NUMBER", r"got 'NUMBER' @ step"),
        ("geometric:splitting?step=0", r"expected a positive number, got '0' @ step"),
        ("geometric:splitting?step=-1", r"expected a positive number, got '-1' @ step"),
        ("geometric:splitting?step=nan", r"got 'nan' @ step"),
        ("geometric:splitting?stp=1", r"got 'stp'; did you mean step\?"),
        ("geometric:splitting?step=1&step=2", r"expected each setting once, got step twice"),
        ("geometric:", r"expected a method \(implicit-midpoint, .*\), got ''"),
        ("scipy:DOP854", r"got 'DOP854'; did you mean DOP853\?"),
        ("scipy:RK45?tol=1e-6", r"got 'tol'; did you mean"),
        ("scipy:RK45?rtol=1e-16", r"expected at least 2.22e-14, SciPy's own bound, .* @ rtol"),
        ("scipy:RK45?atol=0", r"expected a positive number, got '0' @ atol"),
        ("mpmath:odefunc", r"got 'odefunc'; did you mean odefun\?"),
        ("mpmath:odefun?tol=0", r"expected a positive number, got '0' @ tol"),
        ("mpmath:odefun?degree=2.5", r"whole number from 2 to 1000, got '2.5' @ degree"),
        ("mpmath:odefun?degree=1", r"whole number from 2 to 1000, got '1' @ degree"),
        ("mpmath:odefun?rtol=1", r"got 'rtol'; did you mean tol\?"),
        ("outside:cvode-bdg", "did you mean cvode-bdf"),
        ("outside:cvode-bdf?tol=1", "expected a setting"),
        ("outside:cvode-bdf?rtol=0", "expected a positive number"),
        ("outside:cvode-bdf?version=latest", "a version such as .*, got 'latest' @ version"),
        ("outside:cvode-bdf?version=1.0 ; evil", "@ version"),
        ("outside:cvode-bdf?version=", "@ version"),
        ("python:", "expected python:package.module:function, got python:"),
        ("python:nowhere_at_all:f", "No module named 'nowhere_at_all'"),
        ("python:math:nothing", "has no attribute 'nothing'"),
        ("python:math:pi", "expected a callable, got a float"),
        ("python:math:sin?step", "expected KEY=VALUE behind"),
        ("process: ", "expected a"),
        ("process:'open", "expected a"),
        ("proces:x", "expected a"),
        ("tailor", "expected a"),
    ],
)
def test_a_name_that_is_wrong_is_refused(name: str, words: str) -> None:
    """The refusal says what was expected, what came, and where."""
    with pytest.raises(ValueError, match=words):
        solver_named(name)
