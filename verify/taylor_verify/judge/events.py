"""The judgement of a solver's own events: against all events of the scene, each enclosed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import floor, log10, nan
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.event_times import Events, EventTime, Incomplete, events_of
from taylor_verify.exact.printed_events import event_row
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.diagnosis import diagnosed
from taylor_verify.judge.errors.state import Errors, Floats
from taylor_verify.judge.floor.moved_events import NoFloor, attainable_of_events
from taylor_verify.judge.gates import Finding, bounds_of, index_of_largest, judge
from taylor_verify.judge.judged_rows import verdict_on
from taylor_verify.models.problem import pose_as_stored
from taylor_verify.numbers.precision import Rung, exact_value, rung
from taylor_verify.records.faults import brief, refusal
from taylor_verify.records.json_text import finite
from taylor_verify.records.passing import Passing
from taylor_verify.records.reason import Carried, Cause, Reason, RoundoffFloor, stated
from taylor_verify.records.showing import dataframe, html_table
from taylor_verify.records.status import Status, gravest
from taylor_verify.records.verdict import Verdict, summary
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.words.account import event_lines

if TYPE_CHECKING:
    import pandas

_HEADINGS: Final = ("t", "radius", "given", "error", "digits", "bound")
_UNIT: Final = "the time of the event"
_DIGITS: Final = 30
# A time answers an event if it is nearer than this share of the distance to the next one.
_NEAR: Final = 4
# A time that may be 0 has no relative digits: so is one below this share of the span.
_LEAST_SHARE: Final = 2.0**-20


class Answered(NamedTuple):
    """An event and the time that was given for it: off by ``error``, right to so many ``digits``.

    ``scale`` is the size of the time, by which errors are divided; 1 where this is zero to the span.
    ``attainable`` is the error that perfect rounding would leave; None where it is not known.
    """

    event: EventTime
    given: Fraction
    error: float
    digits: int
    scale: float
    attainable: float | None = None


@dataclass(frozen=True, repr=False)
class EventsJudgement(Passing):
    """The times given for an event, against ``true``: answered, missed, invented; true if it passed.

    ``because`` says why the events are not known beyond ``true.until``, empty where they are. Times behind
    it are not judged. ``unbounded`` says why arithmetic has no bound for the errors, empty where it has.
    ``given`` is the scene with its data rounded to the ``rung``, ``file`` the path of the times.
    """

    given: Scene
    true: Events
    answered: tuple[Answered, ...]
    missed: tuple[EventTime, ...]
    invented: tuple[Fraction, ...]
    tolerance: float | None = None
    because: str = ""
    unbounded: str = ""
    rung: str = ""
    file: str = ""

    @property
    def scene(self) -> str:
        """The name of the scene."""
        return self.given.name

    def __repr__(self) -> str:
        word = "passed" if self.passed else "failed" if self.is_wrong else "undecided"
        return f"<{type(self).__name__}: {self.heading}: {word}>"

    def __str__(self) -> str:
        return "\n".join([self.heading, *event_lines(self.document())])

    def _repr_html_(self) -> str:
        rows = [[str(value) for value in row.values()] for row in self.document()["events"]]
        return html_table(repr(self)[1:-1], _HEADINGS, rows, event_lines(self.document()))

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame, a row an answered event. Raises ModuleNotFoundError without pandas."""
        return dataframe(self.document()["events"])

    @property
    def heading(self) -> str:
        """The question, and the number of events that have an answer."""
        return f"{self.true.text}: {len(self.answered)} of {len(self.true)} events of {self.scene}"

    @property
    def is_wrong(self) -> bool:
        """True if an event is missed, invented, or off by more than its bound, relative to its time."""
        return self.status is Status.FAIL

    @property
    def passed(self) -> bool:
        """True if every event is answered, no other time is, and nothing is undecided."""
        return self.status is Status.PASS

    @property
    def status(self) -> Status:
        """The gravest of what the counts and the errors say."""
        is_open = self.because or not self.true.passed
        counted = Status.UNDECIDED if is_open else Status.PASS
        if self.missed or self.invented:
            counted = Status.FAIL
        return gravest([counted, *([self._finding.status] if self._finding else [])])

    @cached_property
    def _errors(self) -> Errors:
        """The errors of all times that answer an event, relative to its time."""
        errors, radii = (
            self._relative("error"),
            [float(each.event.radius) / each.scale for each in self.answered],
        )
        return Errors(self.true.text, _UNIT, errors, np.array(radii), {})

    def _relative(self, name: str) -> Floats:
        return np.array([getattr(each, name) / each.scale for each in self.answered])

    @cached_property
    def _attainable(self) -> Floats | None:
        """The errors that perfect rounding would leave, likewise; None where they are not known."""
        return None if self.unbounded else self._relative("attainable")

    @cached_property
    def _bounds(self) -> Floats | None:
        if self._attainable is None and self.tolerance is None:
            return None
        floors = self._errors.values if self._attainable is None else self._attainable
        return bounds_of(floors, self.tolerance)

    @cached_property
    def _finding(self) -> Finding | None:
        """The comparison of the errors with the tolerance or the bound; None where there is no error."""
        if not self.answered:
            return None
        if self._attainable is not None:
            terms = Reason(floor=RoundoffFloor(Carried.EVENT))
            return judge(self._errors, self._attainable, terms, self.tolerance)
        values, status = self._errors.values, Status.UNDECIDED
        why = f"no bound follows from arithmetic: {self.unbounded}; --tolerance judges the times"
        if self.tolerance is not None:
            status = Status.PASS if (values <= self.tolerance).all() else Status.FAIL
            why = f"no bound follows from arithmetic: {self.unbounded}"
        worst, bound = index_of_largest(values), self.tolerance or nan
        reason = stated(Cause.EVENTS, why)
        no_rounding: dict[str, Any] = {"is_rounding": False, "ratio": nan, "ratio_at": worst}
        return Finding(status, worst, bound, self.tolerance, reason=reason, **no_rounding)

    @property
    def verdicts(self) -> tuple[Verdict]:
        """The verdict on all times together, as a row of its own."""
        counts = {
            "answered": self.answered,
            "missed": self.missed,
            "invented": self.invented,
            "undecided": self.true.undecided,
        }
        words = [f"{len(times)} {word}" for word, times in counts.items() if times]
        text = "; ".join(filter(None, (", ".join(words) or "no event", self.because)))
        reason = self._finding.reason if self._finding else Reason()
        solver, on = Recorded({}, setting=self.file), rung(self.rung)
        row = verdict_on(
            *(self.given, solver, on, self.true.text, self.status, Outcome.FINISHED),
            reason=reason.with_remark(Cause.EVENTS, text),
            roundoff=float(on.unit_roundoff),
        )
        return (self._with_numbers(row),)

    def _with_numbers(self, row: Verdict) -> Verdict:
        """Return the row with the errors and the bound; as it is where no event was answered."""
        finding, values, floors = self._finding, self._errors.values, self._attainable
        if finding is None:
            return row
        times = np.array([float(each.event.t) for each in self.answered])
        row = replace(
            row,
            max=float(values[finding.worst]),
            mean=float(np.mean(values)),
            final=float(values[-1]),
            at=float(times[finding.worst]),
            unit=_UNIT,
            bound=finite(finding.bound),
            tolerance=self.tolerance,
            until=float(times[-1]),
        )
        if floors is None:
            return row
        row = replace(
            row,
            attainable=float(floors[finding.worst]),
            ratio=finding.ratio,
            ratio_at=float(times[finding.ratio_at]),
        )
        return diagnosed(row, times, float(self.given.clock.start), values, floors)

    def document(self) -> dict[str, Any]:
        """Return what `check --event --json` prints."""
        digits, bounds = self.true.digits, self._bounds
        allowed = [None] * len(self.answered) if bounds is None else bounds.tolist()
        return {
            "scene": self.scene,
            "event": self.true.text,
            "events": [
                event_row(a.event, digits)
                | {"given": float(a.given), "error": a.error, "digits": a.digits}
                | {"bound": None if bound is None else bound * a.scale}
                for a, bound in zip(self.answered, allowed, strict=True)
            ],
            "missed": [event_row(event, digits) for event in self.missed],
            "invented": [float(time) for time in self.invented],
            "undecided": [event_row(event, digits) for event in self.true.undecided],
            "passed": self.passed,
            "verdicts": [verdict.row() for verdict in self.verdicts],
            "summary": summary(self.verdicts),
        } | ({"because": self.because} if self.because else {})


