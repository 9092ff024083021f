"""Trajectories for claims that are about orbits: Taylor series of the equations of motion, in balls.

It shares no closed form with the text, and is settled to the digits asked for.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import Final

from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import Clock, Motion, State
from taylor_verify.scenes.scene import Scene

DIGITS: Final = 60


def scene_of(
    body: Body, start: State, times: tuple[Fraction, ...], track: frozenset[str] = frozenset()
) -> Scene:
    """Return the scene of a body at these times after its start."""
    name = "a trajectory of the ledger"
    return Scene(name, name, body.MODEL, track, body, start, Clock(Fraction(0), times))


@lru_cache(maxsize=64)
def trajectory(
    body: Body,
    start: State,
    times: tuple[Fraction, ...],
    digits: int = DIGITS,
    track: frozenset[str] = frozenset(),
) -> Motion:
    """Return the motion at these times after the start, to ``digits`` digits of every vector."""
    return TaylorSolution(scene_of(body, start, times, track)).motion(times, digits)
