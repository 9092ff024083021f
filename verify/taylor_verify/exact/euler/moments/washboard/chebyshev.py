"""The bead on the washboard in mpmath: the time as Chebyshev series in an angle, and its inverse.

Legend as in board; e_1 and e_2 are the lower and the upper end, and G(e, w) = (F(e + w) - F(e))/w. It
shares with the balls which ends there are, and no integral, no variable and no formula for F. In a swing
put sigma = e_1 + 2h sin^2(psi/2), 2h = e_2 - e_1. Then psi grows for ever, and with what is left of F,

    F = h^2 sin^2 psi W,    t = int dpsi/W^(1/2),    nu = h sin psi W^(1/2),

W = G(e_1, sigma - e_1)/(e_2 - sigma) on the lower half and -G(e_2, sigma - e_2)/(sigma - e_1) on the
upper one: neither quotient is of two small numbers. In a run sigma = e_1 + y^2, t = int 2 dy/G^(1/2), and
nu = y G^(1/2). Both integrands are even. With one amplitude and one angle, or in exponentials,

    kappa < 0:  F = a + slope sigma - r cos(2 Omega sigma - chi),
                G = slope + 2 Omega r sin(2 Omega e - chi + Omega w) sin(Omega w)/(Omega w),
    kappa > 0:  F = a + slope sigma - p e^(2 Omega sigma) - q e^(-2 Omega sigma),
                G = slope - 2 Omega (p e^(2 Omega e) E(2 Omega w) - q e^(-2 Omega e) E(-2 Omega w)),

E(x) = (e^x - 1)/x.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from fractions import Fraction
from functools import cached_property
from typing import Final, final

from mpmath import mp, mpf

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.euler.fixed_axis import FixedAxis, FixedAxisFloats
from taylor_verify.exact.euler.moments.washboard.board import Washboard
from taylor_verify.exact.euler.moments.washboard.panels import Panels
from taylor_verify.exact.euler.moments.washboard.turnings import Turnings, located, regime
from taylor_verify.exact.euler.moments.washboard.zeta import ZetaTeeth
from taylor_verify.exact.euler.orbit import converted
from taylor_verify.exact.euler.rotations import Rotation, decades
from taylor_verify.exact.frames import Frame
from taylor_verify.scenes.motion import Quaternion
from taylor_verify.scenes.precision import exact_value, floor_log2

_OWN_GUARD_DIGITS: Final = 14
_POLISHINGS: Final = 40
_SPARE_BITS: Final = 8
# After so many teeth from the turn the others are summed all at once.
_FIRST_TEETH: Final = 4


def motion(board: Washboard, attitude: Quaternion | None = None) -> Rotation:
    """The motion of a triaxial body under a moment, and R from a start where omega keeps its axis."""
    kind = regime(board).value
    if board.keeps_axis:
        axis = FixedAxis(board.omega, board.gain)
        return Rotation(kind, lambda: FixedAxisFloats(axis), axis.lost, attitude)
    ends = located(board)

    def lost(longest: Fraction, turned: bool) -> float:
        return _OWN_GUARD_DIGITS + _phase_digits(board, ends, longest)

    return Rotation(kind, lambda: course(board, ends), lost, by_quadrature=True)


def _phase_digits(board: Washboard, ends: Turnings, longest: Fraction) -> float:
    """The decimal digits before the point of the phase Omega sigma at the turn or in this time."""
    turn = exact_value(midpoint(ends.lower))
    furthest = (abs(board.nu) + abs(board.slope) * longest) * longest + abs(turn)
    return decades(1 + abs(board.kappa) * furthest**2) / 2


class Wave(ABC):
    """F and v, at the precision of mpmath at which this was made."""

    def __init__(self, board: Washboard) -> None:
        self.slope, self._even, self._odd = (
            mp.convert(entry) for entry in (board.slope, board.even, board.odd)
        )
        self.rate = mp.sqrt(mp.convert(abs(board.kappa)))
        self._level = mp.convert(board.nu) ** 2 + self._even
        self._across = converted(board.across)
        self._ahead = [entry / self.rate for entry in converted(board.ahead)]

    @abstractmethod
    def squared(self, sigma: mpf) -> mpf:
        """F."""

    @abstractmethod
    def quotient(self, end: mpf, w: mpf) -> mpf:
        """G."""

    @abstractmethod
    def across(self, sigma: mpf) -> list[mpf]:
        """v in body axes."""

    def polished(self, end: mpf) -> mpf:
        """The root of F next to this one, which is known to forty digits or so."""
        for _ in range(_POLISHINGS):
            step = self.squared(end) / self.quotient(end, mpf(0))
            end -= step
            if abs(step) <= 8 * mp.eps * (abs(end) + 1 / self.rate):
                break
        return end


@final
class _Cosine(Wave):
    """kappa < 0."""

    def __init__(self, board: Washboard) -> None:
        super().__init__(board)
        odd = self._odd / (2 * self.rate)
        self._size, self._turn = mp.hypot(self._even, odd), mp.atan2(odd, self._even)

    def squared(self, sigma: mpf) -> mpf:
        swing = self._size * mp.cos(2 * self.rate * sigma - self._turn)
        return self._level + self.slope * sigma - swing

    def quotient(self, end: mpf, w: mpf) -> mpf:
        x = self.rate * w
        angle = 2 * self.rate * end - self._turn
        return self.slope + 2 * self.rate * self._size * mp.sin(angle + x) * mp.sinc(x)

    def across(self, sigma: mpf) -> list[mpf]:
        cos, sin = mp.cos_sin(self.rate * sigma)
        return [cos * v + sin * u for v, u in zip(self._across, self._ahead, strict=True)]


@final
class _Exponential(Wave):
    """kappa > 0."""

    def __init__(self, board: Washboard) -> None:
        super().__init__(board)
        half = self._odd / (4 * self.rate)
        self._p = mpf(0) if board.never_climbs else self._even / 2 + half
        self._q = self._even / 2 - half
        both = list(zip(self._across, self._ahead, strict=True))
        self._up = [mpf(0) if board.never_climbs else (v + u) / 2 for v, u in both]
        self._down = [(v - u) / 2 for v, u in both]

    def squared(self, sigma: mpf) -> mpf:
        grown = mp.exp(2 * self.rate * sigma)
        return self._level + self.slope * sigma - self._p * grown - self._q / grown

    def quotient(self, end: mpf, w: mpf) -> mpf:
        grown, x = mp.exp(2 * self.rate * end), 2 * self.rate * w
        up, down = self._p * grown * _mean_growth(x), self._q / grown * _mean_growth(-x)
        return self.slope - 2 * self.rate * (up - down)

    def across(self, sigma: mpf) -> list[mpf]:
        grown = mp.exp(self.rate * sigma)
        return [u * grown + d / grown for u, d in zip(self._up, self._down, strict=True)]


def _mean_growth(x: mpf) -> mpf:
    """E."""
    return mp.expm1(x) / x if x else mpf(1)


class Course(ABC):
    """The course at one precision of mpmath."""

    _lead: mpf

    def __init__(self, board: Washboard, wave: Wave) -> None:
        self.wave, self._moment = wave, converted(board.moment)

    def at(self, t: Fraction, turned: bool) -> tuple[list[mpf], Frame]:
        """omega in body axes; of the turn nothing is known."""
        sigma, nu = self._swept(self._lead + mp.convert(t))
        parts = zip(self.wave.across(sigma), self._moment, strict=True)
        return [v + nu * m for v, m in parts], []

    @abstractmethod
    def _swept(self, since: mpf) -> tuple[mpf, mpf]:
        """sigma and nu at this time since the turn at the lower end."""


@final
class Swing(Course):
    """The motion between two ends."""

    def __init__(self, board: Washboard, wave: Wave, lower: mpf, upper: mpf) -> None:
        super().__init__(board, wave)
        self._lower, self._upper, self._whole = lower, upper, upper - lower
        self._angles = Panels(lambda psi: 1 / self._root(psi), mpf(1), +mp.pi)
        self._half = self._angles.at(+mp.pi)
        start = 2 * mp.atan2(mp.sqrt(abs(lower)), mp.sqrt(abs(upper)))
        since = self._angles.at(start)
        self._lead = since if board.nu >= 0 else -since

    @property
    def period(self) -> mpf:
        return 2 * self._half

    def _swept(self, since: mpf) -> tuple[mpf, mpf]:
        t = since - self.period * mp.nint(since / self.period)
        psi = self._angles.inverse(abs(t))
        nu = self._whole / 2 * mp.sin(psi) * self._root(psi)
        return self._lower + self._whole * mp.sin(psi / 2) ** 2, nu if t >= 0 else -nu

    def _root(self, psi: mpf) -> mpf:
        """W^(1/2)."""
        cos, sin = mp.cos_sin(psi / 2)
        below, above = self._whole * sin**2, self._whole * cos**2
        if below <= above:
            return mp.sqrt(self.wave.quotient(self._lower, below) / above)
        return mp.sqrt(-self.wave.quotient(self._upper, -above) / below)


@final
class Run(Course):
    """The motion down to one end and up for ever; ``wave`` and ``lower`` have so many ``spare_bits``."""

    def __init__(self, board: Washboard, wave: Wave, lower: mpf, spare_bits: int) -> None:
        super().__init__(board, wave)
        self._lower, self._spare_bits = lower, spare_bits
        self._places = Panels(lambda y: 2 / self._root(y), 1 / mp.sqrt(wave.rate))
        self._teeth: ZetaTeeth | None = None
        if isinstance(wave, _Cosine):
            width = mp.pi / wave.rate
            first = lower + _FIRST_TEETH * width
            self._teeth = ZetaTeeth(self._squared, first, width, wave.slope)
        since = self._time(mpf(0))
        self._lead = since if board.nu >= 0 else -since

    @cached_property
    def _first(self) -> mpf:
        """The time from the turn to where the teeth are summed all at once."""
        assert self._teeth is not None
        return self._places.at(mp.sqrt(self._teeth.start - self._lower))

    def _time(self, sigma: mpf) -> mpf:
        """The time from the turn to a place."""
        if self._teeth is None or sigma <= self._teeth.start:
            return self._places.at(mp.sqrt(abs(sigma - self._lower)))
        return self._first + self._teeth.time(sigma)

    def _swept(self, since: mpf) -> tuple[mpf, mpf]:
        t = abs(since)
        if self._teeth is not None and t > self._first:
            sigma, nu = self._teeth.place(t - self._first)
        else:
            y = self._places.inverse(t)
            sigma, nu = self._lower + y * y, y * self._root(y)
        return sigma, nu if since >= 0 else -nu

    def _root(self, y: mpf) -> mpf:
        """G^(1/2)."""
        with mp.extraprec(self._spare_bits):
            quotient = self.wave.quotient(self._lower, y * y)
        return mp.sqrt(quotient)

    def _squared(self, start: mpf, x: mpf) -> mpf:
        """F at start + x."""
        with mp.extraprec(self._spare_bits):
            squared = self.wave.squared(start + x)
        return +squared


def course(board: Washboard, ends: Turnings) -> Swing | Run:
    """The motion between these ends, at the ambient precision of mpmath."""
    spare_bits = _spare_bits(board, ends) if ends.upper is None and board.kappa < 0 else 0
    with mp.extraprec(spare_bits):
        wave = _Cosine(board) if board.kappa < 0 else _Exponential(board)
        lower = _end(wave, board, midpoint(ends.lower))
    if ends.upper is None:
        return Run(board, wave, lower, spare_bits)
    return Swing(board, wave, lower, _end(wave, board, midpoint(ends.upper)))


def _spare_bits(board: Washboard, ends: Turnings) -> int:
    """The bits that F loses on the crests, where its terms are large and it is as small as its growth."""
    turn = abs(exact_value(midpoint(ends.lower)))
    terms = board.nu**2 + board.slope * turn + abs(board.even) + abs(board.odd)
    phase = abs(board.kappa) * turn**2
    rise = board.slope**2 / abs(board.kappa)
    lost = floor_log2(1 + phase) + floor_log2(1 + terms**2 / rise)
    return lost // 2 + _SPARE_BITS


def _end(wave: Wave, board: Washboard, near: mpf) -> mpf:
    """An end of the interval; where the motion begins there, exactly the start."""
    return wave.polished(near) if near or board.nu else mpf(0)
