"""The half periods of a curve with five real branch points, and the zeros of its theta functions.

Legend: e1 < ... < e5 and infinity are the branch points of w^2 = -4 prod (z - e_j); alpha_1 and alpha_2
go round [e2, e3] and [e4, e5], beta_1 and beta_2 from the cut below e1 round to them. The periods of
the alpha are real, those of the beta imaginary, so tau = iY. A characteristic [a, b] of four bits,

    theta[a, b](Z) = sum over n of exp(pi i (n + a/2).tau (n + a/2) + 2 pi i (n + a/2).(Z + b/2)),

is counted by the number a1 a2 b1 b2 in binary. HALF_PERIODS are the integrals from infinity to the
e_j: from e2 to e3 is half of alpha_1, from e4 to e5 half of alpha_2, from e1 to e2 half of beta_1, from
e3 to e4 half of beta_2 - beta_1, and the five add up to zero. RIEMANN, Riemann's constant, is the sum
of those of them that are odd. So with

    Z = int from e2 to P1 + int from e4 to P2

of the normalised differentials, theta[HALF_PERIODS[j]](Z) vanishes where P1 or P2 is e_j, and
theta[0](Z) where one is at infinity: never in a real motion.

Source: D. Mumford, Tata Lectures on Theta II (1984), IIIa, sections 5 to 7.
"""

from __future__ import annotations

from functools import reduce
from operator import xor
from typing import Final

HALF_PERIODS: Final = (0b0011, 0b1011, 0b1001, 0b0101, 0b0100)


def is_odd(characteristic: int) -> bool:
    """Return True if a.b is odd: theta[a, b](-Z) = -theta[a, b](Z)."""
    return (characteristic >> 2 & characteristic).bit_count() % 2 == 1


RIEMANN: Final = reduce(xor, filter(is_odd, HALF_PERIODS))


def at_branches(*branches: int) -> int:
    """The characteristic of theta[0] at Z of the points e_p, e_q, or with more half periods added."""
    return reduce(xor, (HALF_PERIODS[j] for j in branches), RIEMANN)
