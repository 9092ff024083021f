"""Mass and inertia of a homogeneous ellipsoid in an ideal fluid, by Lamb's integrals.

Legend: a, b, c the semi-axes; V = 4 pi abc/3; D = ((a^2 + s)(b^2 + s)(c^2 + s))^(1/2); rho the density of
the fluid. Lamb, Hydrodynamics, arts. 114 and 115, for axis 1 (the others by exchange), s from 0 to oo:

    alpha = abc int ds / ((a^2 + s) D)               added mass    rho V alpha / (2 - alpha)
    J = abc int ds / ((b^2 + s)(c^2 + s) D)          added inertia
                                rho V (b^2 - c^2)^2 J / (5 (2 - (b^2 + c^2) J))

Lamb writes (gamma - beta) for (b^2 - c^2) J, which is the difference of two of his integrals. As one
integral it loses nothing where b and c nearly agree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import count
from typing import Any

from gmpy2 import const_pi, exp, get_context, mpfr, sqrt


def ellipsoid_masses(axes: Sequence[Any], density: Any, fluid_density: Any) -> list[Any]:
    """Return the diagonal of the mass matrix, solid and fluid together: three masses, three moments."""
    squares = [axis * axis for axis in axes]
    volume = 4 * const_pi() * axes[0] * axes[1] * axes[2] / 3
    solid, displaced = volume * density, volume * fluid_density
    masses, moments = [], []
    for i in range(3):
        b, c = (squares[k] for k in range(3) if k != i)
        masses.append(solid + displaced * added_mass(squares, i))
        moments.append((solid * (b + c) + displaced * added_moment(squares, i)) / 5)
    return masses + moments


def added_mass(squares: Sequence[Any], i: int) -> Any:
    """Return the mass that the fluid adds along axis i, in units of the displaced mass."""
    alpha = lamb_integral(squares, [i])
    return alpha / (2 - alpha)


def added_moment(squares: Sequence[Any], i: int) -> Any:
    """Return the moment that the fluid adds about axis i, in units of a fifth of the displaced mass."""
    j, k = (n for n in range(3) if n != i)
    b, c = squares[j], squares[k]
    integral = lamb_integral(squares, [j, k])
    return (b - c) ** 2 * integral / (2 - (b + c) * integral)


def lamb_integral(squares: Sequence[Any], factors: Sequence[int]) -> Any:
    """Return abc int ds / (D times the factors a_i^2 + s), over 0 < s < oo."""
    a, b, c = map(mpfr, squares)
    volume = sqrt(a * b * c)
    scale = volume ** (mpfr(2) / 3)

    def integrand(v: Any) -> Any:
        # s = scale exp(2 sinh v); both ends decay as an exponential of an exponential.
        ev = exp(v)
        s = scale * exp(ev - 1 / ev)
        terms = [a + s, b + s, c + s]
        value = s * (ev + 1 / ev) / sqrt(terms[0] * terms[1] * terms[2])
        for i in factors:
            value /= terms[i]
        return value

    return volume * trapezoidal_sum(integrand)


def trapezoidal_sum(integrand: Callable[[Any], Any]) -> Any:
    """Return the integral over all real v, by steps that are halved until the sum stays.

    For an analytic integrand that decays at both ends each halving doubles the number of right digits.
    """
    half = mpfr(2) ** (-get_context().precision // 2 - 8)
    step = mpfr(1) / 4
    total = integrand(mpfr(0)) + _both_sides(integrand, step, step)
    while True:
        finer = total + _both_sides(integrand, step / 2, step)
        step, before, total = step / 2, total * step, finer
        if abs(total * step - before) <= half * before:
            # Half of the digits stayed, so that all of them are right in the finer sum.
            return total * step


def _both_sides(integrand: Callable[[Any], Any], first: Any, step: Any) -> Any:
    """Return the sum over first + k step and its mirror image, up to terms that no longer count."""
    return sum(_tail(integrand, first, step)) + sum(_tail(integrand, -first, -step))


def _tail(integrand: Callable[[Any], Any], first: Any, step: Any) -> Iterator[Any]:
    """Yield the values along one side. They rise to one peak at most, then fall ever faster."""
    small = mpfr(2) ** (-get_context().precision - 8)
    largest = mpfr(0)
    for k in count():
        value = integrand(first + k * step)
        yield value
        largest = max(largest, value)
        if value <= small * largest:
            return
