"""Clebsch's body in closed form: impulses, attitude and path at any time, to any precision."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Final, final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.frames import Frame, applied, product, start_frame, transposed, turn
from taylor_verify.exact.kirchhoff.degenerate import ElementaryOrbit, Front
from taylor_verify.exact.kirchhoff.orbit import EllipticOrbit, Orbit
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.solid import short_digits, velocities
from taylor_verify.exact.kirchhoff.space import Axial
from taylor_verify.exact.kirchhoff.turning import Turning
from taylor_verify.exact.solution import Quantities, Settled, Time, beside, longest
from taylor_verify.numbers import tensors
from taylor_verify.scenes.motion import Impulse

_GUARD_DIGITS: Final = 12
_ROUGH_DIGITS: Final = 20
_ORBITS: Final[Mapping[str, type[ElementaryOrbit | Front]]] = {
    "hyperbolic": ElementaryOrbit,
    "trigonometric": ElementaryOrbit,
    "algebraic": ElementaryOrbit,
    "heteroclinic": Front,
}


@final
class Screw(Settled):
    """Motions in which x and y turn about a body axis n together, or stay as they are.

        R = R0 Rot(a t) Rot(-tau n t),    centre = c0 + R0 int Rot(a t) U0 dt,    a = Omega0 + tau n,

    all in rationals but for |a| and |n|.
    """

    route = "mpmath"

    def __init__(self, turning: Turning) -> None:
        self.regime = turning.kind
        self._turning, self._start = turning, turning.start

    def evaluate(self, elapsed: Sequence[Time], digits: int) -> Quantities:
        length = sum(map(abs, self._turning.n))
        rates = abs(self._turning.tau) * length + sum(abs(rate) for rate in self._turning.a)
        with mp.workdps(digits + _GUARD_DIGITS + len(str(int(rates * longest(elapsed))))):
            axis = [mp.convert(entry) for entry in self._turning.n]
            size = mp.norm(axis)
            turns = [turn(axis, size * _times(self._turning.tau, t)) for t in elapsed]
            x, y = (
                [applied(forward, [mp.convert(entry) for entry in v]) for forward in turns]
                for v in (self._start.linear, self._start.angular)
            )
            places = self._places(elapsed, turns) if self._turning.track else []
            return _quantities(x, y, places, self._turning.track)

    def _places(
        self, elapsed: Sequence[Time], turns: Sequence[Frame]
    ) -> list[tuple[Frame, list[mpf]]]:
        """The attitude and the centre at every time."""
        nu, centre = (
            [mp.convert(c) for c in vector] for vector in (self._turning.a, self._start.centre)
        )
        rate = mp.sqrt(mp.convert(tensors.dot(self._turning.a, self._turning.a)))
        first = start_frame(self._start.attitude)
        places = []
        for t, forward in zip(elapsed, turns, strict=True):
            about_impulse = product(first, turn(nu, rate * mp.convert(t)))
            moved = zip(centre, applied(first, self._moved(t, rate)), strict=True)
            places.append((product(about_impulse, transposed(forward)), [c + m for c, m in moved]))
        return places

    def _moved(self, t: Time, rate: mpf) -> list[mpf]:
        """int_0^t Rot(nu t) U0 dt: U0 along nu, and U0 across it on a circle."""
        if rate == 0:
            return [_times(u, t) for u in self._turning.U]
        share = tensors.dot(self._turning.a, self._turning.U) / tensors.dot(
            self._turning.a, self._turning.a
        )
        along = tensors.scaled(share, self._turning.a)
        across = tensors.plus(self._turning.U, tensors.scaled(Fraction(-1), along))
        aside = tensors.cross(self._turning.a, across)
        half = mp.convert(t) * rate / 2
        sine, versed = mp.sin(2 * half) / rate, 2 * (mp.sin(half) / rate) ** 2
        return [
            _times(along[i], t) + sine * mp.convert(across[i]) + versed * mp.convert(aside[i])
            for i in range(3)
        ]


@final
@dataclass(eq=False)
class NutatingBody(Settled):
    """x3 varies: it swings between two roots of f, or falls away from one and returns to it."""

    route = "mpmath"
    regime: str
    nutation: Nutation
    start: Impulse
    track: frozenset[str] = frozenset()
    _orbits: dict[int, Orbit] = field(default_factory=dict, init=False)

    def evaluate(self, elapsed: Sequence[Time], digits: int) -> Quantities:
        with mp.workdps(_ROUGH_DIGITS):
            losses = self._orbit().losses(mp.convert(longest(elapsed)))
            lost = sum(max(0, int(mp.ceil(mp.log10(loss)))) for loss in losses)
        if "centre" in self.track:
            U, _ = velocities(self.nutation.body.body(), self.start)
            lost += short_digits(U, self.start, elapsed)
        with mp.workdps(digits + _GUARD_DIGITS + lost):
            orbit = self._orbit()
            poses = [orbit.pose(mp.convert(t)) for t in elapsed]
            places = [orbit.axes.place(pose) for pose in poses] if self.track else []
            x, y = [_entries(pose.x) for pose in poses], [_entries(pose.y) for pose in poses]
            return _quantities(x, y, places, self.track)

    def elements(self, digits: int) -> dict[str, mpf]:
        """The elements of the orbit, to about ``digits`` digits."""
        with mp.workdps(digits + _GUARD_DIGITS):
            return self._orbit().elements

    def _orbit(self) -> Orbit:
        """The orbit at the ambient precision, made once."""
        if mp.dps not in self._orbits:
            make = _ORBITS.get(self.regime, EllipticOrbit)
            self._orbits[mp.dps] = make(self.nutation, self.start)
        return self._orbits[mp.dps]


def _times(rate: Fraction, t: Time) -> mpf:
    """The product of a rational and a time."""
    return mp.convert(beside(t, mp.convert)(rate) * t)


def _entries(vector: Axial) -> list[mpf]:
    across, along = vector
    return [across.real, across.imag, along]


def _quantities(
    x: Sequence[Sequence[mpf]],
    y: Sequence[Sequence[mpf]],
    places: Sequence[tuple[Frame, list[mpf]]],
    track: frozenset[str],
) -> Quantities:
    """x and y (n, 3), and as far as they are tracked the attitude (n, 3, 3) and the centre (n, 3)."""
    shapes: dict[str, tuple[list[Any], tuple[int, ...]]] = {
        "linear_impulse": (list(x), (-1, 3)),
        "angular_impulse": (list(y), (-1, 3)),
        "attitude": ([frame for frame, _ in places], (-1, 3, 3)),
        "centre": ([centre for _, centre in places], (-1, 3)),
    }
    names = ("linear_impulse", "angular_impulse", *sorted(track))
    return {
        name: np.array(shapes[name][0], dtype=object).reshape(shapes[name][1]) for name in names
    }
