"""Somebody's trajectory in a file: every number exactly as written, or every fault with its place.

t                 time                          q0 q1 q2 q3      quaternion of R, scalar first
w1 w2 w3          angular velocity, body axes   r11 r12 ... r33  R itself, r12 is row 1, column 2
u1 u2 u3          velocity of the body's        c1 c2 c3         centre, space axes
                  origin, body axes
x1 x2 x3 y1 y2 y3 impulses, body axes

Usual other names and units are taken and said (solvers.columns).

Decimals, ``a/b`` and hexadecimal floats become rationals; binary numbers are taken as they are. None
of them passes through a double on its way.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, Final, final

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.faults import Faults, Refused, cut
from taylor_verify.solvers.columns.names import KNOWN
from taylor_verify.solvers.columns.request import Request
from taylor_verify.solvers.columns.selection import Taken, select
from taylor_verify.solvers.formats.column import MOST_ALIKE, Column, add_more_alike, shown
from taylor_verify.solvers.formats.reading import read_columns
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.solvers.values import Value, exact

_DECIMAL: Final = re.compile(r"[+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?")
# Errors are told as doubles, and so is whatever is as large as the answer itself.
_LARGEST: Final = 2**1000


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

    ``groups`` maps the names of COLUMNS to rows of values; ``digits`` is the largest number of
    significant decimals that any value is written with, None where one is binary or a fraction. ``notes``
    say which columns were taken for which, and which were ignored.
    """

    name: str
    times: tuple[Fraction, ...]
    groups: Mapping[str, tuple[tuple[Value, ...], ...]]
    digits: int | None = None
    notes: tuple[str, ...] = ()


def read(file: str | os.PathLike[str], columns: Request = ()) -> TrajectoryFile:
    """Read the trajectory in a CSV, NPZ, Parquet or JSON file.

    Columns: ``t``; ``w1 w2 w3``, ``u1 u2 u3`` and ``x1 x2 x3 y1 y2 y3`` in body axes; ``q0 q1 q2 q3``
    (scalar first) or ``r11 ... r33``, body to space; ``c1 c2 c3`` in space axes. Usual other names are
    taken, and ``columns`` names what has any other name, by pairs of our name and the file's. Raises
    Refused with every fault of it.
    """
    return from_columns(read_columns(Path(file), KNOWN), str(file), columns)


def from_columns(
    columns: Iterable[Column], place: str, wanted: Request = (), notes: Sequence[str] = ()
) -> TrajectoryFile:
    """Return the trajectory in columns as they are written; ``place`` names their file in messages.

    ``notes`` are sentences about the columns that their reader has. Raises Refused with every fault.
    """
    faults = Faults()
    selection = select(_named_once(columns, place, faults), wanted, place, faults)
    taken = selection.columns
    _refuse_ragged([one.column for one in taken], _length(taken), place, faults)
    values = {one.name: list(_exact_column(one.column, place, faults)) for one in taken}
    clock = next((one for one in taken if one.name == "t"), None)
    times = _times(values["t"], clock.column.name, place, faults) if clock else ()
    if faults.lines:
        raise Refused(faults.lines)
    scaled = {one.name: one.scaled(values[one.name]) for one in taken}
    groups = {
        group: tuple(zip(*(scaled[name] for name in names), strict=True))
        for group, names in COLUMNS.items()
        if names[0] in values
    }
    digits = _written_digits(one.column for one in taken if one is not clock)
    factor = clock.factor if clock else Fraction(1)
    said = (*notes, *selection.notes)
    return TrajectoryFile(place, tuple(t * factor for t in times), groups, digits, said)


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


def _exact_column(column: Column, file: str, faults: Faults) -> Iterator[Value]:
    """Every value exactly; NaN stands for what is no number and was recorded as a fault."""
    wrong = 0
    for row, raw in enumerate(column.values, start=1):
        try:
            value = exact(raw)
            if isinstance(value, Fraction) and abs(value) >= _LARGEST:
                raise ValueError("a number below 2^1000 in size")
            yield value
        except ValueError as error:
            wrong += 1
            if wrong <= MOST_ALIKE:
                faults.add(str(error), shown(raw), f"{file}, row {row}, column {column.name}")
            yield math.nan
    add_more_alike(faults, wrong, f"{file}, column {column.name}")


def _times(values: Sequence[Value], name: str, file: str, faults: Faults) -> tuple[Fraction, ...]:
    """The times, strictly increasing or strictly decreasing; anything else is a fault."""
    if faults.lines:
        return ()
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


def _written_digits(columns: Iterable[Column]) -> int | None:
    """The most significant digits of any decimal; None where they do not tell."""
    most = 0
    for _, values in columns:
        for raw in values:
            if not isinstance(raw, str) or not _DECIMAL.fullmatch(raw.strip()):
                return None
            mantissa = raw.lower().split("e")[0]
            digits = "".join(character for character in mantissa if character.isdigit())
            most = max(most, len(digits.lstrip("0")))
    # Zeros alone are exact however they are written.
    return most or None
