"""Clebsch's body in balls: impulses, attitude and centre as quotients of sigma functions.

Legend, Hydromechanics 49: z = x3; xi = x1 + i x2, eta = y1 + i y2; F^2 = x.x, FG = x.y; the space axes of
the formulas have Z along the impulse, where theta, psi, phi are Euler's angles of R = Rz(psi) Rx(theta)
Rz(phi), so that xi = i F sin(theta) e^{-i phi} and z = F cos(theta). With s+ = i r (FG - F y3) and
s- = i r (FG + F y3),

    xi = x1 + i x2                       xi'/xi = (z' - s+)/2(z - F) + (z' - s-)/2(z + F)
                                                  - i (q' - q) z + i (r - r') y3
    D1 = (1 + cos theta) e^{i(psi+phi)}  D1'/D1 = (z' + s-)/(z + F) + i [q F + (r' - r) y3 + (q' - q) z]
    D2 = (1 - cos theta) e^{i(psi-phi)}  D2'/D2 = (z' - s+)/(z - F) + i [q F + (r - r') y3 - (q' - q) z]

are smooth through the poles x3 = +-F. Each is a quotient of products of N(u; a) = s(u - a)/s(-a), with
zeros alpha where (z, z') = (-F, s-) and beta where it is (F, -s+), and the poles w of z, times the
exponential of a linear function of u and of i (q' - q) int z.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import prod
from typing import Any, Final, final

from flint import acb, arb, arb_mat

from taylor_verify.exact.balls import Enclosed, Enclosure, ball, ball_matrix, balls
from taylor_verify.exact.kirchhoff.course import QuarticCourse, course
from taylor_verify.exact.kirchhoff.quartic import Nutation, repeated_root
from taylor_verify.exact.lattice import Lattice
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.solution import Time
from taylor_verify.scenes.motion import Impulse

_I: Final = acb(0, 1)
# Where |xi|^2 is a smaller part of F^2, eta is not found by a division by it.
_NEAR_POLE: Final = 2.0**-6


@final
@dataclass(eq=False)
class NutatingBody(Enclosed):
    """x3 varies: it swings between two roots of f, or falls away from one and returns to it."""

    regime: str
    nutation: Nutation
    start: Impulse
    track: frozenset[str]
    _orbits: dict[int, Orbit] = field(default_factory=dict, init=False)

    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        if bits not in self._orbits:
            heteroclinic = self.regime == "heteroclinic"
            self._orbits[bits] = Orbit(self.nutation, self.start, self.track, heteroclinic)
        rows = [self._orbits[bits].at(ball(t)) for t in elapsed]
        names = ("linear_impulse", "angular_impulse", *sorted(self.track))
        return {name: [row[name] for row in rows] for name in names}


@final
class Factor:
    """N(u; a) = s(u - a)/s(-a); s(u)/s'(0) for the argument 0, and 1 for one at a double point."""

    def __init__(self, lattice: Lattice, argument: acb | None) -> None:
        self._lattice, self._argument = lattice, argument
        if argument is not None:
            order = int(argument.is_zero())
            self._scale = lattice.jet(-argument, order)[order]

    def jet(self, u: arb, order: int) -> list[acb]:
        """N and, for order 1, its derivative."""
        if self._argument is None:
            return [acb(1), acb(0)][: order + 1]
        return [value / self._scale for value in self._lattice.jet(u - self._argument, order)]

    def start_rate(self) -> acb:
        """N'/N at the start, or its constant term, zero, for a factor that vanishes there."""
        if self._argument is None or self._argument.is_zero():
            return acb(0)
        value, slope = self.jet(arb(0), 1)
        return slope / value


