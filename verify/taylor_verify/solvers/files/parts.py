"""The parts of a file that have the same rows: whole groups of columns, and their places in the file."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any, Final

import numpy as np

from taylor_verify.records.faults import Faults, cut
from taylor_verify.solvers.files.columns.names import GROUPS
from taylor_verify.solvers.files.columns.selection import Taken
from taylor_verify.solvers.files.compact_rows import Rows, check_numbers, entries_at, written_digits
from taylor_verify.solvers.files.formats.column import Column, alike
from taylor_verify.solvers.files.present import Flags, blank_rows, first_of_equal, rows_of_groups

# One row is no trajectory.
_FEWEST: Final = 2


@dataclass(frozen=True)
class Part:
    """Groups of columns with the same rows of a file, and the places of these rows."""

    places: Sequence[int]
    groups: Mapping[str, Rows]
    digits: int | None


@dataclass
class Parts:
    """The columns of a file that are ours; ``own`` are those of the scene's own states.

    ``notes`` say which rows were left out.
    """

    taken: Mapping[str, Taken]
    own: Mapping[str, tuple[str, ...]]
    notes: list[str] = field(default_factory=list)

    @cached_property
    def _columns(self) -> Mapping[str, Column]:
        return {
            name: each.column._replace(values=_packed(each.column.values))
            for name, each in self.taken.items()
        }

    @cached_property
    def _groups(self) -> Mapping[str, Sequence[str]]:
        """The names of the columns of each group that is there."""
        every = {**GROUPS, **self.own}
        every.pop("time")
        return {group: names for group, names in every.items() if names[0] in self._columns}

    def _of(self, group: str) -> list[Column]:
        return [self._columns[name] for name in self._groups[group]]

    # The rows.

    def times(self, place: str, faults: Faults) -> tuple[Fraction, ...]:
        """Return the times of all rows in the scene's unit; what is wrong in any column is a fault."""
        self._refuse_ragged(place, faults)
        clock = self._columns.get("t")
        self._finite = self._checked(place, faults)
        if clock is None or faults.lines:
            return ()
        times = _finite_times(clock, place, faults)
        if faults.lines:
            return ()
        every = [column.values for column in self._columns.values()]
        self._first = first_of_equal(times, every)
        if repeated := len(times) - len(self._first):
            rows = "1 row that repeats" if repeated == 1 else f"{repeated} rows that repeat"
            self.notes.append(f"{rows} the row before, time and numbers, left out")
        factor = self.taken["t"].factor
        return tuple(times) if factor == 1 else tuple(time * factor for time in times)

    def _checked(self, place: str, faults: Faults) -> dict[str, Flags]:
        """Return True for the entries of each column that are finite numbers."""
        self._blank = {g: blank_rows(self._of(g)) for g in self._groups if not faults.lines}
        blank = {name: rows for group, rows in self._blank.items() for name in self._groups[group]}
        return {
            name: check_numbers(column, place, faults, blank.get(name))
            for name, column in self._columns.items()
        }

    def _refuse_ragged(self, place: str, faults: Faults) -> None:
        """Refuse columns that are not as long as t, or as the first of them where there is no t."""
        if not self._columns:
            return
        length = len(self._columns.get("t", next(iter(self._columns.values()))).values)
        for name, values in self._columns.values():
            if len(values) != length:
                at = f"{place}, column {cut(name)}"
                faults.add(f"{length} values as in t", str(len(values)), at)
        if not length:
            faults.add("at least one row", "none", place)

    # The parts.

    def of_rows(self, times: Sequence[Fraction], place: str, faults: Faults) -> list[Part]:
        """Return the rows that all groups have as a part, and each group that has others in all its rows.

        Where groups have no rows in common, each is a part. Times that do not go on are a fault.
        """
        places, count = self._places(len(times)), len(times)
        rest = list(places)
        common = set.intersection(*(set(rows) for rows in places.values())) if places else set()
        parts = []
        if not places or len(common) >= min(_FEWEST, count):
            first = sorted(common) if places else self._first
            parts.append(self._part(first, places))
            rest = [group for group in places if len(places[group]) > len(common)]
        parts += [self._part(places[group], [group]) for group in rest]
        at = f"{place}, row {{}}, column {cut(self._columns['t'].name)}"
        for part in parts if not faults.lines else ():
            _refuse_disorder(times, part.places, at, faults)
        return parts

    def _places(self, count: int) -> dict[str, list[int]]:
        """Return the places of the rows that each group has, and note where these are not all."""
        finite = {
            group: np.asarray(np.logical_and.reduce([self._finite[name] for name in names]))
            for group, names in self._groups.items()
        }
        present = rows_of_groups({g: self._of(g) for g in self._groups}, self._blank, finite)
        for group, rows in present.items():
            named, has = cut(" ".join(self._groups[group])), int(rows.sum())
            if not has:
                self.notes.append(f"{named} not read: no row has numbers")
            elif has < count:
                self.notes.append(f"{named} have {has} of the {count} rows")
        places = {g: [k for k in self._first if rows[k]] for g, rows in present.items()}
        return {group: rows for group, rows in places.items() if rows}

    def _part(self, places: Sequence[int], among: Iterable[str]) -> Part:
        is_whole = len(places) == len(self._finite["t"])
        groups, columns = dict[str, Rows](), list[Column]()
        for group in among:
            names = self._groups[group]
            some = self._of(group)
            if not is_whole:
                some = [entries_at(column, places) for column in some]
            finite = np.logical_and.reduce([self._finite[name][places] for name in names])
            factors = [self.taken[name].factor for name in names]
            groups[group] = Rows([column.values for column in some], finite, factors)
            columns += some
        return Part(places, groups, written_digits(columns))


def _packed(values: Sequence[Any]) -> Any:
    """Return the same entries in less memory, if all of them are Python's floats."""
    if isinstance(values, list) and all(type(value) is float for value in values):
        return np.array(values)
    return values


def _finite_times(clock: Column, place: str, faults: Faults) -> list[Fraction]:
    times: list[Fraction] = []
    for row, (value,) in enumerate(Rows([clock.values]), start=1):
        if not isinstance(value, Fraction):
            at = f"{place}, row {row}, column {cut(clock.name)}"
            faults.add("a finite time", str(value), at)
            break
        times.append(value)
    return times


def _refuse_disorder(
    times: Sequence[Fraction], places: Sequence[int], at: str, faults: Faults
) -> None:
    """Refuse times that are not strictly increasing or strictly decreasing at these places."""
    rises = times[-1] >= times[0]
    in_order = operator.gt if rises else operator.lt
    with alike(faults, at.replace("row {}, ", "")) as wrong:
        for before, now in pairwise(places):
            if in_order(times[now], times[before]):
                continue
            later, earlier = _time_text(times[now]), _time_text(times[before])
            expected, got = "no time twice", f"{later} again"
            if later != earlier:
                expected = f"times that keep {'increasing' if rises else 'decreasing'}"
                got = f"{later} after {earlier}"
            wrong(expected, got, at.format(now + 1))


def _time_text(time: Fraction) -> str:
    return f"{float(time):.17g}" if abs(time) < 10**300 else "a huge time"