def judge_events(
    scene: Scene,
    text: str,
    times: Sequence[Fraction],
    rung: Rung,
    tolerance: float | None = None,
    file: str = "",
) -> EventsJudgement:
    """Judge the times of an event over the whole span of a scene.

    Raises Refused for a text or a time that cannot be read.
    """
    given = pose_as_stored(scene, rung).given
    true, because = _known_events(given, text)
    # A time behind those that are known is neither right nor wrong.
    start, sign = given.clock.start, 1 if true.until >= given.clock.start else -1
    left = sorted(
        t for t in times if not because or (t - start) * sign <= (true.until - start) * sign
    )
    answered, missed = list[Answered](), list[EventTime]()
    windows = _windows(true)
    for event in true.undecided:
        # It is not known how many events there are.
        limit = event.radius + windows[event.t]
        left = [time for time in left if not _distance(time, event) <= limit]
    for event in true.times:
        near = [time for time in left if _distance(time, event) < windows[event.t]]
        if not near:
            missed.append(event)
            continue
        best = min(near, key=lambda time: _distance(time, event))
        left.remove(best)
        answered.append(_answered(event, best, abs(float(true.until - start))))
    unbounded = ""
    if answered:
        try:
            known = [exact_value(each.event.t) for each in answered]
            floors = attainable_of_events(scene, text, known, rung)
            answered = [
                each._replace(attainable=float(floor))
                for each, floor in zip(answered, floors, strict=True)
            ]
        except NoFloor as reason:
            unbounded = str(reason)
    return EventsJudgement(
        given,
        true,
        tuple(answered),
        tuple(missed),
        tuple(left),
        tolerance,
        because,
        unbounded,
        rung.name,
        file,
    )


