"""Trajectories for claims that are about orbits: Taylor series of the equations of motion, in balls.

It shares no closed form with the text, and is settled to the digits asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Final

from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import Clock, Motion, State
from taylor_verify.scenes.scene import Scene

DIGITS: Final = 60


def trajectory(
    body: Body,
    start: State,
    times: Sequence[Fraction],
    digits: int = DIGITS,
    track: frozenset[str] = frozenset(),
) -> Motion:
    """The motion at these times after the start, to ``digits`` digits of every vector."""
    return _trajectory(body, start, tuple(times), digits, track)


@lru_cache(maxsize=64)
def _trajectory(
    body: Body, start: State, times: tuple[Fraction, ...], digits: int, track: frozenset[str]
) -> Motion:
    name = "a trajectory of the ledger"
    scene = Scene(name, name, body.MODEL, track, body, start, Clock(Fraction(0), times))
    return TaylorSolution(scene).motion(times, digits)
