"""Somebody's trajectory in a file: every number exactly as written, or every fault with its place.

t                 time                          q0 q1 q2 q3      quaternion of R, scalar first
w1 w2 w3          angular velocity, body axes   r11 r12 ... r33  R itself, r12 is row 1, column 2
u1 u2 u3          velocity of the body's        c1 c2 c3         centre, space axes
                  origin, body axes
x1 x2 x3 y1 y2 y3 impulses, body axes

Usual other names and units are taken and said (the folder columns).

Decimals, ``a/b`` and hexadecimal floats become rationals; binary numbers are taken as they are. None
of them passes through a double on its way.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, Final, final

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.reading.faults import Faults, Refused, cut
from taylor_verify.solvers.files.columns.request import Request
from taylor_verify.solvers.files.columns.selection import Taken, select
from taylor_verify.solvers.files.formats.column import MOST_ALIKE, Column, add_more_alike
from taylor_verify.solvers.files.formats.reading import parted, read_table
from taylor_verify.solvers.files.rows import (
    Rows,
    check_numbers,
    exact_times,
    packed,
    written_digits,
)
from taylor_verify.solvers.files.step import FileStep, step_inside
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.solvers.values import Value

# Numbers as narrow as this are small integers and simple fractions in any precision.
_TELLING_BITS: Final = 18


@final
@dataclass(frozen=True)
class Recorded(Solver):
    """A solver whose answer is already written down, in ``quantities`` as a Trajectory has them.

    ``setting`` is the file. How many steps it took is not known. With ``carries_velocities`` the impulses
    were made of velocities, which are what was rounded.
    """

    quantities: Mapping[str, np.ndarray[Any, Any]]
    name: str = "file"
    setting: str = ""
    carries_velocities: bool = False

    def solve(self, problem: Problem) -> Trajectory:
        del problem
        return Trajectory(Outcome.FINISHED, self.quantities)


@dataclass(frozen=True)
class TrajectoryFile:
    """What a file holds: strictly monotonic times and whole groups of columns, all of one length.

    ``groups`` maps the names of COLUMNS to rows of values, which are formed when they are looked at
    (rows.py); ``digits`` is the largest number of significant decimals that any value is written
    with, None where one is binary or a fraction. ``notes`` say how the
    format was read, which columns were taken for which, and which were ignored.
    ``step`` is the integrator's step, where the file states it.
    """

    name: str
    times: tuple[Fraction, ...]
    groups: Mapping[str, Sequence[tuple[Value, ...]]]
    digits: int | None = None
    notes: tuple[str, ...] = ()
    step: FileStep | None = None

    @cached_property
    def rows(self) -> Mapping[str, Rows]:
        """The groups with ways to many of their rows at once."""
        return {name: Rows.of(group) for name, group in self.groups.items()}

    @cached_property
    def is_single_precision(self) -> bool:
        """True if every finite number is one of float32, and not by chance."""
        values = np.concatenate([rows.doubles().ravel() for rows in self.rows.values()])
        doubles = values[np.isfinite(values)]
        with np.errstate(over="ignore"):
            is_single = np.array_equal(doubles.astype(np.float32).astype(np.float64), doubles)
        return is_single and any(_width(double) >= _TELLING_BITS for double in doubles)

    @property
    def finite(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """The rows of which every number is finite."""
        found = np.ones(len(self.times), dtype=bool)
        for rows in self.rows.values():
            found &= rows.finite
        return found

    def at(self, places: Sequence[int]) -> TrajectoryFile:
        """Return some of the rows as a file of their own."""
        groups = {name: tuple(group[k] for k in places) for name, group in self.groups.items()}
        return replace(self, times=tuple(self.times[k] for k in places), groups=groups)


def read(file: str | os.PathLike[str], columns: Request = ()) -> TrajectoryFile:
    """Return the trajectory in a file of any format of formats/reading.py, or in FILE#PART.

    Columns: ``t``; ``w1 w2 w3``, ``u1 u2 u3`` and ``x1 x2 x3 y1 y2 y3`` in body axes; ``q0 q1 q2 q3``
    (scalar first) or ``r11 ... r33``, body to space; ``c1 c2 c3`` in space axes. Usual other names are
    taken, and ``columns`` names what has any other name, by pairs of our name and the file's. Raises
    Refused with every fault of it.
    """
    table = read_table(file)
    found = from_columns(table.columns, str(file), columns, table.notes)
    return replace(found, step=step_inside(parted(os.fspath(file))[0], table.columns))


def from_columns(
    columns: Iterable[Column], place: str, wanted: Request = (), notes: Sequence[str] = ()
) -> TrajectoryFile:
    """Return the trajectory in columns as they are written; ``place`` names their file in messages.

    ``notes`` are sentences about the columns that their reader has. Raises Refused with every fault.
    """
    faults = Faults()
    selection = select(_named_once(columns, place, faults), wanted, place, faults)
    taken = [replace(one, column=_packed(one.column)) for one in selection.columns]
    _refuse_ragged([one.column for one in taken], _length(taken), place, faults)
    finite = {one.name: check_numbers(one.column, place, faults) for one in taken}
    clock = next((one for one in taken if one.name == "t"), None)
    times = _times(clock.column.values, clock.column.name, place, faults) if clock else ()
    if faults.lines:
        raise Refused(faults.lines)
    by_name = {one.name: one for one in taken}
    groups = {
        group: Rows(
            [by_name[name].column.values for name in names],
            np.logical_and.reduce([finite[name] for name in names]),
            [by_name[name].factor for name in names],
        )
        for group, names in COLUMNS.items()
        if names[0] in by_name
    }
    digits = written_digits(one.column for one in taken if one is not clock)
    if clock and clock.factor != 1:
        times = tuple(t * clock.factor for t in times)
    return TrajectoryFile(place, times, groups, digits, (*notes, *selection.notes))


def _packed(column: Column) -> Column:
    return column._replace(values=packed(column.values))


def _named_once(columns: Iterable[Column], file: str, faults: Faults) -> list[Column]:
    found: dict[str, Column] = {}
    for column in columns:
        if column.name in found:
            faults.add("every column once", f"`{cut(column.name)}` again", file)
        found[column.name] = column
    return list(found.values())


def _length(taken: Sequence[Taken]) -> int:
    """The length that the columns should have: that of t, else the first column's."""
    by_name = {one.name: len(one.column.values) for one in taken}
    return by_name.get("t", next(iter(by_name.values()), 0))