@final
class Orbit:
    """A nutating motion with numbers of one precision, to be used at that precision."""

    def __init__(
        self, nutation: Nutation, start: Impulse, track: frozenset[str], heteroclinic: bool
    ) -> None:
        self._nutation, self._track = nutation, track
        body = nutation.body
        self._root = ball(nutation.axes.nu).sqrt()
        self._F, self._y3 = ball(nutation.F2).sqrt(), ball(nutation.y3)
        self._r, self._screw = self._rate(body.r), self._rate(body.q_prime - body.q)
        self._FG, self._spin = ball(nutation.FG), self._rate(body.r_prime * nutation.y3)
        self._course = course(nutation, heteroclinic)
        self._needs_integral = not self._screw.is_zero()
        # 1 where the derivatives of the poles' factors enter, else 0.
        is_cubic = self._course.order == 2
        self._pole_order = int((is_cubic and self._needs_integral) or "centre" in track)
        self._find_factors()
        self._find_rates()
        self._find_amplitudes(start)
        # The start as given: a centre or a y that is zero has no other narrow ball.
        attitude = ball_matrix(rotation_matrix(start.attitude))
        xi, eta = self._start_xi, self._start_eta
        self._at_start: dict[str, Any] = {
            "linear_impulse": [xi.real, xi.imag, ball(nutation.z)],
            "angular_impulse": [eta.real, eta.imag, self._y3],
            "attitude": attitude.tolist(),
            "centre": balls(start.centre),
        }
        if track:
            self._find_space(attitude)

    def at(self, u: arb) -> dict[str, Any]:
        """Every tracked quantity, and maybe more, at the time u since the start."""
        if u.is_zero():
            return self._at_start
        z, speed = self._course.at(u)
        poles = self._pole_jets(u, self._pole_order)
        along = self._course.integral(u, speed, poles) if self._needs_integral else arb(0)
        screw = (_I * self._screw * along).exp()
        above = self._alpha.jet(u, 0)[0], self._beta.jet(u, 0)[0]
        below = prod((value for value, *_ in poles), start=acb(1)) ** self._course.order
        turn = self._xi * (self._xi_rate * u).exp() / (below * screw)
        xi = turn * above[0].conjugate() * above[1]
        front = self._course.front
        if front is not None:
            # G = y3 = 0, and y keeps its digits where z' = c (F^2 - z^2) has none left.
            eta = _I * front.c / self._r * xi
        elif abs(xi).mid() < _NEAR_POLE * self._F.mid():
            eta = self._eta_near_pole(u, z, xi, turn, above)
        else:
            eta = acb(self._FG - z * self._y3, speed / self._r) / xi.conjugate()
        found: dict[str, Any] = {
            "linear_impulse": [xi.real, xi.imag, z],
            "angular_impulse": [eta.real, eta.imag, self._y3],
        }
        if self._track:
            one = self._one * above[0] ** 2 * (self._one_rate * u).exp() * screw / below
            two = self._two * above[1] ** 2 * (self._two_rate * u).exp() / (screw * below)
            frame = self._frame(one, two, xi, z)
            found["attitude"] = (self._to_space * frame).tolist()
            if "centre" in self._track:
                path = self._path(u, self._moment(frame, eta), poles, along)
                moved = (self._to_space * arb_mat(3, 1, path)).entries()
                start = self._at_start["centre"]
                found["centre"] = [c + v for c, v in zip(start, moved, strict=True)]
        return found

    # The numbers of the whole orbit.

    def _rate(self, rational: Fraction) -> arb:
        """A coefficient of T, or a multiple of one, in the units of the orbit."""
        return ball(rational) / self._root

    def _find_factors(self) -> None:
        """alpha where (z, z') = (-F, s-), beta where it is (F, -s+), and the poles of z."""
        lattice, F = self._course.lattice, self._F
        pull = self._r * (self._FG + F * self._y3), self._r * (self._FG - F * self._y3)
        # Where a pole is a root of f the pull is zero, which no ball can say.
        self._s_minus = acb(0, arb(0) if self._nutation.touches_pole(-1) else pull[0])
        self._s_plus = acb(0, arb(0) if self._nutation.touches_pole(1) else pull[1])
        self._alpha = Factor(lattice, self._zero(-1, self._s_minus))
        self._beta = Factor(lattice, self._zero(1, -self._s_plus))
        self._poles = [Factor(lattice, w) for w in self._course.poles]

    def _zero(self, side: int, s: acb) -> acb | None:
        """The argument of (side F, s): 0 for a start there, None if f has a double root there."""
        if self._starts_on_axis(side):
            return acb(0)
        double = repeated_root(self._nutation.f)
        is_double = double is not None and double**2 == self._nutation.F2 and side * double > 0
        if self._course.front is not None or is_double:
            return None
        return self._course.argument(side * self._F, s)

    def _starts_on_axis(self, side: int) -> bool:
        return self._nutation.is_axial and side * self._nutation.z > 0

    def _find_rates(self) -> None:
        """The linear rates of the exponentials, from the logarithmic derivatives at the start."""
        body, y3 = self._nutation.body, self._nutation.y3
        z, speed, F = self._course.z, self._course.speed, self._F
        up = acb(0) if self._starts_on_axis(1) else (speed - self._s_plus) / (z - F)
        down = acb(0) if self._starts_on_axis(-1) else (speed - self._s_minus) / (z + F)
        down_back = acb(0) if self._starts_on_axis(-1) else (speed + self._s_minus) / (z + F)
        alpha, beta = self._alpha.start_rate(), self._beta.start_rate()
        poles = self._course.order * sum((pole.start_rate() for pole in self._poles), acb(0))
        ahead, spin = self._rate(body.q) * F, self._rate((body.r - body.r_prime) * y3)
        self._xi_rate = (up + down) / 2 + _I * spin - alpha.conjugate() - beta + poles
        self._one_rate = down_back + _I * (ahead - spin) - 2 * alpha + poles
        self._two_rate = up + _I * (ahead + spin) - 2 * beta + poles

    def _find_amplitudes(self, start: Impulse) -> None:
        """xi, D1 and D2 at the start, or their leading coefficients where they vanish there.

        The zero of psi is free: of D1 and D2 the larger one begins real, and D1 D2 = -D1^2 xi^2/(F + z)^2.
        """
        z, F = self._course.z, self._F
        axes = self._nutation.axes
        self._start_xi = acb(*axes.across(start.linear, ball))
        self._start_eta = acb(*axes.across(start.angular, ball))
        self._xi = self._start_xi
        if self._starts_on_axis(1) or self._starts_on_axis(-1):
            self._xi = _I * self._r * z * self._start_eta  # xi = xi'(0) u + ...
        if self._nutation.z >= 0:
            self._one = acb((F + z) / F)
            self._two = -(self._xi**2) / (F * (F + z))
        else:
            self._one = -(self._xi.conjugate() ** 2) / (F * (F - z))
            self._two = acb((F - z) / F)

    def _find_space(self, attitude: arb_mat) -> None:
        """The scene's space axes, in which R and the centre begin as it says."""
        one = acb(0) if self._starts_on_axis(-1) else self._one
        two = acb(0) if self._starts_on_axis(1) else self._two
        frame = self._frame(one, two, self._start_xi, self._course.z)
        self._to_space = attitude * frame.transpose()
        self._start_moment = self._moment(frame, self._start_eta)
        body, F2 = self._nutation.body, self._nutation.F2
        self._ahead = self._rate(body.p * F2 + body.q * self._nutation.FG)
        self._ahead_by_square = self._rate(body.p_prime - body.p)

    # The numbers of one time.

    def _pole_jets(self, u: arb, order: int) -> list[list[acb]]:
        if not self._course.are_conjugate:
            return [pole.jet(u, order) for pole in self._poles]
        jet = self._poles[0].jet(u, order)
        return [jet, [value.conjugate() for value in jet]]

    def _eta_near_pole(self, u: arb, z: arb, xi: acb, turn: acb, above: tuple[acb, acb]) -> acb:
        """Solve xi' = i r z eta - i (r' y3 + (q' - q) z) xi for eta, without a division by xi."""
        alpha, beta = above[0].conjugate(), above[1]
        alpha_slope, beta_slope = (factor.jet(u, 1)[1] for factor in (self._alpha, self._beta))
        growth = alpha_slope.conjugate() * beta + alpha * beta_slope
        slopes = sum((slope / value for value, slope in self._pole_jets(u, 1)), acb(0))
        pull = self._xi_rate - self._course.order * slopes - _I * self._screw * z
        change = turn * growth + pull * xi
        return (change / _I + (self._spin + self._screw * z) * xi) / (self._r * z)

    def _frame(self, one: acb, two: acb, xi: acb, z: arb) -> arb_mat:
        """R with the space axis Z along the impulse, row by row, from D1, D2, xi and z."""
        F = self._F
        # sin(theta) e^{i psi} by the larger of 1 + cos theta and 1 - cos theta
        lean = one * xi / (_I * (F + z)) if z.mid() >= 0 else two * xi.conjugate() / (_I * (z - F))
        total, rest = (one + two) / 2, (one - two) / 2
        return arb_mat(
            [
                [total.real, -rest.imag, lean.imag],
                [total.imag, rest.real, -lean.real],
                [xi.real / F, xi.imag / F, z / F],
            ]
        )

    def _moment(self, frame: arb_mat, eta: acb) -> acb:
        """X + i Y of R y."""
        y = frame * arb_mat(3, 1, [eta.real, eta.imag, self._y3])
        return acb(y[0, 0], y[1, 0])

    def _path(self, u: arb, moment: acb, poles: list[list[acb]], along: arb) -> list[arb]:
        """The centre from its start: 49 (18)-(19) across the impulse, and Z along it.

        F dZ/dt = p F^2 + q FG + (p' - p) z^2 + (q' - q) y3 z, from Z' = (U.x)/F.
        """
        advance = self._ahead * u + self._screw * self._y3 * along
        if isinstance(self._course, QuarticCourse):
            square = self._course.integral_of_square(u, poles, along)
            advance += self._ahead_by_square * square
        across = (moment - self._start_moment) / (_I * self._F)
        return [across.real, across.imag, advance / self._F]
