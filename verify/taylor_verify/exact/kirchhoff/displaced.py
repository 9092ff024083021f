"""A free solid about another origin, such as the one where B is symmetric.

Legend: d the displacement in body axes, D = [d]x, so that D v = d x v; about the origin moved by d

    B1 = B - D C,   A1 = A + B1 D + (B1 D)^T - D^T C D,   C1 = C,
    x1 = x,   y1 = y - d x x,   R1 = R,   centre1 = centre + R d,

and Kirchhoff's equations, T, F^2 and FG are what they were. B1 is symmetric for

    d = (tr C - C)^-1 (B32 - B23, B13 - B31, B21 - B12)

alone, for tr C - C is positive definite. There T of a body of revolution is of Clebsch's form,
Hydromechanics 49 (1).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from taylor_verify.exact.carried import Back
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.quadratic_forms import exact
from taylor_verify.exact.solution import Number, Time
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import float_text
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene


def centred(reduced: Reduced) -> Reduced:
    """Return the motion of a free body about the origin where B is symmetric."""
    body, _ = solid(reduced.scene)
    return about(reduced, symmetric_origin(body), "where B is symmetric")


def symmetric_origin(body: ImmersedBody) -> Vector:
    """Return the displacement to the one origin about which B is symmetric."""
    B, C = body.coupling, body.angular
    askew = (B[2][1] - B[1][2], B[0][2] - B[2][0], B[1][0] - B[0][1])
    if not any(askew):
        return tensors.ZERO_VECTOR
    trace = sum((C[i][i] for i in range(3)), Fraction(0))
    rest = tuple(map(tensors.minus, tensors.diagonal((trace,) * 3), C))
    return tensors.apply(tensors.inverse(rest), askew)


def about(reduced: Reduced, d: Vector, where: str) -> Reduced:
    """Return the motion about the origin moved by d; ``where`` says what that origin is."""
    if not any(d):
        return reduced
    _, start = solid(reduced.scene)
    place = ", ".join(map(float_text, d))
    words = f"about the origin moved by ({place}), {where}"
    return reduced.then(moved(reduced.scene, d), moved_back(d, start), words)


def moved(scene: Scene, d: Vector) -> Scene:
    """Return the same motion of a free body about the origin moved by d."""
    body, start = solid(scene)
    D, C = exact(tensors.cross_matrix(d)), exact(body.angular)
    B = exact(body.coupling) - D @ C
    turned = B @ D
    A = exact(body.linear) + turned + turned.T - D.T @ C @ D
    moment = tensors.cross(d, start.linear)
    arm = tensors.apply(rotation_matrix(start.attitude), d)
    return replace(
        scene,
        body=ImmersedBody(_matrix(A), _matrix(B), body.angular),
        initial=replace(
            start,
            angular=tensors.minus(start.angular, moment),
            centre=tensors.plus(start.centre, arm),
        ),
    )


def moved_back(d: Vector, start: Impulse) -> Back:
    """Return the way back from ``moved`` to the origin of this start."""

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        far = np.array([number(entry) for entry in d], dtype=object)
        moment = np.cross(far, rows["linear_impulse"])
        rows["angular_impulse"] = as_given(
            rows["angular_impulse"] + moment, start.angular, elapsed, number
        )
        if "centre" in rows:
            centre = rows["centre"] - rows["attitude"] @ far
            rows["centre"] = as_given(centre, start.centre, elapsed, number)

    return back


def as_given(rows: Any, start: Vector, elapsed: Sequence[Time], number: Number) -> Any:
    """The rows with the start itself where no time has gone: a zero there has no digits but exact ones."""
    for row, t in zip(rows, elapsed, strict=True):
        if t == 0:
            row[:] = [number(entry) for entry in start]
    return rows


def _matrix(entries: Any) -> Matrix:
    return tuple(map(tuple, entries))
