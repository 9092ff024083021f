"""Clebsch's body in closed form: impulses, attitude and path at any time, to any precision."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.frames import Frame, applied, product, start_frame, turn
from taylor_verify.exact.kirchhoff.centre import SpaceAxes
from taylor_verify.exact.kirchhoff.degenerate import ElementaryOrbit, Front
from taylor_verify.exact.kirchhoff.orbit import Axial, Orbit, transverse
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.regime import nutation_of, regime
from taylor_verify.exact.solution import Quantities, Settled, Solution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.precision import floor_log2
from taylor_verify.scenes.scene import Scene

_GUARD_DIGITS = 12
_ROUGH_DIGITS = 20
_AXIS = (0, 0, 1)
_ORBITS: Final[Mapping[str, type[ElementaryOrbit] | type[Front]]] = {
    "hyperbolic": ElementaryOrbit,
    "trigonometric": ElementaryOrbit,
    "algebraic": ElementaryOrbit,
    "heteroclinic": Front,
}


def closed_form(scene: Scene) -> Solution:
    """The closed form of a scene with Clebsch's energy and no loads.

    Raises NoClosedForm, with the reason, for every other scene.
    """
    nutation, start = nutation_of(scene)
    kind = regime(nutation)
    if kind in ("rest", "steady", "euler-top"):
        return Screw(kind, nutation, start, scene.track)
    return NutatingBody(kind, nutation, start, scene.track)


@final
class Screw(Settled):
    """Rest, steady motion and Euler's top: x3 is constant, and x and y turn about axis 3 together.

    Seen from axes that turn with them, at the rate tau, the body's U and its Omega do not change:

        R = R0 Rot(nu t) Rz(-tau t),    centre = c0 + R0 int Rot(nu t) U0 dt,    nu = Omega0 + tau e3,

    all in rationals but for |nu|.
    """

    route = "mpmath"

    def __init__(
        self, kind: str, nutation: Nutation, start: Impulse, track: frozenset[str] = frozenset()
    ) -> None:
        self.regime = kind
        self._start = start
        self._track = track
        self._turn_rate = nutation.turn_rate
        energy = nutation.body.body().energy_matrix
        velocities = tensors.apply(energy, start.linear + start.angular)
        self._U, Omega = velocities[:3], velocities[3:]
        self._nu = (*Omega[:2], Omega[2] + self._turn_rate)

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        longest = max((abs(t) for t in elapsed), default=Fraction(0))
        rates = abs(self._turn_rate) + sum(abs(rate) for rate in self._nu)
        with mp.workdps(digits + _GUARD_DIGITS + len(str(int(rates * longest)))):
            turns = [mp.expj(mp.convert(self._turn_rate * t)) for t in elapsed]
            x, y = self._start.linear, self._start.angular
            found = _quantities(
                [(turn * transverse(x), mp.convert(x[2])) for turn in turns],
                [(turn * transverse(y), mp.convert(y[2])) for turn in turns],
            )
            return found | self._space(elapsed) if self._track else found

    def _space(self, elapsed: Sequence[Fraction]) -> dict[str, np.ndarray[Any, Any]]:
        """The attitude, and the centre if it is tracked, at the ambient precision."""
        nu = [mp.convert(rate) for rate in self._nu]
        rate = mp.sqrt(mp.convert(tensors.dot(self._nu, self._nu)))
        first = start_frame(self._start.attitude)
        frames: list[Frame] = []
        centres: list[list[mpf]] = []
        for t in elapsed:
            about_impulse = product(first, turn(nu, rate * mp.convert(t)))
            about_axis = turn(_AXIS, -mp.convert(self._turn_rate * t))
            frames.append(product(about_impulse, about_axis))
            moved = applied(first, self._moved(t, rate))
            centres.append(
                [mp.convert(c) + m for c, m in zip(self._start.centre, moved, strict=True)]
            )
        return _tracked(self._track, frames, centres)

    def _moved(self, t: Fraction, rate: mpf) -> list[mpf]:
        """int_0^t Rot(nu t) U0 dt: U0 along nu, and U0 across it on a circle."""
        if rate == 0:
            return [mp.convert(t * u) for u in self._U]
        share = tensors.dot(self._nu, self._U) / tensors.dot(self._nu, self._nu)
        along = tensors.scaled(share, self._nu)
        across = tensors.plus(self._U, tensors.scaled(Fraction(-1), along))
        aside = tensors.cross(self._nu, across)
        half = mp.convert(t) * rate / 2
        sine, versed = mp.sin(2 * half) / rate, 2 * (mp.sin(half) / rate) ** 2
        return [
            mp.convert(t * along[i]) + sine * mp.convert(across[i]) + versed * mp.convert(aside[i])
            for i in range(3)
        ]


@final
class NutatingBody(Settled):
    """x3 varies: it swings between two roots of f, or falls away from one and returns to it."""

    route = "mpmath"

    def __init__(
        self, kind: str, nutation: Nutation, start: Impulse, track: frozenset[str] = frozenset()
    ) -> None:
        self.regime = kind
        self._nutation = nutation
        self._start = start
        self._track = track
        self._make = _ORBITS.get(kind, Orbit)
        self._orbits: dict[int, Orbit | ElementaryOrbit | Front] = {}
        self._axes: dict[int, SpaceAxes] = {}

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        longest = max((abs(t) for t in elapsed), default=Fraction(0))
        with mp.workdps(_ROUGH_DIGITS):
            lost = self._orbit(_ROUGH_DIGITS).lost_digits(mp.convert(longest))
        if "centre" in self._track:
            lost += self._short_digits(elapsed)
        working = digits + _GUARD_DIGITS + lost
        with mp.workdps(working):
            orbit = self._orbit(working)
            poses = [orbit.pose(mp.convert(t)) for t in elapsed]
            found = _quantities([pose.x for pose in poses], [pose.y for pose in poses])
            if not self._track:
                return found
            axes = self._space_axes(working)
            frames = [axes.attitude(pose.turned) for pose in poses]
            centres = [axes.centre(pose.moment, pose.rise) for pose in poses]
            return found | _tracked(self._track, frames, centres)

    def period(self, digits: int) -> mpf:
        """The period of nutation, to about ``digits`` digits; infinite where x3 does not recur."""
        with mp.workdps(digits + _GUARD_DIGITS):
            return self._orbit(digits + _GUARD_DIGITS).period

    def elements(self, digits: int) -> dict[str, mpf]:
        """The period of nutation where x3 recurs; for elliptic motion also rate, m and m_prime."""
        with mp.workdps(digits + _GUARD_DIGITS):
            orbit = self._orbit(digits + _GUARD_DIGITS)
            found = {"period": orbit.period} if orbit.period < mp.inf else {}
            return found | (orbit.moduli if isinstance(orbit, Orbit) else {})

    def _orbit(self, digits: int) -> Orbit | ElementaryOrbit | Front:
        """The orbit at the working precision of ``digits``, made once."""
        if digits not in self._orbits:
            self._orbits[digits] = self._make(self._nutation, self._start, digits)
        return self._orbits[digits]

    def _space_axes(self, digits: int) -> SpaceAxes:
        """The scene's space axes, likewise."""
        if digits not in self._axes:
            first = self._orbit(digits).pose(mpf(0))
            self._axes[digits] = SpaceAxes(self._start, first.turned, first.moment)
        return self._axes[digits]

    def _short_digits(self, elapsed: Sequence[Fraction]) -> int:
        """The digits by which |y|/F, whose change is the way across F, exceeds the centre itself."""
        start, body = self._start, self._nutation.body.body()
        shortest = min((abs(t) for t in elapsed if t != 0), default=Fraction(1))
        U = tensors.apply(body.energy_matrix, start.linear + start.angular)[:3]
        reached = tensors.dot(start.centre, start.centre) + tensors.dot(U, U) * shortest**2
        lever = tensors.dot(start.angular, start.angular) / self._nutation.F2
        if not 0 < reached < lever:
            return 0
        return math.ceil(floor_log2(lever / reached) * math.log10(2) / 2)


def _quantities(x: Sequence[Axial], y: Sequence[Axial]) -> dict[str, np.ndarray[Any, Any]]:
    return {"linear_impulse": _rows(x), "angular_impulse": _rows(y)}


def _tracked(
    track: frozenset[str], frames: Sequence[Frame], centres: Sequence[Sequence[mpf]]
) -> dict[str, np.ndarray[Any, Any]]:
    """The attitude (n, 3, 3) and the centre (n, 3), as far as they are tracked."""
    shape = (len(frames), 3, 3)
    found = {"attitude": np.array(frames, dtype=object).reshape(shape)}
    if "centre" in track:
        found["centre"] = np.array(centres, dtype=object).reshape(shape[:2])
    return found


def _rows(vectors: Sequence[Axial]) -> np.ndarray[Any, Any]:
    rows = np.empty((len(vectors), 3), dtype=object)
    for row, (across, along) in zip(rows, vectors, strict=True):
        row[:] = across.real, across.imag, along
    return rows
