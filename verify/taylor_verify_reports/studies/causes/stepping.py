"""Simulators that step: what a step does to v, and how the attitude is turned."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Floats, Sample
from taylor_verify_reports.studies.causes.simulated import (
    Rows,
    cross,
    integrated,
    law,
    stepped,
    turned,
)

Draw = np.random.Generator
Make = Callable[[Sample, Draw, float], Rows]


def euler(f: Callable[[Floats], Floats], v: Floats, h: float) -> Floats:
    return v + h * f(v)


def heun(f: Callable[[Floats], Floats], v: Floats, h: float) -> Floats:
    k = f(v)
    return v + h / 2 * (k + f(v + h * k))


def rk4(f: Callable[[Floats], Floats], v: Floats, h: float) -> Floats:
    a = f(v)
    b = f(v + h / 2 * a)
    c = f(v + h / 2 * b)
    return v + h / 6 * (a + 2 * b + 2 * c + f(v + h * c))


def backward(f: Callable[[Floats], Floats], v: Floats, h: float) -> Floats:
    z = v
    for _ in range(60):
        z = v + h * f(z)
    return z


def turn(q: Floats, w: Floats, h: float) -> Floats:
    half = h * np.linalg.norm(w) / 2
    u = np.sinc(half / np.pi) * h * w / 2
    a = np.cos(half)
    return np.array([q[0] * a - q[1:] @ u, *(q[0] * u + a * q[1:] + cross(q[1:], u))])


def begin(q: Floats, before: Floats, after: Floats, h: float) -> Floats:
    return turn(q, before, h)


def mean(q: Floats, before: Floats, after: Floats, h: float) -> Floats:
    return turn(q, (before + after) / 2, h)


def by(step: Any, update: Any) -> Make:
    def make(s: Sample, d: Draw, size: float) -> Rows:
        return stepped(s, step, update, int(d.integers(4, 20)))

    return make


def by_rates(s: Sample, d: Draw, update: Callable[[Floats, Floats, float], Floats]) -> Rows:
    """Return exact v, and an attitude that is updated by the rate at the begin of each step."""
    steps = int(d.integers(2, 6))
    fine = np.concatenate(
        [
            np.linspace(a, b, steps, endpoint=False)
            for a, b in zip(s.times, s.times[1:], strict=False)
        ]
        + [s.times[-1:]]
    )
    rows, q = integrated(s, law(s), fine), [s.q0 / np.linalg.norm(s.q0)]
    for w, h in zip(rows.v[:, -3:], np.diff(fine), strict=False):
        after = update(q[-1], w, float(h))
        q.append(after / np.linalg.norm(after))
    return Rows(s.times, rows.v[::steps], np.array(q)[::steps])


def held_rate(s: Sample, d: Draw, size: float) -> Rows:
    return by_rates(s, d, turn)


def in_place(s: Sample, d: Draw, size: float) -> Rows:
    def update(q: Floats, w: Floats, h: float) -> Floats:
        q = q.copy()
        for i in range(4):
            q[i] += h * turned(q, w)[i]
        return q

    return by_rates(s, d, update)
