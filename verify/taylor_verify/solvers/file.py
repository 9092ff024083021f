"""Somebody's trajectory in a file: every number exactly as written, or every fault with its place.

t                 time                          q0 q1 q2 q3      quaternion of R, scalar first
w1 w2 w3          angular velocity, body axes   r11 r12 ... r33  R itself, r12 is row 1, column 2
x1 x2 x3 y1 y2 y3 impulses, body axes           c1 c2 c3         centre, space axes

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
from taylor_verify.scenes.faults import Faults, Refused, cut, near
from taylor_verify.solvers.file_step import STEP_COLUMNS, FileStep, step_inside
from taylor_verify.solvers.formats.column import MOST_ALIKE, Column, add_more_alike, shown
from taylor_verify.solvers.formats.reading import read_columns
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.solvers.values import Value, exact

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
_DECIMAL: Final = re.compile(r"[+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?")
# Errors are told as doubles, and so is whatever is as large as the answer itself.
_LARGEST: Final = 2**1000


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

    ``groups`` maps the names of COLUMNS to rows of values; ``digits`` is the largest number of
    significant decimals that any value is written with, None where one is binary or a fraction. ``step``
    is the integrator's step, where the file states it.
    """

    name: str
    times: tuple[Fraction, ...]
    groups: Mapping[str, tuple[tuple[Value, ...], ...]]
    digits: int | None = None
    step: FileStep | None = None


def read(file: str | os.PathLike[str]) -> TrajectoryFile:
    """The trajectory in a CSV, NPZ, Parquet or JSON file.

    Columns: ``t``; ``w1 w2 w3`` and ``x1 x2 x3 y1 y2 y3`` in body axes; ``q0 q1 q2 q3`` (scalar first) or
    ``r11 ... r33``, body to space; ``c1 c2 c3`` in space axes. Raises Refused with every fault of it.
    """
    path, faults = Path(file), Faults()
    columns = _named_once(read_columns(path, KNOWN), str(file), faults)
    _refuse_unknown(columns, str(file), faults)
    _refuse_incomplete(columns, str(file), faults)
    lengths = _lengths(columns)
    _refuse_ragged(columns, lengths, str(file), faults)
    wanted = [column for column in columns if column.name in KNOWN]
    values = {c.name: list(_exact_column(c, str(file), faults)) for c in wanted}
    times = _times(values.get("t", []), str(file), faults)
    if faults.lines:
        raise Refused(faults.lines)
    groups = {
        group: tuple(zip(*(values[name] for name in names), strict=True))
        for group, names in COLUMNS.items()
        if names[0] in values
    }
    step = step_inside(path, columns)
    return TrajectoryFile(str(file), times, groups, _written_digits(wanted), step)


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


def _times(values: Sequence[Value], file: str, faults: Faults) -> tuple[Fraction, ...]:
    """The times, strictly increasing or strictly decreasing; anything else is a fault."""
    if faults.lines:
        return ()
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


def _written_digits(columns: Iterable[Column]) -> int | None:
    """The most significant digits of any decimal besides the times; None where they do not tell."""
    most = 0
    for name, values in columns:
        for raw in values if name != "t" else ():
            if not isinstance(raw, str) or not _DECIMAL.fullmatch(raw.strip()):
                return None
            mantissa = raw.lower().split("e")[0]
            digits = "".join(character for character in mantissa if character.isdigit())
            most = max(most, len(digits.lstrip("0")))
    # Zeros alone are exact however they are written.
    return most or None
