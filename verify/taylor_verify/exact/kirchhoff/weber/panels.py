"""Panels of time for the two integrals of Weber's motion, with a proven bound of each integrand.

Legend: n = x/F; the body axis c, with a and b the other two, and W = Omega, U the velocities. About the
impulse, which stands still in space, the axis c has the azimuth phi, and along it the centre goes by Z:

    phi' = (W_a n_a + W_b n_b)/(n_a^2 + n_b^2),    Z' = n.U.

Both are meromorphic in complex time. A panel of half-width h has the ellipse E with its ends as foci and
the half-axes h (rho +- 1/rho)/2. If a function is analytic in E and at most M there, then Gauss's rule
of N nodes, N >= 2, is wrong on the panel by at most (64/15) h M rho^(-2N)/(1 - rho^-2): of the Chebyshev
coefficients, at most 2 M rho^-k, it sees those of even k >= 2N alone, each with at most 2 + 2/(k^2 - 1).
The ellipse of a part of the panel lies within E, and the bound holds for it as well.

M is that of arcs which cover the boundary of E: at the middle t of an arc of half-length d

    |theta(s) - theta(t)| <= |theta'(t)| d + g'' d^2/2,    |s - t| <= d,

where g'' bounds theta'' in the strip |Im s| <= height: g(height) = theta[a, 0](i height rate) is the sum of
the sizes of all terms, cosh included, and so are its derivatives. That theta[0] and n_a^2 + n_b^2 have no
zero inside is the argument principle: a disc about each of their values on an arc has none, and the
middles of the discs do not go round zero. Both functions are real on the real line, which leaves half
of the arcs.

Source of the rule's error: L. N. Trefethen, Approximation Theory and Approximation Practice, 2013, ch. 19.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any, Final, NamedTuple

from flint import acb, acb_mat, arb, ctx

from taylor_verify.exact.balls import Undecidable, ball
from taylor_verify.exact.kirchhoff.weber.curve import Curve
from taylor_verify.exact.kirchhoff.weber.enclosure import Jet, Quotients
from taylor_verify.exact.solution import Unsettled
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.precision import floor_log2, power_of_two

RHO: Final = 3
_ACROSS, _UP = Fraction(5, 3), Fraction(4, 3)
# The way from an end of a panel to that of its ellipse, in half-widths.
BEYOND: Final = _ACROSS - 1
_BITS: Final = 64
_DOUBLINGS: Final = 6
_ARCS: Final = 8
_HALVINGS_OF_ARCS: Final = 4
_HALVINGS: Final = 40
# A disc is used if its radius is less than this part of its middle: without zero, whatever floats round.
_SLENDER: Final = 0.75
# Limit of the number of panels: some hours of work.
_MOST: Final = 20_000
_OTHERS: Final = ((1, 2), (2, 0), (0, 1))


@dataclass(frozen=True)
class Integrands:
    """phi' and Z', in balls or in mpmath: T is diagonal, with p_i, one b and r_i."""

    F: Any
    p: Sequence[Any]
    b: Any
    r: Sequence[Any]

    @classmethod
    def of(cls, body: ImmersedBody, F: Any, number: Any) -> Integrands:
        p, r = ([number(block[i][i]) for i in range(3)] for block in (body.linear, body.angular))
        return cls(F, p, number(body.coupling[0][0]), r)

    def azimuth(self, n: Sequence[Any], y: Sequence[Any], axis: int) -> Any:
        i, j = _OTHERS[axis]
        return self.b * self.F + (self.r[i] * y[i] * n[i] + self.r[j] * y[j] * n[j]) / across(
            n, axis
        )

    def rise(self, n: Sequence[Any], y: Sequence[Any]) -> Any:
        return sum(n[i] * (self.F * self.p[i] * n[i] + self.b * y[i]) for i in range(3))


def across(n: Sequence[Any], axis: int) -> Any:
    """n_a^2 + n_b^2, the square of the part of n across the axis c."""
    i, j = _OTHERS[axis]
    return n[i] * n[i] + n[j] * n[j]


@dataclass(frozen=True)
class Panel:
    """A panel from ``start`` on, which lies after it or before it, and the axis c used there.

    ``azimuth`` and ``rise`` bound |phi'| and |Z'| in its ellipse.
    """

    start: Fraction
    end: Fraction
    axis: int
    azimuth: arb
    rise: arb

    @property
    def half(self) -> Fraction:
        return abs(self.end - self.start) / 2


class _Arc(NamedTuple):
    """The discs of theta[0] and of the three n_a^2 + n_b^2, and the balls of the integrands."""

    below: acb
    across: list[acb]
    azimuth: list[acb]
    rise: acb


class _Sizes(NamedTuple):
    """Bounds of theta'' in time, and of the rate in time of its rate along Neumann's time."""

    bend: arb
    twist: arb


