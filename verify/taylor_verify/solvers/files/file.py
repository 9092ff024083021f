"""A trajectory file: every number exactly as written, or every fault with its place.

`docs/columns.md` has the columns; usual other names and units are taken and said (the folder columns).

Decimals, ``a/b`` and hexadecimal floats become rationals; binary numbers are taken as they are. None
of them passes through a double on its way.
"""

from __future__ import annotations

import operator
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any, final

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.records.faults import Faults, Refused, cut
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.attitudes import one_attitude
from taylor_verify.solvers.files.columns.names import GROUPS
from taylor_verify.solvers.files.columns.request import Request
from taylor_verify.solvers.files.columns.selection import Taken, select
from taylor_verify.solvers.files.formats.column import Column, alike
from taylor_verify.solvers.files.formats.reading import parted, read_table
from taylor_verify.solvers.files.rows import Rows, check_numbers, written_digits
from taylor_verify.solvers.files.single_precision import are_single_precision
from taylor_verify.solvers.files.step import FileStep, step_inside
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory


@final
@dataclass(frozen=True)
class Recorded(Solver):
    """A solver with a recorded answer, in ``quantities`` as in a Trajectory.

    ``setting`` is the file. The number of its steps is not known. With ``carries_velocities`` the impulses
    were computed from velocities, which were rounded.
    """

    quantities: Mapping[str, np.ndarray[Any, Any]]
    name: str = "file"
    setting: str = ""
    carries_velocities: bool = False
    takes_loads = True

    def solve(self, problem: Problem) -> Trajectory:
        del problem
        return Trajectory(Outcome.FINISHED, self.quantities)


