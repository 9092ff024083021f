"""Solutions found in other coordinates, carried back to those of the scene."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, Final, final

import numpy as np
from mpmath import mp

from taylor_verify.exact.balls import Enclosed, Enclosure, ball
from taylor_verify.exact.solution import Quantities, Settled, Solution

_GUARD_DIGITS: Final = 6

Number = Callable[[Fraction], Any]
"""A rational as a ball or in mpmath, at the ambient precision."""

Back = Callable[[dict[str, Any], Sequence[Fraction], Number], None]
"""Puts the object arrays of every quantity, at these times, into the coordinates of the scene."""


def carried(inner: Solution, back: Back, regime: str | None = None) -> Solution:
    """Return the solution in the coordinates of the scene, by the route of the inner one."""
    if isinstance(inner, Enclosed):
        return CarriedBalls(inner, back, regime or inner.regime)
    return Carried(inner, back, regime or inner.regime)


@final
class CarriedBalls(Enclosed):
    """A solution in balls: what cancels on the way back widens them, and the precision rises."""

    def __init__(self, inner: Enclosed, back: Back, regime: str) -> None:
        self.regime = regime
        self._inner, self._back = inner, back

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        rows: dict[str, Any] = dict(self._inner.enclose(elapsed, bits))
        for name, entries in rows.items():
            rows[name] = np.array(entries, dtype=object)
        self._back(rows, elapsed, ball)
        return rows


@final
class Carried(Settled):
    """A solution in mpmath, believed when two evaluations agree after the way back."""

    route = "mpmath"

    def __init__(self, inner: Solution, back: Back, regime: str) -> None:
        self.regime = regime
        self._inner, self._back = inner, back

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        rows: dict[str, Any] = dict(self._inner.evaluate(elapsed, digits))
        with mp.workdps(digits + _GUARD_DIGITS):
            self._back(rows, elapsed, mp.convert)
        return rows
