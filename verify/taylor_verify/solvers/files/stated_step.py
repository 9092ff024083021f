"""The step of the integrator that wrote a trajectory file, as the file, its name or its rows state it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from math import isfinite
from pathlib import Path
from typing import Final

from taylor_verify.records.regular_file import regular_file
from taylor_verify.solvers.files.formats.column import BYTES, Column
from taylor_verify.solvers.files.formats.reading import parted
from taylor_verify.solvers.values import exact

# A column of these names that has one value says the step; it is no part of the motion.
STEP_COLUMNS: Final = ("dt", "h", "step_size", "stepsize", "time_step", "timestep")

# Two digits of exponent: no step needs more, and 1e999999999 would take all memory.
_NUMBER: Final = (
    r"(?P<number>(?:[0-9]{1,20}(?:[.p][0-9]{1,40})?|\.[0-9]{1,40})(?:e[+-]?[0-9]{1,2})?)"
)
_STEP: Final = r"dt|h|step|step[ _-]?size|time[ _-]?step"
# Comments that say the step stand at the top.
_HEAD_BYTES: Final = 2**14
# Rows are equally spaced if their spacing differs by no more than printed times make it.
_EVEN: Final = Fraction(1, 10**4)
_FEWEST_ROWS: Final = 3


class Source(StrEnum):
    """The source of a step."""

    CALL = "the call"
    FILE = "the files themselves"
    NAME = "the names of the files"
    ROWS = "the spacing of the rows"


@dataclass(frozen=True)
class FileStep:
    """A step in the scene's unit of time, and the source that states it."""

    value: float
    source: Source


def step_inside(path: Path, columns: Iterable[Column]) -> FileStep | None:
    """Return the step that a file states: a column of one value, a comment, or a key of its JSON object.

    None where it states none, or two that differ.
    """
    for name, values in columns:
        if name.lower() in STEP_COLUMNS and (value := _only_value(values)) is not None:
            return FileStep(value, Source.FILE)
    return _in_head(path, _STEP)


def step_in_name(name: str) -> FileStep | None:
    """Return the step that the name of a file states, or that of its folder, as in ``run_h0.01.csv``."""
    return _in_name(Path(name), _STEP)


def knob_of(name: str, knob: str) -> FileStep | None:
    """Return the number of a knob that a file's name states, that of its folder, or a comment or key in it.

    A name is one such as ``run_rtol1e-6.csv``.
    """
    path, word = parted(name)[0], re.escape(knob)
    return _in_name(path, word) or _in_head(path, word)


def step_of_rows(times: Sequence[Fraction]) -> FileStep | None:
    """Return the spacing of equally spaced rows; None for other rows."""
    if len(times) < _FEWEST_ROWS:
        return None
    mean = (times[-1] - times[0]) / (len(times) - 1)
    even = all(abs(t - times[0] - k * mean) <= _EVEN * abs(mean) for k, t in enumerate(times))
    return FileStep(float(abs(mean)), Source.ROWS) if even else None


def _in_name(path: Path, word: str) -> FileStep | None:
    for part in (path.stem, path.parent.name):
        if step := _only(_stated(word, "[=_-]?", part), Source.NAME):
            return step
    return None


def _in_head(path: Path, word: str) -> FileStep | None:
    suffix = path.suffix.lower()
    if suffix not in (".csv", ".tsv", ".txt", ".json"):
        return None
    with regular_file(path, "a trajectory file", BYTES) as file:
        head = file.read(_HEAD_BYTES).decode("utf-8", errors="replace")
    if suffix == ".json":
        key = rf'"(?P<word>{word})"\s*:\s*"?{_NUMBER}"?\s*[,}}]'
        return _only(re.finditer(key, head, re.IGNORECASE), Source.FILE)
    comments = (line for line in head.splitlines() if line.lstrip().startswith("#"))
    stated = (match for line in comments for match in _stated(word, r"\s*[=:]\s*", line))
    return _only(stated, Source.FILE)


def _stated(word: str, between: str, text: str) -> Iterator[re.Match[str]]:
    """Return where a word and its number stand: run_h0.01, dt=0.01; neither ch0.1 nor dt10ms."""
    stated = rf"(?<![A-Za-z])(?P<word>{word}){between}{_NUMBER}(?![0-9A-Za-z])"
    return re.finditer(stated, text, re.IGNORECASE)


def _only(stated: Iterable[re.Match[str]], source: Source) -> FileStep | None:
    """Return the one positive step that is stated; two that differ state none."""
    values = {value for match in stated if (value := _value(match)) > 0}
    return FileStep(values.pop(), source) if len(values) == 1 else None


def _value(match: re.Match[str]) -> float:
    number = match["number"].lower().replace("p", ".")
    # step3 is more likely the third run than a step of 3.
    if match["word"].lower() == "step" and number.isdigit():
        return 0.0
    return float(number)


def _only_value(values: Sequence[object]) -> float | None:
    """Return the positive number that every row of a column repeats; None for any other column."""
    if not len(values) or any(value != values[0] for value in values[1:]):
        return None
    try:
        value = exact(values[0])
    except ValueError:
        return None
    return float(value) if isfinite(value) and value > 0 else None
