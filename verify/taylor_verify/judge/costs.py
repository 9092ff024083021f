"""Processor time of a run by stage."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from itertools import chain
from time import process_time

SOLVING = "solving"
TRUTH = "the exact motion"
CONDITION = "the orbit's condition"
ERRORS = "errors and shifts"
CONSERVED = "conserved quantities"


class Costs:
    """A clock for the stages of one run."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def of(self, stage: str) -> Iterator[None]:
        """Add the processor time of the block to the stage, in seconds of all threads of this process."""
        began = process_time()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + process_time() - began


def total(costs: Iterable[Mapping[str, float]]) -> dict[str, float]:
    """Return the sum over many runs, the most expensive stage first."""
    sums: dict[str, float] = {}
    for stage, seconds in chain.from_iterable(run.items() for run in costs):
        sums[stage] = sums.get(stage, 0.0) + seconds
    return dict(sorted(sums.items(), key=lambda item: -item[1]))


def sentence(sums: Mapping[str, float]) -> str:
    """Return the total and the share of each stage, in words."""
    whole = sum(sums.values())
    shares = ", ".join(f"{stage} {100 * s / whole:.0f} %" for stage, s in sums.items())
    return f"processor time {whole:.1f} s: {shares}"
