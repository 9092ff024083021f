"""Events of a motion: the times of all zeros of an expression, or of its extrema, enclosed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil, log2
from typing import TYPE_CHECKING, Any, Final

from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.as_written import as_written
from taylor_verify.exact.balls import midpoint, upper
from taylor_verify.exact.enclosure.along import Part, parts
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.loaded import LoadedBody
from taylor_verify.exact.enclosure.operations import Domain
from taylor_verify.exact.enclosure.rationals import rational_values
from taylor_verify.exact.enclosure.roots import Zero, zeros
from taylor_verify.exact.enclosure.stopping import Coarse, Unreached, reaching
from taylor_verify.exact.enclosure.system import System
from taylor_verify.exact.printed import number_with_digits
from taylor_verify.exact.solution import Unsettled
from taylor_verify.numbers.irrational import ball
from taylor_verify.records.passing import Passing
from taylor_verify.records.showing import dataframe, html_table
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.reading.event import Event, event_of
from taylor_verify.scenes.scene import Scene

if TYPE_CHECKING:
    import pandas

_GUARD_BITS: Final = 56
_MOST_BITS: Final = 10_000
_ATTEMPTS: Final = 12
# A time that may be the start has no relative digits: its error is counted by this much of the span.
_LEAST_SHARE: Final = 2.0**-20
# Bits beyond those asked for with which what is undecided is looked at again, once.
_MORE_BITS: Final = 100


@dataclass(frozen=True)
class EventTime:
    """A time on the clock of the scene: within ``radius`` of ``t`` there is exactly one event.

    Of an undecided one, all that may be events there lie within ``radius``.
    """

    t: mpf
    radius: mpf

    def __float__(self) -> float:
        return float(self.t)


@dataclass(frozen=True, repr=False)
class Events(Passing):
    """All events of one kind in a span, in the order of the motion, and what is undecided.

    ``text`` is what was asked, ``until`` the end of the span, and ``digits`` those asked for.
    """

    text: str
    until: Fraction
    digits: int
    times: tuple[EventTime, ...]
    undecided: tuple[EventTime, ...] = ()

    def __repr__(self) -> str:
        word = "passed" if self.passed else "undecided"
        return f"<Events: {self.text}: {len(self.times)} up to {float(self.until):g}: {word}>"

    def _repr_html_(self) -> str:
        rows = [[str(value) for value in row.values()] for row in self._rows]
        return html_table(repr(self)[1:-1], ("t", "radius"), rows, str(self).splitlines())

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame, a row an event. Raises ModuleNotFoundError without pandas."""
        return dataframe(self._rows)

    @property
    def _rows(self) -> list[dict[str, Any]]:
        from taylor_verify.exact.printed_events import events_document

        rows: list[dict[str, Any]] = events_document(self)["events"]
        return rows

    def __str__(self) -> str:
        from taylor_verify.exact.printed_events import event_lines, events_document

        return "\n".join(event_lines(events_document(self)))

    def __iter__(self) -> Iterator[EventTime]:
        return iter(self.times)

    def __len__(self) -> int:
        return len(self.times)

    def __getitem__(self, k: int) -> EventTime:
        return self.times[k]

    @property
    def passed(self) -> bool:
        """True if nothing is undecided."""
        return not self.undecided


class Incomplete(Unsettled):
    """The error for a motion that is not followed to the end of the span; ``events`` has those before.

    ``events.until`` is the time up to which they are all.
    """

    def __init__(self, because: str, events: Events, is_end: bool) -> None:
        super().__init__(because, is_end=is_end)
        self.events = events


