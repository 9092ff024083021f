"""Clebsch's body where x3 swings between simple roots of f: impulses, attitude and path, in mpmath."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final, final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.frames import Frame
from taylor_verify.exact.kirchhoff.orbit import EllipticOrbit
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.solid import short_digits, velocities
from taylor_verify.exact.kirchhoff.space import Axial
from taylor_verify.exact.solution import Quantities, Settled, Time, longest
from taylor_verify.scenes.motion import Impulse

_GUARD_DIGITS: Final = 12
_ROUGH_DIGITS: Final = 20


@final
@dataclass(eq=False)
class NutatingBody(Settled):
    """x3 swings between two simple roots of f."""

    route = "mpmath"
    regime: str
    nutation: Nutation
    start: Impulse
    track: frozenset[str] = frozenset()
    _orbits: dict[int, EllipticOrbit] = field(default_factory=dict, init=False)

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

    def _orbit(self) -> EllipticOrbit:
        """The orbit at the ambient precision, made once."""
        if mp.dps not in self._orbits:
            self._orbits[mp.dps] = EllipticOrbit(self.nutation, self.start)
        return self._orbits[mp.dps]


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