def _known_events(given: Scene, text: str) -> tuple[Events, str]:
    """Return the events as far as they are known, and why no farther; empty where they all are."""
    try:
        return events_of(given, text, given.clock.instants[-1], _DIGITS), ""
    except Incomplete as doubt:
        return doubt.events, str(doubt)
    except Unsettled as doubt:
        return Events(text, given.clock.start, _DIGITS, ()), str(doubt)


def _windows(true: Events) -> dict[mpf, mpf]:
    """Return the distance by event within which a time answers it."""
    every = sorted(event.t for event in (*true.times, *true.undecided))
    gaps = [b - a for a, b in pairwise(every)] or [mp.convert(abs(true.until) or Fraction(1))]
    return {t: min(gaps[max(0, k - 1) : k + 1]) / _NEAR for k, t in enumerate(every)}


def _answered(event: EventTime, time: Fraction, span: float) -> Answered:
    error, size = float(_distance(time, event)), abs(float(event.t))
    scale = size if size > _LEAST_SHARE * span else 1.0
    digits = min(_DIGITS, floor(-log10(error / scale))) if error else _DIGITS
    return Answered(event, time, error, digits, scale)


def _distance(time: Fraction, event: EventTime) -> mpf:
    with mp.workdps(2 * _DIGITS):
        return abs(mp.convert(time) - event.t)


def given_times(answer: Any) -> list[Any]:
    """Return the times of one event that an object holds: a list, or the t_events of an OdeResult."""
    times = getattr(answer, "t_events", answer)
    if times is not answer and times is not None and len(times) == 1:
        times = times[0]
    elif times is not answer:
        got = "none" if times is None else f"those of {len(times)}"
        raise refusal("the times of one event, as in result.t_events[0]", got, "t_events")
    if not hasattr(times, "__iter__"):
        raise refusal("a list of times", brief(times), "events")
    return list(times)
