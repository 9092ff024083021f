"""The inverse inertia of a homogeneous ellipsoid in an ideal fluid, to any number of bits.

Legend: a_i the semi-axes, V = 4 pi a_1 a_2 a_3/3, (i, j, k) any order of (1, 2, 3); M and I_i mass and
moments of the solid, m_i and j_i what the fluid adds, p_i = 1/(M + m_i) and r_i = 1/(I_i + j_i) the
coefficients of T = (p_i x_i^2 + r_i y_i^2)/2. Lamb, Hydrodynamics, arts. 114 and 115, with
D(t) = ((a_1^2 + t)(a_2^2 + t)(a_3^2 + t))^(1/2) and integrals over 0 < t < oo:

    alpha_i = a_1 a_2 a_3 int dt / ((a_i^2 + t) D),              alpha_1 + alpha_2 + alpha_3 = 2,
    J_i = a_1 a_2 a_3 int dt / ((a_j^2 + t)(a_k^2 + t) D),      alpha_k - alpha_j = (a_j^2 - a_k^2) J_i,
    m_i = rho V alpha_i / (alpha_j + alpha_k),
    j_i = rho V (a_j^2 - a_k^2)^2 J_i / (5 (2 - (a_j^2 + a_k^2) J_i)).

In Carlson's functions alpha_i = (2/3) a_1 a_2 a_3 R_D(a_j^2, a_k^2, a_i^2), and J_i is the divided
difference of two R_D: here it has a duplication of its own, of positive terms, so that nearly equal
axes cost no digits. Nor do thin bodies: 2 - alpha_i is written as alpha_j + alpha_k, and
2 - (a_j^2 + a_k^2) J_i as alpha_i + 2 (alpha_j - a_k^2 J_i) with a_j >= a_k. That difference is alpha_j
times the mean of t/(a_k^2 + t) over the integrand of alpha_j. The mean is least for a_i -> 0 and
a_j = a_k, where it is 1/4: two bits, of the forty of guard, is all that it loses.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import Any, Final

from taylor_verify.scenes.precision import exact_value, rounded
from taylor_verify.scenes.tensors import Vector

# Each of some bits/4 duplications rounds a few dozen times, and sums of positive terms do not magnify
# that: 2^13 units in the last place at a thousand bits, 2^19 at ten thousand digits.
_GUARD_BITS: Final = 40
# A body is asked for at a dozen precisions, and a sweep has any number of bodies.
_MOST_CACHED: Final = 256


@lru_cache(maxsize=_MOST_CACHED)
def inverse_inertias(
    semi_axes: Vector, density: Fraction, fluid_density: Fraction, bits: int
) -> tuple[Vector, Vector]:
    """Return (p_1, p_2, p_3) and (r_1, r_2, r_3), each rounded once to so many bits.

    Equal semi-axes give equal coefficients. Raises ZeroDivisionError where M + m_i or I_i + j_i is 0.
    """
    import gmpy2

    with gmpy2.context(precision=bits + _GUARD_BITS, trap_divzero=True):
        masses, moments = _inertias(semi_axes, density, fluid_density)
        p, r = (
            tuple(rounded(exact_value(1 / inertia), bits) for inertia in inertias)
            for inertias in (masses, moments)
        )
    return p, r


def _inertias(semi_axes: Vector, density: Fraction, fluid_density: Fraction) -> tuple[Any, Any]:
    """Return M + m_i and I_i + j_i at the ambient precision of MPFR."""
    from gmpy2 import const_pi, mpfr

    squares = [axis * axis for axis in semi_axes]
    a1, a2, a3 = semi_axes
    volume = 4 * const_pi() * mpfr(a1 * a2 * a3) / 3
    mass, displaced = volume * mpfr(density), volume * mpfr(fluid_density)
    alphas, divided = lamb_integrals(semi_axes)
    masses, moments = [], []
    for i in range(3):
        # The longer axis first, so that two equal ones are dealt with alike.
        j, k = sorted(((i + 1) % 3, (i + 2) % 3), key=lambda n: -squares[n])
        m = displaced * alphas[i] / (alphas[j] + alphas[k])
        solid = mass * mpfr(squares[j] + squares[k]) / 5
        gap = mpfr((squares[j] - squares[k]) ** 2)
        rest = alphas[i] + 2 * (alphas[j] - mpfr(squares[k]) * divided[i])
        masses.append(mass + m)
        moments.append(solid + displaced * gap * divided[i] / (5 * rest))
    return masses, moments


def lamb_integrals(semi_axes: Vector) -> tuple[list[Any], list[Any]]:
    """Return alpha_i and J_i at the ambient precision of MPFR.

    Duplication: with s = sqrt, shift = s(x)s(y) + s(y)s(z) + s(z)s(x) and x' = (x + shift)/4,

        R_D(x, y, z) = R_D(x', y', z')/4 + 3/(s(z)(z + shift)),
        E(x; y, z) = E(x'; y', z')/16
                     + 3 (y + s(y)s(z) + z + shift)/((s(y) + s(z)) s(y)s(z)(y + shift)(z + shift)),

    for E(x; y, z) = (R_D(x, y, z) - R_D(x, z, y))/(y - z), whose first member follows from that of
    R_D by taking the difference of squares apart. At the end, where the arguments nearly agree, R_D is
    w^(-3/2) and E is 3 w^(-5/2)/5, w being their weighted mean.
    """
    from gmpy2 import mpfr, sqrt

    alphas, divided = [mpfr(0)] * 3, [mpfr(0)] * 3
    quarter = mpfr(1)
    x = [mpfr(axis * axis) for axis in semi_axes]
    while not _agree(x):
        roots = [sqrt(xi) for xi in x]
        a, b, c = sorted(roots)
        shift = a * b + (b * c + c * a)  # in one order, so that equal axes stay equal
        for i in range(3):
            j, k = sorted(((i + 1) % 3, (i + 2) % 3), key=lambda n: x[n])
            y, z, y_root, z_root = x[j], x[k], roots[j], roots[k]
            numerator = 3 * (y + y_root * z_root + z + shift)
            term = numerator / ((y_root + z_root) * y_root * z_root * (y + shift) * (z + shift))
            alphas[i] += quarter * 3 / (roots[i] * (x[i] + shift))
            divided[i] += quarter**2 * term
        quarter /= 4
        x = [(xi + shift) / 4 for xi in x]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        others = x[j] + x[k]
        mean = (3 * x[i] + others) / 5
        alphas[i] += quarter / (mean * sqrt(mean))
        mean = (x[i] + 3 * others) / 7
        divided[i] += quarter**2 * 3 / (5 * mean**2 * sqrt(mean))
    a1, a2, a3 = semi_axes
    factor = mpfr(a1 * a2 * a3) * 2 / 3
    return [factor * alpha for alpha in alphas], [factor * E for E in divided]


def _agree(x: list[Any]) -> bool:
    """Return True if the arguments agree so well that a mean of them stands for all three.

    R_D and E are means of (u.x)^-s over weights u of sum 1, with s <= 5/2. To take the mean of u.x
    itself is wrong by the relative s (s + 1)/2 (spread/least)^2 at most, so that half the bits of
    agreement suffice.
    """
    import gmpy2

    bits = gmpy2.get_context().precision
    return bool(max(x) - min(x) <= min(x) * gmpy2.exp2(-bits // 2 - 2))
