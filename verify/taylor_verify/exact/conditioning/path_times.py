"""Times at which an orbit is followed: samples, and some between them."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import chain
from typing import Final

from taylor_verify.scenes.instants import chosen
from taylor_verify.scenes.scene import Scene

# On a regular orbit all errors grow alike, so this many samples represent all,
_FEW: Final = 33
# with this many times besides that share no period: samples may meet the orbit in one phase only.
_BETWEEN: Final = 20
_GOLDEN: Final = Fraction(0.6180339887498949)
# Up to this many radians there is a point for each radian, later for each 64th part of the elapsed time.
_RESOLVED: Final = 64
_MOST_SAMPLES: Final = 401
# Under written loads the motion and its derivative come from one run, up to this many samples,
MOST_OF_RUN: Final = 2000
# with this many times between them; of more samples as many are chosen.
_OF_RUN: Final = 400


def few(elapsed: Sequence[Fraction]) -> list[Fraction]:
    """Return evenly chosen samples, and times that are independent of them.

    In each of as many equal parts of the time lies one, at a multiple of the golden section modulo 1,
    which keeps away from every rhythm; two lie before the first sample, to which nothing else leads.
    """
    samples = [Fraction(0), *chosen(elapsed, _FEW)]
    parts = max(_BETWEEN, _FEW - len(elapsed))
    between = [elapsed[-1] * share for share in _golden_shares(parts)]
    first = next((t for t in samples if t), Fraction(0))
    return sorted({*samples, *between, first * _GOLDEN**2, first * _GOLDEN}, key=abs)


@lru_cache(maxsize=8)
def _golden_shares(parts: int) -> tuple[Fraction, ...]:
    """Return a number in each of so many equal parts between 0 and 1."""
    return tuple((k + k * _GOLDEN % 1) / parts for k in range(parts))


def many(elapsed: Sequence[Fraction], rate: float) -> list[Fraction]:
    """Radian by radian at first, later in proportion to the time so far; and the samples."""
    end = float(elapsed[-1])
    times, t = [], 0.0
    while t < abs(end):
        times.append(Fraction(t if end > 0 else -t))
        t += max(1 / rate, t / _RESOLVED)
    return sorted({*times, *chosen(elapsed, _MOST_SAMPLES)}, key=abs)


def times_of_run(scene: Scene) -> list[Fraction]:
    """Return the times of samples, of instants, and some between, sorted away from the start.

    Samples and instants are all there unless they are many.
    """
    elapsed, loads = scene.clock.elapsed, scene.body.loads
    taken = [] if loads is None else [instant.time for instant in loads.instants(elapsed[-1])]
    asked = (
        times if len(times) <= MOST_OF_RUN else chosen(times, _OF_RUN) for times in (elapsed, taken)
    )
    between = (elapsed[-1] * share for share in _golden_shares(_OF_RUN))
    return sorted({Fraction(0), *chain(*asked), *between}, key=abs)
