"""A ratio: what something costs over what its yardstick costs, with a target and the reason for it.

Every ratio is a cost over a cost, so that the smaller is the better one.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Literal, Protocol, final

from taylor_verify_reports.studies.tradeoff.rounds import LEAST_SECONDS, Clock, calls_to_time

# Ratios of one code differ by so much: another order of the code in memory is enough.
RESOLUTION: Final = 0.02
# A first call that took so many times as long is no short call.
_FIRST: Final = 10


class Side(Protocol):
    """One side of a ratio: a cost that can be taken again and again."""

    def cost(self) -> float:
        """Return the cost of one unit: seconds, or bytes. It is positive."""


@dataclass(frozen=True)
class Target:
    """A cost, or a ratio, that is not to be exceeded, and why it is this one."""

    most: float
    because: str


@dataclass(frozen=True)
class Ratio:
    """What ``pair`` makes first over what it makes second: the action and its yardstick.

    ``compares`` says so in a sentence. ``limit`` is a target for the cost of one ``unit`` of the action
    itself. A ratio with ``rounds`` takes long and differs little from one process to the next: it is taken
    so often, by the process that starts the others.
    """

    name: str
    compares: str
    pair: Callable[[], tuple[Side, Side]]
    target: Target | None = None
    limit: Target | None = None
    unit: str = "call"
    measure: Literal["second", "byte"] = "second"
    rounds: int | None = None


def nothing() -> None:
    """Return nothing to be given."""


@final
class Action:
    """A call that is timed on the processor's clock, so that a neighbour on the machine counts little.

    ``given`` makes what the call is given anew each time, which is not timed; a call is worth ``units``.
    Short calls are repeated until the clock can tell them; what the first ones fill is not timed.
    """

    def __init__(
        self,
        run: Callable[[Any], object],
        given: Callable[[], Any] = nothing,
        units: int = 1,
        clock: Clock = time.process_time,
    ) -> None:
        self._run, self._given, self._units, self._clock = run, given, units, clock
        self._calls = 0

    def cost(self) -> float:
        """Return the seconds of one unit."""
        if not self._calls:
            # The first call fills caches, and may be slower by far than those that follow.
            is_short = self._seconds(1) < _FIRST * LEAST_SECONDS
            self._calls = calls_to_time(self._seconds(1)) if is_short else 1
        return self._seconds(self._calls) / (self._calls * self._units)

    def _seconds(self, calls: int) -> float:
        each = [self._given() for _ in range(calls)]
        run, clock = self._run, self._clock
        began = clock()
        for given in each:
            run(given)
        return clock() - began