class Panels:
    """The panels of one motion on one side of its start, found as they are asked for."""

    def __init__(self, curve: Curve, body: ImmersedBody, side: int) -> None:
        self._curve, self._body, self._side = curve, body, side
        self._bits = _BITS
        self._panels: list[Panel] = []
        self._sizes: dict[Fraction, list[_Sizes]] = {}
        self._motion = self._set_up()
        with ctx.workprec(self._bits):
            self._integrands = Integrands.of(body, self._motion.F, ball)
            fastest = max(abs(rate).upper() for rate in self._motion.jacobian.rate)
        # The width that is tried first: some eighth of a turn.
        self._first = self._half = power_of_two(-floor_log2(exactly(fastest)) - 3)

    def until(self, t: Fraction) -> Sequence[Panel]:
        """The panels up to the time t, of this side, and maybe more."""
        if abs(t) > 2 * _MOST * self._first:
            raise Unsettled(
                f"the attitude and the centre at t = {float(t):.3g} would take more than {_MOST} panels"
            )
        while abs(self._end) < abs(t):
            self._panels.append(self._next())
        return self._panels

    @property
    def _end(self) -> Fraction:
        return self._panels[-1].end if self._panels else Fraction(0)

    def _next(self) -> Panel:
        half, start = self._half, self._end
        for halved in range(_HALVINGS):
            try:
                with ctx.workprec(self._bits):
                    bounds = self._bounded(start + self._side * half, half)
            except Undecidable:
                bounds = None
            if bounds is not None:
                self._half = half if halved else 2 * half
                return Panel(start, start + 2 * self._side * half, *bounds)
            half /= 2
        raise Unsettled(f"no panel of Weber's integrals is free of poles at t = {float(start):.3g}")

    def _set_up(self) -> Quotients:
        """The motion at a precision that tells the branch points apart."""
        for doubled in range(_DOUBLINGS):
            self._bits = _BITS << doubled
            try:
                with ctx.workprec(self._bits):
                    motion = Quotients(self._curve)
                    if all(rate.is_finite() for rate in motion.jacobian.rate):
                        return motion
            except (Undecidable, ZeroDivisionError):
                continue
        raise Unsettled("the periods of Weber's curve do not settle")

    def _bounded(self, middle: Fraction, half: Fraction) -> tuple[int, arb, arb] | None:
        """The axis and the bounds of both integrands in the ellipse; None if it may hold a pole."""
        piece = Fraction(1, _ARCS)
        waiting = [(k * piece, piece) for k in reversed(range(_ARCS))]
        arcs, axes = [], {0, 1, 2}
        while waiting:
            low, width = waiting.pop()
            arc = self._arc(middle, half, low + width / 2, width / 2)
            good = {c for c in axes if _is_slender(arc.below) and _is_slender(arc.across[c])}
            if good:
                axes = good
                arcs.append(arc)
            elif width * (_ARCS << _HALVINGS_OF_ARCS) <= 1:
                return None
            else:
                waiting += [(low + width / 2, width / 2), (low, width / 2)]
        if _goes_round([arc.below for arc in arcs]):
            return None
        bounds = {
            c: _largest([arc.azimuth[c] for arc in arcs])
            for c in sorted(axes)
            if not _goes_round([arc.across[c] for arc in arcs])
        }
        rise = _largest([arc.rise for arc in arcs])
        bounds = {c: bound for c, bound in bounds.items() if bound.is_finite()}
        if not (bounds and rise.is_finite()):
            return None
        axis = min(bounds, key=lambda c: float(bounds[c].log()))
        return axis, bounds[axis], rise

    def _arc(self, middle: Fraction, half: Fraction, at: Fraction, spread: Fraction) -> _Arc:
        """Return the discs and balls on the arc of the ellipse at pi ``at`` +- pi ``spread``."""
        sine, cosine = arb.sin_cos_pi(ball(at))
        t = acb(ball(middle) + ball(half * _ACROSS) * cosine, ball(half * _UP) * sine)
        reach = (ball(half * _ACROSS * spread) * arb.pi()).upper()
        jets = [
            Jet(
                _widened(jet.value, abs(jet.rate) * reach + size.bend * reach * reach / 2),
                _widened(jet.along, size.twist * reach),
                jet.rate,
            )
            for jet, size in zip(self._motion.jets(t), self._bends(half), strict=True)
        ]
        n, y = self._motion.impulses(jets)
        return _Arc(
            jets[0].value,
            [across(n, c) for c in range(3)],
            [self._integrands.azimuth(n, y, c) for c in range(3)],
            self._integrands.rise(n, y),
        )

    def _bends(self, half: Fraction) -> list[_Sizes]:
        """The bounds in the strip of the ellipse, for each of the theta functions."""
        if half not in self._sizes:
            place, height = self._motion.jacobian, ball(half * _UP)
            Z = acb_mat(2, 1, [acb(0, height * rate) for rate in place.rate])
            jets = place.tau.theta_jets(Z, 2)

            def size(which: int, g: Sequence[arb]) -> arb:
                # Taylor's coefficients, and cosh for cos.
                by_11, by_12, by_22 = (jets[which & 0b1100, order].real for order in (3, 4, 5))
                return -2 * (by_11 * g[0] * g[0] + by_12 * g[0] * g[1] + by_22 * g[1] * g[1])

            self._sizes[half] = [
                _Sizes(bend, (bend * size(which, place.neumann)).sqrt())
                for which in self._motion.characteristics
                for bend in [size(which, place.rate)]
            ]
        return self._sizes[half]


def exactly(point: arb) -> Fraction:
    """Return a ball without a radius as a rational."""
    mantissa, exponent = point.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def _widened(value: acb, radius: arb) -> acb:
    around = arb(0, radius.upper())
    return value + acb(around, around)


def _is_slender(value: acb) -> bool:
    """Return True if a disc about the ball is small beside its middle."""
    radius = math.hypot(float(value.real.rad()), float(value.imag.rad()))
    # Written so that a NaN is not small.
    return value.is_finite() and radius < _SLENDER * abs(complex(value.mid()))


def _goes_round(values: Sequence[acb]) -> bool:
    """Return True if the values on the upper arcs, and their conjugates, go round zero.

    Each disc is seen from zero under less than a right angle to both sides, so that from the middle
    of one to that of the next, which has a point in common with it, the angle is less than two.
    """
    middles = [complex(value.mid()) for value in values]
    closed = [*middles, *(middle.conjugate() for middle in reversed(middles)), middles[0]]
    turned = sum(cmath.phase(after / before) for before, after in pairwise(closed))
    return not abs(turned) < math.pi


def _largest(values: Sequence[acb]) -> arb:
    largest = arb(0)
    for value in values:
        largest = largest.max(abs(value).upper())
    return largest