def _refuse_ragged(columns: Sequence[Column], length: int, file: str, faults: Faults) -> None:
    for name, values in columns:
        if len(values) != length:
            faults.add(f"{length} values as in t", str(len(values)), f"{file}, column {cut(name)}")
    if columns and not length:
        faults.add("at least one row", "none", file)


# Numbers.


def _times(column: Sequence[Any], name: str, file: str, faults: Faults) -> tuple[Fraction, ...]:
    """The times, strictly increasing or strictly decreasing; anything else is a fault."""
    if faults.lines:
        return ()
    values = exact_times(column)
    times = [value for value in values if isinstance(value, Fraction)]
    if len(times) < len(values):
        row = next(i for i, v in enumerate(values, start=1) if not isinstance(v, Fraction))
        faults.add("a finite time", str(values[row - 1]), f"{file}, row {row}, column {cut(name)}")
        return ()
    rises = times[-1] >= times[0]
    wrong = [i for i in range(1, len(times)) if (times[i] > times[i - 1]) is not rises]
    wrong += [i for i in range(1, len(times)) if times[i] == times[i - 1] and not rises]
    for i in sorted(wrong)[:MOST_ALIKE]:
        now, before = _time_text(times[i]), _time_text(times[i - 1])
        expected = "no time twice" if now == before else f"times that keep {_word(rises)}"
        got = f"{now} again" if now == before else f"{now} after {before}"
        faults.add(expected, got, f"{file}, row {i + 1}, column {cut(name)}")
    add_more_alike(faults, len(wrong), f"{file}, column {cut(name)}")
    return tuple(times)


def _word(rises: bool) -> str:
    return "increasing" if rises else "decreasing"


def _time_text(time: Fraction) -> str:
    return f"{float(time):.17g}" if abs(time) < 10**300 else "a huge time"


def _width(double: float) -> int:
    """The bits of a number from its first to its last one."""
    numerator = Fraction(double).numerator
    return (numerator // (numerator & -numerator)).bit_length() if numerator else 0
