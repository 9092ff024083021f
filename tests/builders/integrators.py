"""Integrators of few lines: Euler, Runge-Kutta and extrapolation."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from mpmath import mpf

from builders.numbers import cross
from taylor_verify.models.problem import Problem

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
