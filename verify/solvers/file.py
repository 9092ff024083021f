"""Somebody's trajectory in a file: every number exactly as written, or every fault with its place.

t                 time                          q0 q1 q2 q3      quaternion of R, scalar first
w1 w2 w3          angular velocity, body axes   r11 r12 ... r33  R itself, r12 is row 1, column 2
x1 x2 x3 y1 y2 y3 impulses, body axes           c1 c2 c3         centre, space axes

Decimals, ``a/b`` and hexadecimal floats become rationals; binary numbers are taken as they are. None
of them passes through a double on its way.
"""

from __future__ import annotations

import csv
import json
import math
import re
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, Final, NamedTuple, final

import numpy as np

from verify.models.problem import Problem
from verify.scenes.faults import Faults, Refused, near
from verify.solvers.solver import Solver
from verify.solvers.trajectory import Outcome, Trajectory
from verify.solvers.values import Value, exact, is_number

GROUPS: Final[Mapping[str, tuple[str, ...]]] = {
    "omega": ("w1", "w2", "w3"),
    "linear_impulse": ("x1", "x2", "x3"),
    "angular_impulse": ("y1", "y2", "y3"),
    "quaternion": ("q0", "q1", "q2", "q3"),
    "attitude": tuple(f"r{i}{k}" for i in (1, 2, 3) for k in (1, 2, 3)),
    "centre": ("c1", "c2", "c3"),
}
KNOWN: Final = ("t", *(name for names in GROUPS.values() for name in names))
# Printed by `publish --reference` beside the motion; it is no part of it.
_IGNORED: Final = ("radius",)
# What other programs call the same columns: none of these is near enough in spelling to be guessed.
_ELSEWHERE: Final = {
    "time": "t",
    **dict(zip(("wx", "wy", "wz"), GROUPS["omega"], strict=True)),
    **dict(zip(("omega1", "omega2", "omega3"), GROUPS["omega"], strict=True)),
    **dict(zip(("qw", "qx", "qy", "qz"), GROUPS["quaternion"], strict=True)),
    **dict(zip(("cx", "cy", "cz"), GROUPS["centre"], strict=True)),
}
_DECIMAL: Final = re.compile(r"[+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?")
_MOST_ROWS: Final = 1_000_000
# Errors are told as doubles, and so is whatever is as large as the answer itself.
_LARGEST: Final = 2**1000
_MOST_ALIKE: Final = 3
_MOST_SHOWN: Final = 40


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

    ``groups`` maps the names of GROUPS to rows of values; ``digits`` is the largest number of
    significant decimals that any value is written with, None where one is binary or a fraction.
    """

    name: str
    times: tuple[Fraction, ...]
    groups: Mapping[str, tuple[tuple[Value, ...], ...]]
    digits: int | None = None


class _Column(NamedTuple):
    name: str
    values: Sequence[object]


def read(file: str | Path) -> TrajectoryFile:
    """The trajectory in a CSV, NPZ, Parquet or JSON file.

    Columns: ``t``; ``w1 w2 w3`` and ``x1 x2 x3 y1 y2 y3`` in body axes; ``q0 q1 q2 q3`` (scalar first) or
    ``r11 ... r33``, body to space; ``c1 c2 c3`` in space axes. Raises Refused with every fault of it.
    """
    path, faults = Path(file), Faults()
    columns = _named_once(_columns(path), str(file), faults)
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
        for group, names in GROUPS.items()
        if names[0] in values
    }
    return TrajectoryFile(str(file), times, groups, _written_digits(wanted))


# The formats. Each reader returns the columns as they are, or raises Refused.


def _columns(path: Path) -> list[_Column]:
    reader = _READERS.get(path.suffix.lower())
    if not path.is_file():
        got = "a folder" if path.is_dir() else "no such file"
        raise Refused([f"expected a trajectory file, got {got} @ {path}"])
    if reader is None:
        got = path.suffix or "no suffix"
        expected = f"a file that ends in {', '.join(_READERS)}"
        raise Refused([f"expected {expected}, got {got} @ {path}"])
    try:
        return reader(path)
    except OSError as error:
        reason = error.strerror or str(error)
        raise Refused([f"expected a readable file, got {reason!r} @ {path}"]) from None


def _text(path: Path) -> str:
    try:
        return path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError:
        raise Refused([f"expected text in UTF-8, got other bytes @ {path}"]) from None


def _csv(path: Path) -> list[_Column]:
    """A header and rows; separated by comma, semicolon, tab or blanks; # begins a comment line."""
    numbered = [
        (number, line)
        for number, line in enumerate(_text(path).splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not numbered:
        raise Refused([f"expected a header line and rows, got an empty file @ {path}"])
    lines = [line for _, line in numbered]
    separator = next((mark for mark in ",;\t" if mark in lines[0]), None)
    if separator is None:
        rows = [line.split() for line in lines]
    else:
        try:
            rows = list(csv.reader(lines, delimiter=separator))
        except csv.Error as error:
            raise Refused([f"expected a CSV file, got a fault in it: {error} @ {path}"]) from None
    header = [name.strip() for name in rows[0]]
    if all(is_number(name) for name in header):
        raise Refused(
            [f"expected a header line that names the columns, got numbers @ {path}, line 1"]
        )
    ragged = [
        (n, row) for (n, _), row in zip(numbered, rows, strict=False) if len(row) != len(header)
    ]
    if ragged:
        faults = Faults()
        for number, row in ragged[:_MOST_ALIKE]:
            faults.add(
                f"{len(header)} values as in the header", str(len(row)), f"{path}, line {number}"
            )
        _more_alike(faults, len(ragged), f"{path}, more lines")
        raise Refused(faults.lines)
    cells = list(zip(*rows[1:], strict=True)) or [()] * len(header)
    return [_Column(name, column) for name, column in zip(header, cells, strict=True)]


def _json(path: Path) -> list[_Column]:
    """An object of column arrays, or one that has them under ``columns``."""
    try:
        document = json.loads(_text(path), parse_float=str, parse_int=str, parse_constant=float)
    except (ValueError, RecursionError) as error:
        reason = "brackets nested too deeply" if isinstance(error, RecursionError) else error
        raise Refused([f"expected a JSON document, got a fault in it: {reason} @ {path}"]) from None
    if isinstance(document, dict) and isinstance(document.get("columns"), dict):
        document = document["columns"]
    if not isinstance(document, dict):
        expected = 'an object of column arrays {"t": [...], "w1": [...]}'
        raise Refused([f"expected {expected}, got {_shown(document)} @ {path}"])
    faults, columns = Faults(), []
    for name, values in document.items():
        if isinstance(values, list):
            columns.append(_Column(name, values))
        elif name in KNOWN:
            faults.add("an array of numbers", _shown(values), f"{path}, column {name}")
    if faults.lines:
        raise Refused(faults.lines)
    return columns


def _npz(path: Path) -> list[_Column]:
    """Named one-dimensional arrays; pickled objects are not read."""
    faults, columns = Faults(), []
    try:
        with np.load(path, allow_pickle=False) as archive:
            if not isinstance(archive, np.lib.npyio.NpzFile):
                raise Refused([f"expected an NPZ archive of named arrays, got one array @ {path}"])
            for name in archive.files:
                values = archive[name]
                if values.ndim == 1 and values.dtype.kind in "fiuUb":
                    columns.append(_Column(name, list(values)))
                else:
                    got = f"shape {values.shape} of {values.dtype}"
                    expected = "a one-dimensional array of real numbers"
                    faults.add(expected, got, f"{path}, column {name}")
    except (ValueError, EOFError, KeyError, zipfile.BadZipFile) as error:
        raise Refused([f"expected an NPZ archive, got a fault in it: {error} @ {path}"]) from None
    if faults.lines:
        raise Refused(faults.lines)
    return columns


def _parquet(path: Path) -> list[_Column]:
    try:
        from pyarrow import ArrowException, parquet
    except ModuleNotFoundError:
        raise Refused(
            [
                f"expected the package pyarrow to read Parquet, got none @ {path} "
                "(install it with `pip install 'taylor-verify[parquet]'`, or write CSV)"
            ]
        ) from None
    try:
        table = parquet.read_table(path)
    except (ArrowException, ValueError) as error:
        reason = str(error).splitlines()[0]
        raise Refused([f"expected a Parquet file, got a fault in it: {reason} @ {path}"]) from None
    return [_Column(name, table.column(i).to_pylist()) for i, name in enumerate(table.column_names)]


_READERS: Final = {
    ".csv": _csv,
    ".tsv": _csv,
    ".txt": _csv,
    ".json": _json,
    ".npz": _npz,
    ".parquet": _parquet,
}


# Which columns there are.


def _named_once(columns: Iterable[_Column], file: str, faults: Faults) -> list[_Column]:
    found: dict[str, _Column] = {}
    for column in columns:
        if column.name in found:
            faults.add("every column once", f"`{column.name}` again", file)
        found[column.name] = column
    return list(found.values())


def _refuse_unknown(columns: Sequence[_Column], file: str, faults: Faults) -> None:
    for name, _ in columns:
        if name not in KNOWN and name not in _IGNORED:
            meant = _ELSEWHERE.get(name.lower())
            mend = f"did you mean `{meant}`?" if meant else near(name.lower(), KNOWN)
            faults.add("a known column", f"`{name}`", file, mend)


def _refuse_incomplete(columns: Sequence[_Column], file: str, faults: Faults) -> None:
    present = {column.name for column in columns}
    if "t" not in present:
        faults.add("a column `t` of times", "none", file, "add the column `t`")
    for names in GROUPS.values():
        missing = [name for name in names if name not in present]
        if 0 < len(missing) < len(names):
            faults.add(f"all of {' '.join(names)}", f"no {' '.join(missing)}", file)
    if {"q0", "r11"} <= present:
        faults.add("the attitude once", "q0 q1 q2 q3 and r11 ... r33", file, "keep one of them")


def _lengths(columns: Sequence[_Column]) -> int:
    """The length that the columns should have: that of t, else the first column's."""
    by_name = {column.name: len(column.values) for column in columns}
    return by_name.get("t", next(iter(by_name.values()), 0))


def _refuse_ragged(columns: Sequence[_Column], length: int, file: str, faults: Faults) -> None:
    for name, values in columns:
        if len(values) != length:
            faults.add(f"{length} values as in t", str(len(values)), f"{file}, column {name}")
    if not length:
        faults.add("at least one row", "none", file)
    if length > _MOST_ROWS:
        faults.add(f"at most {_MOST_ROWS} rows", str(length), file)


# Numbers.


def _exact_column(column: _Column, file: str, faults: Faults) -> Iterator[Value]:
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
            if wrong <= _MOST_ALIKE:
                faults.add(str(error), _shown(raw), f"{file}, row {row}, column {column.name}")
            yield math.nan
    _more_alike(faults, wrong, f"{file}, column {column.name}")


def _more_alike(faults: Faults, wrong: int, place: str) -> None:
    if wrong > _MOST_ALIKE:
        faults.lines.append(f"and {wrong - _MOST_ALIKE} more of this kind @ {place}")


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
    for i in sorted(wrong)[:_MOST_ALIKE]:
        now, before = _time_text(times[i]), _time_text(times[i - 1])
        expected = "no time twice" if now == before else f"times that keep {_word(rises)}"
        got = f"{now} again" if now == before else f"{now} after {before}"
        faults.add(expected, got, f"{file}, row {i + 1}, column t")
    _more_alike(faults, len(wrong), f"{file}, column t")
    return tuple(times)


def _word(rises: bool) -> str:
    return "increasing" if rises else "decreasing"


def _time_text(time: Fraction) -> str:
    return f"{float(time):.17g}" if abs(time) < 10**300 else "a huge time"


def _written_digits(columns: Iterable[_Column]) -> int | None:
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


def _shown(value: object) -> str:
    text = repr(value) if isinstance(value, str) or value is None else str(value)
    return text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}..."
