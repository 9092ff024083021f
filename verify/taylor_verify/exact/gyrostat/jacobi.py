"""The free motion of a gyrostat in mpmath: Jacobi's functions, and Carlson's integrals for the attitude.

Legend: as in pencil and azimuth; x_j and v_j are p and p' at a pole of phi' and sigma_j its sign, L the
period of p. For t = n L + r with |r| <= L/2,

    phi = phi'(0) t + (1/2) Im sum_j sigma_j [log(p(r) - x_j) + v_j (2 n J_j(L/2) + J_j(r))],
    J_j(r) = int_0^r dt/(p - x_j) = R_J(p - e1, p - e2, p - e3, p - x_j)/3 for r > 0, and odd in r.

p is real on the way and x_j is not, so that the principal logarithm is continuous.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from fractions import Fraction
from functools import cached_property
from operator import itemgetter
from typing import Final, NamedTuple, final

from flint import acb, ctx
from mpmath import mp, mpc, mpf

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.elliptic import Landen
from taylor_verify.exact.euler.orbit import converted
from taylor_verify.exact.euler.rotations import Course, Rotation, decades
from taylor_verify.exact.frames import Frame as Rows
from taylor_verify.exact.frames import applied, product, transposed, turn
from taylor_verify.exact.gyrostat.azimuth import (
    FRAMES,
    Arithmetic,
    Frame,
    Pole,
    poles,
    rate_at_start,
)
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.exact.gyrostat.point import point_map
from taylor_verify.exact.gyrostat.velocity import momentum_form
from taylor_verify.exact.rotation import cross
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.motion import Quaternion

_MPMATH: Final = Arithmetic(mp.convert, mpc, mp.sqrt)
_GUARD_DIGITS: Final = 15
# Of Carlson's integral, whose balls are wider than the last bit.
_GUARD_BITS: Final = 20


def free_rotation(free: FreeGyrostat, attitude: Quaternion | None) -> Rotation:
    """Return the free motion of a rigid body with wheels, and R where an attitude is given."""

    def course() -> Course:
        return Tumbling(free) if free.outer is None else Turning(free, free.outer)

    return Rotation(free.regime.value, course, lambda *until: _lost_digits(free, *until), attitude)


def _lost_digits(free: FreeGyrostat, longest: Fraction, turned: bool) -> float:
    """The decimal digits lost to the angle turned in a time, and beside a multiple root of the pencil."""
    del turned
    return _GUARD_DIGITS + decades(1 + longest * _pace(free)) + digits_beside_multiple_root(free)


def _pace(free: FreeGyrostat) -> Fraction:
    """A bound of the rates of the motion."""
    rates = (free.omega, free.g, tensors.apply(free.K, free.momentum))
    return sum((abs(c) for v in rates for c in v), Fraction(0))


def digits_beside_multiple_root(free: FreeGyrostat) -> float:
    """Return the decimal digits that two or three nearly equal roots of the pencil cost.

    A pole of phi' may be all but at the double point there, and too few digits put it on that point: two
    precisions would agree, and be wrong by the share of the pole in the angle. Three equal roots are zero:
    near them differences of roots, and of p at a pole, are small beside the square of the rates.
    """
    if not free.discriminant:
        return 0
    g2, g3 = free.invariants
    size = abs(g2) ** 3 + 27 * g3**2
    return decades(size / abs(free.discriminant)) + decades(_pace(free) ** 12 / size) / 6


@final
class Turning:
    """w turns in the body at a constant rate v, and the body about u: a turn by Rot(u t) Rot(-v t)."""

    def __init__(self, free: FreeGyrostat, outer: Vector) -> None:
        self._omega, self._outer, self._inner = map(converted, (free.omega, outer, free.inner))

    def at(self, t: Fraction, turned: bool) -> tuple[list[mpf], Rows]:
        """omega, and the turn since the start."""
        time = mp.convert(t)
        inner = turn(self._inner, mp.norm(self._inner) * time)
        omega = applied(inner, self._omega)
        if not turned:
            return omega, []
        return omega, product(turn(self._outer, mp.norm(self._outer) * time), transposed(inner))


class Place(NamedTuple):
    """p at a time, p', and p less each of the three roots, of which p - e1 is real."""

    p: mpf
    slope: mpf
    above_roots: tuple[mpf | mpc, mpf | mpc, mpf | mpc]


