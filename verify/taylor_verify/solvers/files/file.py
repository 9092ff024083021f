"""A trajectory file: every number exactly as written, or every fault with its place.

`docs/columns.md` has the columns; usual other names and units are taken and said (the folder columns).

Decimals, ``a/b`` and hexadecimal floats become rationals; binary numbers are taken as they are. None
of them passes through a double on its way.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, final

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.records.escapes import one_line
from taylor_verify.records.faults import Faults, Refused, cut
from taylor_verify.records.quantities import COLUMNS, answerable_groups
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.clock import with_times
from taylor_verify.solvers.files.columns.assigned import Request
from taylor_verify.solvers.files.columns.attitudes import one_attitude
from taylor_verify.solvers.files.columns.selection import select
from taylor_verify.solvers.files.compact_rows import Rows
from taylor_verify.solvers.files.formats.column import Column, Ragged
from taylor_verify.solvers.files.formats.reading import parted, read_table
from taylor_verify.solvers.files.numbered import usual_names
from taylor_verify.solvers.files.own_states import apart, own_columns, whole
from taylor_verify.solvers.files.parts import Parts
from taylor_verify.solvers.files.planar import with_zeros
from taylor_verify.solvers.files.single_precision import are_single_precision
from taylor_verify.solvers.files.stated_step import FileStep, step_inside
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
    are the names of the columns of each group, states of the scene's own among them. ``apart`` are the
    groups that have other rows than these: each with all of its own rows. ``form`` is that of an attitude
    which was no quaternion nor a matrix; ``in_space`` are the groups along space axes that no attitude of
    the file turned.
    """

    name: str
    times: tuple[Fraction, ...]
    groups: Mapping[str, Rows]
    digits: int | None = None
    notes: tuple[str, ...] = ()
    step: FileStep | None = None
    columns: Mapping[str, tuple[str, ...]] = field(default_factory=lambda: COLUMNS)
    apart: tuple[TrajectoryFile, ...] = ()
    form: str = ""
    in_space: tuple[str, ...] = ()

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
    place = one_line(os.fspath(file))
    try:
        table = read_table(file)
    except Ragged as ragged:
        lines = [*ragged.faults]
        try:
            from_columns(ragged.table.columns, place, columns, scene=scene)
        except Refused as others:
            lines += others.faults
        raise Refused(lines) from None
    trajectory = from_columns(table.columns, place, columns, table.notes, scene)
    return replace(trajectory, step=step_inside(parted(os.fspath(file))[0], table.columns))


def from_columns(
    columns: Iterable[Column],
    place: str,
    wanted: Request = (),
    notes: Sequence[str] = (),
    scene: Scene | None = None,
) -> TrajectoryFile:
    """Return the trajectory in columns as they are written; ``place`` names their file in messages.

    ``notes`` are sentences about the columns that their reader has. The ``scene`` has states of its own,
    and times that tell which of two clocks is meant. Raises Refused with every fault.
    """
    faults = Faults()
    by_name: dict[str, Column] = {}
    for column in columns:
        if column.name in by_name:
            faults.add("every column once", f"`{cut(column.name)}` again", place)
        by_name[column.name] = column
    names, asked = usual_names(list(by_name.values()), wanted, scene, place)
    renamed = [c._replace(name=names.get(name, name)) for name, c in by_name.items()]
    every, planar = with_zeros(renamed, scene)
    every, asked, timed = with_times(every, asked, scene, place, faults)
    own = own_columns(scene)
    beside, left, asked = apart(every, asked, own, place, faults)
    foreign = () if scene is None else COLUMNS.keys() - answerable_groups(scene.model)
    selection = select(left, asked, place, faults, foreign)
    own = whole(beside, own, place, faults)
    taken = {column.name: column for column in (*selection.columns, *beside)}
    parts = Parts(taken, own)
    times = parts.times(place, faults)
    if faults.lines:
        raise Refused(faults.lines)
    files, agreed, known = [], list[str](), {**COLUMNS, **own}
    for part in parts.of_rows(times, place, faults):
        instants = tuple(times[k] for k in part.places)
        groups, form, settled = one_attitude(part.groups, selection, scene, instants, place, faults)
        agreed += settled
        turned = groups.keys() & {"quaternion", "attitude"}
        in_space = () if turned else tuple(g for g in selection.in_space if g in groups)
        whole_part = TrajectoryFile(place, instants, groups, part.digits, columns=known, form=form)
        files.append(replace(whole_part, in_space=in_space))
    if faults.lines:
        raise Refused(faults.lines)
    first, *others = files
    sentences = (*notes, *planar, *timed, *selection.notes, *parts.notes, *agreed)
    return replace(first, notes=sentences, apart=tuple(others))
