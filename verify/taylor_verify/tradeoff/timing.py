"""Times in rounds: everything that is timed has its turn in each round, in a random order.

A disturbance of the machine does not always hit the same turn, and a ratio is formed within its round, when
the machine was equally warm, busy and fast. Short calls are repeated until the clock resolves them.

A few values are summed up by their median, with an interval without assumptions on their distribution. Each
of n independent values from one distribution is below its median with probability 1/2. Therefore the median
lies between the k-th smallest and the k-th largest value with probability

    1 - 2 sum_{i<k} C(n, i) / 2^n

or more, for any distribution (H. A. David and H. N. Nagaraja, Order Statistics, 3rd ed. (2003), 7.1).
The interval has the largest k with the required confidence.
"""

from __future__ import annotations

import gc
import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from math import ceil, comb, inf
from statistics import median
from time import perf_counter
from typing import Final, NamedTuple, TypeVar

Answer = TypeVar("Answer")
# A function that returns seconds.
Clock = Callable[[], float]

# The least duration of a measurement: an interrupt does not matter then, nor what the clock costs.
LEAST_SECONDS: Final = 1e-2
_FEWEST_ROUNDS: Final = 2
_MOST_CALLS: Final = 1000

CONFIDENCE: Final = 0.95
FORMULA: Final = "1 - 2 sum_{i<k} C(n, i)/2^n"


# Rounds.


def in_rounds(
    turns: Sequence[Callable[[], Answer]], rounds: int, seed: int, seconds: float = inf
) -> list[list[Answer]]:
    """Call every turn once in each round, in a random order, and return the answers of each turn by round.

    After the first round, which may set something up, and a second one no round begins that is so many
    ``seconds`` later than the first.
    """
    answers: list[list[Answer]] = [[] for _ in turns]
    order, draw = list(range(len(turns))), random.Random(seed)
    end = inf
    with _without_garbage_collection():
        for number in range(rounds):
            if number >= _FEWEST_ROUNDS and perf_counter() > end:
                break
            draw.shuffle(order)
            for i in order:
                answers[i].append(turns[i]())
            if number == 0:
                end = perf_counter() + seconds
    return answers


@contextmanager
def _without_garbage_collection() -> Iterator[None]:
    """Collect garbage once, and then not until the end, so that it disturbs no turn."""
    was_enabled = gc.isenabled()
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def calls_to_time(seconds: float, least: float = LEAST_SECONDS) -> int:
    """Return the number of calls of so many ``seconds`` that last ``least`` seconds together."""
    return min(_MOST_CALLS, max(1, ceil(least / seconds))) if seconds > 0 else _MOST_CALLS


def clock_resolution(clock: Clock = perf_counter) -> float:
    """Return the smallest observed step of the clock, in seconds."""

    def step() -> float:
        began = clock()
        while (now := clock()) == began:
            pass
        return now - began

    return min(step() for _ in range(100))


# The median of a few values.


class Estimate(NamedTuple):
    """The median of some values; ``low`` and ``high`` enclose the median of their distribution.

    Both are None if the values are too few for the confidence.
    """

    median: float
    low: float | None
    high: float | None


def estimate(values: Iterable[float]) -> Estimate:
    """Return the median of the values, at least one, with its interval at CONFIDENCE."""
    ranked = sorted(values)
    rank = place(len(ranked), CONFIDENCE)
    low, high = (ranked[rank - 1], ranked[-rank]) if rank else (None, None)
    return Estimate(median(ranked), low, high)


def coverage(count: int, rank: int) -> float:
    """Return the probability that the median is between the rank-th smallest and largest value."""
    return 1 - 2 * sum(comb(count, i) for i in range(rank)) * 0.5**count


def place(count: int, confidence: float) -> int:
    """Return the largest rank whose interval has the confidence; 0 if not even rank 1 has it."""
    ranks = range(1, (count + 1) // 2 + 1)
    return max((rank for rank in ranks if coverage(count, rank) >= confidence), default=0)
