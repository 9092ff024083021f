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

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Final, final

from flint import acb, arb, arb_mat

from taylor_verify.exact.balls import Enclosed, Enclosure, ball_matrix, balls, balls_of
from taylor_verify.exact.kirchhoff.nutation import Pole, QuarticCourse, course
from taylor_verify.exact.kirchhoff.quartic import Nutation, repeated_root
from taylor_verify.exact.lattice import Lattice, Periods
from taylor_verify.exact.solution import Time
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.scenes.motion import Impulse

Rows = list[list[arb]]
# The columns of a matrix, of each the first component plus i times the second.
Columns = tuple[acb, acb, acb]

_I: Final = acb(0, 1)
_HALF: Final = arb(0.5)
_HALF_I: Final = acb(0, 0.5)
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
        rows = self._orbits[bits].rows(balls_of(elapsed))
        return {name: rows[name] for name in ("linear_impulse", "angular_impulse", *self.track)}


@final
class Factor:
    """N(u; a) = s(u - a)/s(-a); s(u)/s'(0) for the argument 0, and 1 for one at a double point."""

    def __init__(self, lattice: Lattice, argument: acb | None) -> None:
        self._lattice, self._argument = lattice, argument
        if argument is not None:
            order = int(argument.is_zero())
            self._scale = lattice.jet(-argument, order)[order]

    def jets(self, times: Sequence[arb], order: int) -> list[list[acb]]:
        """N at each of the arguments and, for order 1, its derivatives there."""
        jets = [self.jet(u, order) for u in times]
        return [[jet[k] for jet in jets] for k in range(order + 1)]

    def jet(self, u: arb, order: int) -> list[acb]:
        """N and, for order 1, its derivative."""
        if self._argument is None:
            return [acb(1), acb(0)][: order + 1]
        return [value / self._scale for value in self._lattice.jet(u - self._argument, order)]

    def start_rate(self) -> acb:
        """N'/N at the start, or its constant term, zero, for a factor that vanishes there."""
        if self._argument is None or self._argument.is_zero():
            return acb(0)
        value, slope = self.jet(arb(0), order=1)
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
        self._over_F, self._over_r = 1 / self._F, self._root / ball(body.r)
        self._near = _NEAR_POLE**2 * (self._F * self._F).mid()
        self._r, self._screw = self._rate(body.r), self._rate(body.q_prime - body.q)
        self._FG, self._spin = ball(nutation.FG), self._rate(body.r_prime * nutation.y3)
        self._course = course(nutation, heteroclinic)
        self._needs_integral = not self._screw.is_zero()
        self._is_periodic = isinstance(self._course.lattice, Periods)
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

    def rows(self, times: Sequence[arb]) -> dict[str, list[Any]]:
        """Return every tracked quantity, and possibly others, at each time since the start."""
        count, places = len(times), self._course.places(times)
        (alpha,) = self._alpha.jets(times, order=0)
        (beta,) = self._beta.jets(times, order=0)
        poles = [Pole.of(*pole.jets(times, self._pole_order)) for pole in self._own_poles]
        along = [arb(0)] * count
        if self._needs_integral:
            along = self._course.integrals(times, [speed for _, speed in places], poles)
        screws = [self._screw * z for z in along]
        over = self._over(poles, count)
        turns = [
            self._xi * self._grown(self._xi_rate, u, -screw) * part
            for u, screw, part in zip(times, screws, over, strict=True)
        ]
        across = [turn * a.conjugate() * b for turn, a, b in zip(turns, alpha, beta, strict=True)]
        etas = self._etas(times, places, across, turns, alpha, beta)
        rows: dict[str, list[Any]] = {
            "linear_impulse": [
                [xi.real, xi.imag, z] for xi, (z, _) in zip(across, places, strict=True)
            ],
            "angular_impulse": [[eta.real, eta.imag, self._y3] for eta in etas],
        }
        if self._track:
            larger = [
                self._larger(u, z, a, b, screw) * part
                for u, (z, _), a, b, screw, part in zip(
                    times, places, alpha, beta, screws, over, strict=True
                )
            ]
            columns = [
                self._columns(large, xi, z)
                for large, xi, (z, _) in zip(larger, across, places, strict=True)
            ]
            rows["attitude"] = self._attitudes(columns, across, [z for z, _ in places])
            if "centre" in self._track:
                moments = map(self._moment, columns, etas)
                advances = self._advances(times, poles, along)
                rows["centre"] = self._centres(moments, advances)
        for k, u in enumerate(times):
            if u.is_zero():
                for name, quantity in rows.items():
                    quantity[k] = self._at_start[name]
        return rows

    def _etas(
        self,
        times: Sequence[arb],
        places: Sequence[tuple[arb, arb]],
        across: Sequence[acb],
        turns: Sequence[acb],
        alpha: Sequence[acb],
        beta: Sequence[acb],
    ) -> list[acb]:
        """eta at each time, from xi; near a pole, where that is no division, from xi'."""
        front = self._course.front
        if front is not None:
            # G = y3 = 0, and y keeps its digits where z' = c (F^2 - z^2) has none left.
            factor = _I * front.c / self._r
            return [factor * xi for xi in across]
        FG, y3, over_r, near, etas = self._FG, self._y3, self._over_r, self._near, list[acb]()
        for k, (xi, (z, speed)) in enumerate(zip(across, places, strict=True)):
            re, im = xi.real, xi.imag
            square = re * re + im * im
            if square.mid() < near:
                eta = self._eta_near_pole(times[k], z, xi, turns[k], (alpha[k], beta[k]))
            else:
                eta = acb(FG - z * y3, speed * over_r) * xi * (1 / square)
            etas.append(eta)
        return etas

    def _larger(self, u: arb, z: arb, alpha: acb, beta: acb, screw: arb) -> acb:
        """The larger one of D1 and D2, without the factors of the poles."""
        if z.mid() >= 0:
            return self._one * alpha * alpha * self._grown(self._one_rate, u, screw)
        return self._two * beta * beta * self._grown(self._two_rate, u, -screw)

    def _attitudes(
        self, columns: Sequence[Columns], across: Sequence[acb], heights: Sequence[arb]
    ) -> list[Rows]:
        """R in the scene's space axes, by one product of matrices, from its columns, xi and z."""
        frames = arb_mat(3, 3 * len(columns), self._frames(columns, across, heights))
        first, second, third = (self._to_space * frames).tolist()
        places = range(0, 3 * len(columns), 3)
        return [[first[k : k + 3], second[k : k + 3], third[k : k + 3]] for k in places]

    def _grown(self, rate: acb, u: arb, angle: arb) -> acb:
        """e^{rate u + i angle}, for a rate of xi, D1 or D2.

        Where s has two periods a rate is imaginary: the quotients of s, and what they make together with
        the exponential, come back to their sizes after every period of s.
        """
        if self._is_periodic:
            sin, cos = (rate.imag * u + angle).sin_cos()
            return acb(cos, sin)
        return (rate * u + acb(0, angle)).exp()

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
        larger = self._one if self._nutation.z >= 0 else self._two
        columns = self._columns(larger, self._start_xi, self._course.z)
        frame = arb_mat(3, 3, self._frames([columns], [self._start_xi], [self._course.z]))
        self._to_space = attitude * frame.transpose()
        self._start_moment = self._moment(columns, self._start_eta)
        body, F2 = self._nutation.body, self._nutation.F2
        self._ahead = self._rate(body.p * F2 + body.q * self._nutation.FG)
        self._ahead_by_square = self._rate(body.p_prime - body.p)

    # The numbers of one time.

    @property
    def _own_poles(self) -> Sequence[Factor]:
        """The factors of the poles; of two that are conjugate, the first one."""
        return self._poles[:1] if self._course.are_conjugate else self._poles

    def _over(self, poles: Sequence[Pole], count: int) -> list[acb]:
        """The product of 1/N over all poles, each as often as its order says, at each time."""
        if self._course.are_conjugate:
            return [acb(1 / square) for square in poles[0].squares]
        if not poles:
            return [acb(1)] * count
        values, squares = poles[0].values, poles[0].squares
        for pole in poles[1:]:
            values = [N * other for N, other in zip(values, pole.values, strict=True)]
            squares = [size * other for size, other in zip(squares, pole.squares, strict=True)]
        over = [N.conjugate() * (1 / size) for N, size in zip(values, squares, strict=True)]
        return [part * part for part in over] if self._course.order == 2 else over

    def _eta_near_pole(self, u: arb, z: arb, xi: acb, turn: acb, above: tuple[acb, acb]) -> acb:
        """Solve xi' = i r z eta - i (r' y3 + (q' - q) z) xi for eta, without a division by xi."""
        alpha, beta = above[0].conjugate(), above[1]
        alpha_slope, beta_slope = (
            factor.jet(u, order=1)[1] for factor in (self._alpha, self._beta)
        )
        growth = alpha_slope.conjugate() * beta + alpha * beta_slope
        jets = [factor.jet(u, order=1) for factor in self._own_poles]
        rates = [slope / value for value, slope in jets]
        if self._course.are_conjugate:
            rates += [rate.conjugate() for rate in rates]
        slopes = sum(rates, acb(0))
        pull = self._xi_rate - self._course.order * slopes - _I * self._screw * z
        change = turn * growth + pull * xi
        return (change / _I + (self._spin + self._screw * z) * xi) / (self._r * z)

    def _columns(self, larger: acb, xi: acb, z: arb) -> Columns:
        """The columns of R with the space axis Z along the impulse, from xi, z and the larger of D1 and D2.

        With g = xi/(F + z) the other one is -D1 g^2, and sin(theta) e^{i psi} is -i D1 g; where D2 is the
        larger, with g the conjugate of xi/(F - z), they are -D2 g^2 and i D2 g.
        """
        is_up = z.mid() >= 0
        g = xi * (1 / (self._F + z)) if is_up else xi.conjugate() * (1 / (self._F - z))
        slanted = larger * g
        smaller = slanted * g
        first, second = (larger - smaller) * _HALF, (larger + smaller) * _HALF_I
        return (first, second, -slanted) if is_up else (first, -second, slanted)

    def _frames(
        self, columns: Sequence[Columns], across: Sequence[acb], heights: Sequence[arb]
    ) -> list[arb]:
        """The first rows of all R with the space axis Z along the impulse, their second and their third."""
        over = self._over_F
        first = [column.real for three in columns for column in three]
        second = [column.imag for three in columns for column in three]
        impulses = zip(across, heights, strict=True)
        third = [part * over for xi, z in impulses for part in (xi.real, xi.imag, z)]
        return first + second + third

    def _moment(self, columns: Columns, eta: acb) -> acb:
        """X + i Y of R y."""
        first, second, third = columns
        return first * eta.real + second * eta.imag + third * self._y3

    def _centres(self, moments: Iterable[acb], advances: Sequence[arb]) -> Rows:
        """The centre in the scene's space axes, from X + i Y of R y and F times its way along the impulse.

        Across the impulse, by 49 (18)-(19), F times its way is that of R y, turned by a right angle.
        """
        ways = [moment - self._start_moment for moment in moments]
        across = [way.imag for way in ways] + [-way.real for way in ways]
        to_space = self._to_space * self._over_F
        moved = (to_space * arb_mat(3, len(ways), across + list(advances))).tolist()
        start = self._at_start["centre"]
        x, y, z = ([at + way for way in ways] for at, ways in zip(start, moved, strict=True))
        return [list(centre) for centre in zip(x, y, z, strict=True)]

    def _advances(
        self, times: Sequence[arb], poles: Sequence[Pole], along: Sequence[arb]
    ) -> list[arb]:
        """F times the way of the centre along the impulse, from int z du.

        F dZ/dt = p F^2 + q FG + (p' - p) z^2 + (q' - q) y3 z, from Z' = (U.x)/F.
        """
        screw = self._screw * self._y3
        advances = [self._ahead * u + screw * z for u, z in zip(times, along, strict=True)]
        if not isinstance(self._course, QuarticCourse):
            return advances
        share = self._ahead_by_square
        squares = self._course.integrals_of_square(times, poles, along)
        return [way + share * z for way, z in zip(advances, squares, strict=True)]
