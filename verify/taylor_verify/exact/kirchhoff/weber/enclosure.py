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
from typing import Any, Final, NamedTuple

from flint import acb, acb_mat, arb, ctx
from mpmath import mpf

from taylor_verify.exact.balls import Undecidable, ball, midpoint, sign
from taylor_verify.exact.kirchhoff.integrable import CYCLIC
from taylor_verify.exact.kirchhoff.weber.characteristics import HALF_PERIODS, at_branches
from taylor_verify.exact.kirchhoff.weber.curve import Curve
from taylor_verify.exact.kirchhoff.weber.integrals import Jacobian, branch_points, jacobian
from taylor_verify.exact.solution import Unsettled

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


class Jet(NamedTuple):
    """A theta function, its rate along Neumann's time, and its rate in time."""

    value: Any
    along: Any
    rate: Any


class Quotients:
    """The motion set up at the ambient precision of flint, and good only there."""

    def __init__(self, curve: Curve) -> None:
        self.jacobian = jacobian(curve)
        self._places = curve.places
        self.F, self._rho = ball(curve.F2).sqrt(), ball(curve.rho)
        sizes = _sizes(curve, self.jacobian)
        self._c = [arb(1)] * 3
        n, rate = self._direction(self.jets(arb(0)))
        self._c = [
            size * sign(ball(x) * entry + ball(x_rate) * slope)
            for size, entry, slope, (x, x_rate) in zip(sizes, n, rate, curve.sign_data, strict=True)
        ]

    def at(self, t: arb) -> tuple[list[arb], list[arb]]:
        """x and y, this long after the start."""
        n, y = self.impulses(self.jets(t))
        return [self.F * entry for entry in n], y

    def jets(self, t: arb | acb) -> list[Jet]:
        """theta[0] and those of x_1, x_2 and x_3 at a time, which may be complex."""
        place = self.jacobian
        pairs = zip(place.phase, place.rate, strict=True)
        Z = [acb(start) + acb(rate) * acb(t) for start, rate in pairs]
        jets = place.tau.theta_jets(acb_mat(2, 1, Z), 1)

        def jet(which: int) -> Jet:
            row = (jets[which, order] for order in range(3))
            # In real time the theta functions are real.
            value, first, second = (entry.real if isinstance(t, arb) else entry for entry in row)
            along, rate = (
                direction[0] * first + direction[1] * second
                for direction in (place.neumann, place.rate)
            )
            return Jet(value, along, rate)

        return [jet(which) for which in self.characteristics]

    @property
    def characteristics(self) -> list[int]:
        """The characteristics of the theta functions in ``jets``."""
        return [0, *(HALF_PERIODS[place] for place in self._places)]

    def impulses(self, jets: Sequence[Jet]) -> tuple[list[Any], list[Any]]:
        """n = x/F and y."""
        n, rate = self._direction(jets)
        y = [(rate[j] * n[k] - rate[k] * n[j]) / self._rho for _, j, k in CYCLIC]
        return n, y

    def _direction(self, jets: Sequence[Jet]) -> tuple[list[Any], list[Any]]:
        """n, and its rate along Neumann's time."""
        below, *above = jets
        n, rate = [], []
        for c, jet in zip(self._c, above, strict=True):
            n.append(c * jet.value / below.value)
            slope = jet.along * below.value - jet.value * below.along
            rate.append(c * slope / below.value**2)
        return n, rate


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
