"""The frequency of nutation, as `explain` tells it, is that of the exact motion."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.route import solution
from taylor_verify.numbers.precision import exact_value
from taylor_verify.scenes.motion import Motion, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 25
# A turn is known to thirty digits and each row to 25.
AGREES = mpf(10) ** -20
# A third of a turn is wrong in kind.
DIFFERS = mpf(10) ** -3
START = Fraction(7, 10)
# The axis that nods: the one that omega goes round, or the axis of symmetry.
NODDING = {
    "euler/generic": 0,
    "euler/about-max-axis": 0,
    "euler/tennis-racket": 2,
    "kirchhoff/whole-motion": 2,
    "kirchhoff/cubic": 2,
    "kirchhoff/trigonometric": 2,
}


def nods(name: str, turns: Fraction) -> mpf:
    """By how much the cosine of its tilt changes in so many turns of the frequency."""
    scene = replace(load(name), track=frozenset())
    frequency = elements(scene, 30)["nutation_frequency"].value
    with mp.workdps(40):
        turn = exact_value(2 * mp.pi / mp.mpf(frequency))
    motion = solution(scene).motion([START, START + turns * turn], DIGITS)
    with mp.workdps(30):
        return abs(tilt(scene, motion, 1) - tilt(scene, motion, 0))


def tilt(scene: Scene, motion: Motion, row: int) -> mpf:
    """The cosine of the angle between the axis and the vector that is fixed in space, H or x."""
    if isinstance(scene.initial, Spin):
        omega = motion["omega"][row]
        fixed = [mp.convert(scene.body.inertia[i][i]) * omega[i] for i in range(3)]
    else:
        fixed = list(motion["linear_impulse"][row])
    return fixed[NODDING[scene.name]] / mp.norm(fixed)


@pytest.mark.parametrize("name", NODDING)
def test_the_axis_nods_at_the_frequency_of_nutation(name: str) -> None:
    """After 2 pi over it the axis is tilted as before, and after a third of that it is not."""
    assert nods(name, Fraction(1)) <= AGREES
    assert nods(name, Fraction(1, 3)) > DIFFERS
