"""The growth of an error of the state along an orbit, from the first sample on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Final

import numpy as np

from taylor_verify.exact.conditioning.condition import Path
from taylor_verify.exact.invariant import Array
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.judge.errors.state import largest, norms
from taylor_verify.judge.floor.attainable import condition
from taylor_verify.judge.floor.loads import Along
from taylor_verify.scenes.scene import Scene

# The sizes of the state are needed only to the digits of a sentence.
_DIGITS: Final = 15
# Growth in proportion to time doubles when the time doubles. Oscillations within a period are added to it,
# hence the margins.
_DOUBLING: Final = (1.5, 2.7)


@dataclass(frozen=True)
class Carrying:
    """Growth factors of a relative error made at ``times[0]``, at each of ``times``.

    The first error is relative to |H|, |x| or |y| at that time. Later errors are relative to the largest
    |omega|, |x| or |y| of the run, as in a verdict. The largest factor of all pairs counts. Factors beyond
    float64 are infinite.
    """

    times: tuple[float, ...]
    factors: tuple[float, ...]

    @property
    def worst(self) -> int:
        """Index of the largest factor."""
        return self.factors.index(max(self.factors))

    @property
    def pace(self) -> float | None:
        """Largest factor per unit of time, if the factors grow in proportion to time."""
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


def carrying(scene: Scene, along: Path | None = None) -> Carrying | None:
    """Return the growth factors of the scene's orbit; None for a body at rest.

    ``along`` is the orbit under written loads, with as many times as are wanted. Raises Unsettled if the
    transition matrix is not known.
    """
    kind, path = kind_of(scene.body), along or condition(scene)
    states = _states(scene, path)
    momentum = kind.momentum_rows(scene.body, {n: rows[:1] for n, rows in states.items()})
    factors = []
    for out, rows in states.items():
        at_most = largest(norms(rows))
        for k, into in enumerate(kind.momenta):
            (at_first,) = norms(momentum[:, 3 * k : 3 * k + 3])
            if at_first and at_most:
                # Each alone may be beyond the doubles.
                factors.append(path.norms(out, into) * float(at_first / at_most))
    if not factors:
        return None
    instants = [float(scene.clock.start + elapsed) for elapsed in path.elapsed]
    return Carrying(tuple(instants), tuple(float(factor) for factor in np.max(factors, axis=0)))


def _states(scene: Scene, path: Path) -> Mapping[str, Array]:
    """Return omega or the impulses at every time of a path."""
    if scene.body.loads is None:
        return solution(replace(scene, track=frozenset())).evaluate(path.elapsed, _DIGITS)
    z = Along(path).state.astype(object)
    moving = kind_of(scene.body).moving
    return {name: z[:, 3 * k : 3 * k + 3] for k, name in enumerate(moving)}
