"""Steps from a start to the requested times, and the decision to raise the precision."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from decimal import MAX_EMAX, MIN_EMIN, Decimal, localcontext
from fractions import Fraction
from math import ceil
from statistics import median
from typing import Final

from flint import arb, arb_mat, ctx

from taylor_verify.exact.balls import ball
from taylor_verify.exact.enclosure.box import Box, carried, identity, inverted, within
from taylor_verify.exact.enclosure.crossing import Touched
from taylor_verify.exact.enclosure.flow import Flow
from taylor_verify.exact.enclosure.operations import Domain
from taylor_verify.exact.enclosure.placing import Place
from taylor_verify.exact.enclosure.step import Step, Stepper, size_of
from taylor_verify.exact.enclosure.system import System
from taylor_verify.exact.enclosure.tube import BOUND_BITS, StepTooLong
from taylor_verify.exact.solution import Unsettled
from taylor_verify.numbers.precision import float_text, power_of_two
from taylor_verify.records.faults import shown

MOST_STEPS: Final = 1_000_000
# A box this large, as a power of two of its vector, is lost: further steps would shrink without end.
_LOST: Final = -10
_SHRUNK: Final = -20
_SEVERAL: Final = 16
# Flat steps in a row: a kink that is crossed takes one or two.
_MOST_FLAT: Final = 8
_TOUCHED: Final = "a kink may be touched and not crossed"
# Progress messages for callers that wait.
_progress: Final = logging.getLogger("taylor_verify.progress")
_DIGITS_PER_BIT: Final = Fraction(301, 1000)


class Coarse(ArithmeticError):
    """The motion cannot be followed to its end at this precision; ``bits`` may suffice.

    ``stuck`` is the first time that was not reached though the box was narrow, and ``because`` says why;
    None where the box was lost.
    """

    def __init__(self, bits: int, stuck: Fraction | None = None, because: str = "") -> None:
        super().__init__()
        self.bits, self.stuck, self.because = bits, stuck, because


class Unreached(Unsettled):
    """More steps or more bits would be needed than there may be; ``time`` is the first one to need them."""

    def __init__(self, because: str, time: Fraction) -> None:
        super().__init__(because)
        self.time = time


@dataclass(frozen=True)
class Row:
    """The state at one time in balls. ``turn`` is R, nine entries row by row, and may be empty.

    ``largest`` is log2 of the largest size so far of each block of the state, and last of the centre. A
    block is as large as the terms of its rate make it in a step, though they may cancel. ``since`` is the
    derivative of the state by the one at the row before it, or at the start, if the course has derivatives.
    """

    state: list[arb]
    turn: list[arb]
    centre: list[arb] | None
    largest: tuple[float, ...]
    since: arb_mat | None = None


class _Since:
    """The derivative of the state by the one at the last row, carried from step to step."""

    def __init__(self, size: int) -> None:
        self._steps, self._from = identity(size), identity(size)

    def at_row(self, flow: Flow, share: arb) -> arb_mat:
        """The derivative at a row, from which the next one counts."""
        self.to(flow, share)
        reached, self._steps = self._steps, identity(self._steps.nrows())
        self._from = flow.at(share)
        return reached

    def to(self, flow: Flow, share: arb) -> None:
        self._steps = flow.at(share) * inverted(self._from) * self._steps
        self._from = identity(self._steps.nrows())


@dataclass(frozen=True)
class Course:
    """Steps from a start, away from it, at one precision; to be used at that precision.

    ``start`` are balls about the state; ``place`` is the frame there, or None where it is not tracked.
    More than ``most_bits`` bits, or ``most_steps`` steps, are never asked for. ``begin`` is what a clock
    shows at the start, for messages alone; ``origin`` is the start's time since that of the scene.
    With ``differentiates`` the rows have derivatives; then no component of the start is exact.
    """

    stepper: Stepper
    start: Sequence[arb]
    place: Place | None
    bits: int
    most_bits: int
    most_steps: int = MOST_STEPS
    begin: Fraction = Fraction(0)
    origin: Fraction = Fraction(0)
    differentiates: bool = False

    @classmethod
    def of(
        cls, system: System, start: Sequence[arb], place: Place | None, bits: int, most_bits: int
    ) -> Course:
        """The course of a system, at the ambient precision of ``bits`` bits."""
        has_centre = place is not None and place.centre is not None
        stepper = Stepper.of(system, place is not None, has_centre)
        return cls(stepper, start, place, bits, most_bits)

    @property
    def system(self) -> System:
        return self.stepper.system

    def first_row(self) -> Row:
        """The start itself."""
        turn, centre = ([], None) if self.place is None else self.place.balls()
        return Row(list(self.start), turn, centre, self._largest(Box.about(self.start), self.place))

    def _largest(self, box: Box, place: Place | None) -> tuple[float, ...]:
        """log2 of the size of each block, and of the centre."""
        centre = [] if place is None or place.centre is None else place.centre
        sizes = [size_of(box.point, span) for span in self.system.spans]
        return (*sizes, size_of(centre, range(len(centre))))

    def rows(self, times: Sequence[Fraction]) -> Iterator[tuple[Fraction, Row]]:
        """The state at these times, which go away from zero on one side.

        Raises Coarse where more bits are needed, and Unreached where more than a million steps, or
        more than ``most_bits`` bits, would be. What was yielded until then stands.
        """
        box, place = Box.about(self.start), self.place
        now, last = Fraction(0), times[-1]
        pending, lengths, length = list(times[::-1]), [], last
        usual, flat = last, 0
        largest = self._largest(box, place)
        since = _Since(self.system.size) if self.differentiates else None
        while pending:
            step = self._step(box, now, length, pending)
            largest = tuple(map(max, zip(largest, self._terms(step), strict=True)))
            while pending and abs(pending[-1] - now) <= abs(step.length):
                time = pending.pop()
                share = ball((time - now) / step.length)
                row = self._row(box, place, step, share, time, largest)
                if since is not None and step.flow is not None:
                    row = replace(row, since=since.at_row(step.flow, share))
                yield time, row
            if since is not None and step.flow is not None:
                since.to(step.flow, arb(1))
            box = carried(box, step.state, step.tube, step.flow, self.system.spans)
            place = None if place is None or step.leg is None else step.leg.carried(place)
            largest = tuple(map(max, zip(largest, self._largest(box, place), strict=True)))
            now, length = now + step.length, 2 * (usual if step.is_flat else step.length)
            usual = length / 2
            if _progress.isEnabledFor(logging.INFO):
                percent = float(100 * now / last)
                _progress.info("%.0f %% of the time, with %d bits", percent, self.bits)
            flat = flat + 1 if step.is_flat else 0
            if flat > _MOST_FLAT and pending:
                raise self._stuck(_TOUCHED, now, pending)
            if not step.is_flat:
                lengths.append(abs(step.length))
            if pending and lengths:
                self._watch(box, largest, lengths, now, pending)

    def _step(self, box: Box, now: Fraction, guess: Fraction, pending: Sequence[Fraction]) -> Step:
        """The next step, towards the last of the pending times, which stands first."""
        try:
            return self.stepper.step(box, self.origin + now, guess, pending[0] - now)
        except StepTooLong:
            raise self._stuck("the bounds of no step close", now, pending) from None
        except Touched:
            raise self._stuck(_TOUCHED, now, pending) from None
        except Domain as end:
            because = f"{end} near t = {float_text(self.begin + now)}"
            raise Unreached(because, pending[-1]) from end

    def _row(
        self,
        box: Box,
        place: Place | None,
        step: Step,
        share: arb,
        time: Fraction,
        largest: tuple[float, ...],
    ) -> Row:
        """The row at a time, which is at this share of a step."""
        state = within(box, step.state, step.tube, step.flow, share)
        frame = None if place is None or step.leg is None else step.leg.place(place, share)
        turn, centre = ([], None) if frame is None else frame.balls()
        if centre is not None and self.system.current:
            drift = self.system.current
            centre = [c + ball(v * time) for c, v in zip(centre, drift, strict=True)]
        return Row(state, turn, centre, largest)

    def _terms(self, step: Step) -> tuple[float, ...]:
        """log2 of what the terms of the rates make of each block in a step, none cancelled."""
        with ctx.workprec(BOUND_BITS):
            added = [size * ball(step.length) for size in step.terms]
        return (*(size_of(added, span) for span in self.system.spans), float("-inf"))

    # When to stop.

    def _stuck(self, because: str, now: Fraction, pending: Sequence[Fraction]) -> Coarse:
        """The exception for a motion that cannot be followed from here, with however many bits."""
        return Coarse(
            2 * self.bits, pending[-1], f"{because} near t = {float_text(self.begin + now)}"
        )

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
            if size_of(apart, span) > largest[k] + _LOST:
                raise Coarse(self._needed(now, pending))
        if len(lengths) % _SEVERAL == 0:
            usual = median(lengths[-8 * _SEVERAL :])
            if lengths[-1] < usual * power_of_two(_SHRUNK):
                if self._is_narrow(box):
                    because = (
                        "steps become ever shorter, as where a motion ends or a kink is touched,"
                    )
                    raise self._stuck(because, now, pending)
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

    def _is_narrow(self, box: Box) -> bool:
        """True if half of the bits are right in every block."""
        apart = box.apart.entries()
        return all(
            size_of(apart, span) <= size_of(box.point, span) - self.bits / 2
            for span in self.system.spans
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


def _brief(value: Fraction) -> str:
    """Two digits of a number of any size."""
    with localcontext(Emax=MAX_EMAX, Emin=MIN_EMIN):
        return f"{Decimal(value.numerator) / Decimal(value.denominator):.2g}"
