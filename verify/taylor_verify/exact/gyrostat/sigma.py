"""The free motion of a gyrostat in balls: omega by Weierstrass's p, the attitude by sigma quotients.

Legend: as in pencil and azimuth; s is the odd function of exact.lattice, alpha_j the argument of
a pole of phi' and sigma_j its sign. With k such that the rate at the start is phi'(0),

    e^{i phi} = e^{i k t} prod (q_j/|q_j|)^sigma_j,    q_j = s(t - alpha_j)/s(-alpha_j):

four factors of modulus one, of which no branch has to be chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from functools import cached_property
from typing import NamedTuple, final

from flint import acb, arb, arb_mat

from taylor_verify.exact.balls import Undecidable, balls, balls_of
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.euler.rotations import BallCourse, Moving, OneByOne, RotationBalls, Rows
from taylor_verify.exact.gyrostat.azimuth import (
    FRAMES,
    Frame,
    poles,
    rate_at_start,
)
from taylor_verify.exact.gyrostat.curve_point import PointMap, point_map
from taylor_verify.exact.gyrostat.momentum_function import momentum_form
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.exact.lattice import Lattice, lattice
from taylor_verify.exact.solution import Time
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.rotation import (
    conjugate,
    product,
    rotation_rows,
    scalar_product,
    turn,
)
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector, cross, dot
from taylor_verify.scenes.motion import Quaternion


def top_rotation(spin: FreeSpin, attitude: Quaternion | None) -> RotationBalls:
    """The free motion of a rigid body without wheels, and R where an attitude is given."""
    free = FreeGyrostat(spin.inertia, ZERO_VECTOR, spin.omega)
    return free_rotation(free, attitude, spin.regime.value)


def free_rotation(
    free: FreeGyrostat, attitude: Quaternion | None, regime: str | None = None
) -> RotationBalls:
    """The free motion of a rigid body with wheels, and R where an attitude is given.

    Its regime is that of a gyrostat, unless another word is given.
    """

    def course() -> BallCourse:
        return Tumbling(free) if free.outer is None else Turning(free, free.outer)

    return RotationBalls(regime or free.regime.value, course, attitude)


@final
class Turning(OneByOne):
    """w turns in the body at a constant rate v, and the body about u: a turn by Rot(u t) Rot(-v t)."""

    def __init__(self, free: FreeGyrostat, outer: Vector) -> None:
        self._omega, self._outer, self._inner = free.omega, outer, free.inner

    def at(self, t: Time, turned: bool) -> tuple[list[arb], Rows]:
        time = ball(t)
        inner = _turn(self._inner, time)
        omega = (arb_mat(rotation_rows(inner)) * arb_mat(3, 1, balls(self._omega))).entries()
        if not turned:
            return omega, []
        return omega, rotation_rows(product(_turn(self._outer, time), conjugate(inner)))


def _turn(rate: Vector, t: arb) -> list[arb]:
    """The rotation at a constant rate for a time t."""
    speed = ball(dot(rate, rate)).sqrt()
    axis = [w / speed for w in balls(rate)] if any(rate) else balls(rate)
    return turn(axis, speed * t / 2)


@final
class Tumbling:
    """A motion that is not a uniform turning."""

    def __init__(self, free: FreeGyrostat) -> None:
        self._free = free
        self._form = momentum_form(free).converted(ball)
        self._K, self._g = [balls(row) for row in free.K], balls(free.g)
        self._lattice = lattice(*free.invariants)
        self._omega = balls(free.omega)

    @cached_property
    def _azimuth(self) -> Azimuth:
        return best_azimuth(self._free, self._lattice)

    @cached_property
    def _tilted_back(self) -> arb_mat:
        """M(0)."""
        return arb_mat(self._azimuth.axes(balls(self._free.momentum))).transpose()

    def rows(self, times: Sequence[Time], start: arb_mat | None) -> Moving:
        """omega, and R from the R at the start, at each time."""
        elapsed = balls_of(times)
        places = [self._form.at(*self._lattice.real(u)) for u in elapsed]
        at_start = [t.is_zero() for t in elapsed]
        omega = [
            self._omega if first else self._spin(G)
            for first, G in zip(at_start, places, strict=True)
        ]
        if start is None:
            return omega, []
        to_space = (start * self._tilted_back).tolist()
        turns = zip(at_start, map(self._azimuth.turn, elapsed), places, strict=True)
        return omega, [
            start.tolist() if first else _in_space(to_space, turn, *self._azimuth.axes(G))
            for first, turn, G in turns
        ]

    # Entry by entry: to make a matrix of balls takes longer than the product.

    def _spin(self, G: Sequence[arb]) -> list[arb]:
        """K G - g."""
        a, b, c = G
        rows = zip(self._K, self._g, strict=True)
        return [p * a + q * b + r * c - g for (p, q, r), g in rows]


def _in_space(to_space: Rows, turn: acb, m1: list[arb], m2: list[arb], m3: list[arb]) -> Rows:
    """R(0) M(0) Rz(phi) M^T, with the cosine and the sine of phi in ``turn``."""
    x, y = turn.real, turn.imag
    turned = [(x * a - y * b, y * a + x * b, c) for a, b, c in zip(m1, m2, m3, strict=True)]
    return [[p * a + q * b + r * c for a, b, c in turned] for p, q, r in to_space]


@final
class Azimuth:
    """phi(t) of one frame, as the rotation by it, and M(t)."""

    def __init__(self, free: FreeGyrostat, place: PointMap, frame: Frame, curve: Lattice) -> None:
        self._lattice, self._c = curve, balls(frame.c)
        self._N = ball(free.n).sqrt()
        self._factors = []
        self._rate = rate_at_start(free, frame.c, self._N)
        for pole in poles(free, place.converted(ball), frame):
            argument = curve.argument(pole.p, pole.slope)
            value, slope = curve.jet(-argument, order=1)
            self._factors.append(_Factor(argument, value, pole.sigma))
            self._rate -= pole.sigma * (slope / value).imag

    @property
    def per_period(self) -> arb:
        """phi after a period, less whole turns: each of an even number of factors changes its sign."""
        assert self._lattice.period is not None
        return self._rate * self._lattice.period

    @property
    def distance(self) -> float:
        """The least distance of a pole from the real line; zero if a pole is at no finite place."""
        if not all(f.argument.is_finite() and (1 / f.scale).is_finite() for f in self._factors):
            return 0.0
        return min(abs(float(factor.argument.imag.mid())) for factor in self._factors)

    def turn(self, t: arb) -> acb:
        """e^{i phi}."""
        quotient = acb(1)
        for argument, scale, sigma in self._factors:
            (value,) = self._lattice.jet(t - argument, order=0)
            # A factor for sigma = -1 is inverted; once its modulus is left out that is the conjugate.
            quotient *= value / scale if sigma > 0 else (value / scale).conjugate()
        sin, cos = (self._rate * t).sin_cos()
        p, q = quotient.real, quotient.imag
        size = (p * p + q * q).rsqrt()
        return acb((cos * p - sin * q) * size, (sin * p + cos * q) * size)

    def axes(self, G: Sequence[arb]) -> list[list[arb]]:
        """m1, m2 and m3, the columns of M."""
        over = 1 / self._N
        m3 = [component * over for component in G]
        along = scalar_product(self._c, m3)
        across = [p - along * q for p, q in zip(self._c, m3, strict=True)]
        length = scalar_product(across, across).rsqrt()
        m1 = [component * length for component in across]
        return [m1, list(cross(m3, m1)), m3]


class _Factor(NamedTuple):
    argument: acb
    scale: acb
    sigma: int


def best_azimuth(free: FreeGyrostat, curve: Lattice) -> Azimuth:
    """Return the azimuth of a motion in a frame whose poles are far from the real line.

    Any frame that has its poles would be right.
    """
    place = point_map(free)
    for frames in FRAMES:
        made = [_azimuth(free, place, frame, curve) for frame in frames]
        if azimuths := [azimuth for azimuth in made if azimuth and azimuth.distance]:
            return max(azimuths, key=lambda azimuth: azimuth.distance)
    raise Undecidable


def _azimuth(free: FreeGyrostat, place: PointMap, frame: Frame, curve: Lattice) -> Azimuth | None:
    """Return the azimuth in a frame; None in one that has too few poles."""
    with suppress(Undecidable, ZeroDivisionError):
        return Azimuth(free, place, frame, curve)
    return None
