"""Weber's curve in mpmath: its periods and the start on its Jacobian, by double exponentials.

Legend: that of curve.py and characteristics.py. On each stretch between branch points the substitution
is that of integrals.py, and the nodes in phi are mpmath's of tanh-sinh, which crowd at the ends, where
a near branch point beyond them is felt. Nothing here bounds an error: two precisions must agree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from mpmath import mp, mpc, mpf

from taylor_verify.exact.kirchhoff.weber.curve import Curve
from taylor_verify.exact.kirchhoff.weber.riemann import Symmetric
from taylor_verify.exact.kirchhoff.weber.surd import Surd
from taylor_verify.exact.solution import Unsettled

# A stretch whose neighbour is 10^-60 of its length away takes eight levels at 100 digits.
_LEVELS: Final = 12
_DOUBLINGS: Final = 10

Pair = tuple[mpf, mpf]


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
    """Count the digits that the e share with a neighbour: as many are lost by their differences."""
    for digits in (20 << n for n in range(_DOUBLINGS)):
        with mp.workdps(digits):
            e = branch_points(curve)
            narrowest = min(b - a for a, b in pairwise(e)) / (e[-1] - e[0])
            if narrowest >= mpf(10) ** (-digits // 2):
                return 1 - int(mp.floor(mp.log10(narrowest)))
    raise Unsettled("two branch points of Weber's curve do not come apart")


def real_jacobian(curve: Curve) -> RealJacobian:
    """Return Y and the motion on the Jacobian, at the ambient precision of mpmath."""
    e = branch_points(curve)
    gap1, oval1, gap2, oval2 = (stretch(e, s, mp.pi / 2, mpf(0)) for s in range(4))
    area = 2 * _cross(oval1, oval2)

    def turns(v: mpc) -> Pair:
        """Convert a pair of integrals to parts of the two real periods (Cramer)."""
        return _cross(v, oval2) / area, _cross(v, oval1) / area

    Y11, Y12 = turns(2 * gap1)
    _, Y22 = turns(2 * (gap1 - gap2))
    phase = (mpf(0), mpf(0))
    for s, point in zip((1, 3), curve.points, strict=True):
        if point.branch is not None:
            # u1 from e2 to e3, or u2 from e4 to e5, is half of its own period.
            half = mpf(point.branch - s) / 2
            share = (half, mpf(0)) if s == 1 else (mpf(0), half)
        else:
            u = _real(point.u)
            up, down = mp.sqrt(u - e[s]), mp.sqrt(e[s + 1] - u)
            below = stretch(e, s, mp.atan2(up, down), mp.atan2(down, up))
            share = turns(point.sheet * below)
        phase = (phase[0] + share[0], phase[1] + share[1])
    flow, neumann = mpc(*map(mp.convert, curve.flow)), mpc(0, mp.convert(curve.sigma))
    return RealJacobian((Y11, Y12, Y22), phase, turns(flow), turns(neumann))


def _cross(a: mpc, b: mpc) -> mpf:
    return a.real * b.imag - a.imag * b.real


def stretch(e: Sequence[mpf], s: int, angle: mpf, rest: mpf) -> mpc:
    """The integrals of dz/|w| and, as imaginary part, z dz/|w| from e_s to where phi is the angle.

    s counts from 0, and ``rest`` is what the angle lacks of a right one. Raises Unsettled where the levels
    do not suffice.
    """
    width = e[s + 1] - e[s]
    below = [e[s] - entry for entry in e[:s]]
    above = [entry - e[s + 1] for entry in e[s + 2 :]]

    def both(x: mpf) -> mpc:
        # z from either end: each has its digits where it is small.
        up = width * mp.sin(angle * x) ** 2
        down = width * mp.sin(rest + angle * (1 - x)) ** 2
        near = [distance + up for distance in below] + [distance + down for distance in above]
        weight = angle / mp.sqrt(mp.fprod(near))
        return mpc(weight, weight * (e[s] + up if up <= down else e[s + 1] - down))

    integral, error = mp.quad(both, [0, 1], error=True, maxdegree=_LEVELS)
    # Every integral is near 1 in the unit sigma.
    if not error <= mp.eps:
        raise Unsettled("an integral along Weber's curve does not settle")
    return integral


def _real(surd: Surd) -> mpf:
    return surd.form(mp.convert, mp.sqrt)
