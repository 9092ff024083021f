"""Fixed-step integrators of a free rigid body: explicit Euler and the classical Runge-Kutta method."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np

from builders.numbers import cross
from taylor_verify.models.problem import Problem

Floats = np.ndarray[Any, Any]


def euler_rates(problem: Problem, number: type) -> Callable[[Floats], Floats]:
    inertia = np.array(problem.given.body.inertia, dtype=float)
    inverse = np.linalg.inv(inertia).astype(number)
    inertia = inertia.astype(number)
    return lambda w: inverse @ cross(inertia @ w, w)


def explicit_euler(f: Callable[[Floats], Floats], w: Floats, h: Any) -> tuple[Floats, Floats]:
    return w + h * f(w), w


def rk4(f: Callable[[Floats], Floats], w: Floats, h: Any) -> tuple[Floats, Floats]:
    """The step, and the mean of the angular velocities at its four stages."""
    two = type(h)(2)
    k1 = f(w)
    w2 = w + h / two * k1
    k2 = f(w2)
    w3 = w + h / two * k2
    k3 = f(w3)
    w4 = w + h * k3
    weights = (w + two * w2 + two * w3 + w4) / type(h)(6)
    return w + h / type(h)(6) * (k1 + two * k2 + two * k3 + f(w4)), weights


def turned(q: Floats, angle: Floats) -> Floats:
    """q times the exponential of half a rotation vector in body axes."""
    half = np.linalg.norm(angle) / 2
    s, v = np.cos(half), np.sinc(half / np.pi) * angle / 2
    return np.array([q[0] * s - q[1:] @ v, *(q[0] * v + s * q[1:] + cross(q[1:], v))])


def fixed_step(
    method: Callable[..., tuple[Floats, Floats]], number: type = np.float64, attitude: bool = False
) -> Callable[[Problem, float], Floats]:
    def solve(problem: Problem, step: float) -> Floats:
        f = euler_rates(problem, number)
        initial = problem.given.initial
        w = np.array([float(v) for v in initial.omega]).astype(number)
        q = np.array([float(v) for v in initial.attitude])
        q /= np.linalg.norm(q)
        rows = [[*w, *q] if attitude else [*w]]
        for a, b in pairwise(float(t) for t in problem.given.clock.elapsed):
            count = round((b - a) / step)
            h = number((b - a) / count)
            for _ in range(count):
                w, mean = method(f, w, h)
                q = turned(q, float(h) * mean.astype(float)) if attitude else q
            rows.append([*w, *q] if attitude else [*w])
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
