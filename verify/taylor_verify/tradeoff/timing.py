"""Times in rounds: everything that is timed has its turn in each round, in a random order.

A disturbance of the machine does not always hit the same turn, and a ratio is formed within its round, when
the machine was equally warm, busy and fast.
"""

from __future__ import annotations

import gc
import random
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from math import inf
from time import perf_counter
from typing import Final, TypeVar

Answer = TypeVar("Answer")

_FEWEST_ROUNDS: Final = 2


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
