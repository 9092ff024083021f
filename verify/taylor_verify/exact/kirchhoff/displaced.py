"""A body of revolution whose origin is not the point of its axis that Clebsch's form is about.

That every turn about axis 3 leaves T as it is allows one term more than Hydromechanics 49 (1) has,
beta (x1 y2 - x2 y1). About the origin moved by a e3, a = -beta/r, it is gone:

    x' = x,   y' = y - a e3 x x,   p_moved = p - beta^2/r,   centre' = centre + a R e3,

and Kirchhoff's equations, the attitude, T, F^2, FG and y3 are what they were.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from taylor_verify.exact.carried import Back
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.solution import Number, Time
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Vector


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
    moved = replace(
        start,
        angular=(y1 + distance * x2, y2 - distance * x1, y3),
        centre=tuple(c + distance * e for c, e in zip(start.centre, along, strict=True)),
    )
    six = Clebsch(p, body.linear[2][2], q, body.coupling[2][2], r, body.angular[2][2])
    return replace(scene, body=six.body(), initial=moved), distance


def moved_back(distance: Fraction, start: Impulse) -> Back:
    """Return the way back from ``centred`` to the scene's own origin."""

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        far = number(distance)
        x, y = rows["linear_impulse"], rows["angular_impulse"].copy()
        y[:, 0], y[:, 1] = y[:, 0] - far * x[:, 1], y[:, 1] + far * x[:, 0]
        rows["angular_impulse"] = _as_given(y, start.angular, elapsed, number)
        if "centre" in rows:
            centre = rows["centre"] - far * rows["attitude"][:, :, 2]
            rows["centre"] = _as_given(centre, start.centre, elapsed, number)

    return back


def _as_given(rows: Any, start: Vector, elapsed: Sequence[Time], number: Number) -> Any:
    """The rows with the start itself where no time has gone: a zero there has no digits but exact ones."""
    for row, t in zip(rows, elapsed, strict=True):
        if t == 0:
            row[:] = [number(entry) for entry in start]
    return rows
