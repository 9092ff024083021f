"""Numbers and arrays of mpmath: exact values, largest entries, distances of motions."""

from __future__ import annotations

from typing import Any

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.solution import Motion
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Matrix, Vector

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
