"""Solutions in other coordinates or another time, converted back to those of the scene."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, final

import numpy as np
from mpmath import mp

from taylor_verify.exact.balls import Enclosed, Enclosure
from taylor_verify.exact.solution import Number, Quantities, Settled, Solution, Time
from taylor_verify.numbers.irrational import ball

_GUARD_DIGITS: Final = 6
# Digits of an inner time before its point that cost no second evaluation.
_TIME_DIGITS: Final = 30

Back = Callable[[dict[str, Any], Sequence[Time], Number], None]
"""A function that converts the arrays of all quantities, in place, to the coordinates of the scene."""

Clock = Callable[[Time, Number], Time]
"""A function from the time since the start of the scene to the inner time; exactly zero at zero."""


def carried(
    inner: Solution, back: Back, regime: str | None = None, clock: Clock | None = None
) -> Solution:
    """Return the solution in the coordinates and the time of the scene, by the route of the inner one."""
    kind = regime or inner.regime
    if isinstance(inner, Enclosed):
        return CarriedBalls(inner, back, kind, clock)
    return Carried(inner, back, kind, clock)


@final
class CarriedBalls(Enclosed):
    """A converted solution in balls; where the conversion widens them the precision rises."""

    def __init__(
        self, inner: Enclosed, back: Back, regime: str, clock: Clock | None = None
    ) -> None:
        self.regime = regime
        self.by_periods = inner.by_periods
        self._inner, self._back, self._clock = inner, back, clock

    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        clock = self._clock
        times = elapsed if clock is None else [clock(t, ball) for t in elapsed]
        rows: dict[str, Any] = dict(self._inner.enclose(times, bits))
        for name, entries in rows.items():
            rows[name] = np.array(entries, dtype=object)
        self._back(rows, elapsed, ball)
        return rows


@final
class Carried(Settled):
    """A converted solution in mpmath, accepted when two evaluations agree after the conversion."""

    route = "mpmath"

    def __init__(
        self, inner: Solution, back: Back, regime: str, clock: Clock | None = None
    ) -> None:
        self.regime = regime
        self._inner, self._back, self._clock = inner, back, clock

    def evaluate(self, elapsed: Sequence[Time], digits: int) -> Quantities:
        rows: dict[str, Any] = dict(self._inner.evaluate(self._times(elapsed, digits), digits))
        with mp.workdps(digits + _GUARD_DIGITS):
            self._back(rows, elapsed, mp.convert)
        return rows

    def _times(self, elapsed: Sequence[Time], digits: int) -> Sequence[Time]:
        """The times of the inner motion, to more digits than a phase has before its point.

        A motion too fast for that agrees with itself at a higher precision only.
        """
        clock = self._clock
        if clock is None:
            return elapsed
        with mp.workdps(2 * digits + _TIME_DIGITS):
            return [clock(t, mp.convert) for t in elapsed]
