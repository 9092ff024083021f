"""The times of a file: the column that has them, and its numbers in the scene's unit from its start on.

Seconds beside nanoseconds are added. Of several clocks the one that fits the scene's times is taken. Times
of a calendar, and seconds since 1970, count from the first row, which is then at the scene's start.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import nan
from typing import Any, Final

import numpy as np

from taylor_verify.records.faults import Faults, cut
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.assigned import Request
from taylor_verify.solvers.files.columns.choice import Candidates
from taylor_verify.solvers.files.columns.column_units import OWN, Unit, in_brackets
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.columns.spelling import Spelling
from taylor_verify.solvers.files.formats.column import Column, shown
from taylor_verify.solvers.files.formats.epochs import is_epoch, seconds_in_log
from taylor_verify.solvers.values import exact

_OURS: Final = ("t", "time")
# The ends of the names of a second and of its fractions, and how many of these a second has.
_SECONDS: Final = ("seconds", "secs", "sec", "s")
_FRACTIONS: Final[Mapping[str, int]] = {
    **dict.fromkeys(("nanoseconds", "nanosecs", "nanosec", "nsecs", "nsec"), 10**9),
    **dict.fromkeys(("microseconds", "usecs", "usec"), 10**6),
}
# Seconds since 1970 of the years 2001 to 2286, and the parts of a second in which they may be counted.
_CLOCK: Final = (10**9, 10**10)
_PARTS: Final[Mapping[str, int]] = {"ms": 10**3, "us": 10**6, "ns": 10**9}
# A file whose first row is this near to the start, in spans of the scene, begins there.
_NEAR: Final = Fraction(1, 10**6)
# Words of clocks that have another zero than a simulation.
_OF_A_CLOCK: Final = re.compile("stamp|gps|tow|unix|epoch|utc|boot|weekseconds|timeofweek")
# What begins so few rows after the start is late, by a fault that is to be seen, and no other clock.
_ROWS_OF_A_LAG: Final = 10


def with_times(
    columns: Sequence[Column], wanted: Request, scene: Scene | None, place: str, faults: Faults
) -> tuple[list[Column], Request, tuple[str, ...]]:
    """Return the columns with times that count from the scene's start, and ask for the one that fits.

    Sentences about the time follow.
    """
    read, beside = list(columns), [*_seconds_beside_fractions(columns)]
    sums, notes = list[Column](), list[str]()
    for whole, fractions, parts in beside:
        sums.append(whole._replace(values=[*_sums(whole, fractions, parts, place, faults)]))
        read = [sums[-1] if each is whole else each for each in read if each is not fractions]
        notes.append(f"`{cut(fractions.name)}` is added to `{cut(whole.name)}`")
    names = Candidates([Name(column) for column in columns], {}, {})
    asked = [theirs for ours, theirs in wanted if ours in _OURS]
    clocks = _clocks(read, asked, scene, names, sums)
    chosen = _fitting(clocks)
    if chosen is None:
        return read, wanted, tuple(notes)
    others = [clock for clock in clocks if clock is not chosen]
    if others:
        named = ", ".join(f"`{cut(other.column.name)}`" for other in others)
        notes.append(f"`{cut(chosen.column.name)}` fits the scene's times better than {named}")
    column, note = chosen.counted(place, faults)
    read = [column if each is chosen.column else each for each in read]
    if others or sums or column is not chosen.column or not Name(column).is_time:
        wanted = [*(pair for pair in wanted if pair[0] not in _OURS), ("t", column.name)]
    return read, wanted, (*notes, *note)


def _clocks(
    columns: Sequence[Column],
    asked: Sequence[str],
    scene: Scene | None,
    names: Candidates,
    sums: Sequence[Column],
) -> list[_Clock]:
    """Return the columns that are asked for, or called a time, or else those with times of a calendar."""
    if asked:
        times = [column for column in columns if column.name.strip() in asked]
    else:
        times = [column for column in columns if Name(column).is_time]
        times = times or [c for c in columns if len(c.values) and _is_calendar(c.values[0])]
    return [
        _Clock(column, scene, _of_program(column, names), any(column is each for each in sums))
        for column in times
    ]


def _of_program(column: Column, names: Candidates) -> Spelling | None:
    """Return the spelling of a program that states the unit of a time, where the name does not."""
    every = (reading.spelling for reading in Name(column).readings if reading.unit is OWN)
    stated = (s for s in every if s.group == "time" and s.unit and names.has_signs(s))
    return next(stated, None)


def is_fraction(name: str) -> bool:
    """Return True for a name that says parts of a second: ``nanosec``."""
    return Name.of(name).key in _FRACTIONS


def _is_calendar(value: object) -> bool:
    return isinstance(value, datetime | np.datetime64) or (
        isinstance(value, str) and is_epoch(value.strip())
    )


# Seconds beside their fractions.


def _seconds_beside_fractions(
    columns: Sequence[Column],
) -> Iterator[tuple[Column, Column, int]]:
    """Yield columns of whole seconds, those of their fractions, and how many parts a second has there."""
    by_key = {Name(column).key: column for column in columns}
    for key, fractions in by_key.items():
        end = next((end for end in _FRACTIONS if key.endswith(end)), "")
        stem = key.removesuffix(end)
        whole = next((by_key[stem + s] for s in _SECONDS if end and stem + s in by_key), None)
        if whole is not None:
            yield whole, fractions, _FRACTIONS[end]


def _sums(
    whole: Column, fractions: Column, parts: int, place: str, faults: Faults
) -> Iterator[Fraction | float]:
    for row, pair in enumerate(zip(whole.values, fractions.values, strict=False), start=1):
        at = f"{place}, row {row}, column {cut(fractions.name)}"
        try:
            seconds, below = map(exact, pair)
        except ValueError:
            # A row of another topic, or no time at all.
            seconds, below = nan, Fraction(0)
        if below < 0 or below >= parts:
            faults.add(f"less than a second, {parts} of which are one", shown(pair[1]), at)
            return
        yield seconds + Fraction(below) / parts if below == below else nan


# One clock.


class _Clock:
    """A column that may have the times."""

    def __init__(
        self, column: Column, scene: Scene | None, spelling: Spelling | None, is_sum: bool = False
    ) -> None:
        self.column, self._scene, self._spelling = column, scene, spelling
        self._is_sum = is_sum

    @cached_property
    def _habit(self) -> Spelling | None:
        """The spelling of the program whose unit this is; None where somebody has made seconds of it."""
        spelling = None if self._is_calendar else self._spelling
        if spelling is None or spelling.unit in ("s", "d") or not len(self.column.values):
            return spelling
        is_whole = all(number == number // 1 for number in self._numbers)
        return spelling if is_whole and abs(self._numbers[-1]) > self._last else None

    @cached_property
    def _implied(self) -> str:
        """The unit of a program's habit, or of large whole numbers since 1970; empty for a stated one."""
        if self._habit or self._behind:
            return self._habit.unit if self._habit else self._behind
        stated = Name(self.column).unit("time")
        if self._is_calendar or (stated and stated.words) or self._first.denominator != 1:
            return ""
        fitting = (u for u, n in _PARTS.items() if _CLOCK[0] <= self._first / n < _CLOCK[1])
        unit = next(fitting, "")
        return "" if unit and self._is_as_written(Fraction(1, _PARTS[unit])) else unit

    def _is_as_written(self, factor: Fraction) -> bool:
        """Return True if the numbers reach the scene as they stand, or are all before it times a factor."""
        if self._scene is None:
            return False
        ends = self._ends
        first, last = sorted((self._numbers[0], self._numbers[-1]))
        return bool(first <= ends[1] and last >= ends[0]) or bool(last * factor < ends[0])

    @cached_property
    def _unit(self) -> Unit:
        """The unit by which the numbers are multiplied."""
        stated = None if self._is_calendar else Name(self.column).unit("time")
        return in_brackets(self._implied, "time") or stated or OWN

    @cached_property
    def _is_calendar(self) -> bool:
        return bool(len(self.column.values)) and _is_calendar(self.column.values[0])

    @cached_property
    def _behind(self) -> str:
        """The unit behind each of the times in a timetable of MATLAB, as in 0.5 sec; mostly empty."""
        first = self.column.values[0] if len(self.column.values) else ""
        unit = first.strip().partition(" ")[2] if isinstance(first, str) else ""
        return unit if unit and in_brackets(unit, "time") else ""

    def _number(self, value: Any) -> Any:
        """Return a number as it is written, in seconds where it is of a calendar."""
        if self._is_calendar:
            return seconds_in_log(str(value))
        return exact(value.strip().removesuffix(f" {self._behind}") if self._behind else value)

    @cached_property
    def _numbers(self) -> list[Any]:
        return [self._number(value) for value in self.column.values]

    @cached_property
    def _first(self) -> Fraction:
        first = self._number(self.column.values[0]) if len(self.column.values) else None
        return first if isinstance(first, Fraction) else Fraction(0)

    @cached_property
    def is_of_the_day(self) -> bool:
        """True for times of a calendar, since 1970, and of a clock with another zero than the scene's."""
        first = self._first * self._unit.factor
        is_since_1970 = _CLOCK[0] <= first < _CLOCK[1] and first > self._last
        return self._is_calendar or is_since_1970 or self._is_of_another_zero

    @property
    def _is_of_another_zero(self) -> bool:
        """True for a clock by its name or its program, which has no row in the scene, or no lag in it.

        A clock that nothing but its name says is the scene's where it has any row in the scene.
        """
        has_habit = self._habit is not None and self._habit.unit != "s"
        is_clock = self._is_sum or _OF_A_CLOCK.search(Name(self.column).whole_key) is not None
        # The numbers are read last: they are many.
        if self._scene is None or not (has_habit or is_clock) or not self.runs:
            return False
        clock, factor = self._scene.clock, self._unit.factor
        first, last = (number * factor for number in (self._numbers[0], self._numbers[-1]))
        if has_habit:
            lag = _ROWS_OF_A_LAG * abs(last - first) / (len(self._numbers) - 1)
            beyond = last > self._last + _NEAR * abs(clock.elapsed[-1])
            return bool(beyond and abs(first - clock.start) > lag)
        return bool(min(first, last) >= self._last or max(first, last) <= self._ends[0])

    @cached_property
    def _ends(self) -> tuple[Fraction, Fraction]:
        """The first and the last instant of the scene; zeros without one."""
        clock = self._scene.clock if self._scene else None
        first, last = sorted((clock.start, clock.instants[-1])) if clock else (Fraction(0),) * 2
        return first, last

    @property
    def _last(self) -> Fraction:
        return self._ends[1]

    @cached_property
    def times(self) -> list[Any]:
        """The times in the scene's unit."""
        start = self._scene.clock.start if self._scene else Fraction(0)
        zero = self._first if self.is_of_the_day else Fraction(0)
        shift = start if self.is_of_the_day else Fraction(0)
        return [(number - zero) * self._unit.factor + shift for number in self._numbers]

    @cached_property
    def runs(self) -> bool:
        """True if the numbers go on in one direction, though some may stand twice."""
        try:
            numbers = self._numbers
        except ValueError:
            return False
        if len(numbers) < 2 or numbers[0] == numbers[-1]:
            return False
        rises = numbers[-1] > numbers[0]
        return all((a <= b) if rises else (a >= b) for a, b in pairwise(numbers))

    @cached_property
    def misfit(self) -> tuple[bool, bool, int]:
        """Reasons against the times of a scene, the gravest first: the smaller the better."""
        if self._scene is None:
            return (self.is_of_the_day, False, 0)
        clock = self._scene.clock
        span = abs(clock.elapsed[-1])
        is_apart = self.is_of_the_day or abs(self.times[0] - clock.start) > _NEAR * span
        is_beyond = abs(self.times[-1] - clock.start) > span * (1 + _NEAR)
        instants = set(map(float, clock.instants))
        return (is_apart, is_beyond, -sum(float(time) in instants for time in self.times))

    def counted(self, place: str, faults: Faults) -> tuple[Column, list[str]]:
        """Return the column, from the scene's start on where it is a clock of the day, and notes on it."""
        column, shown_name = self.column, cut(self.column.name)
        notes = []
        try:
            if unit := self._implied:
                whose = f", the habit of {self._habit.whose}" if self._habit else ""
                notes.append(f"`{shown_name}` is in {unit}{whose}")
                values = self._numbers if self._behind else column.values
                column = Column(f"{column.name} [{unit}]", values)
            if not self.is_of_the_day:
                return column, notes
            values = [time / self._unit.factor for time in self.times]
        except ValueError:
            return self._without_faults(place, faults), []
        unit = Name(column).unit_text if self._is_calendar else ""
        bare = column.name.replace(unit, "").strip(" []()") if unit else column.name
        first = shown(column.values[0]).strip("'")
        notes.append(f"t counts from {first} of `{shown_name}`, the first row")
        return Column(bare or "t", values), notes

    def _without_faults(self, place: str, faults: Faults) -> Column:
        """Return the column; the first time of a calendar that is none is a fault, and no second one."""
        for row, value in enumerate(self.column.values if self._is_calendar else (), start=1):
            try:
                seconds_in_log(str(value))
            except ValueError as error:
                at = f"{place}, row {row}, column {cut(self.column.name)}"
                faults.add(str(error), shown(value), at)
                return self.column._replace(values=range(len(self.column.values)))
        return self.column


def _fitting(clocks: Sequence[_Clock]) -> _Clock | None:
    """Return the clock that fits best; of equal ones ours, and none where they differ."""
    if len(clocks) > 1:
        clocks = [clock for clock in clocks if clock.runs] or clocks[:1]
    if len(clocks) < 2:
        return clocks[0] if clocks else None
    best = min(clock.misfit for clock in clocks)
    alike = [clock for clock in clocks if clock.misfit == best]
    ours = [clock for clock in alike if clock.column.name in _OURS[:1]]
    same = all(clock.times == alike[0].times for clock in alike)
    return next(iter(ours), alike[0] if same else None)