@dataclass(frozen=True)
class TrajectoryFile:
    """A trajectory file: strictly monotonic times and whole groups of columns, all of one length.

    ``groups`` maps the names of COLUMNS to rows of values, which are formed when they are looked at.
    ``digits`` is the largest number of significant decimals that any value is written with, None where
    one is binary or a fraction. ``notes`` say how the format was read, which columns were taken for
    which, and which were ignored. ``step`` is the integrator's step, where the file states it. ``columns``
    are the names of the columns of each group, states of the scene's own among them.
    """

    name: str
    times: tuple[Fraction, ...]
    groups: Mapping[str, Rows]
    digits: int | None = None
    notes: tuple[str, ...] = ()
    step: FileStep | None = None
    columns: Mapping[str, tuple[str, ...]] = field(default_factory=lambda: COLUMNS)

    @cached_property
    def is_single_precision(self) -> bool:
        """True if every finite number is one of float32, or its decimal, and not by chance."""
        return are_single_precision(
            column for rows in self.groups.values() for column in rows.written()
        )

    @property
    def finite(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """The rows of which every number is finite."""
        finite = np.ones(len(self.times), dtype=bool)
        for rows in self.groups.values():
            finite &= rows.finite
        return finite

    def at(self, places: Sequence[int]) -> TrajectoryFile:
        """Return some of the rows as a file of their own."""
        groups = {name: rows.at(places) for name, rows in self.groups.items()}
        return replace(self, times=tuple(self.times[k] for k in places), groups=groups)


def read(
    file: str | os.PathLike[str], columns: Request = (), scene: Scene | None = None
) -> TrajectoryFile:
    """Return the trajectory in a file of any format of formats/reading.py, or in FILE#PART.

    Columns: ``t``; ``w1 w2 w3``, ``u1 u2 u3`` and ``x1 x2 x3 y1 y2 y3`` in body axes; ``q0 q1 q2 q3``
    (scalar first) or ``r11 ... r33``, body to space; ``c1 c2 c3`` in space axes; and the states of the
    scene's own by their names. Usual other names are taken, and ``columns`` names what has any other name,
    by pairs of our name and the file's. Raises Refused with every fault of it.
    """
    table = read_table(file)
    trajectory = from_columns(table.columns, str(file), columns, table.notes, own_columns(scene))
    return replace(trajectory, step=step_inside(parted(os.fspath(file))[0], table.columns))


def own_columns(scene: Scene | None) -> Mapping[str, tuple[str, ...]]:
    """Return the columns of each state of the scene's own, tracked or not."""
    states = () if scene is None else scene.own_states
    return {state.name: state.components for state in states}


def from_columns(
    columns: Iterable[Column],
    place: str,
    wanted: Request = (),
    notes: Sequence[str] = (),
    own: Mapping[str, tuple[str, ...]] | None = None,
) -> TrajectoryFile:
    """Return the trajectory in columns as they are written; ``place`` names their file in messages.

    ``notes`` are sentences about the columns that their reader has, and ``own`` the columns of states of
    the scene's own. Raises Refused with every fault.
    """
    faults, own = Faults(), own or {}
    by_name = _named_once(columns, place, faults)
    apart, left, asked = _apart(by_name, wanted, own, place, faults)
    selection = select(left, asked, place, faults)
    own = _whole(apart, own, place, faults)
    taken = {column.name: column for column in (*selection.columns, *apart)}
    read = {
        name: column.column._replace(values=_packed(column.column.values))
        for name, column in taken.items()
    }
    _refuse_ragged(read, place, faults)
    finite = {name: check_numbers(column, place, faults) for name, column in read.items()}
    clock = read.pop("t", None)
    times = _times(clock, place, faults) if clock and not faults.lines else ()
    if faults.lines:
        raise Refused(faults.lines)
    groups: Mapping[str, Rows] = {
        group: Rows(
            [read[name].values for name in names],
            np.logical_and.reduce([finite[name] for name in names]),
            [taken[name].factor for name in names],
        )
        for group, names in {**GROUPS, **own}.items()
        if names[0] in read
    }
    groups, settled = one_attitude(groups, selection, place, faults)
    if faults.lines:
        raise Refused(faults.lines)
    if clock and (factor := taken["t"].factor) != 1:
        times = tuple(t * factor for t in times)
    digits = written_digits(read.values())
    sentences = (*notes, *selection.notes, *settled)
    return TrajectoryFile(place, times, groups, digits, sentences, columns={**COLUMNS, **own})


def _apart(
    columns: list[Column],
    wanted: Request,
    own: Mapping[str, tuple[str, ...]],
    place: str,
    faults: Faults,
) -> tuple[list[Taken], list[Column], Request]:
    """Return the columns of states of the scene's own, the others, and what is asked of those."""
    names = {name for group in own.values() for name in group}
    asked = _asked([pair for pair in wanted if pair[0] in names], columns, place, faults)
    ours_of = {name: name for name in names - asked.keys()}
    ours_of |= {theirs: ours for ours, theirs in asked.items()}
    apart = [Taken(ours_of[column.name], column) for column in columns if column.name in ours_of]
    left = [column for column in columns if column.name not in ours_of]
    return apart, left, tuple(pair for pair in wanted if pair[0] not in names)


def _asked(
    wanted: Request, columns: Sequence[Column], place: str, faults: Faults
) -> dict[str, str]:
    """Return the file's name, which may be asked for by its number, for each of ours."""
    by_text = {str(k): column.name for k, column in enumerate(columns, start=1)}
    by_text |= {column.name: column.name for column in columns}
    asked: dict[str, str] = {}
    for ours, theirs in wanted:
        if theirs not in by_text:
            faults.add(f"a column of the file for {ours}", f"`{cut(theirs)}`", place)
        elif ours in asked:
            faults.add("every name once", f"{ours} again", place)
        else:
            asked[ours] = by_text[theirs]
    return asked


def _whole(
    taken: Sequence[Taken], own: Mapping[str, tuple[str, ...]], place: str, faults: Faults
) -> dict[str, tuple[str, ...]]:
    """Return the states of the scene's own that are there; a part of one is a fault."""
    has = {column.name for column in taken}
    there = {group: names for group, names in own.items() if not has.isdisjoint(names)}
    for names in there.values():
        if missing := [name for name in names if name not in has]:
            faults.add(f"the columns {' '.join(names)}", f"no {' '.join(missing)}", place)
    return there


def _packed(values: Sequence[Any]) -> Any:
    """Return the same entries in less memory, if all of them are Python's floats."""
    if isinstance(values, list) and all(type(value) is float for value in values):
        return np.array(values)
    return values


def _named_once(columns: Iterable[Column], file: str, faults: Faults) -> list[Column]:
    by_name: dict[str, Column] = {}
    for column in columns:
        if column.name in by_name:
            faults.add("every column once", f"`{cut(column.name)}` again", file)
        by_name[column.name] = column
    return list(by_name.values())


def _refuse_ragged(columns: Mapping[str, Column], file: str, faults: Faults) -> None:
    """Refuse columns that are not as long as t, or as the first of them where there is no t."""
    if not columns:
        return
    length = len(columns.get("t", next(iter(columns.values()))).values)
    for name, values in columns.values():
        if len(values) != length:
            faults.add(f"{length} values as in t", str(len(values)), f"{file}, column {cut(name)}")
    if not length:
        faults.add("at least one row", "none", file)


def _times(clock: Column, file: str, faults: Faults) -> tuple[Fraction, ...]:
    """Return the times, strictly increasing or strictly decreasing; anything else is a fault."""
    place = f"column {cut(clock.name)}"
    times: list[Fraction] = []
    for row, (value,) in enumerate(Rows([clock.values]), start=1):
        if not isinstance(value, Fraction):
            faults.add("a finite time", str(value), f"{file}, row {row}, {place}")
            return ()
        times.append(value)
    rises = times[-1] >= times[0]
    in_order = operator.gt if rises else operator.lt
    with alike(faults, f"{file}, {place}") as wrong:
        for row, (before, now) in enumerate(pairwise(times), start=2):
            if in_order(now, before):
                continue
            later, earlier = _time_text(now), _time_text(before)
            if later == earlier:
                expected, got = "no time twice", f"{later} again"
            else:
                expected = f"times that keep {'increasing' if rises else 'decreasing'}"
                got = f"{later} after {earlier}"
            wrong(expected, got, f"{file}, row {row}, {place}")
    return tuple(times)


def _time_text(time: Fraction) -> str:
    return f"{float(time):.17g}" if abs(time) < 10**300 else "a huge time"
