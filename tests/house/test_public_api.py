"""The names of `import taylor_verify`: plain typed functions, whatever else is imported."""

from __future__ import annotations

import inspect
import pickle
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import is_dataclass
from itertools import chain
from types import FunctionType
from typing import Any, get_args, get_type_hints

import pytest

import taylor_verify
import taylor_verify_reports
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.status import Status
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.tradeoff.recommendation import recommend
from taylor_verify_reports.claims.claim import Finding

TYPES = [name for name in taylor_verify.__all__ if name[0].isupper()]
NAMES = [name for name in taylor_verify.__all__ if name not in ("__version__", *TYPES)]
FUNCTIONS = [getattr(taylor_verify, name) for name in NAMES]
PROMISED = {
    *("load", "exact", "solve", "run", "run_many", "check", "explain", "tradeoff", "recommend"),
    *("certify", "enclose", "events"),
    "sweep",
}


# What the names are.


def test_the_public_names_are_those_of_the_design() -> None:
    """No name is missing, and none was added without a word."""
    assert set(NAMES) == PROMISED


def test_importing_the_package_imports_no_library_of_numbers() -> None:
    """`import taylor_verify` brings in neither an array nor an integrator, nor what is slow to import."""
    command = [sys.executable, "-c", "import sys, taylor_verify; print(*sys.modules)"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    loaded = set(done.stdout.split())
    slow = {"flint", "gmpy2", "heyoka", "mpmath", "numpy", "rich", "dataclasses", "multiprocessing"}
    assert loaded.isdisjoint(slow)
    beside = {"records", "records.version", "numbers", "numbers.working_precision", "types"}
    assert {name for name in loaded if name.startswith("taylor_verify.")} == {
        function.__module__ for function in FUNCTIONS
    } | {f"taylor_verify.{name}" for name in beside}


def named_in(hint: Any) -> Iterator[type]:
    """The classes of this package that an annotation names."""
    if isinstance(hint, type) and hint.__module__.startswith("taylor_verify"):
        yield hint
    inner = hint if isinstance(hint, list) else get_args(hint)
    yield from chain.from_iterable(map(named_in, inner))


def test_the_hints_of_what_functions_take_and_return_are_types() -> None:
    """So are those of every dataclass within: pydantic reads them all to check an answer."""
    waiting, known = [*FUNCTIONS], set[object]()
    while waiting:
        each = waiting.pop()
        if each not in known and (isinstance(each, FunctionType) or is_dataclass(each)):
            known.add(each)
            waiting += chain.from_iterable(map(named_in, get_type_hints(each).values()))
    assert {taylor_verify.Motion, taylor_verify.Trajectory, taylor_verify.Judgement} <= known


def test_a_function_goes_to_another_process() -> None:
    """Pickled and read again each public function is the same one."""
    assert all(pickle.loads(pickle.dumps(function)) is function for function in FUNCTIONS)


# What they return.


class Lost(Solver):
    """A solver of one's own that raises, leaves, or is not there."""

    name = "lost"

    def __init__(self, lacks: str = "") -> None:
        self.lacks = lacks

    def unavailable(self, rung: Rung) -> str:
        del rung
        return self.lacks

    def solve(self, problem: Problem) -> Trajectory:
        del problem
        sys.exit(3)


def test_solve_returns_what_run_judges() -> None:
    """The states of `solve` are those of the solver, one row for each time."""
    trajectory = taylor_verify.solve("euler/generic", "taylor", "f64")
    assert trajectory.outcome is Outcome.FINISHED
    times = taylor_verify.load("euler/generic").clock.elapsed
    assert trajectory.quantities["omega"].shape == (len(times), 3)
    (_, omega, *_) = taylor_verify.run("euler/generic", "taylor", "f64").verdicts
    assert (omega.steps, omega.outcome) == (trajectory.steps, trajectory.outcome.value)


@pytest.mark.parametrize(
    ("scene", "solver", "outcome", "detail"),
    [
        ("euler/rest", Lost(), Outcome.RAISED, "SystemExit: 3"),
        ("euler/rest", Lost("not here"), Outcome.UNSUITED, "not here"),
        ("extremes/kirchhoff-linear-1e-150", "taylor", Outcome.NOT_REPRESENTABLE, ""),
    ],
)
def test_a_run_that_cannot_begin_is_an_outcome(
    scene: str, solver: Solver | str, outcome: Outcome, detail: str
) -> None:
    """`solve` raises nothing for it and has no states; `run` has a verdict with the same outcome."""
    trajectory = taylor_verify.solve(scene, solver, "f32")
    assert trajectory.outcome is outcome
    assert detail in trajectory.detail
    assert trajectory.quantities == {}
    first, *_ = taylor_verify.run(scene, solver, "f32").verdicts
    assert first.outcome == outcome.value
    assert first.verdict is not Status.PASS


def test_a_recommendation_has_the_arguments_of_its_room() -> None:
    """The public function and that of the room ask for the same, by the same names."""
    assert list(inspect.signature(taylor_verify.recommend).parameters) == list(
        inspect.signature(recommend).parameters
    )


def test_claims_returns_findings() -> None:
    """An id, or a part that ends one, gives the finding with its verdict; another one is refused."""
    (finding,) = taylor_verify_reports.claims("hydromechanics 49 (11)")
    assert isinstance(finding, Finding)
    assert finding.is_as_recorded
    with pytest.raises(ValueError, match="expected the id of a claim"):
        taylor_verify_reports.claims("hydromechanics 99")
