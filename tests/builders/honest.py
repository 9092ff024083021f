"""Honest answers: a Runge-Kutta method of order four, with every operation rounded to one number type.

Many bodies are integrated at once, one row of an array each. Steps are so short that the truncation of the
method is below the roundings.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import gmpy2
import numpy as np

from builders.integrators import step
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

Rows = np.ndarray[Any, Any]
Rates = Callable[[Rows], Rows]
# Changes what a step makes of a state, from the states before and after it.
Push = Callable[[Rows, Rows], Rows]
Answer = dict[str, Any]
# Makes the number of the type that is nearest to a rational.
Number = Callable[[Fraction], Any]


@dataclass(frozen=True)
class Arithmetic:
    """The number type of a precision: ``bits``, the nearest ``number``, and the array type."""

    bits: int
    number: Number
    dtype: Any

    def array(self, values: Any) -> Rows:
        """Return rationals in an array of this type."""
        rationals = np.array(values, dtype=object)
        return np.array([self.number(v) for v in rationals.flat], self.dtype).reshape(
            rationals.shape
        )


def _in_long_double(value: Fraction) -> np.longdouble:
    return np.longdouble(value.numerator) / np.longdouble(value.denominator)


def arithmetic(rung: str) -> Arithmetic:
    """Return the arithmetic of f32, f64, f80 or mpN; numbers of MPFR round at gmpy2's own precision."""
    if rung.startswith("mp"):
        return Arithmetic(int(rung[2:]), lambda v: gmpy2.mpfr(gmpy2.mpq(v)), object)
    types: dict[str, tuple[int, Number, Any]] = {
        "f32": (24, lambda v: np.float32(float(v)), np.float32),
        "f64": (53, float, np.float64),
        "f80": (64, _in_long_double, np.longdouble),
    }
    return Arithmetic(*types[rung])


def exact(value: Any) -> Fraction:
    """Return the exact value of a number of any type."""
    return Fraction(*(int(part) for part in value.as_integer_ratio()))


# Vectors and tensors, one in each row.


def apply(tensors: Rows, vectors: Rows) -> Rows:
    products: Rows = (tensors * vectors[:, None, :]).sum(axis=-1)
    return products


def cross(a: Rows, b: Rows) -> Rows:
    products: Rows = np.roll(a, -1, 1) * np.roll(b, -2, 1) - np.roll(a, -2, 1) * np.roll(b, -1, 1)
    return products


def inverse(tensors: Rows) -> Rows:
    """Return the inverses of symmetric tensors by their adjugates."""
    columns = [cross(tensors[:, (i + 1) % 3], tensors[:, (i + 2) % 3]) for i in range(3)]
    volume = (tensors[:, 0] * columns[0]).sum(axis=-1)
    inverses: Rows = np.stack(columns, axis=-1) / volume[:, None, None]
    return inverses


def turning(q: Rows, w: Rows) -> Rows:
    """Return q' = q (0, omega) / 2."""
    scalar = -(q[:, 1:] * w).sum(axis=-1, keepdims=True)
    return np.hstack([scalar, q[:, :1] * w + cross(q[:, 1:], w)]) / 2


def to_space(q: Rows, v: Rows) -> Rows:
    r = q[:, 1:]
    turned: Rows = v + 2 * cross(r, cross(r, v) + q[:, :1] * v)
    return turned


# The equations.


def euler_rates(scenes: Sequence[Scene], array: Callable[[Any], Rows]) -> Rates:
    """Return the rates of omega and the quaternion."""
    bodies: list[Any] = [scene.body for scene in scenes]
    inertia, moment = array([b.inertia for b in bodies]), array([b.moment for b in bodies])
    wheels = array([getattr(b, "rotor", (Fraction(0),) * 3) for b in bodies])
    damping, K = array([[b.damping] for b in bodies]), inverse(inertia)

    def rates(state: Rows) -> Rows:
        w, q = state[:, :3], state[:, 3:]
        rate = apply(K, cross(apply(inertia, w) + wheels, w) + moment) - damping * w
        return np.hstack([rate, turning(q, w)])

    return rates


def kirchhoff_rates(scenes: Sequence[Scene], array: Callable[[Any], Rows]) -> Rates:
    """Return the rates of both impulses, the quaternion and the centre."""
    bodies: list[Any] = [scene.body for scene in scenes]
    A, B, C = (array([getattr(b, n) for b in bodies]) for n in ("linear", "coupling", "angular"))
    force, couple = array([b.force for b in bodies]), array([b.couple for b in bodies])
    damping = array([[b.damping] for b in bodies])

    def rates(state: Rows) -> Rows:
        x, y, q = state[:, :3], state[:, 3:6], state[:, 6:10]
        U, w = apply(A, x) + apply(B, y), apply(np.swapaxes(B, 1, 2), x) + apply(C, y)
        linear = cross(x, w) + force - damping * x
        angular = cross(y, w) + cross(x, U) + couple - damping * y
        return np.hstack([linear, angular, turning(q, w), to_space(q, U)])

    return rates


# The answers.


def answers(
    scenes: Sequence[Scene],
    rung: str,
    every: int,
    push: Push = lambda before, after: after,
) -> list[Answer]:
    """Return an answer to each scene, as columns by name: ``every`` steps lead from row to row.

    All scenes have the same model and the same number of equally spaced instants, the first at the start.
    ``push`` changes what a step makes of a state.
    """
    with gmpy2.context(precision=arithmetic(rung).bits):
        return _answers(scenes, arithmetic(rung), every, push)


def _answers(scenes: Sequence[Scene], numbers: Arithmetic, every: int, push: Push) -> list[Answer]:
    array = numbers.array
    make = kirchhoff_rates if isinstance(scenes[0].body, ImmersedBody) else euler_rates
    rates = make(scenes, array)
    state = array([_start(scene) for scene in scenes])
    h = array([[scene.clock.elapsed[1] / every] for scene in scenes])
    rows = [state]
    for _ in scenes[0].clock.elapsed[1:]:
        for _ in range(every):
            state = push(state, step(lambda _, now: rates(now), 0, state, h))
        rows.append(state)
    return [_columns(scene, np.array([row[k] for row in rows])) for k, scene in enumerate(scenes)]


def _start(scene: Scene) -> list[Fraction]:
    """Return the state at the start; the quaternions of these scenes have unit length."""
    centre = scene.initial.centre if isinstance(scene.initial, Impulse) else ()
    return [*scene.initial.moving, *scene.initial.attitude, *centre]


def _columns(scene: Scene, rows: Rows) -> Answer:
    """Return the rows of a state by group, with exact numbers where the type is MPFR's."""
    if rows.dtype == object:
        rows = np.array([exact(v) for v in rows.flat], dtype=object).reshape(rows.shape)
    columns: Answer = {"t": list(scene.clock.instants)}
    names = ["omega"] if scene.model == "euler" else ["linear_impulse", "angular_impulse"]
    for k, name in enumerate(names):
        columns[name] = rows[:, 3 * k : 3 * k + 3]
    place = 3 * len(names)
    if "attitude" in scene.track:
        columns["attitude"] = rows[:, place : place + 4]
    if "centre" in scene.track:
        columns["centre"] = rows[:, place + 4 :]
    return columns
