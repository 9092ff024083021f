"""A tube: a bound of the distance of the motion from its Taylor polynomial within one step.

Let p be a polynomial on [0, 1] with |p' - h F(p)| <= D, the motion start within a of p(0), and M bound
|h dF/dz| wherever |z - p(s)| <= T; all of it component by component. Let

    E = (int_0^1 e^(M s) ds) D,        X = e^M a.

If E + X <= T then |z - p| <= E + X on the whole step, and |z - p| <= E if a = 0.

Proof. Let F(p + clip(e)) replace F(z), where clip cuts each component of e to [-T, T]. This field is
bounded and Lipschitz, so it has one solution, p + e. By the mean value theorem
|e'| <= M |clip(e)| + D <= M |e| + D. As M >= 0, the solution of the linear equation is above |e|:
|e(s)| <= e^(M s) a + (int_0^s e^(M v) dv) D <= E + X <= T. So nothing is ever cut, and p + e is the
motion.

Bounds are exact numbers of 64 bits that are rounded upwards; none passes through a float, in which the
square of 1e-200 is zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from flint import arb, arb_mat

from taylor_verify.exact.enclosure.system import column, magnitudes

if TYPE_CHECKING:
    from taylor_verify.exact.enclosure.node_bounds import Bounds

BOUND_BITS: Final = 64

_MOST_TERMS: Final = 60
# The tail of an exponential is asked for at every so many terms: the question costs seven of them.
_TERMS_BETWEEN: Final = 4
# More than one, so that a bound which is only just one is seen to be one; six powers of it reach every
# component that the others drive.
_LOOSER: Final = arb("1.25")
_POWERS: Final = 6
_TRIES: Final = 5


class StepTooLong(ArithmeticError):
    """The bounds of a step do not close; those of a shorter one may."""


@dataclass(frozen=True)
class Tube:
    """``truncation`` is E and ``width`` E + X, columns; ``growth`` is M, which holds within the tube."""

    truncation: arb_mat
    width: arb_mat
    growth: arb_mat


def tube(bounds: Bounds, apart: arb_mat) -> Tube:
    """The tube about the polynomial that the bounds are of, from all states ``apart`` of its beginning.

    Raises StepTooLong where no tube closes.
    """
    defect, size = bounds.defect(), bounds.series.length.abs_upper()
    around = column([arb(0)] * apart.nrows())
    for _ in range(_TRIES):
        growth = bounds.rates_of_change(around.entries()) * size
        error = accumulated(growth, defect, order=1)
        width = magnitudes(error + accumulated(growth, apart, order=0))
        if is_within(width, around):
            return Tube(error, width, growth)
        # Twice as wide: a component that is zero so far may be reached through the others' width.
        around = width * 2
    raise StepTooLong


def accumulated(growth: arb_mat, source: arb_mat, order: int) -> arb_mat:
    """A bound of (int_0^1 e^(M s) ds) D for order 1, and of e^M D for order 0; by columns of D.

    The terms are w_k = M w_(k-1)/(k + order). After w_K the rest is at most
    sum_j (M/(K + 1 + order))^j w_K. If some y >= w_K has M y <= mu y with mu = (K + 1 + order)/2, then
    the rest is at most sum_j 2^-j y = y.
    """
    term = total = source
    for k in range(1, _MOST_TERMS + 1):
        term = growth * term * (1 / arb(k + order))
        total = total + term
        if k % _TERMS_BETWEEN == 0:
            half = arb(k + 1 + order) / 2
            loose = growth * (_LOOSER / half)
            rest = power = term
            for _ in range(_POWERS):
                power = loose * power
                rest = rest + power
            rest = magnitudes(rest)
            if is_within(growth * rest, rest * half):
                return magnitudes(total + rest)
    raise StepTooLong


def is_within(small: arb_mat, large: arb_mat) -> bool:
    """Return True if every entry is certainly at most that of the other."""
    return all(a <= b for a, b in zip(small.entries(), large.entries(), strict=True))
