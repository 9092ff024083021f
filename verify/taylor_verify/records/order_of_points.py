"""The order of convergence of a quantity, read from its errors at several steps.

Beside the order: a lower one at smaller steps, a point whose step does not fit, and the step below which
the errors fall no longer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from math import exp, log
from typing import Final

from taylor_verify.records.answers import Order, OrderPoint, Stall
from taylor_verify.records.observed_order import SAME, Convergence, convergence, local_orders

# The step of an integrator, in the sentences.
STEP: Final = "h"
# Without the suspect, three files are needed to show an order.
_FEWEST_WITH_A_SUSPECT: Final = 4
# An error within this factor of 10^-d is explained by d printed digits.
_OF_DIGITS: Final = 30.0


def read_order(
    quantity: str,
    unit: str,
    points: Sequence[OrderPoint],
    knob: str = STEP,
    digits: Sequence[int | None] = (),
) -> Order:
    """Return the order that the errors of a quantity show, without its sentence.

    ``points`` begin with the largest step; ``digits`` are the printed digits of the file of each, where it
    is one. Raises ValueError for two points with the same step.
    """
    points = tuple(_with_local_orders(points))
    fit = convergence(
        [point.step for point in points],
        [point.error for point in points],
        [point.attainable or 0.0 for point in points],
    )
    order = Order(quantity, unit, points, "", knob=knob)
    measured = [point for point in points if point.error is not None]
    if measured:
        best = min(measured, key=lambda point: point.error or 0.0)
        order = replace(order, best_step=best.step, best_error=best.error)
    if fit.level is not None:
        order = replace(order, stalls_at=fit.stalls_at, stall=_stall(fit, points, digits))
    return _with_order(order, fit, order.clear)


def _with_local_orders(points: Sequence[OrderPoint]) -> Iterator[OrderPoint]:
    """Yield points with the order from the point before, where both have an error."""
    before: OrderPoint | None = None
    for point in points:
        local = None
        if point.error and before:
            (local,) = local_orders([before, point])
        before = point if point.error else None
        yield replace(point, local=local)


# The order, and the file that does not fit.


def _with_order(order: Order, fit: Convergence, clear: Sequence[OrderPoint]) -> Order:
    fits = {point.step for point in clear} <= {*fit.steps}
    if not fits and (suspect := _suspect(clear)) is not None:
        file, step = suspect
        return replace(order, suspect=file, suspect_step=step)
    beyond = [point for point in clear if fit.steps and point.step < fit.steps[-1]]
    if beyond:
        # The order at smaller steps counts: a lower order dominates there.
        fit = _read(beyond)
    if fit.order is None or fit.spread is None:
        return order
    return replace(
        order,
        order=fit.order,
        low=fit.order - fit.spread,
        high=fit.order + fit.spread,
        largest=fit.steps[0],
        smallest=fit.steps[-1],
    )


def _read(points: Sequence[OrderPoint]) -> Convergence:
    return convergence([point.step for point in points], [point.error for point in points])


def _suspect(points: Sequence[OrderPoint]) -> tuple[str, float] | None:
    """Return the single file without which all others agree, and the step that fits its error.

    A wrong step makes one of its two local orders too high and the other too low. Errors that are not yet
    asymptotic depart to one side only.
    """
    if len(points) < _FEWEST_WITH_A_SUSPECT:
        return None
    for i, (before, after) in enumerate(pairwise(local_orders(points)), start=1):
        others = [*points[:i], *points[i + 1 :]]
        fit = _read(others)
        if fit.order is None or len(fit.steps) < len(others):
            continue
        low, high = sorted((before - fit.order, after - fit.order))
        if low < -SAME and high > SAME:
            near, point = points[i - 1], points[i]
            fall = log((point.error or 1.0) / (near.error or 1.0))
            return point.file, float(f"{near.step * exp(fall / fit.order):.3g}")
    return None


def _stall(fit: Convergence, points: Sequence[OrderPoint], digits: Sequence[int | None]) -> Stall:
    """Return the reason why errors stop falling below the best step."""
    if fit.by_rounding:
        return Stall.ROUNDOFF
    pairs = zip(points, digits, strict=bool(digits))
    stalled = [number for point, number in pairs if point.step <= (fit.stalls_at or 0)]
    known = [number for number in stalled if number is not None]
    if known and len(known) == len(stalled):
        printed = 10.0 ** -max(known)
        if printed / _OF_DIGITS <= (fit.level or 0.0) <= printed * _OF_DIGITS:
            return Stall.DIGITS
    return Stall.OTHER
