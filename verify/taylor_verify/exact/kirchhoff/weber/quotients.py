"""Weber's motion in balls, by quotients of theta functions of two variables.

Legend: that of curve.py and characteristics.py; j(i) says which e_j is a_i. With ' for Neumann's time,

    x_i = F n_i,    n_i = c_i theta[j(i)](Z)/theta[0](Z),    y = n' x n/rho,

because n_i^2 = U(a_i)/A'(a_i) has its zeros where P1 or P2 is a_i, and its poles at infinity. At the half
period where the points are e_p and e_q, U(a_i) = (a_i - e_p)(a_i - e_q): that is c_i^2, and the start
has its sign.

Every number here is a ball, and every choice is made in rationals or by a ball without a zero. So the error
bounds are proven, given the theorems. FLINT encloses the theta functions.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, log2
from typing import Final, NamedTuple, final

from flint import acb, acb_mat, arb, ctx
from mpmath import mpf

from taylor_verify.exact.balls import Enclosed, Enclosure, Undecidable, balls, midpoint, sign
from taylor_verify.exact.kirchhoff.integrable import CYCLIC
from taylor_verify.exact.kirchhoff.weber.characteristics import HALF_PERIODS, at_branches
from taylor_verify.exact.kirchhoff.weber.curve import REGIME, Curve
from taylor_verify.exact.kirchhoff.weber.periods import Jacobian, branch_points, jacobian
from taylor_verify.exact.solution import Time, Unsettled
from taylor_verify.numbers.irrational import ball

_DOUBLINGS: Final = 8


def rates(curve: Curve, digits: int) -> tuple[mpf, mpf]:
    """The rates of the two angles of the motion, in radians per unit of time; their error is not bounded.

    A shift of Z by a whole real period may turn signs of x_i and y_i; by two of them it does not.
    """
    bits = ceil(digits * log2(10))
    for doubled in range(_DOUBLINGS):
        try:
            with ctx.workprec(bits << doubled):
                first, second = (arb.pi() * abs(rate) for rate in jacobian(curve).rate)
                if first.is_finite() and second.is_finite():
                    return midpoint(first), midpoint(second)
        except (Undecidable, ZeroDivisionError):
            continue
    raise Unsettled("the periods of Weber's curve do not settle")


@final
class WeberBalls(Enclosed):
    """The impulses of a motion of Weber's case in balls."""

    regime = REGIME
    by_periods = True

    def __init__(self, curve: Curve) -> None:
        self._curve = curve
        self._quotients: dict[int, Quotients] = {}

    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        if bits not in self._quotients:
            self._quotients[bits] = Quotients(self._curve)
        quotients, start = self._quotients[bits], self._curve.start
        # The start as given: a zero of the start must be exactly zero.
        given = balls(start.linear), balls(start.angular)
        rows = [given if t == 0 else quotients.at(ball(t)) for t in elapsed]
        names = ("linear_impulse", "angular_impulse")
        return {name: [row[k] for row in rows] for k, name in enumerate(names)}


class _Jet(NamedTuple):
    """A theta function, and its rate along Neumann's time."""

    value: arb
    along: arb


class Quotients:
    """The motion set up at the ambient precision of flint, and good only there."""

    def __init__(self, curve: Curve) -> None:
        self._jacobian = jacobian(curve)
        self._places = curve.places
        self._F, self._rho = ball(curve.F2).sqrt(), ball(curve.rho)
        sizes = _sizes(curve, self._jacobian)
        self._c = [arb(1)] * 3
        n, rate = self._direction(arb(0))
        self._c = [
            size * sign(ball(x) * entry + ball(x_rate) * slope)
            for size, entry, slope, (x, x_rate) in zip(sizes, n, rate, curve.sign_data, strict=True)
        ]

    def at(self, t: arb) -> tuple[list[arb], list[arb]]:
        """x and y, this long after the start."""
        n, rate = self._direction(t)
        y = [(rate[j] * n[k] - rate[k] * n[j]) / self._rho for _, j, k in CYCLIC]
        return [self._F * entry for entry in n], y

    def _direction(self, t: arb) -> tuple[list[arb], list[arb]]:
        """n = x/F, and its rate along Neumann's time."""
        below, *above = self._jets(t)
        n, rate = [], []
        for c, jet in zip(self._c, above, strict=True):
            n.append(c * jet.value / below.value)
            slope = jet.along * below.value - jet.value * below.along
            rate.append(c * slope / below.value**2)
        return n, rate

    def _jets(self, t: arb) -> list[_Jet]:
        """theta[0] and those of x_1, x_2 and x_3, which are real in real time."""
        place = self._jacobian
        pairs = zip(place.phase, place.rate, strict=True)
        Z = [acb(start + rate * t) for start, rate in pairs]
        jets = place.tau.theta_jets(acb_mat(2, 1, Z), 1)

        def jet(which: int) -> _Jet:
            value, first, second = (jets[which, order].real for order in range(3))
            return _Jet(value, place.neumann[0] * first + place.neumann[1] * second)

        return [jet(which) for which in (0, *(HALF_PERIODS[place] for place in self._places))]


def _sizes(curve: Curve, place: Jacobian) -> list[arb]:
    """|c_i|, from the half period of the two lowest e that are not a_i."""
    e = branch_points(curve)
    constants = place.tau.theta(acb_mat([[0], [0]]))
    sizes = []
    for i, j, k in CYCLIC:
        own = curve.places[i]
        p, q = [branch for branch in range(5) if branch != own][:2]
        below, above = at_branches(p, q), at_branches(p, q) ^ HALF_PERIODS[own]
        slope = ball((curve.a[i] - curve.a[j]) * (curve.a[i] - curve.a[k]))
        square = abs((e[own] - e[p]) * (e[own] - e[q]) / slope)
        sizes.append(square.sqrt() * abs(constants[0, below].real / constants[0, above].real))
    return sizes
