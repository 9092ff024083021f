"""A body of revolution about body axis 1 or 2: solved in axes named anew.

The closed forms are written for the axis 3. A cyclic change of names, v' = (v_j, v_k, v_axis), turns
the body axes by a third of a turn about (1, 1, 1) and mirrors nothing, so Kirchhoff's equations keep
their form; space axes stay, and of the attitude R' = R Q the columns change their places.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.exact.carried import Back
from taylor_verify.exact.kirchhoff.displaced import centred
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.solution import Number, Time
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse, Quaternion
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix

_BODY_AXES: Final = {"linear_impulse", "angular_impulse", "attitude"}


def axis_of_revolution(scene: Scene) -> int | None:
    """Return the body axis along which a free solid is of revolution; 3 where there is a choice."""
    body, _ = solid(centred(Reduced(scene)).scene)
    return body.axis_of_symmetry


def upright(found: Reduced) -> Reduced:
    """Return the motion in axes of which the third is the axis of symmetry.

    A body without one keeps its axes, as does one with a choice that includes the third.
    """
    scene = found.scene
    body, start = solid(scene)
    axis = body.axis_of_symmetry or 3
    if axis == 3:
        return found
    unit = tensors.diagonal((Fraction(1),) * 3)
    change = tuple(unit[i] for i in _order(axis))

    def renamed(matrix: Matrix) -> Matrix:
        return tensors.product(tensors.product(change, matrix), tensors.transpose(change))

    named_anew = replace(
        scene,
        body=ImmersedBody(renamed(body.linear), renamed(body.coupling), renamed(body.angular)),
        initial=Impulse(
            tensors.apply(change, start.linear),
            tensors.apply(change, start.angular),
            _third_of_a_turn(start.attitude, 1 if axis == 1 else -1),
            start.centre,
        ),
    )
    return found.then(named_anew, put_back(axis))


def put_back(axis: int) -> Back:
    """Return the way back from ``upright``, which changes no norm."""
    # Where the component i of the body's own axes stands in the other ones.
    places = [_order(axis).index(i) for i in range(3)]

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        for name in _BODY_AXES & rows.keys():
            rows[name] = np.take(rows[name], places, axis=-1)

    return back


def _order(axis: int) -> tuple[int, int, int]:
    """The components of v in the order of v': the last is that of the axis."""
    return axis % 3, (axis + 1) % 3, (axis + 2) % 3


def _third_of_a_turn(q: Quaternion, side: int) -> Quaternion:
    """q times (1, 1, 1, 1), or times its inverse, which turn by 120 degrees; the norm does not matter.

    The first takes e1, e2, e3 to e2, e3, e1.
    """
    q0, q1, q2, q3 = q
    return (
        q0 - side * (q1 + q2 + q3),
        q1 + side * (q0 + q2 - q3),
        q2 + side * (q0 + q3 - q1),
        q3 + side * (q0 + q1 - q2),
    )
