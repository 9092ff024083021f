"""The time over any number of teeth of the washboard as one integral over one tooth, in balls.

Legend as in board, kappa < 0. Teeth have the width pi/Omega, and from each to the next F grows by
d = slope pi/Omega. Hurwitz' zeta function has zeta(1/2, a) - zeta(1/2, a + 1) = a^(-1/2), so that

    g(sigma) = d^(-1/2) zeta(1/2, F(sigma)/d),    g(sigma) - g(sigma + pi/Omega) = F(sigma)^(-1/2) = 1/nu,

and the time from sigma_1 to sigma_2, however far apart they are, is L(sigma_1) - L(sigma_2) with

    L(sigma) = int g    from sigma to sigma + pi/Omega.

Far from the turning point the zeta function is the sum of Euler and Maclaurin (DLMF 25.11.43),

    zeta(1/2, a) = a^(1/2) (-2 + u/2 + sum_(j <= n) B_2j/(2j)! (1/2)_(2j-1) u^(2j)) + R,    u = 1/a,

where for a > 0 the rest R is smaller than the first term left out: (a + x)^(-1/2) and all its derivatives
keep their signs (DLMF 2.10(i)).
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil
from typing import Final, final

from flint import acb, acb_poly, arb, ctx, fmpq

from taylor_verify.exact.balls import Undecidable
from taylor_verify.exact.euler.moments.washboard.speed import Swinging
from taylor_verify.exact.integral import integral

# The least term of the sum is about e^(-2 pi a), 9 bits for each 1 of a: at 6 bits it is not needed.
_BITS_PER_TOOTH: Final = 6
_SPARE_BITS: Final = 8


@final
class FarTeeth:
    """L(sigma) at the precision of flint at which this was made, beyond ``first`` teeth from the turn."""

    def __init__(self, speed: Swinging) -> None:
        self.width = arb.pi() / speed.rate
        self.first = ceil(ctx.prec / _BITS_PER_TOOTH)
        self._speed, self._rise = speed, speed.slope * self.width
        coefficients = _coefficients(self.first, ctx.prec + _SPARE_BITS)
        self._rest = arb(abs(coefficients[-1])) / arb(self.first) ** (len(coefficients) - 1)
        self._polynomial = acb_poly(coefficients[:-1])

    def level(self, sigma: arb) -> arb:
        """L, to within a constant; raises Undecidable where the precision does not carry that far."""
        span = acb(sigma), acb(sigma + self.width)
        summed = integral(self._integrand, *span).real
        # F/d is at least ``first`` on the tooth, and a^(1/2) times the term left out falls with a.
        error = self._rest * arb(self.first).sqrt() * self.width
        level = (summed + arb(0, error.upper())) / self._rise.sqrt()
        if not level.rad() <= abs(level) * arb(2) ** (-ctx.prec // 2):
            raise Undecidable
        return level

    def _integrand(self, sigma: acb, analytic: bool) -> acb:
        a = self._speed.around(sigma) / self._rise
        return a.sqrt(analytic=analytic) * self._polynomial(1 / a)


def _coefficients(a: int, bits: int) -> list[fmpq]:
    """The numbers beside u^k, up to the first whose term is below so many bits at this a."""
    numbers = [fmpq(-2), fmpq(1, 2)]
    factor, j = Fraction(1, 4), 1  # (1/2)_(2j-1)/(2j)!
    while True:
        numbers += [fmpq.bernoulli(2 * j) * fmpq(factor.numerator, factor.denominator)]
        if abs(numbers[-1]) * fmpq(2) ** bits < fmpq(a) ** (2 * j):
            return numbers
        numbers += [fmpq(0)]
        factor *= Fraction((4 * j - 1) * (4 * j + 1), 4 * (2 * j + 1) * (2 * j + 2))
        j += 1
