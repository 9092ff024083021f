"""A manufactured motion evaluated: the truth of omega, or of x and y, under loads that change with time.

z*(t) = constant + sum of cosine cos(nu t) + sine sin(nu t), t since the start: see scenes.manufactured. It
is the motion only from its own start; from any other state, as the condition of the orbit asks, the same
loads lead elsewhere, and exact.taylor follows them.

Two routes, which share no function: Arb's cosine and sine of each angle, in balls; and e^(i nu t) by the
exponential series of a small part of the angle, doubled as often as it was halved.

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
from mpmath import libmp, mp, mpf

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

# Every doubling of an angle doubles the error, in one more bit; and some for the sums.
_GUARD_BITS: Final = 20


def enclosed(scene: Scene) -> EnclosedPolynomial:
    """The motion in balls; raises NoClosedForm for another start and for attitude or centre."""
    return EnclosedPolynomial(scene, _motion(scene))


def closed_form(scene: Scene) -> DoubledPolynomial:
    """The motion in mpmath, by doubled angles; raises NoClosedForm likewise."""
    return DoubledPolynomial(scene, _motion(scene))


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
    """Every cosine and sine by Arb, to the precision that the rows ask for."""

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
class DoubledPolynomial(Settled):
    """Every cosine and sine from (c, s) -> (c^2 - s^2, 2 c s)."""

    scene: Scene
    polynomial: Manufactured

    route = "mpmath"
    regime = REGIME

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        with mp.workdps(digits):
            rows = [self._row(t) for t in elapsed]
        parts = _parts(self.scene, rows)
        return {
            name: np.array(part, dtype=object).reshape(len(rows), 3) for name, part in parts.items()
        }

    def _row(self, t: Fraction) -> list[mpf]:
        row = [mp.convert(z) for z in self.polynomial.constant]
        for wave in self.polynomial.waves:
            c, s = _turned(wave.frequency * t, mp.prec)
            pairs = zip(row, wave.cosine, wave.sine, strict=True)
            row = [z + mp.convert(a) * c + mp.convert(b) * s for z, a, b in pairs]
        return row


def _turned(angle: Fraction, bits: int) -> tuple[mpf, mpf]:
    """cos and sin of the angle, to about so many bits: integers that count the last of some more."""
    whole = abs(angle.numerator) // angle.denominator
    # Halved to below 2^-12: a dozen orders of the series are saved for one doubling each.
    halvings = whole.bit_length() + 12
    places = bits + 2 * halvings + _GUARD_BITS
    one = libmp.MPZ(1) << places
    x = libmp.MPZ((angle.numerator << places) // (angle.denominator << halvings))
    c, s, term, order = one, libmp.MPZ(0), one, 0
    while abs(term) > 1:
        order += 1
        term = (term * x >> places) // order
        # i, -1, -i, 1: the powers of i give the terms to sine and cosine in turn.
        if order % 2:
            s += term if order % 4 == 1 else -term
        else:
            c += term if order % 4 == 0 else -term
    for _ in range(halvings):
        c, s = (c * c - s * s) >> places, (c * s) >> (places - 1)
    c, s = (mp.make_mpf(libmp.from_man_exp(count, -places)) for count in (c, s))
    return c, s


def _parts(scene: Scene, rows: Sequence[Sequence[Any]]) -> dict[str, list[Sequence[Any]]]:
    """The rows by the names of what they hold."""
    names = kind_of(scene.body).moving
    return {name: [row[3 * k : 3 * k + 3] for row in rows] for k, name in enumerate(names)}
