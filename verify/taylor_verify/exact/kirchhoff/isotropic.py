"""Multiples of 1 in B and in A, which move the space axes and leave x and y as they are.

Legend: X0 = R x and Y0 = R y at the start, F = |x|; a prime marks the motion of the free body without the
multiple, from centre' = 0.

    B = B' + b 1:   R = Q R',   Q = Rot(X0, b F t),   centre = c0 + Q centre' + b int_0^t Q Y0 dt,
    A = A' + p 1:   R = R',     centre = c0 + centre' + p X0 t.

Q turns space, and stands on the left. It is 1 where F = 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb
from mpmath import mp

from taylor_verify.exact.carried import Back
from taylor_verify.exact.kirchhoff.displaced import as_given
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.solution import Number, Time
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import float_text
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene


def multiple(matrix: Matrix) -> Fraction | None:
    """Return b of a matrix b 1, or None for another."""
    first = matrix[0][0]
    return first if matrix == tensors.diagonal((first,) * 3) else None


def less_coupling(reduced: Reduced, b: Fraction) -> Reduced:
    """Return the motion of the body with b 1 less in B."""
    if not b:
        return reduced
    scene = reduced.scene
    body, start = solid(scene)
    words = f"less b = {float_text(b)} in B, which only turns space about the impulse"
    return reduced.then(
        _from_zero(scene, coupling=less(body.coupling, b)), _turned(b, start), words
    )


def less_linear(reduced: Reduced, p: Fraction) -> Reduced:
    """Return the motion of the body with p 1 less in A."""
    if not p:
        return reduced
    scene = reduced.scene
    body, start = solid(scene)
    words = f"less p = {float_text(p)} in A, which only drifts along the impulse"
    return reduced.then(_from_zero(scene, linear=less(body.linear, p)), _drifted(p, start), words)


def less(matrix: Matrix, b: Fraction) -> Matrix:
    """Return the matrix without b 1."""
    return tuple(map(tensors.minus, matrix, tensors.diagonal((b,) * 3)))


def _from_zero(scene: Scene, **blocks: Matrix) -> Scene:
    """Return the scene with other blocks of T, from centre 0."""
    body, start = solid(scene)
    own = {name: getattr(body, name) for name in ("linear", "coupling", "angular")}
    return replace(
        scene,
        body=ImmersedBody(**(own | blocks)),
        initial=replace(start, centre=tensors.ZERO_VECTOR),
    )


def _turned(b: Fraction, start: Impulse) -> Back:
    """Return the way back to a body with b 1 more in B."""
    to_space = rotation_matrix(start.attitude)
    X0, Y0 = (tensors.apply(to_space, v) for v in (start.linear, start.angular))
    w = tensors.scaled(b, X0)
    K = tensors.cross_matrix(w)
    turn = [tensors.diagonal((Fraction(1),) * 3), K, tensors.product(K, K)]
    # int_0^t Q Y0 dt: the part of Y0 along w goes on, the part across it goes round a circle.
    rate_squared = tensors.dot(w, w)
    along = tensors.scaled(tensors.dot(w, Y0) / rate_squared, w) if any(w) else Y0
    across = tensors.minus(Y0, along)
    sweep = [tensors.scaled(b, v) for v in (along, across, tensors.cross(w, across))]

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        if "attitude" not in rows:
            return
        identity, once, twice, ahead, around, aside = (_numbers(v, number) for v in (*turn, *sweep))
        circle = _circle(rate_squared, number)
        for row, t in enumerate(elapsed):
            sine, versed = circle(number(t))
            Q = identity + sine * once + versed * twice
            rows["attitude"][row] = Q @ rows["attitude"][row]
            if "centre" in rows:
                swept = number(t) * ahead + sine * around + versed * aside
                rows["centre"][row] = (
                    _numbers(start.centre, number) + Q @ rows["centre"][row] + swept
                )
        if "centre" in rows:
            as_given(rows["centre"], start.centre, elapsed, number)

    return back


def _circle(rate_squared: Fraction, number: Number) -> Callable[[Any], tuple[Any, Any]]:
    """Return sin(n t)/n and (1 - cos(n t))/n^2, without a difference, as functions of t."""
    if not rate_squared:
        return lambda t: (t, t * t / 2)
    root, sin = (arb.sqrt, arb.sin) if isinstance(number(Fraction(0)), arb) else (mp.sqrt, mp.sin)
    n = root(number(rate_squared))
    return lambda t: (sin(n * t) / n, 2 * (sin(n * t / 2) / n) ** 2)


def _drifted(p: Fraction, start: Impulse) -> Back:
    """Return the way back to a body with p 1 more in A."""
    drift = tensors.scaled(p, tensors.apply(rotation_matrix(start.attitude), start.linear))

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        if "centre" not in rows:
            return
        first, rate = _numbers(start.centre, number), _numbers(drift, number)
        for row, t in enumerate(elapsed):
            rows["centre"][row] = first + rows["centre"][row] + number(t) * rate
        as_given(rows["centre"], start.centre, elapsed, number)

    return back


def _numbers(exact: Any, number: Number) -> Any:
    """Return an object array of a vector or a matrix of rationals."""
    return np.frompyfunc(number, 1, 1)(np.array(exact, dtype=object))
