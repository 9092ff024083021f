"""Integrators of few lines: Euler, Runge-Kutta and extrapolation; and the order that steps show."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil
from typing import Any, final

import numpy as np
from mpmath import mpf

from builders.numbers import cross
from builders.trajectories import QUATERNION, VECTORS, Columns, named
from builders.verdicts import by_quantity
from taylor_verify.judge.judgement import judgement
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.observed_order import SAME, Convergence, convergence
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Trajectory

Floats = np.ndarray[Any, Any]


def euler_rates(problem: Problem) -> Callable[[Floats], Floats]:
    inertia = np.array(problem.given.body.inertia, dtype=float)
    inverse = np.linalg.inv(inertia)
    return lambda w: inverse @ cross(inertia @ w, w)


def explicit_euler(f: Callable[[Floats], Floats], w: Floats, h: float) -> tuple[Floats, Floats]:
    return w + h * f(w), w


def rk4(f: Callable[[Floats], Floats], w: Floats, h: float) -> tuple[Floats, Floats]:
    """The step, and the mean of the angular velocities at its four stages."""
    k1 = f(w)
    w2 = w + h / 2 * k1
    k2 = f(w2)
    w3 = w + h / 2 * k2
    k3 = f(w3)
    w4 = w + h * k3
    mean = (w + 2 * w2 + 2 * w3 + w4) / 6
    return w + h / 6 * (k1 + 2 * k2 + 2 * k3 + f(w4)), mean


def turned(q: Floats, angle: Floats) -> Floats:
    """q times the exponential of half a rotation vector in body axes."""
    half = np.linalg.norm(angle) / 2
    s, v = np.cos(half), np.sinc(half / np.pi) * angle / 2
    return np.array([q[0] * s - q[1:] @ v, *(q[0] * v + s * q[1:] + cross(q[1:], v))])


def fixed_step(method: Callable[..., tuple[Floats, Floats]]) -> Callable[[Problem, float], Floats]:
    """Rows of omega and the quaternion at the samples, by steps that divide their spans."""

    def solve(problem: Problem, step: float) -> Floats:
        f = euler_rates(problem)
        initial = problem.given.initial
        w = np.array([float(v) for v in initial.omega])
        q = np.array([float(v) for v in initial.attitude])
        q /= np.linalg.norm(q)
        rows = [[*w, *q]]
        for a, b in pairwise(float(t) for t in problem.given.clock.elapsed):
            count = round((b - a) / step)
            h = (b - a) / count
            for _ in range(count):
                w, mean = method(f, w, h)
                q = turned(q, h * mean)
            rows.append([*w, *q])
        return np.array(rows)

    return solve


def step(rates: Callable[[Any, Any], Any], t: Any, y: Any, h: Any) -> Floats:
    """Return the state after one step of the classical Runge-Kutta method, in whatever numbers."""
    y = np.asarray(y)
    a = np.asarray(rates(t, y))
    b = np.asarray(rates(t + h / 2, y + a * (h / 2)))
    c = np.asarray(rates(t + h / 2, y + b * (h / 2)))
    d = np.asarray(rates(t + h, y + c * h))
    after: Floats = y + (a + 2 * b + 2 * c + d) * (h / 6)
    return after


# The method of Gragg, Bulirsch and Stoer in mpmath

Vector = list[Any]
Rates = Callable[[Any, Vector], Vector]


def extrapolated(rates: Rates, t: Any, y: Vector, h: Any, columns: int) -> tuple[Vector, Any]:
    """Take one large step: the modified midpoint rule at 2, 4, .. small ones, extrapolated to none."""
    table: list[list[Vector]] = []
    for j in range(1, columns + 1):
        row = [_midpoint(rates, t, y, h, 2 * j)]
        for k in range(1, j):
            ratio = (mpf(j) / (j - k)) ** 2
            row.append(
                [b + (b - a) / (ratio - 1) for a, b in zip(table[-1][k - 1], row[-1], strict=True)]
            )
        table.append(row)
    last, before = table[-1][-1], table[-2][-1]
    return last, max(abs(a - b) for a, b in zip(last, before, strict=True))


def _midpoint(rates: Rates, t: Any, y: Vector, h: Any, count: int) -> Vector:
    s = h / count
    before, here = y, [a + s * r for a, r in zip(y, rates(t, y), strict=True)]
    for k in range(1, count):
        rate = rates(t + k * s, here)
        before, here = here, [a + 2 * s * r for a, r in zip(before, rate, strict=True)]
    rate = rates(t + h, here)
    return [(a + b + s * r) / 2 for a, b, r in zip(before, here, rate, strict=True)]


# The order of convergence of a solver that takes a step

Answer = Callable[[Problem, float], Any]


@final
@dataclass(frozen=True)
class AtStep(Solver):
    """A function at one step; it counts as many steps as fit into the span."""

    answer: Answer
    step: float
    setting: str = ""
    name: str = "fixed step"

    def solve(self, problem: Problem) -> Trajectory:
        trajectory = Callback(lambda posed: self.answer(posed, self.step)).solve(problem)
        span = max(abs(t) for t in problem.given.clock.elapsed)
        return replace(trajectory, steps=ceil(float(span) / self.step))


def by_step(scene: Scene, answer: Answer, steps: Sequence[float]) -> dict[str, Convergence]:
    """The convergence of every quantity that is measured."""
    problem = pose(scene, rung("f64"))
    solvers = [AtStep(answer, step) for step in steps]
    judged = [by_quantity(judgement(problem, s, s.solve(problem))) for s in solvers]
    orders = {}
    for name in dict.fromkeys(
        n for rows in judged for n, row in rows.items() if row.at is not None
    ):
        rows = [each.get(name) for each in judged]
        errors = [r.max if r and r.verdict is not Status.UNDECIDED else None for r in rows]
        floors = [(row.attainable or 0.0) if row else 0.0 for row in rows]
        orders[name] = convergence(steps, errors, floors)
    return orders


def has_order(fit: Convergence, order: float) -> bool:
    """Return True if the steps show this order, within the scatter of local orders."""
    return fit.order is not None and abs(fit.order - order) <= SAME


# First-order engines

Array = np.ndarray[Any, Any]
# omega after a step of length h, from I, the momentum of the wheels, omega, the moment M and h.
Kick = Callable[[Array, Array, Array, Array, float], Array]


def none(inertia: Array, rotor: Array, w: Array, moment: Array, h: float) -> Array:
    return w + h * np.linalg.solve(inertia, moment)


def explicit(inertia: Array, rotor: Array, w: Array, moment: Array, h: float) -> Array:
    return w + h * np.linalg.solve(inertia, moment - cross(w, inertia @ w + rotor))


def without_wheels(inertia: Array, rotor: Array, w: Array, moment: Array, h: float) -> Array:
    """An implicit step that knows nothing of the wheels."""
    return implicit(inertia, 0 * rotor, w, moment, h)


def implicit(inertia: Array, rotor: Array, w: Array, moment: Array, h: float) -> Array:
    """One step of Newton's method for I (w' - w) = h (M - w' x (I w' + rotor))."""
    momentum = inertia @ w + rotor
    slope = np.column_stack([cross(e, momentum) + cross(w, inertia @ e) for e in np.eye(3)])
    return w + h * np.linalg.solve(inertia + h * slope, moment - cross(w, momentum))


def engine(scene: str, kick: Kick, h: float, rows: int, every: int = 1) -> Columns:
    """Rows of t, omega in body axes and a unit quaternion; a row after every so many steps."""
    given = load(scene)
    inertia = np.array(given.body.inertia, dtype=float)
    moment = np.array(given.body.moment, dtype=float)
    rotor = np.array(given.body.rotor, dtype=float)
    w = np.array(given.initial.omega, dtype=float)
    q = np.array(given.initial.attitude, dtype=float)
    q /= np.linalg.norm(q)
    start, states = float(given.clock.start), []
    for step in range((rows - 1) * every + 1):
        if step % every == 0:
            states.append([start + step * h, *w, *q])
        w = kick(inertia, rotor, w, moment, h)
        q = turned(q, h * w)
        q /= np.linalg.norm(q)
    table = np.array(states)
    columns = named(("t",), table[:, :1])
    return columns | named(VECTORS["omega"], table[:, 1:4]) | named(QUATERNION, table[:, 4:])
