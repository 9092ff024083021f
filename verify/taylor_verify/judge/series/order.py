"""Order of convergence of each quantity, from files of one solver at several steps.

An order needs errors clearly above roundoff, and steps between which the local order is the same. Other
observations are reported in words: a lower order at smaller steps, a file whose step does not fit, the
step below which roundoff dominates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from math import exp, isfinite, log, log10, sqrt
from typing import TYPE_CHECKING, Final

from taylor_verify.records.answers import Order, OrderPoint, Stall
from taylor_verify.records.json_text import finite
from taylor_verify.records.observed_order import (
    CLEAR,
    SAME,
    Convergence,
    convergence,
    local_orders,
)
from taylor_verify.records.quantities import COMPLETE, INITIAL, SOUND_ATTITUDE
from taylor_verify.records.status import Status

if TYPE_CHECKING:
    from taylor_verify.judge.files.judgement import FileJudgement
    from taylor_verify.records.verdict import Verdict

_NOT_OF_THE_STEP: Final = (INITIAL, COMPLETE, *SOUND_ATTITUDE)
# The step of an integrator, in the sentences.
STEP: Final = "h"
# Without the suspect, three files are needed to show an order.
_FEWEST_WITH_A_SUSPECT: Final = 4
# An error within this factor of 10^-d is explained by d printed digits.
_OF_DIGITS: Final = 30.0


@dataclass(frozen=True)
class Sample:
    """A file and the step of the integrator that wrote it."""

    judged: FileJudgement
    step: float
    is_step: bool = True

    def row(self, quantity: str) -> Verdict | None:
        """Return the verdict on a quantity; None if its error was not measured."""
        for verdict in self.judged.verdicts:
            if verdict.quantity == quantity and verdict.is_compared:
                return None if verdict.verdict is Status.UNDECIDED else verdict
        return None

    @property
    def times(self) -> tuple[Fraction, ...]:
        """Times of the rows."""
        return self.judged.file.times

    @property
    def roundings(self) -> float:
        """Ratio of the floor for the integrator's steps to that for one step per row; 1 if not known."""
        if not self.is_step:
            return 1.0
        steps = float(abs(self.times[-1] - self.times[0])) / self.step
        return sqrt(max(1.0, steps / len(self.times)))


def orders(samples: Sequence[Sample], knob: str = STEP) -> tuple[Order, ...]:
    """Return the order of every quantity that depends on the step, in the order of the verdicts.

    Raises ValueError for two files with the same step.
    """
    samples = sorted(samples, key=lambda sample: -sample.step)
    verdicts = (v for sample in samples for v in sample.judged.verdicts if v.is_compared)
    names = dict.fromkeys(v.quantity for v in verdicts if v.quantity not in _NOT_OF_THE_STEP)
    return tuple(_order(name, samples, knob) for name in names)


def _order(quantity: str, samples: Sequence[Sample], knob: str) -> Order:
    rows = [sample.row(quantity) for sample in samples]
    unit = next((row.unit for row in rows if row is not None), "")
    points = tuple(_points(samples, rows))
    fit = convergence(
        [point.step for point in points],
        [point.error for point in points],
        [point.attainable or 0.0 for point in points],
    )
    # Errors of the method itself: far above roundoff, and above the level at which errors stall.
    clear = [
        point
        for point in points
        if point.error
        and point.error > CLEAR * max(point.attainable or 0.0, fit.level or 0.0)
        and (fit.stalls_at is None or point.step > fit.stalls_at)
    ]
    order = Order(quantity, unit, points, "", knob=knob)
    measured = [point for point in points if point.error is not None]
    if measured:
        best = min(measured, key=lambda point: point.error or 0.0)
        order = replace(order, best_step=best.step, best_error=best.error)
    if fit.level is not None:
        order = replace(order, stalls_at=fit.stalls_at, stall=_stall(fit, samples))
    order = _with_order(order, fit, clear)
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
    for i, (before, after) in enumerate(pairwise(_locals(points)), start=1):
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


