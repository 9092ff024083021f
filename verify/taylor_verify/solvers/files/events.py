"""The column or list ``events`` of a file: the times at which a solver found its event."""

from __future__ import annotations

import os
from fractions import Fraction
from typing import Any

from taylor_verify.records.faults import Faults, Refused, refusal
from taylor_verify.solvers.files.formats.reading import read_table
from taylor_verify.solvers.values import exact

_NAME = "events"


def read_events(file: str | os.PathLike[str]) -> list[Fraction]:
    """Return the times, exactly. Raises Refused for a file without them, with every fault of them."""
    faults, times = Faults(), []
    for k, entry in enumerate(_entries(file)):
        # A column beside longer ones ends in blanks.
        if entry is None or entry == "" or entry != entry:
            continue
        try:
            time = exact(entry)
        except ValueError as error:
            faults.add(str(error), repr(entry), f"{file}, {_NAME}[{k}]")
            continue
        if not isinstance(time, Fraction):
            faults.add("a finite time", repr(entry), f"{file}, {_NAME}[{k}]")
            continue
        times.append(time)
    if faults.lines:
        raise Refused(faults.lines)
    return times


def _entries(file: str | os.PathLike[str]) -> list[Any]:
    for column in read_table(file).columns:
        if column.name.strip().lower() == _NAME:
            return list(column.values)
    raise refusal(f"a column or list `{_NAME}`", "none", os.fspath(file))
