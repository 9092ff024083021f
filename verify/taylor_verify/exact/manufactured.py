"""A manufactured motion evaluated: the truth of omega, or of x and y, under loads that change with time.

z*(t) = constant + sum of cosine cos(nu t) + sine sin(nu t), t since the start: see scenes.manufactured. It
is the motion only from its own start; from any other state, as the condition of the orbit asks, the same
loads lead elsewhere, and exact.taylor follows them. Two routes, which share no function: the cosines and
sines are Arb's, in balls, or mpmath's.

The frame has no closed form here. Its equation R' = R [omega*]x is solved by quadratures where omega*
keeps its direction, and only there: whoever tracks the attitude is led to exact.taylor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final, final

import numpy as np
from flint import arb_mat
from mpmath import mp, mpf

from taylor_verify.exact.balls import Enclosed, Enclosure, balls
from taylor_verify.exact.clocks import balls_at, swing
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.solution import NoClosedForm, Quantities, Settled
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.scene import Scene

REGIME: Final = "manufactured"
# What the elements of an orbit are told by instead.
MANUFACTURED: Final = (
    "A manufactured motion: a trigonometric polynomial, exact for this body under the loads that it takes.",
    "Not conserved: the loads change with time, and do work on everything.",
)

_GUARD_DIGITS: Final = 6


def enclosed(scene: Scene) -> EnclosedPolynomial:
    """The motion in balls; raises NoClosedForm for another start and for attitude or centre."""
    return EnclosedPolynomial(scene, _motion(scene))


def closed_form(scene: Scene) -> SettledPolynomial:
    """The motion in mpmath; raises NoClosedForm likewise."""
    return SettledPolynomial(scene, _motion(scene))


def _motion(scene: Scene) -> Manufactured:
    motion = scene.body.manufactured
    if motion is None:
        raise NoClosedForm("the scene has no manufactured motion")
    if scene.track:
        raise NoClosedForm("the frame of a manufactured motion has no closed form")
    if kind_of(scene.body).state(scene.initial) != motion.start:
        raise NoClosedForm("the start is not that of the manufactured motion")
    return motion


@final
@dataclass(frozen=True)
class EnclosedPolynomial(Enclosed):
    """A manufactured motion in balls: cosines and sines by Arb."""

    scene: Scene
    polynomial: Manufactured

    regime = REGIME

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        del bits  # set already
        coefficients = arb_mat([balls(row) for row in swing(self.polynomial)[0]])
        clocks = ([[c] for c in balls_at(self.polynomial, t)] for t in elapsed)
        return _parts(self.scene, [(coefficients * arb_mat(w)).entries() for w in clocks])


@final
@dataclass(frozen=True)
class SettledPolynomial(Settled):
    """A manufactured motion in mpmath."""

    scene: Scene
    polynomial: Manufactured

    route = "mpmath"
    regime = REGIME

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        largest = self.polynomial.highest * max(map(abs, elapsed), default=Fraction(0))
        # The digits of an angle before its point are lost to the ones behind it.
        with mp.workdps(digits + _GUARD_DIGITS + len(str(int(largest)))):
            parts = _parts(self.scene, [self._row(t) for t in elapsed])
        with mp.workdps(digits):
            return {
                name: +np.array(part, dtype=object).reshape(-1, 3) for name, part in parts.items()
            }

    def _row(self, t: Fraction) -> list[mpf]:
        row = [mp.convert(z) for z in self.polynomial.constant]
        for wave in self.polynomial.waves:
            c, s = mp.cos_sin(mp.convert(wave.frequency * t))
            pairs = zip(row, wave.cosine, wave.sine, strict=True)
            row = [z + mp.convert(a) * c + mp.convert(b) * s for z, a, b in pairs]
        return row


def _parts(scene: Scene, rows: Sequence[Sequence[Any]]) -> dict[str, list[Sequence[Any]]]:
    """The rows by the names of what they hold."""
    names = kind_of(scene.body).moving
    return {name: [row[3 * k : 3 * k + 3] for row in rows] for k, name in enumerate(names)}