@final
class Swing:
    """p and p' at real times, with numbers of one precision; ``period`` is infinite where p has none."""

    at: Callable[[mpf], Place]
    half: Place
    """The place at half the period, where there is one."""
    least: mpf
    """The least p at a real time, which a motion without a period never reaches."""
    m: mpf | None = None
    m_prime: mpf | None = None

    def __init__(self, free: FreeGyrostat) -> None:
        g2, g3 = (mp.convert(g) for g in free.invariants)
        self.period = mp.inf
        discriminant = mp.convert(free.discriminant)
        if not discriminant:
            self._root = mp.convert(free.double_root)
            self.rate = mp.sqrt(3 * abs(self._root))
            self.least = max(self._root, -2 * self._root)
            if self._root < 0:
                self.period = mp.pi / self.rate
                self.half = Place(-2 * self._root, mpf(0), (mpf(0), self.rate**2, self.rate**2))
            self.at = self._elementary
        elif discriminant > 0:
            self._three_roots(g2, g3, discriminant)
        else:
            self._one_root(g2, g3, discriminant)

    def reduced(self, t: mpf) -> tuple[int, mpf]:
        """n and r of t = n L + r."""
        if self.period == mp.inf:
            return 0, t
        n = int(mp.nint(t / self.period))
        return n, t - n * self.period

    def _three_roots(self, g2: mpf, g3: mpf, discriminant: mpf) -> None:
        """e1 > e2 > e3: the closer two have their distance from the discriminant."""
        size = mp.sqrt(g2 / 12)
        angle = mp.acos(max(min(g3 / (8 * size**3), mpf(1)), mpf(-1))) / 3
        e1, e2, e3 = (2 * size * mp.cos(angle - 2 * mp.pi * k / 3) for k in (0, 1, 2))
        e2, e3 = max(e2, e3), min(e2, e3)
        upper, lower, whole = e1 - e2, e2 - e3, e1 - e3
        if upper < lower:
            upper = mp.sqrt(discriminant) / (4 * lower * whole)
        else:
            lower = mp.sqrt(discriminant) / (4 * upper * whole)
        self._root, self.least, self.rate = e3, e1, mp.sqrt(whole)
        self.m, self.m_prime = lower / whole, upper / whole
        self._chain = Landen(self.m, self.m_prime)
        self.period = 2 * self._chain.quarter_period / self.rate
        self.half = Place(e1, mpf(0), (mpf(0), upper, whole))
        self.at = self._rectangular

    def _rectangular(self, t: mpf) -> Place:
        sn, cn, dn = self._chain.jacobi(self.rate * t)
        ns = self.rate / sn
        above = (ns * cn) ** 2, (ns * dn) ** 2, ns**2
        return Place(self._root + above[2], -2 * ns**3 * cn * dn, above)

    def _one_root(self, g2: mpf, g3: mpf, discriminant: mpf) -> None:
        """Set up one real root e: of the parameters 1/2 -+ 3 e/4 H the smaller comes from their product."""
        grown = mp.sqrt(-discriminant / 27)
        # Of the two cube roots in Cardano's formula the larger one, and the other from their product.
        larger = mp.cbrt((abs(g3) + grown) / 8)
        e = larger + g2 / (12 * larger)
        e = e if g3 >= 0 else -e
        H = mp.sqrt(3 * e * e - g2 / 4)
        bigger = mpf(1) / 2 + abs(3 * e / (4 * H))
        smaller = -discriminant / (256 * H**6 * bigger)
        self.m, self.m_prime = (smaller, bigger) if e >= 0 else (bigger, smaller)
        self._root = self.least = e
        self.rate = mp.sqrt(H)
        self._chain = Landen(self.m, self.m_prime)
        self.period = 2 * self._chain.quarter_period / self.rate
        self._to_pair = mpc(3 * e / 2, 2 * H * mp.sqrt(self.m * self.m_prime))
        self.half = Place(e, mpf(0), (mpf(0), self._to_pair, mp.conj(self._to_pair)))
        self.at = self._rhombic

    def _rhombic(self, t: mpf) -> Place:
        sn, cn, dn = self._chain.jacobi(2 * self.rate * t)
        versed = 1 - cn if cn < 0 else sn**2 / (1 + cn)
        whole = self.rate / versed
        rise = self.rate**2 * (1 + cn) / versed
        above = rise, rise + self._to_pair, rise + mp.conj(self._to_pair)
        return Place(self._root + rise, -4 * whole**2 * self.rate * sn * dn, above)

    def _elementary(self, t: mpf) -> Place:
        """A double root e, whose k^2 = 3 |e|: hyperbolic, trigonometric or rational."""
        e, k = self._root, self.rate
        if e == 0:
            square = 1 / t**2
            return Place(square, -2 / t**3, (square, square, square))
        sine, cosine = (mp.sinh, mp.cosh) if e > 0 else (mp.sin, mp.cos)
        s, c = sine(k * t), cosine(k * t)
        rise = (k / s) ** 2
        # The simple root is -2 e = e - 3 e.
        above = ((k * c / s) ** 2, rise, rise) if e < 0 else (rise, rise, (k * c / s) ** 2)
        return Place(e + rise, -2 * k**3 * c / s**3, above)


