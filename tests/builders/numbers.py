"""Numbers and arrays of mpmath, distances of motions, and the closed routes of a scene."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.route import CLOSED_ROUTES, solution
from taylor_verify.exact.solution import Motion, NoClosedForm
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]


def matrix(rows: Matrix) -> Array:
    """Return the array of these numbers, rounded at the ambient precision."""
    return np.array([[mp.convert(entry) for entry in row] for row in rows], dtype=object)


def cross(a: Array, b: Array) -> Array:
    """Return the cross product of two vectors.

    np.cross is made for many rows at once, and takes ten times as long for one.
    """
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def rationals(values: Array) -> Vector:
    """Return the exact values of an array of mpf, flat."""
    return tuple(map(exact_value, values.flat))


def largest(values: Any) -> mpf:
    """Return the largest absolute value of an array."""
    return max(abs(value) for value in np.asarray(values, dtype=object).flat)


def apart(one: Motion, other: Motion) -> mpf:
    """Return the largest distance of a vector or matrix from its like, in parts of its norm.

    NaN if one of them is.
    """
    assert set(one.quantities) == set(other.quantities)
    distances = [mpf(0)]
    for name, rows in one.quantities.items():
        for p, q in zip(rows, other[name], strict=True):
            size = mp.norm(list(p.flat))
            distances.append(mp.norm(list((p - q).flat)) / (size if size else 1))
    return mp.nan if any(map(mp.isnan, distances)) else max(distances)


def overlap(one: Motion, other: Motion) -> bool:
    """Return True if no vector or matrix differs by more than both radii, times its norm, allow."""
    with mp.workdps(400):
        return set(one.quantities) == set(other.quantities) and all(
            mp.norm(list((p - q).flat)) <= _room(p, r) + _room(q, s)
            for name, rows in one.quantities.items()
            for p, q, r, s in zip(rows, other[name], one.radius, other.radius, strict=True)
        )


def _room(values: Array, radius: mpf) -> mpf:
    """Return the radius times the largest norm that the truth can have."""
    return radius * (mp.norm(list(values.flat)) / (1 - radius) or 1)


# Closed routes


def has_route(scene: Scene, route: str) -> bool:
    """True if the scene has a closed form by this route."""
    try:
        solution(scene, route)
    except NoClosedForm:
        return False
    return True


def closed_routes(scene: Scene) -> list[str]:
    """The routes by which a scene has a closed form: balls, mpmath where it has one, or none."""
    return [route for route in CLOSED_ROUTES if has_route(scene, route)]


def motions_of_taylor(
    scene: Scene, regime: str, times: Sequence[Fraction], digits: int
) -> list[Motion]:
    """Return the motion by each closed route, which has this regime and all digits of the enclosed one."""
    truth, motions = solution(scene, "taylor").motion(times, digits), []
    for route in closed_routes(scene):
        exact = solution(scene, route)
        assert (exact.regime, exact.route) == (regime, route)
        motions.append(exact.motion(times, digits))
        with mp.workdps(2 * digits + 20):
            assert apart(motions[-1], truth) <= 2 * mpf(10) ** -digits
    return motions
