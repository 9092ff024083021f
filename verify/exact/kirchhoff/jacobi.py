"""Clebsch's body in closed form: its impulses at any time, to any precision."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, final

import numpy as np
from mpmath import mp, mpf

from verify.exact.kirchhoff.degenerate import ElementaryOrbit, Front
from verify.exact.kirchhoff.orbit import Axial, Orbit, transverse
from verify.exact.kirchhoff.quartic import Nutation
from verify.exact.kirchhoff.regime import regime
from verify.exact.solution import NoClosedForm, Quantities, Settled, Solution
from verify.scenes.bodies import ImmersedBody
from verify.scenes.motion import Impulse
from verify.scenes.scene import Scene

_GUARD_DIGITS = 12
_ROUGH_DIGITS = 20
_ORBITS: Final[Mapping[str, type[ElementaryOrbit] | type[Front]]] = {
    "hyperbolic": ElementaryOrbit,
    "trigonometric": ElementaryOrbit,
    "algebraic": ElementaryOrbit,
    "heteroclinic": Front,
}


def closed_form(scene: Scene) -> Solution:
    """The closed form of a scene with Clebsch's energy, no loads, and only the impulses tracked.

    Raises NoClosedForm, with the reason, for every other scene.
    """
    body, start = scene.body, scene.initial
    assert isinstance(body, ImmersedBody)
    assert isinstance(start, Impulse)
    if body.clebsch is None:
        raise NoClosedForm("the energy is not of Clebsch's form about axis 3")
    if not body.is_free:
        raise NoClosedForm("a force or a couple acts on the body")
    if scene.track & {"attitude", "centre"}:
        raise NoClosedForm("the attitude and the centre of Clebsch's body are not built")
    nutation = Nutation.of(body.clebsch, start)
    kind = regime(nutation)
    if kind in ("rest", "steady", "euler-top"):
        return Precession(kind, nutation, start)
    return NutatingBody(kind, nutation, start)


@final
class Precession(Settled):
    """Rest, steady motion and Euler's top: x3 is constant, and x and y turn about axis 3 together."""

    route = "mpmath"

    def __init__(self, kind: str, nutation: Nutation, start: Impulse) -> None:
        self.regime = kind
        self._start = start
        self._turn_rate = nutation.turn_rate

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        angles = [self._turn_rate * t for t in elapsed]
        largest = max((abs(angle) for angle in angles), default=Fraction(0))
        with mp.workdps(digits + _GUARD_DIGITS + len(str(int(largest)))):
            turns = [mp.expj(mp.convert(angle)) for angle in angles]
            x, y = self._start.linear, self._start.angular
            return _quantities(
                [(turn * transverse(x), mp.convert(x[2])) for turn in turns],
                [(turn * transverse(y), mp.convert(y[2])) for turn in turns],
            )


@final
class NutatingBody(Settled):
    """x3 varies: it swings between two roots of f, or falls away from one and returns to it."""

    route = "mpmath"

    def __init__(self, kind: str, nutation: Nutation, start: Impulse) -> None:
        self.regime = kind
        self._nutation = nutation
        self._start = start
        self._make = _ORBITS.get(kind, Orbit)
        self._orbits: dict[int, Orbit | ElementaryOrbit | Front] = {}

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        longest = max((abs(t) for t in elapsed), default=Fraction(0))
        with mp.workdps(_ROUGH_DIGITS):
            lost = self._orbit(_ROUGH_DIGITS).lost_digits(mp.convert(longest))
        working = digits + _GUARD_DIGITS + lost
        with mp.workdps(working):
            orbit = self._orbit(working)
            states = [orbit.state(mp.convert(t)) for t in elapsed]
            return _quantities([x for x, _ in states], [y for _, y in states])

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


def _quantities(x: Sequence[Axial], y: Sequence[Axial]) -> Quantities:
    return {"linear_impulse": _rows(x), "angular_impulse": _rows(y)}


def _rows(vectors: Sequence[Axial]) -> np.ndarray[Any, Any]:
    rows = np.empty((len(vectors), 3), dtype=object)
    for row, (across, along) in zip(rows, vectors, strict=True):
        row[:] = across.real, across.imag, along
    return rows
