"""Somebody's trajectory in a file: every number exactly as written, or every fault with its place.

t                 time                          q0 q1 q2 q3      quaternion of R, scalar first
w1 w2 w3          angular velocity, body axes   r11 r12 ... r33  R itself, r12 is row 1, column 2
x1 x2 x3 y1 y2 y3 impulses, body axes           c1 c2 c3         centre, space axes

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
from taylor_verify.scenes.faults import Faults, Refused, cut, near
from taylor_verify.solvers.file_step import STEP_COLUMNS, FileStep, step_inside
from taylor_verify.solvers.formats.column import MOST_ALIKE, Column, add_more_alike
from taylor_verify.solvers.formats.reading import parted, read_table
from taylor_verify.solvers.rows import Rows, check_numbers, exact_times, packed, written_digits
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.solvers.values import Value

KNOWN: Final = ("t", *(name for names in COLUMNS.values() for name in names))
# Printed by `publish --reference` beside the motion, or a statement of the step: no part of the motion.
_IGNORED: Final = ("radius", *STEP_COLUMNS)
# What other programs call the same columns: none of these is near enough in spelling to be guessed.
_ELSEWHERE: Final = {
    "time": "t",
    **dict(zip(("wx", "wy", "wz"), COLUMNS["omega"], strict=True)),
    **dict(zip(("omega1", "omega2", "omega3"), COLUMNS["omega"], strict=True)),
    **dict(zip(("qw", "qx", "qy", "qz"), COLUMNS["quaternion"], strict=True)),
    **dict(zip(("cx", "cy", "cz"), COLUMNS["centre"], strict=True)),
}


@final
@dataclass(frozen=True)
class Recorded(Solver):
    """A solver whose answer is already written down, in ``quantities`` as a Trajectory has them.

    ``setting`` is the file. How many steps it took is not known.
    """

    quantities: Mapping[str, np.ndarray[Any, Any]]
    name: str = "file"
    setting: str = ""

    def solve(self, problem: Problem) -> Trajectory:
        del problem
        return Trajectory(Outcome.FINISHED, self.quantities)


@dataclass(frozen=True)
class TrajectoryFile:
    """What a file holds: strictly monotonic times and whole groups of columns, all of one length.

    ``groups`` maps the names of COLUMNS to rows of values, which are formed when they are looked at
    (solvers.rows); ``digits`` is the largest number of significant decimals that any value is written
    with, None where one is binary or a fraction. ``notes`` are sentences that say how the format was read.
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


def read(file: str | os.PathLike[str]) -> TrajectoryFile:
    """Return the trajectory in a file of any format of solvers.formats.reading, or in FILE#PART.

    Columns: ``t``; ``w1 w2 w3`` and ``x1 x2 x3 y1 y2 y3`` in body axes; ``q0 q1 q2 q3`` (scalar first) or
    ``r11 ... r33``, body to space; ``c1 c2 c3`` in space axes. Raises Refused with every fault of it.
    """
    faults = Faults()
    table = read_table(file, KNOWN)
    columns = _named_once(table.columns, str(file), faults)
    _refuse_unknown(columns, str(file), faults)
    _refuse_incomplete(columns, str(file), faults)
    lengths = _lengths(columns)
    _refuse_ragged(columns, lengths, str(file), faults)
    wanted = [Column(c.name, packed(c.values)) for c in columns if c.name in KNOWN]
    finite = {column.name: check_numbers(column, str(file), faults) for column in wanted}
    values = dict(wanted)
    times = _times(values.get("t", []), str(file), faults)
    if faults.lines:
        raise Refused(faults.lines)
    groups = {
        group: Rows(
            [values[name] for name in names],
            np.logical_and.reduce([finite[name] for name in names]),
        )
        for group, names in COLUMNS.items()
        if names[0] in values
    }
    step = step_inside(parted(os.fspath(file))[0], columns)
    return TrajectoryFile(str(file), times, groups, written_digits(wanted), table.notes, step)


# Which columns there are.


def _named_once(columns: Iterable[Column], file: str, faults: Faults) -> list[Column]:
    found: dict[str, Column] = {}
    for column in columns:
        if column.name in found:
            faults.add("every column once", f"`{cut(column.name)}` again", file)
        found[column.name] = column
    return list(found.values())


def _refuse_unknown(columns: Sequence[Column], file: str, faults: Faults) -> None:
    for name, _ in columns:
        if name not in KNOWN and name not in _IGNORED:
            meant = _ELSEWHERE.get(name.lower())
            mend = f"did you mean `{meant}`?" if meant else near(cut(name.lower()), KNOWN)
            faults.add("a known column", f"`{cut(name)}`", file, mend)


def _refuse_incomplete(columns: Sequence[Column], file: str, faults: Faults) -> None:
    present = {column.name for column in columns}
    if "t" not in present:
        faults.add("a column `t` of times", "none", file, "add the column `t`")
    for names in COLUMNS.values():
        missing = [name for name in names if name not in present]
        if 0 < len(missing) < len(names):
            faults.add(f"all of {' '.join(names)}", f"no {' '.join(missing)}", file)
    if {"q0", "r11"} <= present:
        faults.add("the attitude once", "q0 q1 q2 q3 and r11 ... r33", file, "keep one of them")


def _lengths(columns: Sequence[Column]) -> int:
    """The length that the columns should have: that of t, else the first column's."""
    by_name = {column.name: len(column.values) for column in columns}
    return by_name.get("t", next(iter(by_name.values()), 0))


def _refuse_ragged(columns: Sequence[Column], length: int, file: str, faults: Faults) -> None:
    for name, values in columns:
        if len(values) != length:
            faults.add(f"{length} values as in t", str(len(values)), f"{file}, column {cut(name)}")
    if not length:
        faults.add("at least one row", "none", file)


# Numbers.


def _times(column: Sequence[Any], file: str, faults: Faults) -> tuple[Fraction, ...]:
    """The times, strictly increasing or strictly decreasing; anything else is a fault."""
    if faults.lines:
        return ()
    values = exact_times(column)
    times = [value for value in values if isinstance(value, Fraction)]
    if len(times) < len(values):
        row = next(i for i, v in enumerate(values, start=1) if not isinstance(v, Fraction))
        faults.add("a finite time", str(values[row - 1]), f"{file}, row {row}, column t")
        return ()
    rises = times[-1] >= times[0]
    wrong = [i for i in range(1, len(times)) if (times[i] > times[i - 1]) is not rises]
    wrong += [i for i in range(1, len(times)) if times[i] == times[i - 1] and not rises]
    for i in sorted(wrong)[:MOST_ALIKE]:
        now, before = _time_text(times[i]), _time_text(times[i - 1])
        expected = "no time twice" if now == before else f"times that keep {_word(rises)}"
        got = f"{now} again" if now == before else f"{now} after {before}"
        faults.add(expected, got, f"{file}, row {i + 1}, column t")
    add_more_alike(faults, len(wrong), f"{file}, column t")
    return tuple(times)


def _word(rises: bool) -> str:
    return "increasing" if rises else "decreasing"


def _time_text(time: Fraction) -> str:
    return f"{float(time):.17g}" if abs(time) < 10**300 else "a huge time"
