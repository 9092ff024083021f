"""Steps from a start to the requested times, and the decision to raise the precision."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import MAX_EMAX, MIN_EMIN, Decimal, localcontext
from fractions import Fraction
from math import ceil, log2
from statistics import median
from typing import Final

from flint import arb, ctx

from taylor_verify.exact.balls import ball
from taylor_verify.exact.enclosure.box import Box, Flow, carried, exponent, flow, within
from taylor_verify.exact.enclosure.coefficients import (
    Series,
    frame_series,
    scaled,
    state_series,
    value,
)
from taylor_verify.exact.enclosure.placing import Leg, Place, leg
from taylor_verify.exact.enclosure.system import Balls, System, column, magnitudes
from taylor_verify.exact.enclosure.tube import (
    BOUND_BITS,
    StepTooLong,
    Tube,
    rates_of_change,
    tube,
)
from taylor_verify.exact.solution import Unsettled
from taylor_verify.scenes.precision import floor_log2, power_of_two
from taylor_verify.scenes.reading.faults import shown

# If the convolutions dominate the cost, the cheapest steps are the radius of convergence over e^2, with
# bits ln 2/2 orders. Work that is done once per order or once per step makes higher orders cheaper.
_ORDERS_PER_BIT: Final = 0.42
_STEP_BITS: Final = 8
# Near a steady motion the series converges everywhere, and the bounds do not close.
_MOST_GROWTH: Final = 5.0
_LEAST_CUT: Final = 0.25
_HALVINGS: Final = 30
# A step that nearly reaches the end is extended to the end.
_NEARLY: Final = Fraction(63, 64)
MOST_STEPS: Final = 1_000_000
# A box this large, as a power of two of its vector, is lost: further steps would shrink without end.
_LOST: Final = -10
_SHRUNK: Final = -20
_SEVERAL: Final = 16
# Progress messages for callers that wait.
_progress: Final = logging.getLogger("taylor_verify.progress")
_DIGITS_PER_BIT: Final = Fraction(301, 1000)


class Coarse(ArithmeticError):
    """The motion cannot be followed to its end at this precision; ``bits`` may suffice.

    ``stuck`` is the first time that was not reached because the bounds of a step did not close, however
    short it was; None where these closed.
    """

    def __init__(self, bits: int, stuck: Fraction | None = None) -> None:
        super().__init__()
        self.bits, self.stuck = bits, stuck


class Unreached(Unsettled):
    """More steps or more bits would be needed than there may be; ``time`` is the first one to need them."""

    def __init__(self, because: str, time: Fraction) -> None:
        super().__init__(because)
        self.time = time


@dataclass(frozen=True)
class Row:
    """The state at one time in balls. ``turn`` is R, nine entries row by row, and may be empty.

    ``largest`` is log2 of the largest size so far of each block of the state, and last of the centre. A
    block is as large as the terms of its rate make it in a step, though they may cancel.
    """

    state: list[arb]
    turn: list[arb]
    centre: list[arb] | None
    largest: tuple[float, ...]


@dataclass(frozen=True)
class _Step:
    """A step of length h from a box, and everything that is known about the motion within it."""

    length: Fraction
    state: Series
    tube: Tube
    flow: Flow | None
    leg: Leg | None


@dataclass(frozen=True)
class Course:
    """Steps from a start, away from it, at one precision; to be used at that precision.

    ``start`` are balls about the state; ``place`` is the frame there, or None where it is not tracked.
    More than ``most_bits`` bits, or ``most_steps`` steps, are never asked for. ``begin`` is what a clock
    shows at the start, for messages alone.
    """

    system: System
    balls: Balls
    bounds: Balls
    start: Sequence[arb]
    place: Place | None
    bits: int
    most_bits: int
    most_steps: int = MOST_STEPS
    begin: Fraction = Fraction(0)

    @classmethod
    def of(
        cls, system: System, start: Sequence[arb], place: Place | None, bits: int, most_bits: int
    ) -> Course:
        """The course of a system, at the ambient precision of ``bits`` bits."""
        coefficients = Balls.of(system)
        with ctx.workprec(BOUND_BITS):
            bounds = coefficients.magnitudes()
        return cls(system, coefficients, bounds, start, place, bits, most_bits)

    @property
    def order(self) -> int:
        return ceil(_ORDERS_PER_BIT * self.bits) + 2

    def first_row(self) -> Row:
        """The start itself."""
        turn, centre = ([], None) if self.place is None else self.place.balls()
        return Row(list(self.start), turn, centre, self._largest(Box.about(self.start), self.place))

    def _largest(self, box: Box, place: Place | None) -> tuple[float, ...]:
        """log2 of the size of each block, and of the centre."""
        centre = [] if place is None or place.centre is None else place.centre
        sizes = [_size(box.point, span) for span in self.system.spans]
        return (*sizes, _size(centre, range(len(centre))))

    def rows(self, times: Sequence[Fraction]) -> Iterator[tuple[Fraction, Row]]:
        """The state at these times, which go away from zero on one side.

        Raises Coarse where more bits are needed, and Unreached where more than a million steps, or
        more than ``most_bits`` bits, would be. What was yielded until then stands.
        """
        box, place = Box.about(self.start), self.place
        now, last = Fraction(0), times[-1]
        pending, lengths, length = list(times[::-1]), [], last
        largest = self._largest(box, place)
        while pending:
            try:
                step = self._step(box, length, last - now)
            except StepTooLong:
                raise Coarse(2 * self.bits, stuck=pending[-1]) from None
            largest = tuple(map(max, zip(largest, self._terms(step), strict=True)))
            while pending and abs(pending[-1] - now) <= abs(step.length):
                time = pending.pop()
                share = ball((time - now) / step.length)
                state = within(box, step.state, step.tube, step.flow, share)
                frame = None if place is None or step.leg is None else step.leg.place(place, share)
                turn, centre = ([], None) if frame is None else frame.balls()
                yield time, Row(state, turn, centre, largest)
            box = carried(box, step.state, step.tube, step.flow, self.system.spans)
            place = None if place is None or step.leg is None else step.leg.carried(place)
            largest = tuple(map(max, zip(largest, self._largest(box, place), strict=True)))
            now, length = now + step.length, 2 * step.length
            if _progress.isEnabledFor(logging.INFO):
                percent = float(100 * now / last)
                _progress.info("%.0f %% of the time, with %d bits", percent, self.bits)
            lengths.append(abs(step.length))
            if pending:
                self._watch(box, largest, lengths, now, pending)

    def _terms(self, step: _Step) -> tuple[float, ...]:
        """log2 of what the terms of the rates make of each block in a step, none cancelled."""
        with ctx.workprec(BOUND_BITS):
            point = magnitudes(column(step.state[0]))
            terms = self.bounds.hessian * column((point * point.transpose()).entries())
            added = (terms * ball(step.length)).entries()
        return (*(_size(added, span) for span in self.system.spans), float("-inf"))

    # One step.

    def _step(self, box: Box, guess: Fraction, left: Fraction) -> _Step:
        system, bounds = self.balls, self.bounds
        first = self._first(box, guess, left)
        state, frame = self._series(box, ball(first))
        length = self._fitted(box, state, frame, first, left)
        state, frame = (scaled(series, ball(length / first)) for series in (state, frame))
        for _ in range(_HALVINGS):
            h = ball(length)
            with ctx.workprec(BOUND_BITS):
                sizes = [[z.abs_upper() for z in row] for row in state]
                try:
                    step_tube = tube(bounds, sizes, h.abs_upper(), box.apart)
                    moving = None
                    if not box.is_point:
                        moving = flow(system, bounds, box, state, sizes, h, step_tube)
                except StepTooLong:
                    step_tube = None
            if step_tube is not None:
                frame_leg = None
                if frame:
                    frame_leg = leg(system, bounds, state, frame, h, step_tube, moving, box)
                return _Step(length, state, step_tube, moving, frame_leg)
            length = length / 2
            state, frame = (scaled(series, arb(1) / 2) for series in (state, frame))
        raise StepTooLong

    def _series(self, box: Box, h: arb) -> tuple[Series, Series]:
        """The coefficients of the state and of the frame, which has none where it is not tracked."""
        state = state_series(self.balls, box.point, h, self.order)
        if self.place is None:
            return state, []
        return state, frame_series(self.balls, state, h, self.place.centre is not None)

    def _first(self, box: Box, guess: Fraction, left: Fraction) -> Fraction:
        """A length at which the coefficients are no giants: no guess can make a result wrong."""
        with ctx.workprec(BOUND_BITS):
            growth = self._growth(box.point)
        length = guess if abs(guess) < abs(left) else left
        if growth == float("-inf"):
            return length
        limit = power_of_two(ceil(-growth))
        return length if abs(length) <= limit else limit * (1 if left > 0 else -1)

    def _growth(self, point: Sequence[arb]) -> float:
        """log2 of the spectral radius of |dF/dz| there, within a factor of n^(1/8); -inf of none.

        The trace of an eighth power does not depend on the units of the components.
        """
        power = rates_of_change(self.bounds, magnitudes(column(point)))
        for _ in range(3):
            power = power * power
        trace = power.trace()
        return float("-inf") if trace.is_zero() else exponent(trace) / 8

    def _fitted(
        self, box: Box, state: Series, frame: Series, length: Fraction, left: Fraction
    ) -> Fraction:
        """The length at which the last coefficients fall below the last bit."""
        both = [z + turn for z, turn in zip(state, frame, strict=True)] if frame else state
        factor = min(self._root_test(both), _log2(left) - _log2(length))
        is_constant = all(entry.is_zero() for row in state[1:] for entry in row)
        if not (box.is_point and is_constant):
            with ctx.workprec(BOUND_BITS):
                factor = self._bounded(state, length, factor)
        fitted = _cut(length, factor)
        return left if abs(fitted) >= abs(left) * _NEARLY else fitted

    def _bounded(self, state: Series, length: Fraction, factor: float) -> float:
        """The factor, or less where the linearised motion would outgrow the bounds within the step."""
        sizes = [list(map(arb.abs_upper, row)) for row in state]
        while True:
            most = value(sizes, _power(factor))
            excess = self._growth(most) + _log2(length) + factor - log2(_MOST_GROWTH)
            if excess <= 0:
                return factor
            # The reach may itself grow with the length.
            factor -= max(excess / 2, _LEAST_CUT)

    def _root_test(self, series: Series) -> float:
        """log2 of the factor by which the length may grow; infinite where the series has ended.

        Rows of the state, and of the turn beside it where the frame is tracked.
        """
        factor, n = float("inf"), self.system.size
        for span in (*self.system.spans, range(n, min(n + 4, len(series[0])))):
            # The size of the block, or of its first change.
            sizes = (_size(row, span) for row in series[:3])
            size = next((size for size in sizes if size > float("-inf")), float("-inf"))
            for k in range(max(1, self.order - 2), self.order + 1):
                last = _size(series[k], span)
                if last > float("-inf"):
                    factor = min(factor, (size - self.bits - last) / k)
        return factor

    # When to stop.

    def _watch(
        self,
        box: Box,
        largest: Sequence[float],
        lengths: Sequence[Fraction],
        now: Fraction,
        pending: Sequence[Fraction],
    ) -> None:
        """Raise Coarse where the box is lost: as large as the motion, or steps that end nowhere.

        Raises Unreached where there would be too many steps. ``pending`` has the nearest time last.
        """
        apart = box.apart.entries()
        for k, span in enumerate(self.system.spans):
            if _size(apart, span) > largest[k] + _LOST:
                raise Coarse(self._needed(now, pending))
        if len(lengths) % _SEVERAL == 0:
            usual = median(lengths[-8 * _SEVERAL :])
            if lengths[-1] < usual * power_of_two(_SHRUNK):
                raise Coarse(self._needed(now, pending))
            limit = abs(now) + (self.most_steps - len(lengths)) * usual
            if abs(pending[0]) > limit:
                time = next(time for time in reversed(pending) if abs(time) > limit)
                steps = len(lengths) + abs(time - now) / usual
                raise Unreached(
                    f"the Taylor series would take about {_brief(steps)} steps to reach "
                    f"t = {self._shown(time)}; expected at most {self.most_steps}",
                    time,
                )

    def _needed(self, lost: Fraction, pending: Sequence[Fraction]) -> int:
        """The bits with which the box would reach the last time, if it grows as it did so far."""
        rate = self.bits / abs(lost)
        for time in reversed(pending):
            needed = ceil(rate * abs(time))
            if needed > self.most_bits:
                raise Unreached(
                    f"the motion loses about {_brief(rate * _DIGITS_PER_BIT)} digits per unit of time; "
                    f"t = {self._shown(time)} needs more than {self.most_bits} bits",
                    time,
                )
        return min(max(needed, self.bits * 5 // 4), 6 * self.bits)

    def _shown(self, time: Fraction) -> str:
        """The time on the clock, for a time since the start."""
        return shown(self.begin + time)


def _log2(length: Fraction) -> float:
    """log2 of a magnitude that no float needs to hold."""
    return log2(abs(length.numerator)) - log2(length.denominator)


def _power(exponent: float) -> arb:
    """An exact number near 2^exponent, of any size."""
    whole = int(exponent // 1)
    return arb(2.0 ** (exponent - whole)) * arb(2) ** whole


def _brief(value: Fraction) -> str:
    """Two digits of a number of any size."""
    with localcontext(Emax=MAX_EMAX, Emin=MIN_EMIN):
        return f"{Decimal(value.numerator) / Decimal(value.denominator):.2g}"


def _cut(length: Fraction, log2_factor: float) -> Fraction:
    """The length times 2^log2_factor, cut to so few bits that sums of lengths stay short."""
    whole = int(log2_factor // 1)
    wide = length * power_of_two(whole) * Fraction(2.0 ** (log2_factor - whole))
    unit = power_of_two(floor_log2(abs(wide)) - _STEP_BITS + 1)
    return int(wide / unit) * unit


def _size(entries: Sequence[arb], span: range) -> float:
    """log2 of the largest entry, rounded upwards; -inf of zeros."""
    sizes = [exponent(entries[i]) for i in span if not entries[i].abs_upper().is_zero()]
    return float(max(sizes, default=float("-inf")))
