"""A certified quadrature of Lamb's integrals of an ellipsoid."""

from __future__ import annotations

from fractions import Fraction

from flint import acb, arb

from taylor_verify.numbers.irrational import ball


def quadrature(axes: tuple[Fraction, ...], of: tuple[int, ...]) -> arb:
    """a1 a2 a3 int dt / (product of (a_i^2 + t) for i in ``of``, times D), enclosed.

    With t = s (1/u^2 - 1) the integrand is analytic in u from 0 to 1; s is the largest a_i^2.
    """
    squares = [a * a for a in axes]
    s = max(squares)
    power = 2 * len(of)  # a factor 1/(a^2 + t) is u^2/(s + (a^2 - s) u^2)

    def integrand(u: acb, analytic: bool) -> acb:
        terms = [ball(s) + ball(q - s) * u * u for q in squares]
        value = 2 * ball(s) * u**power
        for i in of:
            value /= terms[i]
        for term in terms:
            value /= term.sqrt(analytic=analytic)
        return value

    return ball(axes[0] * axes[1] * axes[2]) * acb.integral(integrand, 0, 1).real
