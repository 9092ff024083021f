"""The coefficients of an ellipsoid in balls about Lamb's integrals, and the body that each of them makes.

T = sum_i (p_i x_i^2 + r_i y_i^2)/2 with p_i = 1/(M + m_i), r_i = 1/(I_i + j_i) is linear in the six
coefficients, and so are the equations: the sum of a ball times exact rationals, one for each coefficient.
Equal coefficients are one ball times one body. So what cancels between them is zero exactly, and no
rounding disturbs it.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from flint import arb, ctx

from taylor_verify.exact.ellipsoid import inertias
from taylor_verify.scenes.bodies import Ellipsoid, ImmersedBody
from taylor_verify.scenes.precision import floor_log2
from taylor_verify.scenes.tensors import ZERO_MATRIX, Matrix, diagonal

# The differences of coefficients are those of semi-axes to the first power, times numbers of size one.
_SPARE_BITS = 16


def without_coefficients(body: ImmersedBody) -> ImmersedBody:
    """The body with its loads, and with no kinetic energy."""
    return replace(
        body, linear=ZERO_MATRIX, coupling=ZERO_MATRIX, angular=ZERO_MATRIX, ellipsoid=None
    )


def units(body: ImmersedBody, shape: Ellipsoid) -> list[ImmersedBody]:
    """The bodies in which one coefficient, and those equal to it, are 1, and all others 0."""
    bare = without_coefficients(body)
    masses, axes = _equal(shape)
    return [
        *(replace(bare, linear=_ones(places)) for places in masses),
        *(replace(bare, angular=_ones(places)) for places in axes),
    ]


def factors(shape: Ellipsoid) -> list[arb]:
    """The coefficients themselves, in the order of the units, to the ambient precision."""
    pairs = zip(inertias(shape, ctx.prec).coefficients(), _equal(shape), strict=True)
    return [values[places[0]] for values, groups in pairs for places in groups]


def cancelled_bits(shape: Ellipsoid) -> int:
    """The bits that differences of the coefficients lose where semi-axes are nearly equal."""
    axes = sorted(shape.semi_axes)
    gaps = [(b - a) / b for a, b in pairwise(axes) if a != b]
    return _SPARE_BITS - floor_log2(min(gaps, default=Fraction(1)))


def _equal(shape: Ellipsoid) -> tuple[list[list[int]], list[list[int]]]:
    """The axes along which the body has the same mass, and those about which it has the same inertia."""
    groups: dict[Fraction, list[int]] = {}
    for place, axis in enumerate(shape.semi_axes):
        groups.setdefault(axis, []).append(place)
    alike = list(groups.values())
    # In a vacuum the mass is the same along all of them.
    return (alike if shape.fluid_density else [[0, 1, 2]]), alike


def _ones(places: list[int]) -> Matrix:
    return diagonal(tuple(Fraction(int(i in places)) for i in range(3)))
