"""The order of convergence of fixed-step answers, from their errors at several steps.

    h, e(h)      step and error; e ~ C h^p where the order p shows
    p_i          local order between neighbouring steps, log(e_i / e_i+1) / log(h_i / h_i+1)

At large steps the next power of h is not small yet; at small steps roundings dominate. The order is read
between the two: on the longest run of steps with the same local order. Pages show orders of stored errors,
so this file needs only the standard library.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import fsum, isfinite, log, sqrt
from typing import Final, Protocol

from taylor_verify.records.student import student

# An error must be this many times the roundoff floor to be free of rounding.
CLEAR: Final = 10.0
# An error beyond this multiple of the floor is not caused by rounding on this rung.
_FAR: Final = 100.0
# Local orders that differ by less are equal: orders are integers or halves, which differ by at least twice
# as much.
SAME: Final = 0.25
# The smallest number of steps: two local orders can agree by chance, and a single one cannot disagree.
_FEWEST: Final = 3
# Errors that fall more slowly than this order have stopped falling.
_STALLED: Final = 0.5
# The probability that an interval contains the order.
_LEVEL: Final = 0.95


@dataclass(frozen=True)
class Convergence:
    """The order that a sweep of steps shows.

    ``order`` is the observed order and ``spread`` half of its 95 % interval, from the scatter about a
    straight line in log-log; None if no range of steps has an order. ``steps`` are the steps used, in
    descending order. ``level`` is the smallest error that smaller steps reach, None if the error still
    falls. ``stalls_at`` is the step at which it stops falling, and ``by_rounding`` is True if rounding
    explains that.
    """

    order: float | None
    spread: float | None
    steps: tuple[float, ...]
    level: float | None
    stalls_at: float | None = None
    by_rounding: bool = False


def convergence(
    steps: Sequence[float],
    errors: Sequence[float | None],
    roundoff_floor: float | Sequence[float] = 0.0,
) -> Convergence:
    """Return the order of convergence from errors and steps, which may be given in any sequence.

    ``errors`` that are None or not finite belong to runs that broke. ``roundoff_floor`` is the error that
    perfect rounding would leave, for all steps or for each. Raises ValueError for different lengths and for
    steps that are not positive or not distinct.
    """
    points = _points(steps, errors, roundoff_floor)
    stop = _stop(points)
    chosen = _straight([point for point in points[:stop] if point.is_clear])
    least = min(points[stop:], key=lambda point: point.error, default=None)
    order, spread = (None, None) if chosen is None else _slope(chosen)
    return Convergence(
        order=order,
        spread=spread,
        steps=tuple(point.step for point in chosen or ()),
        level=least.error if least else None,
        stalls_at=points[stop].step if least else None,
        by_rounding=least is not None and least.is_rounding,
    )


class Measured(Protocol):
    """An error at a step; one that is not known counts as none."""

    @property
    def step(self) -> float: ...

    @property
    def error(self) -> float | None: ...


def local_orders(points: Sequence[Measured]) -> tuple[float, ...]:
    """Return the order between neighbouring points; their steps fall."""
    return tuple(_local(a, b) for a, b in pairwise(points))


@dataclass(frozen=True)
class _Point:
    step: float
    error: float
    floor: float

    @property
    def is_clear(self) -> bool:
        """True if the error comes from the method: it is not zero, and larger than roundings make."""
        return self.error > CLEAR * self.floor

    @property
    def is_rounding(self) -> bool:
        """True if rounding on this rung explains the error."""
        return self.floor > 0 and self.error <= _FAR * self.floor


def _points(
    steps: Sequence[float], errors: Sequence[float | None], floors: float | Sequence[float]
) -> list[_Point]:
    """Return the points from the largest step to the smallest, without runs that broke."""
    floor_of_step = [floors] * len(steps) if isinstance(floors, int | float) else list(floors)
    if not len(steps) == len(errors) == len(floor_of_step):
        raise ValueError(
            f"expected an error and a floor for each of {len(steps)} steps, got {len(errors)} errors "
            f"and {len(floor_of_step)} floors"
        )
    if not all(step > 0 for step in steps) or len(set(steps)) < len(steps):
        raise ValueError(f"expected positive steps, no two the same, got {list(steps)}")
    points = zip(steps, errors, floor_of_step, strict=True)
    return [
        _Point(float(step), float(error), float(floor))
        for step, error, floor in sorted(points, key=lambda p: -p[0])
        if error is not None and isfinite(error)
    ]


def _local(a: Measured, b: Measured) -> float:
    """The order between two neighbours, of which the second has the smaller step."""
    if not b.error:
        return float("inf")
    return log(a.error / b.error) / log(a.step / b.step) if a.error else 0.0


def _stop(points: Sequence[_Point]) -> int:
    """The place where errors stop falling for good: the first point that no smaller step improves on.

    An improvement counts if it is faster, from there to the end, than an order of a half. A single step
    that does well by chance is no stop, nor is a beginning where errors do not fall yet or fall slowly.
    """
    for i, point in enumerate(points[:-1]):
        later = min(points[i + 1 :], key=lambda p: p.error)
        slow = _local(point, replace(later, step=points[-1].step)) < _STALLED
        if slow and not _is_gaining(points[i:]):
            return i
    return len(points)


def _is_gaining(points: Sequence[_Point]) -> bool:
    """Return True if errors fall faster from step to step: then the first steps were too large."""
    orders = local_orders(points)
    rises = all(before < after for before, after in pairwise(orders))
    return len(orders) >= 2 and orders[0] > 0 and rises and orders[-1] >= _STALLED


def _straight(points: Sequence[_Point]) -> Sequence[_Point] | None:
    """Return the longest run of steps with the same local order; of two, the one of smaller steps."""
    best: Sequence[_Point] | None = None
    for first in range(len(points)):
        for last in range(first + _FEWEST, len(points) + 1):
            run = points[first:last]
            orders = local_orders(run)
            if max(orders) - min(orders) <= SAME and (best is None or len(run) >= len(best)):
                best = run
    return best


def _slope(points: Sequence[_Point]) -> tuple[float, float]:
    """The least-squares slope of log e over log h, and half of its 95 % interval."""
    x = _centred([log(p.step) for p in points])
    y = _centred([log(p.error) for p in points])
    square = fsum(a * a for a in x)
    slope = fsum(a * b for a, b in zip(x, y, strict=True)) / square
    freedom = len(points) - 2
    scatter = fsum((b - slope * a) ** 2 for a, b in zip(x, y, strict=True)) / freedom
    return slope, student(freedom, _LEVEL) * sqrt(scatter / square)


def _centred(values: Sequence[float]) -> list[float]:
    """Return the values less their mean."""
    mean = fsum(values) / len(values)
    return [value - mean for value in values]
