"""A body of revolution whose origin is not the point of its axis that Clebsch's form is about.

That every turn about axis 3 leaves T as it is allows one term more than Hydromechanics 49 (1) has,
beta (x1 y2 - x2 y1). About the origin moved by a e3, a = -beta/r, it is gone:

    x' = x,   y' = y - a e3 x x,   p_moved = p - beta^2/r,   centre' = centre + a R e3,

and Kirchhoff's equations, the attitude, T, F^2, FG and y3 are what they were.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, final

import numpy as np
from mpmath import mp

from taylor_verify.exact.balls import Enclosed, Enclosure, ball, balls
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.solution import Quantities, Settled, Solution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

_GUARD_DIGITS = 6


def centred(scene: Scene) -> tuple[Scene, Fraction]:
    """The scene about the point of axis 3 where T is of Clebsch's form, and how far along it that is.

    A body that is there already, one that axis 3 is no axis of symmetry of, and one that loads act
    on keep their origin.
    """
    body, start = solid(scene)
    beta, r = body.coupling[0][1], body.angular[0][0]
    if not beta or body.axis_of_symmetry != 3 or not body.is_free:
        return scene, Fraction(0)
    distance = -beta / r
    p, q = body.linear[0][0] + beta * distance, body.coupling[0][0]
    x1, x2, _ = start.linear
    y1, y2, y3 = start.angular
    along = (row[2] for row in rotation_matrix(start.attitude))
    return replace(
        scene,
        body=ImmersedBody(
            linear=tensors.diagonal((p, p, body.linear[2][2])),
            coupling=tensors.diagonal((q, q, body.coupling[2][2])),
            angular=body.angular,
        ),
        initial=Impulse(
            start.linear,
            (y1 + distance * x2, y2 - distance * x1, y3),
            start.attitude,
            tuple(c + distance * e for c, e in zip(start.centre, along, strict=True)),
        ),
    ), distance


def displaced(inner: Solution, distance: Fraction, scene: Scene) -> Solution:
    """The motion of the scene itself, from that of the scene about the other origin."""
    _, start = solid(scene)
    if isinstance(inner, Enclosed):
        return DisplacedBalls(inner, distance, start)
    return Displaced(inner, distance, start)


@final
class DisplacedBalls(Enclosed):
    """In balls: what cancels in y or in the centre widens them, and the precision rises."""

    def __init__(self, inner: Enclosed, distance: Fraction, start: Impulse) -> None:
        self.regime = inner.regime
        self._inner, self._distance, self._start = inner, distance, start

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        return _moved_back(
            self._inner.enclose(elapsed, bits),
            ball(self._distance),
            _at_start(elapsed, (balls(self._start.angular), balls(self._start.centre))),
        )


@final
class Displaced(Settled):
    """In mpmath, believed when two evaluations agree after the move."""

    route = "mpmath"

    def __init__(self, inner: Solution, distance: Fraction, start: Impulse) -> None:
        self.regime = inner.regime
        self._inner, self._distance, self._start = inner, distance, start

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        found = self._inner.evaluate(elapsed, digits)
        with mp.workdps(digits + _GUARD_DIGITS):
            start = self._start
            told = [[mp.convert(c) for c in part] for part in (start.angular, start.centre)]
            moved = _moved_back(found, mp.convert(self._distance), _at_start(elapsed, told))
        return {name: np.array(rows, dtype=object) for name, rows in moved.items()}


def _at_start(elapsed: Sequence[Fraction], told: Sequence[Any]) -> list[Sequence[Any] | None]:
    """y and the centre as they are told, where no time has gone; None elsewhere.

    A y, or a centre, that starts from zero has no digits but exact ones.
    """
    return [None if t else told for t in elapsed]


def _moved_back(
    found: Mapping[str, Any], distance: Any, told: Sequence[Sequence[Any] | None]
) -> dict[str, Any]:
    """The quantities about the scene's own origin; y and the centre as ``told`` where they are."""
    impulses = zip(found["linear_impulse"], found["angular_impulse"], told, strict=True)
    moved = dict(found)
    moved["angular_impulse"] = [
        [y[0] - distance * x[1], y[1] + distance * x[0], y[2]] if start is None else start[0]
        for x, y, start in impulses
    ]
    if "centre" in found:
        places = zip(found["centre"], found["attitude"], told, strict=True)
        moved["centre"] = [
            [c - distance * row[2] for c, row in zip(centre, frame, strict=True)]
            if start is None
            else start[1]
            for centre, frame, start in places
        ]
    return moved
