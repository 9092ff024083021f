"""Motions of Weber's kind, and nearly: bodies of both families, and starts by what is special in them."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any

import pytest

from builders.scenes import vector
from taylor_verify.exact.kirchhoff.integrable import CYCLIC
from taylor_verify.exact.kirchhoff.weber.curve import Curve, curve
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Clock, Impulse
from taylor_verify.scenes.scene import Scene

CLEBSCH = ("1", "3/2", "1/2")
ALIKE = ("3/4", "3/4", "3/4")


def built(
    x: Vector,
    y: Vector,
    r: Vector,
    p: Vector,
    coupling: Fraction = Fraction(1, 8),
) -> Scene:
    """A scene whose T is sum (p_i x_i^2 + r_i y_i^2)/2 and a multiple of x.y, which is nothing here."""
    body = ImmersedBody(tensors.diagonal(p), tensors.diagonal((coupling,) * 3), tensors.diagonal(r))
    clock = Clock(Fraction(0), (Fraction(1),))
    return Scene("built", "built", "kirchhoff", frozenset(), body, Impulse(x, y), clock)


def second(r: Vector, theta: Fraction, shared: Fraction = Fraction(4)) -> Vector:
    """The p of Clebsch's second case."""
    return tuple(shared + theta * r[j] * r[k] for _, j, k in CYCLIC)


# Starts, by what is special about them; y is across x in all.
STARTS: dict[str, tuple[Vector, Vector]] = {
    "plain": (vector("3/4", "-1/2", "1"), vector("1/2", "-1/4", "-1/2")),
    "x_1 = 0": (vector("0", "-1/2", "1"), vector("1/2", "1", "1/2")),
    "x along axis 2": (vector("0", "3/4", "0"), vector("1/2", "0", "-1/3")),
    "x along axis 3": (vector("0", "0", "-1"), vector("1/2", "1/3", "0")),
    "y = 0": (vector("3/4", "-1/2", "1"), vector("0", "0", "0")),
    "y_3 = 0": (vector("3/4", "-1/2", "1"), vector("1/2", "3/4", "0")),
    "fast": (vector("1/4", "1/2", "-1/3"), vector("2", "-1", "0")),
}
BODIES: dict[str, tuple[Vector, Vector]] = {
    "r alike": (vector(*ALIKE), vector("1", "7/4", "1/2")),
    "theta > 0": (vector(*CLEBSCH), second(vector(*CLEBSCH), Fraction(1, 2))),
    "theta < 0": (vector("1/2", "1", "5/4"), second(vector("1/2", "1", "5/4"), Fraction(-3, 4))),
}


@cache
def case(start: str, body: str) -> Scene:
    return built(*STARTS[start], *BODIES[body])


def curve_of(scene: Scene) -> Curve:
    weber_curve = curve(scene)
    assert weber_curve is not None
    return weber_curve


def by_turns() -> list[Any]:
    """Return every pair of body and start as parameters of a test: one of three is quick."""
    return [
        pytest.param(body, start, marks=() if (n + m) % 3 == 0 else pytest.mark.slow)
        for n, start in enumerate(STARTS)
        for m, body in enumerate(BODIES)
    ]
