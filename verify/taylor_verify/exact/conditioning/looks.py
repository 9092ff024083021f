"""At which times an orbit is looked at, where it need not be at all."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Final

# On a regular orbit what is injected at any time grows alike, and so many samples stand for all,
_FEW: Final = 33
# if there are so many times beside them that no period shares: samples may meet the orbit in one phase.
_BETWEEN: Final = 20
_GOLDEN: Final = Fraction(0.6180339887498949)
# Until so many radians every radian is a point of its own, later every 64th part of the time so far.
_RESOLVED: Final = 64
_MOST_SAMPLES: Final = 401


def few(elapsed: Sequence[Fraction]) -> list[Fraction]:
    """Evenly chosen samples, and times that owe nothing to them: few samples leave more to these.

    In each of as many equal parts of the time lies one, at a multiple of the golden section modulo 1,
    which keeps away from every rhythm; two lie before the first sample, to which nothing else leads.
    """
    samples = [Fraction(0), *chosen(elapsed, _FEW)]
    parts = max(_BETWEEN, _FEW - len(elapsed))
    between = [elapsed[-1] / parts * (k + k * _GOLDEN % 1) for k in range(parts)]
    first = next((t for t in samples if t), Fraction(0))
    return _sorted([*samples, *between, first * _GOLDEN**2, first * _GOLDEN])


def many(elapsed: Sequence[Fraction], rate: float) -> list[Fraction]:
    """Radian by radian at first, later in proportion to the time so far; and the samples."""
    end = float(elapsed[-1])
    times, t = [], 0.0
    while t < abs(end):
        times.append(Fraction(t if end > 0 else -t))
        t += max(1 / rate, t / _RESOLVED)
    return _sorted([*times, *chosen(elapsed, _MOST_SAMPLES)])


def refined(elapsed: Sequence[Fraction], parts: int) -> list[Fraction]:
    """The instants, and between two of them the points that make so many parts of the time."""
    found = [elapsed[0]]
    for begin, end in pairwise(elapsed):
        found += [begin + (end - begin) * Fraction(part, parts) for part in range(1, parts + 1)]
    return found


def chosen(elapsed: Sequence[Fraction], most: int) -> list[Fraction]:
    """At most so many of the samples, evenly, first and last among them."""
    return [elapsed[k] for k in evenly(len(elapsed), most)]


def evenly(samples: int, most: int) -> list[int]:
    """At most so many indices, evenly, first and last among them."""
    count = min(samples, most)
    return sorted({round(k * (samples - 1) / max(count - 1, 1)) for k in range(count)})


def _sorted(times: Sequence[Fraction]) -> list[Fraction]:
    return sorted(set(times), key=abs)
