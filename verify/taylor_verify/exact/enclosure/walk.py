"""The steps of a course, one after the other, and the rows of the times that they pass."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

from flint import arb, arb_mat, ctx

from taylor_verify.exact.enclosure.box import (
    Box,
    carried,
    identity,
    inverted,
    over_box,
    renewed,
    within,
)
from taylor_verify.exact.enclosure.crossing import Touched
from taylor_verify.exact.enclosure.ending import ending, growing
from taylor_verify.exact.enclosure.flow import Flow
from taylor_verify.exact.enclosure.image import Functions, Image
from taylor_verify.exact.enclosure.jumps import OnJump
from taylor_verify.exact.enclosure.operations import Domain
from taylor_verify.exact.enclosure.step import Step, size_of
from taylor_verify.exact.enclosure.stopping import (
    Coarse,
    Unreached,
    Watch,
    has_shrunk_at_last,
)
from taylor_verify.exact.enclosure.tape import Tape
from taylor_verify.exact.enclosure.tube import BOUND_BITS, StepTooLong
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import float_text
from taylor_verify.scenes.loads.states import Instant

if TYPE_CHECKING:
    from taylor_verify.exact.enclosure.course import Course

# Flat steps in a row: a kink that is crossed takes one or two.
_MOST_FLAT: Final = 8
_TOUCHED: Final = "a kink may be touched and not crossed"
_ON_JUMP: Final = "a held value may be taken on its jump"
_ONE: Final = arb(1)
# Progress messages for callers that wait.
_progress: Final = logging.getLogger("taylor_verify.progress")


@dataclass(frozen=True)
class Row:
    """The state at one time in balls. ``turn`` is R, nine entries row by row, and may be empty.

    ``largest`` is log2 of the largest size so far of each block of the state. A block is as large as the
    terms of its rate make it in a step, though they may cancel. ``peaks`` are
    lower bounds of the largest norm so far of each own state. ``since`` is the derivative of the state by
    the one at the row before it, or at the start, if the course has derivatives.
    """

    state: list[arb]
    turn: list[arb]
    largest: tuple[float, ...]
    peaks: Mapping[str, arb] = field(default_factory=dict)
    since: arb_mat | None = None


class _Since:
    """The derivative of the state by the one at the last row, carried from step to step."""

    def __init__(self, size: int) -> None:
        self._steps, self._from = identity(size), identity(size)

    def at_row(self, flow: Flow | None, share: arb) -> arb_mat:
        """The derivative at a row, from which the next one counts."""
        whole = self.to(flow, share)
        reached, self._steps = self._steps, identity(self._steps.nrows())
        self._from = self._steps if whole is None else whole
        return reached

    def to(self, flow: Flow | None, share: arb) -> arb_mat | None:
        """Go on to a share of a step; the derivative since its beginning, None without a flow."""
        if flow is None:
            return None
        whole = flow.whole(share)
        self._steps = whole * inverted(self._from) * self._steps
        self._from = identity(self._steps.nrows())
        return whole

    def through(self, places: Sequence[int], slopes: arb_mat) -> None:
        """Go through an instant, at which some components become functions of all."""
        rows, taken = identity(self._steps.nrows()).tolist(), slopes.tolist()
        for k, place in enumerate(places):
            rows[place] = taken[k]
        self._steps = arb_mat(rows) * self._steps


class Walk:
    """A way from the start of a course to its last time, and what was met so far."""

    def __init__(self, course: Course, times: Sequence[Fraction]) -> None:
        self._course, self._system, self._stepper = course, course.system, course.stepper
        self._watch = Watch(
            course.bits,
            course.most_bits,
            course.most_steps,
            course.begin,
            # A motion that is of own states alone is lost by these.
            self._system.others or self._system.spans,
        )
        self._box = Box.about(course.start)
        self._now, self._last = Fraction(0), times[-1]
        self._pending = list(times[::-1])
        self._steps, self._lengths = 0, list[Fraction]()
        self._guess = self._usual = self._last
        self._reach: float | None = None
        self._flat = 0
        self._largest = self._sizes()
        self._peaks = dict.fromkeys(self._system.own, arb(0))
        self._since = _Since(self._system.size) if course.differentiates else None
        self._instants = self._coming()
        # What is known in exact numbers: the start, and what values and rates of zero make of it.
        known = None if course.has_values else self._system.exactly
        self._exact: list[Any] = list(known or [None] * self._system.size)
        self._take()
        self._grow()

    def _coming(self) -> list[Instant]:
        """The instants on the way, the nearest last."""
        system, origin = self._system, self._course.origin
        if system.instants is None:
            return []
        if self._last < 0:
            because = f"held states run forward in time, from t = {float(origin):g} on"
            raise Unreached(because, self._pending[-1])
        try:
            instants = system.instants(origin + self._last)
        except ValueError as fault:
            raise Unreached(str(fault), self._pending[-1]) from None
        takes_first = not self._course.has_values
        return [
            instant._replace(time=instant.time - origin)
            for instant in reversed(instants)
            if instant.time > origin or (takes_first and instant.time == origin)
        ]

    def first_row(self) -> Row:
        """The start itself, after the values that are taken there."""
        return self._row_here()

    def rows(self) -> Iterator[tuple[Fraction, Row]]:
        """The rows of all times."""
        while self._pending:
            step = self._step()
            yield from self._rows_within(step)
            self._go(step)
            yield from self._rows_here()
            if self._pending:
                self._check()

    def steps(self) -> Iterator[tuple[Fraction, Step]]:
        """The steps to the last time, each with the time at which it begins."""
        while self._now != self._last:
            step = self._step()
            yield self._now, step
            self._go(step)
            if self._now != self._last:
                self._check()

    # Rows.

    def _rows_within(self, step: Step) -> Iterator[tuple[Fraction, Row]]:
        """The rows of times that the step passes, and of its end unless values are taken there."""
        end = self._now + step.length
        while self._pending and abs(self._pending[-1] - self._now) <= abs(step.length):
            time = self._pending[-1]
            if self._instants and time == end == self._instants[-1].time:
                return
            self._pending.pop()
            yield time, self._row(step, time)

    def _rows_here(self) -> Iterator[tuple[Fraction, Row]]:
        """The row of an instant, read after it."""
        if self._pending and self._pending[-1] == self._now:
            self._pending.pop()
            yield self._now, self._row_here()

    def _row(self, step: Step, time: Fraction) -> Row:
        """The row of a time that the step passes."""
        share = ball((time - self._now) / step.length)
        if step.piece.image is None:
            state = within(self._box, step.state, step.tube, step.flow, share)
            row = self._complete(state)
        else:
            row = self._imaged(self._carried(step, share), step.piece.image, time)
        since = None if self._since is None else self._since.at_row(step.flow, share)
        return replace(row, since=since)

    def _row_here(self) -> Row:
        """The row of the time that is reached."""
        image = self._system.pieces(self._course.origin + self._now, self._last >= 0).image
        if image is None:
            row = self._complete(self._box.balls())
        else:
            row = self._imaged(self._box, image, self._now)
        since = None if self._since is None else self._since.at_row(None, _ONE)
        return replace(row, since=since)

    def _imaged(self, box: Box, image: Tape, time: Fraction) -> Row:
        """The row over a box, with omega by an image of it."""
        outputs = over_box(box, *self._outputs(Image(image, box, self._course.origin + time)))
        return self._complete([*outputs, *box.balls()[3:]])

    def _complete(self, state: list[arb]) -> Row:
        self._raise_peaks(state)
        turn = [] if self._system.framed is None else self._system.framed(state)
        return Row(state, turn, self._largest, dict(self._peaks))

    # Steps.

    def _step(self) -> Step:
        """The next step, towards the last time, and no farther than the next instant."""
        goal = self._instants[-1].time if self._instants else self._pending[0]
        left = min(goal - self._now, self._pending[0] - self._now, key=abs)
        now = self._course.origin + self._now
        try:
            return self._stepper.step(self._box, now, self._guess, left, self._reach)
        except StepTooLong:
            raise self._stuck("the bounds of no step close") from None
        except Touched:
            raise self._stuck(_TOUCHED) from None
        except Domain as end:
            raise self._ended(end, "" if end.node is None else self._ending()) from end

    def _carried(self, step: Step, share: arb | None = None) -> Box:
        spans = self._system.spans
        sizes = {
            i: size
            for span, size in zip(spans, self._largest, strict=False)
            for i in span
            if i >= self._own_from
        }
        return carried(self._box, step.state, step.tube, step.flow, spans, sizes, share)

    @cached_property
    def _own_from(self) -> int:
        """The first place of an own state."""
        return min((span.start for span in self._system.own.values()), default=self._system.size)

    def _go(self, step: Step) -> None:
        """Go to the end of the step, and take the values of an instant there."""
        self._largest = _larger(self._largest, self._terms(step))
        if self._since is not None:
            self._since.to(step.flow, _ONE)
        self._box = self._carried(step)
        self._now, self._reach = self._now + step.length, step.reach
        pairs = zip(self._exact, step.piece.tape.still, strict=True)
        self._exact = [number if is_still else None for number, is_still in pairs]
        is_cut = bool(self._instants) and self._instants[-1].time == self._now
        self._guess = max(
            2 * (self._usual if step.is_flat else step.length),
            self._guess if is_cut else step.length,
            key=abs,
        )
        self._usual = self._guess / 2
        self._flat = self._flat + 1 if step.is_flat else 0
        self._steps += 1
        if not (step.is_flat or is_cut):
            self._lengths.append(abs(step.length))
        self._take()
        self._grow()
        if _progress.isEnabledFor(logging.INFO):
            percent = float(100 * self._now / self._last)
            _progress.info("%.0f %% of the time, with %d bits", percent, self._course.bits)

    def _take(self) -> None:
        """Take the values of an instant that is reached, all of them from the box before it."""
        if not self._instants or self._instants[-1].time != self._now or self._system.taken is None:
            return
        instant = self._instants.pop()
        time = self._course.origin + self._now
        tape, places = self._system.taken(instant._replace(time=time))
        image = Image(tape, self._box, time, self._exact)
        values, slopes = self._outputs(image)
        for place, number in zip(places, image.rational_outputs(), strict=True):
            self._exact[place] = number
        self._box = renewed(self._box, places, values, slopes)
        if self._since is not None:
            self._since.through(places, slopes)

    def _outputs(self, image: Image) -> Functions:
        try:
            return image.outputs()
        except OnJump:
            raise self._stuck(_ON_JUMP) from None
        except Domain as end:
            raise self._ended(end, self._text(image.step_of(end))) from end

    # Sizes.

    def _sizes(self) -> tuple[float, ...]:
        """log2 of the size of each block."""
        return tuple(size_of(self._box.point, span) for span in self._system.spans)

    def _terms(self, step: Step) -> tuple[float, ...]:
        """log2 of what the terms of the rates make of each block in a step, none cancelled."""
        with ctx.workprec(BOUND_BITS):
            added = [size * ball(step.length) for size in step.terms]
        return tuple(size_of(added, span) for span in self._system.spans)

    def _grow(self) -> None:
        self._largest = _larger(self._largest, self._sizes())
        self._raise_peaks(self._box.balls())

    def _raise_peaks(self, state: Sequence[arb]) -> None:
        with ctx.workprec(BOUND_BITS):
            for name, span in self._system.own.items():
                least = [state[i].abs_lower() for i in span]
                norm = sum((size * size for size in least), arb(0)).sqrt().lower()
                self._peaks[name] = max(self._peaks[name], norm)

    # When to stop.

    def _check(self) -> None:
        if self._flat > _MOST_FLAT:
            raise self._stuck(_TOUCHED)
        try:
            self._watch.check(
                self._box, self._largest, self._lengths, self._steps, self._now, self._pending
            )
        except Coarse as reason:
            raise reason if reason.stuck is None else self._at_end() or reason from None
        except Unreached as reason:
            raise self._at_end() or reason from None

    def _stuck(self, because: str) -> Coarse | Unreached:
        """The exception for a motion that cannot be followed from here; more bits help at no end."""
        return self._at_end() or self._watch.stuck(because, self._now, self._pending)

    def _at_end(self) -> Unreached | None:
        if function := self._ending():
            return self._unreached(f"{function} has no value or no derivative near")
        if part := self._growing():
            return self._unreached(part)
        return None

    def _ended(self, end: Domain, function: str) -> Unreached:
        return self._unreached(f"{end} near", f" ({function})" if function else "")

    def _unreached(self, because: str, more: str = "") -> Unreached:
        time = float_text(self._course.begin + self._now)
        return Unreached(f"{because} t = {time}{more}", self._pending[-1], is_end=True)

    def _growing(self) -> str:
        """The part of the state that seems to grow without bound, as a text; empty of none."""
        if not has_shrunk_at_last(self._lengths):
            return ""
        now, is_later = self._course.origin + self._now, self._last >= 0
        step = self._lengths[-1] if is_later else -self._lengths[-1]
        tape = self._system.pieces(now, is_later).tape
        return growing(tape, self._box, now, step, self._system.named)

    def _ending(self) -> str:
        """The function at which the motion ends here, and where it is written; empty of none."""
        now, is_later = self._course.origin + self._now, self._last >= 0
        longest = max(self._lengths, default=abs(self._guess))
        tape = self._system.pieces(now, is_later).tape
        return self._text(ending(tape, self._box.point, now, longest if is_later else -longest))

    def _text(self, place: int | None) -> str:
        """A step of the loads as text, and where it is written; empty of none."""
        system, now = self._system, self._course.origin + self._now
        if place is None or system.step_text is None:
            return ""
        return system.step_text(now, self._last >= 0, place)


def _larger(first: Sequence[float], second: Sequence[float]) -> tuple[float, ...]:
    return tuple(map(max, zip(first, second, strict=True)))