def events_of(scene: Scene, text: str, until: Fraction, digits: int) -> Events:
    """Return the events between the start of a scene and a time. Raises as `events`."""
    event, scene = event_of(scene, text), as_written(scene)
    elapsed = until - scene.clock.start
    if not elapsed:
        return Events(text, until, digits, ())
    target = ceil(digits * log2(10))
    search = _Search(system(scene, event.loads, elapsed, 1 + event.is_extremum), event, elapsed)
    bits, stuck, looked = target + _GUARD_BITS, False, False
    for _ in range(_ATTEMPTS):
        with ctx.workprec(bits):
            every, reached, end = search.zeros(bits)
            lacking = max((_lacking(z, target, elapsed) for z in every), default=0)
            if isinstance(end, Coarse) and not (end.stuck is not None and stuck):
                bits, stuck = end.bits, end.stuck is not None
                continue
            if lacking <= 0 and (looked or all(zero.is_crossed for zero in every)):
                events = _events(event, reached if end else until, digits, every)
                if end is None:
                    return events
                because = end.because if isinstance(end, Coarse) else str(end)
                raise Incomplete(because, events, getattr(end, "is_end", False)) from end
        looked, bits = True, bits + max(lacking + _GUARD_BITS // 2, _MORE_BITS * (lacking <= 0))
        if bits > _MOST_BITS:
            break
    raise Unsettled(f"the times of `{text}` do not shrink to {digits} digits with {bits} bits")


def system(scene: Scene, loads: Loads, elapsed: Fraction, orders: int) -> System:
    """The equations of a scene with functions of its motion, as far as a time. Raises Unreached."""
    further = reaching(loads, elapsed)
    return LoadedBody(replace(scene, track=frozenset()), further, orders).system()


def parts_of(system: System, until: Fraction, begin: Fraction, bits: int) -> Iterator[Part]:
    """Yield the functions of a motion along it, part by part, at a precision that is the ambient one."""
    course = Course.of(system, system.start_balls(), bits, _MOST_BITS)
    for time, step in replace(course, begin=begin).steps(until):
        yield from parts(time, step)


@dataclass(frozen=True)
class _Search:
    system: System
    event: Event
    elapsed: Fraction

    def zeros(self, bits: int) -> tuple[list[Zero], Fraction, ArithmeticError | None]:
        """Return the zeros, the time up to which they are all, and why the motion is not followed on."""
        skipped = int(self.event.is_extremum)
        origin = reached = self.event.loads.origin

        def every() -> Iterator[Part]:
            nonlocal reached
            for part in parts_of(self.system, self.elapsed, origin, bits):
                yield Part(part.begin, part.length, part.functions[skipped:])
                reached = origin + part.end

        before = list[Zero]()
        begins_with_zero = self._at_start(skipped) == 0
        try:
            for zero in zeros(every(), begins_with_zero, is_continuous=not skipped):
                before.append(zero._replace(time=zero.time + ball(origin)))
        except (Coarse, Domain, Unreached) as end:
            return before, reached, end
        return before, reached, None

    def _at_start(self, place: int) -> Any:
        """The exact value of the function at the start; None where it is not known."""
        functions = self.system.pieces(Fraction(0), self.elapsed > 0).functions
        if functions is None or self.system.begin is not None:
            return None
        values = rational_values(functions, self.system.start, Fraction(0))
        return values[functions.outputs[place]]


def _lacking(zero: Zero, target: int, elapsed: Fraction) -> int:
    """The bits that a crossed zero lacks."""
    radius = arb(zero.time.rad())
    if not zero.is_crossed or radius.is_zero():
        return 0
    scale = zero.time.abs_lower().max(ball(abs(elapsed)) * _LEAST_SHARE)
    return int(mp.mag(upper(radius / scale))) + target


def _events(event: Event, until: Fraction, digits: int, every: list[Zero]) -> Events:
    crossed, others = (
        tuple(_time(zero.time, digits) for zero in every if zero.is_crossed is kind)
        for kind in (True, False)
    )
    return Events(event.text, until, digits, crossed, others)


def _time(time: arb, digits: int) -> EventTime:
    t, radius = midpoint(time), upper(arb(time.rad()))
    return EventTime(number_with_digits(t._mpf_, digits), radius)
