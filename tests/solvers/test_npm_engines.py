"""The physics engines from npm, where their environments can be made without a download."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from builders.oblique import oblique
from builders.other_equations import WITHOUT_GYROSCOPIC_TERM

from taylor_verify.models.problem import Problem, pose_as_stored
from taylor_verify.scenes.precision import rung
from taylor_verify.solvers.engines.engine import prepare
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.tradeoff.accuracy import Truth

pytestmark = pytest.mark.slow

OMEGA, ATTITUDE = ("[1.2, -0.8, 1.5]", "[3, -1, 2, 1]")
DIAGONAL = "[2, 3, 4]"
FULL = "[[2.64, -0.288, -0.384], [-0.288, 3.4096, -0.7872], [-0.384, -0.7872, 2.9504]]"
PRECISION = {"cannon": "f64"}
WITH_THE_TERM = ["ammo", "ammo?build=wasm", "jolt", "rapier"]
WITHOUT_IT = [name for name in WITHOUT_GYROSCOPIC_TERM if not name.startswith("brax")]
ALL = [*WITH_THE_TERM, *WITHOUT_IT]

Rows = Callable[[str, str, float], tuple[Problem, Any]]


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> Rows:
    """Solves the scene by an engine; nothing is downloaded for it."""
    monkeypatch.setenv("npm_config_offline", "true")

    def solve(name: str, inertia: str, step: float) -> tuple[Problem, Any]:
        try:
            prepare(f"outside:{name}")
        except NotMade as reason:
            pytest.skip(str(reason))
        problem = pose_as_stored(oblique(inertia, omega=OMEGA, attitude=ATTITUDE), posed_on(name))
        joint = "&" if "?" in name else "?"
        trajectory = solver_named(f"outside:{name}{joint}step={step}").solve(problem)
        assert trajectory.outcome is Outcome.FINISHED, trajectory.detail
        return problem, trajectory

    return solve


def posed_on(name: str) -> Any:
    return rung(PRECISION.get(name, "f32"))


def doubles(rows: Any) -> Any:
    return np.array(rows, dtype=float)


@pytest.mark.parametrize("inertia", [DIAGONAL, FULL])
@pytest.mark.parametrize("name", ALL)
def test_an_engine_begins_with_the_start_of_the_scene(
    name: str, inertia: str, solved: Rows
) -> None:
    """Its first row is the start to a few roundings of the engine, in the axes of the scene."""
    problem, trajectory = solved(name, inertia, 0.01)
    start = problem.given.initial
    attitude = doubles(start.attitude)
    # Attitude and omega in space axes are each rounded once by the engine, and omega is turned back.
    few = 8 * 2.0 ** -posed_on(name).bits
    assert np.max(np.abs(doubles(trajectory.quantities["omega"][0]) - doubles(start.omega))) <= few
    attitude /= np.linalg.norm(attitude)
    # The sign is free.
    first = doubles(trajectory.quantities["quaternion"][0])
    assert np.max(np.abs(first * np.sign(first @ attitude) - attitude)) <= few


@pytest.mark.parametrize("name", WITH_THE_TERM)
def test_an_engine_with_the_gyroscopic_term_is_of_first_order(name: str, solved: Rows) -> None:
    """Half the step leaves about half the error, where rounding is small beside it."""
    errors = []
    for step in (0.04, 0.02):
        problem, trajectory = solved(name, DIAGONAL, step)
        errors.append(Truth(problem).accuracy(trajectory).max["omega"])
    assert 1.5 <= errors[0] / errors[1] <= 3


@pytest.mark.parametrize("name", WITHOUT_IT)
def test_an_engine_without_it_keeps_omega_in_space(name: str, solved: Rows) -> None:
    """Omega in space axes stays where it was, whatever the moments."""
    _, trajectory = solved(name, DIAGONAL, 0.01)
    rows = zip(
        doubles(trajectory.quantities["quaternion"]),
        doubles(trajectory.quantities["omega"]),
        strict=True,
    )
    in_space = np.array([turned(q, w) for q, w in rows])
    assert np.max(np.abs(in_space - in_space[0])) <= 400 * 2.0 ** -posed_on(name).bits


def turned(q: Any, v: Any) -> Any:
    twice = 2 * np.cross(q[1:], v)
    return v + q[0] * twice + np.cross(q[1:], twice)
