"""The yardstick of the bench follows the same motion as the enclosure that is measured by it."""

from __future__ import annotations

from dataclasses import replace
from math import ceil

import pytest
from builders.two_runs import APART_DIGITS, GUARD_BITS, GUARD_DIGITS, two_runs
from mpmath import mp, mpf

from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.reading.reader import load

DIGITS = 20


@pytest.mark.parametrize(
    "name", ["euler/constant-moment", "kirchhoff/general-body", "manufactured/kirchhoff-path"]
)
def test_both_runs_end_where_the_enclosure_does(name: str) -> None:
    """The state agrees to the digits asked for, and the quaternion of the turn keeps its length."""
    scene = load(name)
    track = {"attitude"} if scene.model == "euler" else {"attitude", "centre"}
    scene = replace(scene, track=frozenset(track))
    times = scene.clock.elapsed[-1:]
    motion = TaylorSolution(scene).motion(times, DIGITS + 5)
    first = motion["omega" if scene.model == "euler" else "linear_impulse"][0]
    for rows, more in zip(two_runs(scene, times, DIGITS), (0, APART_DIGITS), strict=True):
        bits = ceil((DIGITS + GUARD_DIGITS + more) * 3.3219280948873626) + GUARD_BITS
        with mp.workdps(50):
            got = [mp.ldexp(mpf(int(z)), -bits) for z in rows[0]]
            assert mp.norm([a - b for a, b in zip(got, first, strict=False)]) <= mpf(10) ** -DIGITS
            quaternion = got[-7:-3] if "centre" in scene.track else got[-4:]
            assert abs(mp.norm(quaternion) - 1) <= mpf(10) ** -DIGITS
