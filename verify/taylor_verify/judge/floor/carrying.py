"""How an error of the state at the first sample is carried along an orbit, in relative numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf
from typing import Any, Final

import numpy as np

from taylor_verify.exact.route import solution
from taylor_verify.judge.errors.state import largest, norms
from taylor_verify.judge.floor.attainable import condition
from taylor_verify.scenes.bodies import Body, RigidBody
from taylor_verify.scenes.gyrostat import Gyrostat
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# The sizes of the state are wanted to the digits of a sentence.
_DIGITS: Final = 15
# Growth in proportion to time doubles with the time. What swings within a period lies on top of it,
# hence the margin on either side.
_DOUBLING: Final = (1.5, 2.7)


@dataclass(frozen=True)
class Carrying:
    """By what factor a relative error made at ``times[0]`` is larger at each of ``times``.

    The error there is relative to |H|, |x| or |y| as they are there; later it is relative to the
    largest |omega|, |x| or |y| of the run, as the errors of a verdict are. The largest factor of all
    pairs counts. Infinite beyond float64.
    """

    times: tuple[float, ...]
    factors: tuple[float, ...]

    @property
    def worst(self) -> int:
        """The index of the largest factor."""
        return self.factors.index(max(self.factors))

    @property
    def pace(self) -> float | None:
        """The largest factor per unit of time, if the factors grow in proportion to time."""
        since, span = self.times[0], self.times[-1] - self.times[0]
        quarter, half, whole = (self._largest_until(since + span * part) for part in (0.25, 0.5, 1))
        low, high = _DOUBLING
        doubles = low * quarter <= half <= high * quarter and low * half <= whole <= high * half
        return whole / abs(span) if doubles and whole < inf else None

    def _largest_until(self, time: float) -> float:
        reach = abs(time - self.times[0])
        return max(
            factor
            for instant, factor in zip(self.times, self.factors, strict=True)
            if abs(instant - self.times[0]) <= reach
        )


def carrying(scene: Scene) -> Carrying | None:
    """From the transition norms of the scene's own orbit; None for a body that is at rest.

    Raises Unsettled where the transition matrix is not known.
    """
    found = condition(scene)
    sizes = _sizes(scene, found.elapsed)
    factors = [
        found.norms(out, into) * at_first / at_most
        for out, at_most in sizes.at_most.items()
        for into, at_first in sizes.at_first.items()
        if at_first and at_most
    ]
    if not factors:
        return None
    instants = [float(scene.clock.start + elapsed) for elapsed in found.elapsed]
    return Carrying(tuple(instants), tuple(float(factor) for factor in np.max(factors, axis=0)))


@dataclass(frozen=True)
class _Sizes:
    """Norms by block: of what is disturbed, at the first instant, and of what is judged, at most."""

    at_first: dict[str, float]
    at_most: dict[str, float]


def _sizes(scene: Scene, elapsed: Sequence[Fraction]) -> _Sizes:
    found = solution(replace(scene, track=frozenset())).evaluate(elapsed, _DIGITS)
    at_most = {name: float(largest(norms(rows))) for name, rows in found.items()}
    at_first = {name: float(norms(rows)[0]) for name, rows in found.items()}
    if momentum := _MOMENTUM.get(type(scene.body)):
        at_first = {"momentum": momentum(scene.body, found["omega"][0])}
    return _Sizes(at_first, at_most)


def _rigid_momentum(body: RigidBody | Gyrostat, omega: Sequence[Any]) -> float:
    """|I omega|."""
    return float(np.linalg.norm(np.array(body.inertia, dtype=float) @ np.array(omega, dtype=float)))


# By the class of a body, the size of the momentum of its state. One that is absent has momenta for it.
_MOMENTUM: Final[Mapping[type[Body], Callable[[Any, Sequence[Any]], float]]] = {
    RigidBody: _rigid_momentum,
    Gyrostat: _rigid_momentum,
}
