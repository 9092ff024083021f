"""Ratios taken by several processes, one after the other, kept and summarised by pyperf.

pyperf's own Runner gives each benchmark processes of its own, minutes apart from those of another one. A
ratio asks for both sides in one process, in turns: these are the rounds of `tradeoff`, and all else is
pyperf.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pyperf

from benches.ratio import Ratio
from taylor_verify.tradeoff.timing import in_rounds

# The fewest of which no single one decides the median.
PROCESSES: Final = 3
# Of each ratio in each process.
SECONDS: Final = 0.6
# Rounds in these seconds, or so many.
_MOST_ROUNDS: Final = 15
_SEED: Final = 1
_YARDSTICK: Final = "yardstick of "
# A cost is that of one core.
_ONE_THREAD: Final = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


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


def measured(ratios: Sequence[Ratio], file: Path, processes: int = PROCESSES) -> list[Measured]:
    """Return the ratios as they are measured now; ``file`` is filled with all that pyperf keeps."""
    repeated = [ratio.name for ratio in ratios if ratio.rounds is None]
    environment = dict.fromkeys(_ONE_THREAD, "1") | os.environ
    for k in range(processes if repeated else 0):
        print(f"process {k + 1} of {processes}: {len(repeated)} ratios", file=sys.stderr)
        command = [sys.executable, "-m", "benches.worker", str(file), *repeated]
        subprocess.run(command, env=environment, check=True, stdout=sys.stderr)
    for ratio in ratios:
        if ratio.rounds is not None:
            print(ratio.name, file=sys.stderr)
            add(ratio, in_turns(ratio), file)
    return summary(ratios, file)


def add(ratio: Ratio, costs: Costs, file: Path) -> None:
    """Add the costs that one process has measured to a file of pyperf."""
    names = (ratio.name, _YARDSTICK + ratio.name)
    pyperf.add_runs(
        str(file),
        pyperf.BenchmarkSuite(
            [
                pyperf.Benchmark(
                    [pyperf.Run(values, metadata={"name": name, "unit": ratio.measure})]
                )
                for name, values in zip(names, (costs.action, costs.yardstick), strict=True)
            ]
        ),
    )


def summary(ratios: Sequence[Ratio], file: Path) -> list[Measured]:
    """Return what a file of pyperf holds of the ratios."""
    suite = pyperf.BenchmarkSuite.load(str(file))
    measured = []
    for ratio in ratios:
        action = suite.get_benchmark(ratio.name)
        yardstick = suite.get_benchmark(_YARDSTICK + ratio.name)
        quotients = pyperf.Benchmark(list(_quotients(action, yardstick)))
        spread = quotients.median_abs_dev()
        measured.append(Measured(ratio, quotients.median(), spread, action.median()))
    return measured


def _quotients(action: pyperf.Benchmark, yardstick: pyperf.Benchmark) -> Iterator[pyperf.Run]:
    """Yield the quotients of each process's rounds."""
    for over, under in zip(action.get_runs(), yardstick.get_runs(), strict=True):
        quotients = Costs(over.values, under.values).quotients
        yield pyperf.Run(quotients, metadata={"name": "ratio"}, collect_metadata=False)
