"""Weber's curve in mpmath: its periods and the start on its Jacobian, by double exponentials.

Legend: that of curve.py and characteristics.py. On each stretch between branch points the substitution
is that of integrals.py, and the nodes in phi are those of tanh-sinh, which crowd at the ends, where a
near branch point beyond them is felt. Nothing here bounds an error: two precisions must agree.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from mpmath import mp, mpf

from taylor_verify.exact.kirchhoff.weber.curve import Curve, Point
from taylor_verify.exact.kirchhoff.weber.riemann import Symmetric
from taylor_verify.exact.kirchhoff.weber.surd import Surd
from taylor_verify.exact.solution import Unsettled

# A stretch whose neighbour is 10^-60 of its length away takes eight levels at 100 digits.
_LEVELS: Final = 12
_DOUBLINGS: Final = 10

Pair = tuple[mpf, mpf]
Triple = tuple[mpf, mpf, mpf]


@dataclass(frozen=True)
class RealJacobian:
    """Y of tau = iY, and Z = phase + rate t; ``neumann`` is the rate of Z along Neumann's time."""

    Y: Symmetric
    phase: Pair
    rate: Pair
    neumann: Pair


def branch_points(curve: Curve) -> list[mpf]:
    return [_real(surd) for surd in curve.branches]


def narrowness(curve: Curve) -> int:
    """How many digits the e share with a neighbour, at least: as many are lost by their differences."""
    for digits in (20 << n for n in range(_DOUBLINGS)):
        with mp.workdps(digits):
            e = branch_points(curve)
            narrowest = min(b - a for a, b in pairwise(e)) / (e[-1] - e[0])
            if narrowest >= mpf(10) ** (-digits // 2):
                return 1 - int(mp.floor(mp.log10(narrowest)))
    raise Unsettled("two branch points of Weber's curve do not come apart")


def real_jacobian(curve: Curve) -> RealJacobian:
    """At the ambient precision of mpmath."""
    e = branch_points(curve)
    nodes = Nodes()
    gap1, oval1, gap2, oval2 = (stretch(e, s, mp.pi / 2, mpf(0), nodes) for s in range(4))
    det = 4 * (oval1[1] * oval2[0] - oval1[0] * oval2[1])

    def turns(v: Pair) -> Pair:
        """From the integrals of dz/w and z dz/w to parts of the two real periods (Cramer)."""
        first = -2 * (v[0] * oval2[1] - v[1] * oval2[0]) / det
        second = 2 * (oval1[0] * v[1] - oval1[1] * v[0]) / det
        return first, second

    Y11, Y12 = turns((2 * gap1[0], 2 * gap1[1]))
    _, Y22 = turns((2 * (gap1[0] - gap2[0]), 2 * (gap1[1] - gap2[1])))
    phase = [mpf(0), mpf(0)]
    for k, point in enumerate(curve.points):
        if point.branch is not None:
            # u1 from e2 to e3, or u2 from e4 to e5, is half of its own period.
            phase[k] += mpf(point.branch - (1, 3)[k]) / 2
        else:
            share = turns(_from_below(e, (1, 3)[k], point, nodes))
            phase = [entry + part for entry, part in zip(phase, share, strict=True)]
    flow = [mp.convert(rate) for rate in curve.flow]
    return RealJacobian(
        (Y11, Y12, Y22),
        (phase[0], phase[1]),
        turns((flow[0], flow[1])),
        turns((mpf(0), mp.convert(curve.sigma))),
    )


def stretch(e: Sequence[mpf], s: int, angle: mpf, rest: mpf, nodes: Nodes) -> Pair:
    """The integrals of dz/|w| and z dz/|w| from e_s, s counted from 0, to where phi is the angle.

    ``rest`` is what the angle lacks of a right one.
    """
    radius = (e[s + 1] - e[s]) / 2
    below = [e[s] - entry for entry in e[:s]]
    above = [entry - e[s + 1] for entry in e[s + 2 :]]

    def both(x: mpf, left: mpf) -> Pair:
        # 1 - cos 2 phi, and the same of the angle that phi lacks: each has its digits where it is small.
        up = 2 * radius * mp.sin(angle * x) ** 2
        down = 2 * radius * mp.sin(rest + angle * left) ** 2
        product = mpf(1)
        for distance in below:
            product *= distance + up
        for distance in above:
            product *= distance + down
        weight = angle / mp.sqrt(product)
        return weight, weight * (e[s] + up if up <= down else e[s + 1] - down)

    return nodes.integral(both)


class Nodes:
    """The tanh-sinh rule on the unit interval, at one precision of mpmath and good only there.

    x = 1/(1 + e^{-pi sinh t}) at equal steps of t, halved level by level; kept while the weight counts.
    """

    def __init__(self) -> None:
        self._levels: list[list[Triple]] = []

    def integral(self, integrands: Callable[[mpf, mpf], Pair]) -> Pair:
        """Of both, functions of x and 1 - x, over the unit interval.

        With each level the number of right digits doubles: what is left after one that changes
        less than eps^(2/3) is far below eps. Raises Unsettled where the levels do not suffice.
        """
        totals, poorer, goal = [mpf(0), mpf(0)], None, mp.cbrt(mp.eps) ** 2
        for level in range(_LEVELS):
            for x, left, weight in self._level(level):
                for n, value in enumerate(integrands(x, left)):
                    totals[n] += weight * value
            better = (totals[0] / 2**level, totals[1] / 2**level)
            if poorer is not None:
                change = max(abs(b - p) for b, p in zip(better, poorer, strict=True))
                if change <= max(map(abs, better)) * goal:
                    return better
            poorer = better
        raise Unsettled("an integral along Weber's curve does not settle")

    def _level(self, level: int) -> list[Triple]:
        """The nodes that this level adds."""
        while len(self._levels) <= level:
            self._levels.append(_nodes(len(self._levels)))
        return self._levels[level]


def _nodes(level: int) -> list[Triple]:
    """x, 1 - x and dx/dt at the odd multiples of 2^-level, and at level 0 at all whole ones."""
    found: list[Triple] = []
    n, stride = (0, 1) if level == 0 else (1, 2)
    while True:
        t = mp.ldexp(n, -level)
        grown = mp.exp(mp.pi * mp.sinh(t))
        # x (1 - x) pi cosh t, with 1 - x formed without a difference.
        weight = grown / (1 + grown) ** 2 * mp.pi * mp.cosh(t)
        if not weight > mp.eps**2:
            return found
        near, far = grown / (1 + grown), 1 / (1 + grown)
        found.append((near, far, weight))
        if n:
            found.append((far, near, weight))
        n += stride


def _from_below(e: Sequence[mpf], s: int, point: Point, nodes: Nodes) -> Pair:
    """The two integrals from e_s to the point."""
    u = _real(point.u)
    up, down = mp.sqrt(u - e[s]), mp.sqrt(e[s + 1] - u)
    first, second = stretch(e, s, mp.atan2(up, down), mp.atan2(down, up), nodes)
    return point.sheet * first, point.sheet * second


def _real(surd: Surd) -> mpf:
    return surd.form(mp.convert, mp.sqrt)