@final
class Tumbling:
    """A motion that is no uniform turning, with numbers of one precision."""

    def __init__(self, free: FreeGyrostat) -> None:
        self._free, self._swing = free, Swing(free)
        self._form = momentum_form(free).converted(mp.convert)
        self._K, self._g = [converted(row) for row in free.K], converted(free.g)
        self._omega = converted(free.omega)

    def at(self, t: Fraction, turned: bool) -> tuple[list[mpf], Rows]:
        """omega, and the turn since the start."""
        if t == 0:
            return self._omega, turn(self._omega, mpf(0)) if turned else []
        time = mp.convert(t)
        turns, r = self._swing.reduced(time)
        place = self._swing.at(r)
        G = self._form.at(place.p, place.slope)
        omega = [q - g for q, g in zip(applied(self._K, G), self._g, strict=True)]
        if not turned:
            return omega, []
        cos, sin = mp.cos_sin(self._azimuth.at(time, turns, r, place))
        about_momentum = [[cos, -sin, mpf(0)], [sin, cos, mpf(0)], [mpf(0), mpf(0), mpf(1)]]
        return omega, product(product(self._tilted_back, about_momentum), self._azimuth.tilt(G))

    @cached_property
    def _azimuth(self) -> Azimuth:
        return Azimuth(self._free, self._swing)

    @cached_property
    def _tilted_back(self) -> Rows:
        """M(0)."""
        return transposed(self._azimuth.tilt(converted(self._free.momentum)))


@final
class Azimuth:
    """phi(t) of one frame, and M(t)."""

    def __init__(self, free: FreeGyrostat, swing: Swing) -> None:
        frame, self._poles = _best_poles(free, swing)
        self._c = converted(frame.c)
        self._N = mp.sqrt(mp.convert(free.n))
        self._rate = rate_at_start(free, frame.c, self._N, mp.convert)
        self._half = mpf(0)
        self.per_period = mp.nan
        if swing.period < mp.inf:
            self._half = sum(sigma * v * _integral(swing.half, x) for sigma, x, v in self._poles)
            self.per_period = self._rate * swing.period + mp.im(self._half)

    def at(self, t: mpf, turns: int, r: mpf, place: Place) -> mpf:
        """phi at t = turns L + r, where p is at ``place``."""
        total = 2 * turns * self._half
        for sigma, x, v in self._poles:
            part = v * _integral(place, x)
            total += sigma * (mp.log(place.p - x) + (part if r > 0 else -part))
        return self._rate * t + mp.im(total) / 2

    def tilt(self, G: Sequence[mpf]) -> Rows:
        """M^T: its rows are m1, m2, m3."""
        m3 = [component / self._N for component in G]
        along = mp.fdot(self._c, m3)
        across = [p - along * q for p, q in zip(self._c, m3, strict=True)]
        length = mp.norm(across)
        m1 = [component / length for component in across]
        return [m1, cross(m3, m1), m3]


def _integral(place: Place, x: mpc) -> mpc:
    """int_0^r dt/(p - x) up to the time r > 0 of the place, at most half a period: R_J by Carlson."""
    numbers = map(mp.mpc, (*place.above_roots, place.p - x))
    with ctx.workprec(mp.prec + _GUARD_BITS):
        value = acb.elliptic_rj(*(acb(z.real, z.imag) for z in numbers))
    return mpc(midpoint(value.real), midpoint(value.imag)) / 3


def _best_poles(free: FreeGyrostat, swing: Swing) -> tuple[Frame, list[Pole]]:
    """Return the frame whose poles are farthest from the real times, and those poles."""
    place, choices = point_map(free).converted(mp.convert), []
    for frame in FRAMES:
        with suppress(ZeroDivisionError):
            choice = poles(free, place, frame, _MPMATH)
            # Near the start, where p has its pole, the momentum itself tells the distance.
            distances = (_distance(pole, swing.least) for pole in choice)
            choices.append((min(*distances, _distance_at_start(free, frame)), frame, choice))
    if not choices:
        raise ZeroDivisionError("no frame has its poles at finite places")
    _, frame, best = max(choices, key=itemgetter(0))
    return frame, best


def _distance(pole: Pole, least: mpf) -> mpf:
    """The distance of a pole, roughly, from the real times, at which p is ``least`` or more."""
    return abs(pole.p - max(mp.re(pole.p), least)) / abs(pole.slope)


def _distance_at_start(free: FreeGyrostat, frame: Frame) -> mpf:
    """The time in which the momentum turns as far as it is from the axis c at the start."""
    away, G1 = tensors.cross(frame.c, free.momentum), free.jet[1]
    return mp.sqrt(mp.convert(tensors.dot(away, away) / tensors.dot(G1, G1)))
