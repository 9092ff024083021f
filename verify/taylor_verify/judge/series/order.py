"""The order of convergence of each quantity, from files of one solver at several steps.

Only errors that are clear of roundoff show an order, and only steps between which it is the same. What is
left of that is said: a lower order at smaller steps, a file whose step does not fit, the step below which
roundoff takes over.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from math import exp, isfinite, log, log10, sqrt
from typing import TYPE_CHECKING, Final

from taylor_verify.records.answers import Order, OrderPoint, Stall
from taylor_verify.records.convergence import (
    CLEAR,
    SAME,
    Convergence,
    convergence,
    local_orders,
)
from taylor_verify.records.json_text import finite
from taylor_verify.records.quantities import COMPLETE, INITIAL, UNIT_QUATERNION
from taylor_verify.records.status import Status

if TYPE_CHECKING:
    from taylor_verify.judge.files.judgement import FileJudgement
    from taylor_verify.records.verdict import Verdict

_NOT_OF_THE_STEP: Final = (INITIAL, COMPLETE, UNIT_QUATERNION)
# Three others show an order without the file that is in doubt.
_FEWEST_WITH_A_SUSPECT: Final = 4
# An error is that of d printed digits within this factor of 10^-d.
_OF_DIGITS: Final = 30.0


@dataclass(frozen=True)
class Sample:
    """A file and the step of the integrator that wrote it."""

    judged: FileJudgement
    step: float

    def row(self, quantity: str) -> Verdict | None:
        """Return the verdict on a quantity; None where its error was not measured."""
        for verdict in self.judged.verdicts:
            if verdict.quantity == quantity and verdict.is_compared:
                return None if verdict.verdict is Status.UNDECIDED else verdict
        return None

    @property
    def times(self) -> tuple[Fraction, ...]:
        """The times of the rows."""
        return self.judged.file.times

    @property
    def roundings(self) -> float:
        """The factor by which the floor of so many steps is above that of a step for each row."""
        steps = float(abs(self.times[-1] - self.times[0])) / self.step
        return sqrt(max(1.0, steps / len(self.times)))


def orders(samples: Sequence[Sample]) -> tuple[Order, ...]:
    """Return the order of every quantity that all steps might share, in the order of the verdicts.

    Raises ValueError for two files of one step.
    """
    samples = sorted(samples, key=lambda sample: -sample.step)
    verdicts = (v for sample in samples for v in sample.judged.verdicts if v.is_compared)
    names = dict.fromkeys(v.quantity for v in verdicts if v.quantity not in _NOT_OF_THE_STEP)
    return tuple(_order(name, samples) for name in names)


def _order(quantity: str, samples: Sequence[Sample]) -> Order:
    rows = [sample.row(quantity) for sample in samples]
    unit = next((row.unit for row in rows if row is not None), "")
    points = tuple(_points(samples, rows))
    found = convergence(
        [point.step for point in points],
        [point.error for point in points],
        [point.attainable or 0.0 for point in points],
    )
    # Errors of the method: far above roundoff, and above the level where errors stall.
    clear = [
        point
        for point in points
        if point.error
        and point.error > CLEAR * max(point.attainable or 0.0, found.level or 0.0)
        and (found.stalls_at is None or point.step > found.stalls_at)
    ]
    order = Order(quantity, unit, points, "")
    measured = [point for point in points if point.error is not None]
    if measured:
        best = min(measured, key=lambda point: point.error or 0.0)
        order = replace(order, best_step=best.step, best_error=best.error)
    if found.level is not None:
        order = replace(order, stalls_at=found.stalls_at, stall=_stall(found, samples))
    order = _with_order(order, found, clear)
    return replace(order, sentence="; ".join(_sentences(order, clear)))


def _points(samples: Sequence[Sample], rows: Sequence[Verdict | None]) -> Iterator[OrderPoint]:
    before: tuple[float, float] | None = None
    for sample, row in zip(samples, rows, strict=True):
        error = finite(row.max) if row is not None else None
        floor = row.attainable if row is not None else None
        floor = None if floor is None else finite(floor * sample.roundings)
        local = None
        if error and before:
            (local,) = local_orders((before[0], sample.step), (before[1], error))
        before = (sample.step, error) if error else None
        yield OrderPoint(sample.judged.file.name, sample.step, error, floor, local)


# The order, and the file that does not fit.


def _with_order(order: Order, found: Convergence, clear: Sequence[OrderPoint]) -> Order:
    fits = {point.step for point in clear} <= {*found.steps}
    if not fits and (suspect := _suspect(clear)) is not None:
        file, step = suspect
        return replace(order, suspect=file, suspect_step=step)
    beyond = [point for point in clear if found.steps and point.step < found.steps[-1]]
    if beyond:
        # What smaller steps show counts: a lower order comes out below a higher one.
        found = _read(beyond)
    if found.order is None or found.spread is None:
        return order
    return replace(
        order,
        order=found.order,
        low=found.order - found.spread,
        high=found.order + found.spread,
        largest=found.steps[0],
        smallest=found.steps[-1],
    )


def _read(points: Sequence[OrderPoint]) -> Convergence:
    return convergence([point.step for point in points], [point.error for point in points])


def _suspect(points: Sequence[OrderPoint]) -> tuple[str, float] | None:
    """Return the one file without which all others agree, and the step that its error would fit.

    A wrong step makes one of its two local orders too high and the other too low. Errors that are not
    asymptotic yet depart to one side alone.
    """
    if len(points) < _FEWEST_WITH_A_SUSPECT:
        return None
    for i, (before, after) in enumerate(pairwise(_locals(points)), start=1):
        others = [*points[:i], *points[i + 1 :]]
        found = _read(others)
        if found.order is None or len(found.steps) < len(others):
            continue
        low, high = sorted((before - found.order, after - found.order))
        if low < -SAME and high > SAME:
            near, point = points[i - 1], points[i]
            fall = log((point.error or 1.0) / (near.error or 1.0))
            return point.file, float(f"{near.step * exp(fall / found.order):.3g}")
    return None


def _locals(points: Sequence[OrderPoint]) -> tuple[float, ...]:
    return local_orders([p.step for p in points], [p.error or 0.0 for p in points])


def _stall(found: Convergence, samples: Sequence[Sample]) -> Stall:
    """The reason why errors stop falling below the best step."""
    if found.by_rounding:
        return Stall.ROUNDOFF
    stalled = [sample for sample in samples if sample.step <= (found.stalls_at or 0)]
    digits = [sample.judged.file.digits for sample in stalled]
    known = [number for number in digits if number is not None]
    if known and len(known) == len(digits):
        printed = 10.0 ** -max(known)
        if printed / _OF_DIGITS <= (found.level or 0.0) <= printed * _OF_DIGITS:
            return Stall.DIGITS
    return Stall.OTHER


# The words.


def _sentences(order: Order, clear: Sequence[OrderPoint]) -> Iterator[str]:
    if all(_is_at_the_floor(point) for point in order.points if point.error is not None):
        yield f"{order.quantity}: no order shows, because the error is near roundoff at every step"
        return
    yield f"{order.quantity}: {_order_words(order, clear)}"
    if order.best_step is not None and order.best_error is not None:
        best = f"best h = {order.best_step:g} with {_accuracy(order, order.best_error)}"
        yield f"{best}{_below_the_best(order, order.best_step, order.best_error)}"


def _is_at_the_floor(point: OrderPoint) -> bool:
    return point.error is not None and point.error <= CLEAR * (point.attainable or 0.0)


def _order_words(order: Order, clear: Sequence[OrderPoint]) -> str:
    if order.order is not None and order.high is not None and order.largest is not None:
        spread = order.high - order.order
        uncertain = f" ± {spread:.1f}" if spread >= 0.05 else ""
        steps = f"from h = {order.largest:g} to {order.smallest:g}"
        # Larger steps are not asymptotic or hide a lower order.
        larger = _locals([point for point in clear if point.step >= order.largest])
        seen = ", ".join(f"{local:.1f}" for local in larger)
        left_out = f" ({seen} at larger steps)" if seen else ""
        return f"order {order.order:.1f}{uncertain} {steps}{left_out}"
    between = [f"{local:.1f}" for local in _locals(clear)]
    no_fit = f"no one order fits: from step to step it is {', '.join(between)}"
    if order.suspect is not None and order.suspect_step is not None:
        labelled = next(p.step for p in order.points if p.file == order.suspect)
        return (
            f"{no_fit}; the others agree without {order.suspect}, whose error is that of "
            f"h = {order.suspect_step:g} and not of {labelled:g}"
        )
    if len(between) >= 2:
        return no_fit
    if between:
        large, small = clear[0].step, clear[-1].step
        return (
            f"order {between[0]} between h = {large:g} and {small:g}, which no third step confirms"
        )
    level = "roundoff" if order.stall is None else "the level at which errors stop falling"
    return f"no order shows, because fewer than two steps have an error well above {level}"


def _accuracy(order: Order, error: float) -> str:
    if order.unit == "rad":
        return f"an error of {error:.1e} rad"
    if not error > 0 or not isfinite(error):
        return "no error"
    return f"{max(0.0, -log10(error)):.1f} digits"


def _below_the_best(order: Order, step: float, error: float) -> str:
    """The course of the error at smaller steps than the best one, in words."""
    if order.stall is None or order.stalls_at is None:
        last = order.points[-1]
        falls = "near roundoff" if _is_at_the_floor(last) else "the error still falls"
        return f", the smallest: {falls}" if step == last.step else ""
    place = "below it" if order.stalls_at == step else f"from h = {order.stalls_at:g} down"
    if order.stall is Stall.ROUNDOFF:
        return f"; {place} roundoff takes over"
    if order.stall is Stall.DIGITS:
        return f"; {place} the error is that of the printed digits"
    floors = [p.attainable for p in order.points if p.attainable and p.step == step]
    above = f" {error / floors[0]:.0e} times what roundoff leaves" if floors and error else ""
    return (
        f"; {place} the error falls no longer, at{above}: a lower precision inside, or an error that no "
        "step removes"
    )
