"""The equations of motion as quadratic forms with exact coefficients.

Each kind of body writes its own from the texts; they share nothing with models. What cancels in exact
coefficients is gone: a vector that stays zero for a whole body is disturbed by no rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import prod
from typing import Any, NamedTuple

import numpy as np

from taylor_verify.numbers.tensors import Matrix, Vector

Exact = np.ndarray[Any, Any]
"""An object array of rationals."""
Floats = np.ndarray[Any, np.dtype[np.float64]]


class Scaled(NamedTuple):
    """Equations in units, as float64."""

    constant: Floats
    linear: Floats
    hessian: Floats
    spin: Floats
    velocity: Floats


class Equations(NamedTuple):
    """z' = ``constant`` + ``linear`` z + z.``hessian`` z/2, with Omega = ``spin`` z and U = ``velocity`` z.

    The shapes are (n,), (n, n), (n, n, n), symmetric in the last two places, and (3, n); ``velocity`` has
    no rows for a rigid body.
    """

    constant: Exact
    linear: Exact
    hessian: Exact
    spin: Exact
    velocity: Exact

    def minus(self, other: Equations) -> Equations:
        """The difference, entry by entry."""
        return Equations(*(ours - theirs for ours, theirs in zip(self, other, strict=True)))

    def damped(self, damping: Fraction) -> Equations:
        """The equations with -c z more."""
        if not damping:
            return self
        decay = np.diag([damping] * len(self.constant)) + nothing(len(self.constant))
        return self._replace(linear=self.linear - decay)

    def scaled(self, units: Vector, time: Fraction, length: Fraction) -> Scaled:
        """The equations with z in ``units``, one for each component; the centre goes by lengths."""
        unit = np.array(units, dtype=object)
        rates, turns, lengths = time / unit, [time] * 3, [time / length] * 3
        return Scaled(
            in_units(self.constant, rates).astype(float),
            in_units(self.linear, rates, unit).astype(float),
            in_units(self.hessian, rates, unit, unit).astype(float),
            in_units(self.spin, turns, unit).astype(float),
            in_units(self.velocity, lengths, unit).astype(float),
        )


def exact(rows: Sequence[Any]) -> Exact:
    """The array of a vector or a matrix."""
    return np.array(rows, dtype=object)


def nothing(n: int) -> Exact:
    """The linear part of equations that have none."""
    return np.full((n, n), Fraction(0), dtype=object)


def in_units(values: Exact, *units: Exact | Sequence[Fraction]) -> Exact:
    """The entries times the unit of each of their places, one vector of units for each axis."""
    products = np.full(values.shape, Fraction(0), dtype=object)
    # Most of them are zero, and a product of rationals is dear.
    for place in zip(*np.nonzero(values), strict=True):
        factors = (vector[i] for vector, i in zip(units, place, strict=True))
        products[place] = prod(factors, start=values[place])
    return products


def cross(left: Matrix, right: Matrix) -> Exact:
    """The second derivatives of (left z) x (right z), two linear forms of z with three rows each."""
    n = len(left[0])
    hessian = np.full((3, n, n), Fraction(0), dtype=object)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        for first, second, sign in ((j, k, 1), (k, j, -1)):
            for a, p in enumerate(left[first]):
                for b, q in enumerate(right[second]):
                    # Most entries are zero, and a product of rationals is dear.
                    if p and q:
                        hessian[i, a, b] += sign * p * q
                        hessian[i, b, a] += sign * p * q
    return hessian


def mapped(matrix: Exact, hessian: Exact) -> Exact:
    """The second derivatives of a matrix times a quadratic form."""
    image = np.full((len(matrix), *hessian.shape[1:]), Fraction(0), dtype=object)
    # Most entries are zero, and a product of rationals is dear.
    for k, a, b in zip(*np.nonzero(hessian), strict=True):
        for i in np.flatnonzero(matrix[:, k]):
            image[i, a, b] += matrix[i, k] * hessian[k, a, b]
    return image
