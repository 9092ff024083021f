"""Weber's curve in balls: its periods, and where on its Jacobian the motion starts.

Legend: that of curve.py and characteristics.py. On the stretch from e_s to e_{s+1} the substitution
z = e_s + (e_{s+1} - e_s) sin^2 phi takes both end points out of w: there

    z^m dz/|w| = z^m dphi/sqrt(prod of |z - e_j| over the other three j),

analytic about the whole interval. Arb encloses its integral.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

from flint import acb, acb_mat, arb, arb_mat, ctx

from taylor_verify.exact.balls import Undecidable, balls, sign
from taylor_verify.exact.integral import Integrand, integral
from taylor_verify.exact.kirchhoff.weber.curve import Curve
from taylor_verify.exact.real_roots import polynomial, real_roots
from taylor_verify.numbers.irrational import ball

# u1 is on the second stretch between neighbouring branch points, u2 on the fourth.
OVALS = (1, 3)


@dataclass(frozen=True)
class Jacobian:
    """tau = iY, and Z = phase + rate t; ``neumann`` is the rate of Z along Neumann's time."""

    tau: acb_mat
    phase: tuple[arb, arb]
    rate: tuple[arb, arb]
    neumann: tuple[arb, arb]


class Point(NamedTuple):
    """The point u1 or u2 at the start: ``sheet`` is the sign of its w, 0 at one of e1 ... e5."""

    u: arb
    sheet: int


def branch_points(curve: Curve) -> list[arb]:
    """e1 ... e5; raises Undecidable where the balls do not come apart."""
    e = sorted([*balls(curve.a), *real_roots(polynomial(*reversed(curve.B)))], key=arb.mid)
    if not all(a < b for a, b in pairwise(e)):
        raise Undecidable("two branch points of Weber's curve share a ball")
    return e


def points(curve: Curve) -> list[Point]:
    """u1 and u2 at the start; raises Undecidable where a sign is open."""
    U, both = polynomial(*reversed(curve.U)), polynomial(*reversed(curve.B))
    for entry in curve.a:
        both *= polynomial(-entry, Fraction(1))
    shared = U.gcd(both)
    _, slope, offset = map(ball, curve.U_rate)
    begins = [Point(u, 0) for u in real_roots(shared)]
    begins += [Point(u, -sign(slope * u + offset)) for u in real_roots(U // shared)]
    return sorted(begins, key=lambda point: point.u.mid())


def jacobian(curve: Curve) -> Jacobian:
    """Return tau and the motion on the Jacobian, at the ambient precision of flint."""
    e = branch_points(curve)
    gap1, oval1, gap2, oval2 = (stretch(e, s, arb.pi() / 2) for s in range(4))
    # The phase of w changes by a right angle at every branch point: hence the signs.
    alpha = arb_mat([[2 * oval1[m], -2 * oval2[m]] for m in (0, 1)])
    beta = arb_mat([[2 * gap1[m], 2 * (gap1[m] - gap2[m])] for m in (0, 1)])
    to_turns = alpha.inv()
    Y = to_turns * beta
    # Riemann's relation makes Y symmetric: both balls hold the number.
    across = Y[0, 1].intersection(Y[1, 0])
    tau = acb_mat([[acb(0, Y[0, 0]), acb(0, across)], [acb(0, across), acb(0, Y[1, 1])]])
    phase = [arb(0), arb(0)]
    for k, point in enumerate(points(curve)):
        for n, share in enumerate(_share(e, k, point, to_turns)):
            phase[n] += share
    return Jacobian(
        tau,
        (phase[0], phase[1]),
        _turned(to_turns, [ball(rate) for rate in curve.flow]),
        _turned(to_turns, [arb(0), ball(curve.sigma)]),
    )


def stretch(e: Sequence[arb], s: int, angle: arb) -> tuple[arb, arb]:
    """The integrals of dz/|w| and z dz/|w| from e_s, s counted from 0, to where phi is the angle."""
    below = [e[s] - e[j] for j in range(s)]
    above = [e[j] - e[s + 1] for j in range(s + 2, 5)]
    width = e[s + 1] - e[s]

    def weight(phi: acb, analytic: bool) -> acb:
        sine, cosine = phi.sin_cos()
        up, down = width * sine * sine, width * cosine * cosine
        product = acb(1)
        for distance in below:
            product *= (distance + up).rsqrt(analytic)
        for distance in above:
            product *= (distance + down).rsqrt(analytic)
        return product

    def moment(phi: acb, analytic: bool) -> acb:
        return weight(phi, analytic) * (e[s] + width * phi.sin() ** 2)

    return _integral(weight, angle), _integral(moment, angle)


def _integral(integrand: Integrand, angle: arb) -> arb:
    """Integrate from 0, to an error that is small beside the integrand in the middle."""
    goal = abs(integrand(acb(angle / 2), False)) * arb(2) ** -ctx.prec  # noqa: FBT003 (as Arb calls it)
    return integral(integrand, acb(0), acb(angle), abs_tol=goal).real


def _share(e: Sequence[arb], k: int, point: Point, to_turns: arb_mat) -> tuple[arb, arb]:
    """The share of the point in Z; exactly nothing, or half a turn, where it is a branch point."""
    s, u = OVALS[k], point.u
    if not point.sheet:
        is_last = u.overlaps(e[s + 1])
        if is_last and u.overlaps(e[s]):
            raise Undecidable("two branch points of Weber's curve share a ball")
        half = arb(1) / 2 if is_last else arb(0)
        return (half, arb(0)) if k == 0 else (arb(0), half)
    if not e[s] < u < e[s + 1]:
        raise Undecidable("a point and a branch point of Weber's curve share a ball")
    angle = arb.atan2((u - e[s]).sqrt(), (e[s + 1] - u).sqrt())
    return _turned(to_turns, [point.sheet * entry for entry in stretch(e, s, angle)])


def _turned(matrix: arb_mat, vector: Sequence[arb]) -> tuple[arb, arb]:
    product = matrix * arb_mat([[entry] for entry in vector])
    return product[0, 0], product[1, 0]
