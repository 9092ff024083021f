"""The costs of both sides of a ratio, taken in turns in one process."""

from __future__ import annotations

import gc
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from benches.ratio import Ratio

# Rounds in the seconds that a ratio is given, so many at least and at most.
_FEWEST, _MOST = 2, 15


@dataclass(frozen=True)
class Costs:
    """The costs of one unit of the action and of its yardstick, a pair for each round."""

    action: tuple[float, ...]
    yardstick: tuple[float, ...]

    @property
    def quotients(self) -> tuple[float, ...]:
        return tuple(a / b for a, b in zip(self.action, self.yardstick, strict=True))


def in_turns(ratio: Ratio, seconds: float = 0) -> Costs:
    """Take the action and its yardstick in turns, each of them first in every other round.

    The rounds are those of the ratio, or as many as fit into the seconds once all is set up. The garbage
    collector is off.
    """
    sides = ratio.pair()
    taken: tuple[list[float], list[float]] = ([], [])
    end = float("inf")
    with _no_garbage():
        while (done := len(taken[0])) < (ratio.rounds or _MOST):
            if done == 1:
                end = time.perf_counter() + seconds
            if done >= _FEWEST and ratio.rounds is None and time.perf_counter() > end:
                break
            for side in (0, 1) if done % 2 == 0 else (1, 0):
                taken[side].append(sides[side].cost())
    return Costs(*map(tuple, taken))


@contextmanager
def _no_garbage() -> Iterator[None]:
    gc.collect()
    gc.freeze()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
        gc.unfreeze()
