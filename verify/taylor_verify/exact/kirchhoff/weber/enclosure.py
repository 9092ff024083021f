"""Weber's motion in balls, by quotients of theta functions of two variables.

Legend: that of curve.py and characteristics.py; j(i) says which e_j is a_i. With ' for Neumann's time,

    x_i = F n_i,    n_i = c_i theta[j(i)](Z)/theta[0](Z),    y = n' x n/rho,

because n_i^2 = U(a_i)/A'(a_i) has its zeros where P1 or P2 is a_i, and its poles at infinity. At the half
period where the points are e_p and e_q, U(a_i) = (a_i - e_p)(a_i - e_q): that is c_i^2, and the start
has its sign.

Every number here is a ball, and every choice is made in rationals or by a ball without a zero: what is
said of the error is proven, given the theorems. FLINT encloses the theta functions.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, log2
from typing import Final, final

from flint import acb, acb_mat, arb, ctx
from mpmath import mpf

from taylor_verify.exact.balls import Enclosed, Enclosure, Undecidable, ball, balls, midpoint, sign
from taylor_verify.exact.kirchhoff.integrable import CYCLIC
from taylor_verify.exact.kirchhoff.weber.characteristics import HALF_PERIODS, at_branches
from taylor_verify.exact.kirchhoff.weber.curve import REGIME, Curve
from taylor_verify.exact.kirchhoff.weber.integrals import Jacobian, branch_points, jacobian
from taylor_verify.exact.solution import Time, Unsettled

_DOUBLINGS: Final = 8


@final
class WeberBalls(Enclosed):
    """x and y of one motion of Weber's."""

    regime = REGIME

    def __init__(self, found: Curve) -> None:
        self._curve = found

    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        motion, start = Quotients(self._curve), self._curve.start
        # As told: a y that starts from zero has no digits but exact ones.
        told = (balls(start.linear), balls(start.angular))
        found = [told if t == 0 else motion.at(ball(t)) for t in elapsed]
        return {
            "linear_impulse": [x for x, _ in found],
            "angular_impulse": [y for _, y in found],
        }


def rates(found: Curve, digits: int) -> tuple[mpf, mpf]:
    """The rates of the two angles of the motion, in radians per unit of time, without a claim.

    A shift of Z by a whole real period may turn signs of x_i and y_i; by two of them it does not.
    """
    bits = ceil(digits * log2(10))
    for doubled in range(_DOUBLINGS):
        try:
            with ctx.workprec(bits << doubled):
                first, second = (arb.pi() * abs(rate) for rate in jacobian(found).rate)
                if first.is_finite() and second.is_finite():
                    return midpoint(first), midpoint(second)
        except (Undecidable, ZeroDivisionError):
            continue
    raise Unsettled("the periods of Weber's curve do not settle")


class Quotients:
    """The motion set up at the ambient precision of flint, and good only there."""

    def __init__(self, found: Curve) -> None:
        self._jacobian = jacobian(found)
        self._places = found.places
        self._F, self._rho = ball(found.F2).sqrt(), ball(found.rho)
        sizes = _sizes(found, self._jacobian)
        self._c = [arb(1)] * 3
        n, rate = self._direction(arb(0))
        self._c = [
            size * sign(ball(x) * entry + ball(x_rate) * slope)
            for size, entry, slope, (x, x_rate) in zip(sizes, n, rate, found.told, strict=True)
        ]

    def at(self, t: arb) -> tuple[list[arb], list[arb]]:
        """x and y, this long after the start."""
        n, rate = self._direction(t)
        y = [(rate[j] * n[k] - rate[k] * n[j]) / self._rho for _, j, k in CYCLIC]
        return [self._F * entry for entry in n], y

    def _direction(self, t: arb) -> tuple[list[arb], list[arb]]:
        """n, and its rate along Neumann's time."""
        found = self._jacobian
        Z = [acb(start + rate * t) for start, rate in zip(found.phase, found.rate, strict=True)]
        jets, along = found.tau.theta_jets(acb_mat(2, 1, Z), 1), found.neumann

        def jet(which: int) -> tuple[arb, arb]:
            # The theta functions are real here.
            value, first, second = (jets[which, order].real for order in range(3))
            return value, along[0] * first + along[1] * second

        below, below_rate = jet(0)
        n, rate = [], []
        for c, place in zip(self._c, self._places, strict=True):
            value, slope = jet(HALF_PERIODS[place])
            n.append(c * value / below)
            rate.append(c * (slope * below - value * below_rate) / below**2)
        return n, rate


def _sizes(found: Curve, place: Jacobian) -> list[arb]:
    """|c_i|, from the half period of the two lowest e that are not a_i."""
    e = branch_points(found)
    constants = place.tau.theta(acb_mat([[0], [0]]))
    sizes = []
    for i, j, k in CYCLIC:
        own = found.places[i]
        p, q = [branch for branch in range(5) if branch != own][:2]
        below, above = at_branches(p, q), at_branches(p, q) ^ HALF_PERIODS[own]
        slope = ball((found.a[i] - found.a[j]) * (found.a[i] - found.a[k]))
        square = abs((e[own] - e[p]) * (e[own] - e[q]) / slope)
        sizes.append(square.sqrt() * abs(constants[0, below].real / constants[0, above].real))
    return sizes
