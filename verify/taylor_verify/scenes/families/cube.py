"""Points of the unit cube, each by its number. A point does not depend on which others are asked for."""

from __future__ import annotations

from enum import StrEnum
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


class Spread(StrEnum):
    """The way in which points fill the cube."""

    RANDOM = "random"
    SOBOL = "sobol"


def places(spread: Spread, size: int, seed: int, first: int, stop: int) -> Array:
    """Return the points with these numbers, an array of shape (stop - first, size), in [0, 1).

    Random points come from Philox, a generator with a counter, whose key is the seed: each point has
    its own values of the counter. Sobol's points are scrambled by the seed. Raises ModuleNotFoundError
    for Sobol's points without SciPy.
    """
    if size == 0 or stop <= first:
        return np.zeros((max(stop - first, 0), size))
    return (_sobol if spread is Spread.SOBOL else _random)(size, seed, first, stop)


def _random(size: int, seed: int, first: int, stop: int) -> Array:
    # Philox makes four numbers at each value of its counter.
    blocks = -(-size // 4)
    drawn = np.random.Philox(key=seed, counter=first * blocks)
    raw = drawn.random_raw((stop - first) * blocks * 4).reshape(stop - first, blocks * 4)
    return np.asarray((raw[:, :size] >> np.uint64(11)) * 2.0**-53)


def _sobol(size: int, seed: int, first: int, stop: int) -> Array:
    from scipy.stats import qmc

    engine = qmc.Sobol(size, scramble=True, seed=np.random.default_rng(seed))
    count = stop - first
    if first:
        return np.asarray(engine.fast_forward(first).random(count))
    # SciPy warns of a first draw that is no power of two.
    return np.asarray(engine.random(1 << (count - 1).bit_length())[:count])
