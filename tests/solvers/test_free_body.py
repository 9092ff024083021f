"""The reader of a free rigid body that the scripts of physics engines share, under an engine of our own."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from builders.oblique import BACKWARDS, oblique

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.process import protocol
from taylor_verify.tradeoff.accuracy import Truth


@pytest.fixture
def shared(sibling: Callable[[str], Any]) -> Any:
    return sibling("free_body")


@pytest.fixture
def immersed(sibling: Callable[[str], Any]) -> Any:
    return sibling("immersed_body")


def asked(problem: Problem, shared: Any) -> Any:
    return shared.free_body(json.loads(json.dumps(protocol.question(problem))))


def runge_kutta(shared: Any, body: Any, step: float, read: Callable[..., Any]) -> Any:
    """Return how to start an engine by RK4 on omega and attitude; ``read`` makes a row of the two."""
    inertia = np.array(body.inertia)

    def rates(state: Any) -> Any:
        omega, attitude = state[:3], state[3:]
        gyration = np.linalg.solve(inertia, np.cross(inertia @ omega, omega))
        return np.array([*gyration, *shared.product(attitude, (0.0, *(omega / 2)))])

    def start() -> Any:
        state = np.array([*body.omega, *body.attitude])

        def advance(steps: int) -> None:
            for _ in range(steps):
                k1 = rates(state)
                k2 = rates(state + step / 2 * k1)
                k3 = rates(state + step / 2 * k2)
                k4 = rates(state + step * k3)
                state[:] += step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)

        return advance, lambda: read(state[:3], state[3:])

    return start


def in_body_axes(shared: Any, body: Any, step: float) -> Any:
    """An engine with a full tensor, whose omega is in body axes."""
    return runge_kutta(shared, body, step, body.row)


def in_space_axes(shared: Any, body: Any, step: float) -> Any:
    """An engine that takes principal moments alone, whose omega is in space axes."""
    turned = body.in_principal_axes()
    assert min(turned.moments) > 0

    def read(omega: Any, attitude: Any) -> Any:
        return turned.row_from_space(shared.to_space(attitude, omega), attitude)

    return runge_kutta(shared, turned, step, read)


def errors(problem: Problem, shared: Any, engine: Any, step: float) -> tuple[float, float]:
    """The largest error of the first row, and of all rows, after a way through the protocol."""
    body = asked(problem, shared)
    solved = shared.stepped(body, step, engine(shared, body, step))
    assert solved.steps == round(4 / step)
    answer = protocol.read(json.dumps(shared.document(body.question, solved)).encode(), problem)
    truth = Truth(problem)
    first, *_ = np.array(answer.states, dtype=float)
    start = problem.given.initial
    expected = [float(w) for w in start.omega] + shared.unit([float(q) for q in start.attitude])
    trajectory = Callback(lambda _: answer.states).solve(problem)
    return float(np.max(np.abs(first - expected))), truth.accuracy(trajectory).worst


@pytest.mark.parametrize("engine", [in_body_axes, in_space_axes])
def test_an_engine_with_the_right_equations_converges_to_the_exact_motion(
    engine: Any, shared: Any
) -> None:
    """The first row is the start, and the error falls with the fourth power of the step: full
    tensor, oblique attitude, backwards in time, in the axes of the question."""
    problem = pose(oblique(time=BACKWARDS), rung("f64"))
    first, coarse = errors(problem, shared, engine, 0.1)
    # A dozen products of numbers below three, each rounded.
    assert first <= 40 * 2**-53
    _, fine = errors(problem, shared, engine, 0.05)
    assert fine <= coarse / 8


@pytest.mark.parametrize("seed", range(20))
def test_a_vector_is_turned_exactly_and_rounded_once(seed: int, shared: Any) -> None:
    """A quaternion of any length turns a vector to space axes, and one to body axes."""
    random = np.random.default_rng(seed)
    attitude, vector = random.normal(size=4) * 10.0 ** random.integers(-9, 9), random.normal(size=3)
    q0, *r = map(Fraction, attitude)
    v = [Fraction(entry) for entry in vector]

    def cross(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
        return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]

    size = q0**2 + sum(entry**2 for entry in r)
    for sign, turned in ((1, shared.to_space), (-1, shared.to_body)):
        across = cross(r, v)
        along = [a + sign * q0 * b for a, b in zip(across, v, strict=True)]
        moved = cross(r, along)
        exact = [a + 2 * b / size for a, b in zip(v, moved, strict=True)]
        assert turned(attitude, vector) == [float(entry) for entry in exact]


def test_a_number_that_is_none_is_turned_to_none(shared: Any) -> None:
    """An engine that has lost its state, or its attitude, has no omega in other axes either."""
    for attitude, vector in (((math.nan, 0, 0, 1), (1, 2, 3)), ((0, 0, 0, 0), (1, 2, 3))):
        assert all(map(math.isnan, shared.to_space(attitude, vector)))
    assert all(map(math.isnan, shared.to_space((1, 0, 0, 0), (math.inf, 0, 0))))


def test_a_step_that_divides_no_instant_is_refused(shared: Any) -> None:
    """Samples are multiples of the step, and the first instant that is none is named."""
    body = asked(pose(load("euler/with-attitude"), rung("f64")), shared)
    assert body.steps(0.01)[:3] == [0, 50, 100]
    with pytest.raises(
        SystemExit, match=r"expected a step that divides t = 0\.5, got 0\.03 @ step"
    ):
        body.steps(0.03)
    with pytest.raises(SystemExit, match=r"divides t = 0\.5, got 7\.0 @ step"):
        body.steps(7.0)


@pytest.mark.parametrize("scene", ["euler/constant-moment", "euler/gyrostat", "kirchhoff/screw"])
def test_a_body_that_is_not_free_is_refused(scene: str, shared: Any) -> None:
    """A moment, wheels and a fluid end a script of a physics engine with a sentence."""
    with pytest.raises(SystemExit, match="expected a free rigid body"):
        asked(pose(load(scene), rung("f64")), shared)


@pytest.mark.parametrize(
    "scene", ["kirchhoff/whole-motion", "kirchhoff/ellipsoid-triaxial", "kirchhoff/backward"]
)
def test_a_solid_in_a_fluid_begins_with_its_impulses(scene: str, immersed: Any) -> None:
    """The row of the velocities at the start is the state of the scene, forwards and backwards in time."""
    problem = pose(load(scene), rung("f64"))
    body = immersed.immersed_body(json.loads(json.dumps(protocol.question(problem))))
    expected = [float(value) for value in problem.given.initial.moving]
    own = body.row(body.velocity, body.omega, body.attitude, body.centre)
    space = to_space_and_back(immersed, body)
    # Two products with matrices of condition below ten, in doubles.
    few = 200 * 2**-53 * max(map(abs, expected))
    for row in (own, space):
        assert np.max(np.abs(np.subtract(row[:6], expected))) <= few
    assert (body.ellipsoid is not None) is ("ellipsoid" in scene)


def to_space_and_back(immersed: Any, body: Any) -> Any:
    turned = immersed.to_space(body.attitude, body.omega)
    return body.row_from_space(body.velocity_in_space, turned, body.attitude, body.centre)


def test_an_ellipsoid_is_asked_with_its_axes(immersed: Any) -> None:
    """The question has the semi-axes and the densities of a scene that was written with them."""
    document = protocol.question(pose(load("kirchhoff/ellipsoid-triaxial"), rung("f64")))
    ellipsoid = immersed.immersed_body(json.loads(json.dumps(document))).ellipsoid
    assert ellipsoid.semi_axes == [1.0, 0.8, 0.5]
    assert (ellipsoid.density, ellipsoid.fluid_density) == (1.5, 1.0)


@pytest.mark.parametrize("scene", ["kirchhoff/constant-loads", "euler/generic"])
def test_a_solid_under_loads_or_without_a_fluid_is_refused(scene: str, immersed: Any) -> None:
    """Loads, and a rigid body, end a script for a solid in a fluid with a sentence."""
    document = json.loads(json.dumps(protocol.question(pose(load(scene), rung("f64")))))
    with pytest.raises(SystemExit, match="expected a free solid in a fluid"):
        immersed.immersed_body(document)