def _locals(points: Sequence[OrderPoint]) -> tuple[float, ...]:
    return local_orders([p.step for p in points], [p.error or 0.0 for p in points])


def _stall(fit: Convergence, samples: Sequence[Sample]) -> Stall:
    """Return the reason why errors stop falling below the best step."""
    if fit.by_rounding:
        return Stall.ROUNDOFF
    stalled = [sample for sample in samples if sample.step <= (fit.stalls_at or 0)]
    digits = [sample.judged.file.digits for sample in stalled]
    known = [number for number in digits if number is not None]
    if known and len(known) == len(digits):
        printed = 10.0 ** -max(known)
        if printed / _OF_DIGITS <= (fit.level or 0.0) <= printed * _OF_DIGITS:
            return Stall.DIGITS
    return Stall.OTHER


# The words.


def _sentences(order: Order, clear: Sequence[OrderPoint]) -> Iterator[str]:
    if all(_is_at_the_floor(point) for point in order.points if point.error is not None):
        yield f"{order.quantity}: no order shows, because the error is near roundoff at every step"
        return
    yield f"{order.quantity}: {_order_words(order, clear)}"
    if order.best_step is not None and order.best_error is not None:
        best = f"best {order.knob} = {order.best_step:g} with {_accuracy(order, order.best_error)}"
        yield f"{best}{_below_the_best(order, order.best_step, order.best_error)}"


def _is_at_the_floor(point: OrderPoint) -> bool:
    return point.error is not None and point.error <= CLEAR * (point.attainable or 0.0)


def _order_words(order: Order, clear: Sequence[OrderPoint]) -> str:
    if order.order is not None and order.high is not None and order.largest is not None:
        spread = order.high - order.order
        uncertain = f" ± {spread:.1f}" if spread >= 0.05 else ""
        steps = f"from {order.knob} = {order.largest:g} to {order.smallest:g}"
        # Larger steps may not be asymptotic, or may hide a lower order.
        larger = _locals([point for point in clear if point.step >= order.largest])
        local_orders = ", ".join(f"{local:.1f}" for local in larger)
        left_out = f" ({local_orders} at larger steps)" if local_orders else ""
        return f"order {order.order:.1f}{uncertain} {steps}{left_out}"
    between = [f"{local:.1f}" for local in _locals(clear)]
    no_fit = f"no one order fits: from step to step it is {', '.join(between)}"
    if order.suspect is not None and order.suspect_step is not None:
        labelled = next(p.step for p in order.points if p.file == order.suspect)
        return (
            f"{no_fit}; the others agree without {order.suspect}, whose error is that of "
            f"{order.knob} = {order.suspect_step:g} and not of {labelled:g}"
        )
    if len(between) >= 2:
        return no_fit
    if between:
        large, small = clear[0].step, clear[-1].step
        pair = f"between {order.knob} = {large:g} and {small:g}"
        return f"order {between[0]} {pair}, which no third step confirms"
    level = "roundoff" if order.stall is None else "the level at which errors stop falling"
    return f"no order shows, because fewer than two steps have an error well above {level}"


def _accuracy(order: Order, error: float) -> str:
    if order.unit == "rad":
        return f"an error of {error:.1e} rad"
    if not error > 0 or not isfinite(error):
        return "no error"
    return f"{max(0.0, -log10(error)):.1f} digits"


def _below_the_best(order: Order, step: float, error: float) -> str:
    """Return the course of the error at steps smaller than the best one, in words."""
    if order.stall is None or order.stalls_at is None:
        last = order.points[-1]
        falls = "near roundoff" if _is_at_the_floor(last) else "the error still falls"
        return f", the smallest: {falls}" if step == last.step else ""
    place = (
        "below it" if order.stalls_at == step else f"from {order.knob} = {order.stalls_at:g} down"
    )
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
