"""The numbers of the swing of x3 between two simple roots of f, from the lattice of Weierstrass's p."""

from __future__ import annotations

from typing import Final

from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.lattice import lattice

_GUARD_BITS: Final = 40


def swing(nutation: Nutation) -> dict[str, mpf]:
    """The period of x3, the rate of the elliptic argument, m and 1 - m, at mpmath's precision.

    Jacobi's functions of m have the quarter period K. x3 recurs after 2 K of their argument where all roots
    of f are real, and after 4 K where two are complex.
    """
    with ctx.workprec(mp.prec + _GUARD_BITS):
        g2, g3 = nutation.invariants
        curve = lattice(g2, g3)
        assert curve.period is not None
        assert curve.parameters is not None
        m, m_prime = curve.parameters
        quarter = arb.pi() / (2 * arb(1).agm(m_prime.sqrt()))
        rate = (2 if g2**3 > 27 * g3**2 else 4) * quarter / curve.period
        numbers = {"period": curve.period, "rate": rate, "m": m, "m_prime": m_prime}
        return {name: midpoint(number) for name, number in numbers.items()}
