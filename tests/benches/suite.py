"""Ratios taken by several processes, one after the other: medians of their rounds."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from typing import Final

from benches.ratio import Ratio
from taylor_verify.batch.work import run_all
from taylor_verify.tradeoff.timing import in_rounds

# The fewest of which no single one decides the median.
PROCESSES: Final = 3
# Of each ratio in each process.
SECONDS: Final = 0.6
# Rounds in these seconds, or so many.
_MOST_ROUNDS: Final = 15
_SEED: Final = 1


@dataclass(frozen=True)
class Costs:
    """The costs of one unit of the action and of its yardstick, a pair for each round."""

    action: tuple[float, ...]
    yardstick: tuple[float, ...]

    @property
    def quotients(self) -> tuple[float, ...]:
        return tuple(a / b for a, b in zip(self.action, self.yardstick, strict=True))


def in_turns(ratio: Ratio, seconds: float = 0) -> Costs:
    """Take both sides in the rounds of the ratio, or in as many as fit into the seconds."""
    sides = [side.cost for side in ratio.pair()]
    if ratio.rounds is not None:
        return Costs(*map(tuple, in_rounds(sides, ratio.rounds, _SEED)))
    return Costs(*map(tuple, in_rounds(sides, _MOST_ROUNDS, _SEED, seconds)))


@dataclass(frozen=True)
class Measured:
    """A ratio with the median of what all rounds of all processes gave.

    ``spread`` is the median distance of their quotients from ``value``, and ``cost`` that of one unit of
    the action. NaN misses every target.
    """

    ratio: Ratio
    value: float
    spread: float
    cost: float

    @property
    def misses_target(self) -> bool:
        """Whether the ratio exceeds its target."""
        return self.ratio.target is not None and not self.value <= self.ratio.target.most

    @property
    def misses_limit(self) -> bool:
        """Whether the cost exceeds its target."""
        return self.ratio.limit is not None and not self.cost <= self.ratio.limit.most

    @property
    def misses(self) -> bool:
        return self.misses_target or self.misses_limit


def measured(ratios: Sequence[Ratio], processes: int = PROCESSES) -> list[Measured]:
    """Return the ratios as they are measured now, by several processes one after the other."""
    repeated = [ratio.name for ratio in ratios if ratio.rounds is None]
    every: dict[str, list[Costs]] = {ratio.name: [] for ratio in ratios}
    for k in range(processes if repeated else 0):
        print(f"process {k + 1} of {processes}: {len(repeated)} ratios", file=sys.stderr)
        # With one piece of work a pool has one process, which is new, has one thread, and ends with it.
        (taken,) = run_all(take, [repeated], workers=1)
        for name, costs in taken.items():
            every[name].append(costs)
    for ratio in ratios:
        if ratio.rounds is not None:
            print(ratio.name, file=sys.stderr)
            every[ratio.name].append(in_turns(ratio))
    return [summary(ratio, every[ratio.name]) for ratio in ratios]


def take(names: Sequence[str]) -> dict[str, Costs]:
    """Take the ratios of these names, in this process."""
    from benches.registry import RATIOS

    return {ratio.name: in_turns(ratio, SECONDS) for ratio in RATIOS if ratio.name in names}


def summary(ratio: Ratio, every: Sequence[Costs]) -> Measured:
    """Return the medians of all rounds of all processes."""
    quotients = [quotient for costs in every for quotient in costs.quotients]
    value = median(quotients)
    spread = median(abs(quotient - value) for quotient in quotients)
    return Measured(ratio, value, spread, median(cost for costs in every for cost in costs.action))
