"""The choices that the names of a file leave for a group: every spelling all of whose names are there."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from taylor_verify.solvers.files.columns.choice import Choice, Rank, shown_names
from taylor_verify.solvers.files.columns.names import GROUPS, SPELLINGS, Spelling
from taylor_verify.solvers.files.columns.readings import Name, is_ours
from taylor_verify.solvers.files.columns.units import OWN, Unit
from taylor_verify.solvers.files.formats.column import Column

_NUMBERED: Final = re.compile(r"[a-z]\d")

# By component the columns that may be it, by number, each with its unit.
Cells = Mapping[int, Sequence[tuple[int, Unit | None]]]


@dataclass(frozen=True)
class Candidates:
    """The columns of a file, and those of them that somebody asked for by our names."""

    columns: Sequence[Column]
    asked: Mapping[str, Column]

    @cached_property
    def names(self) -> dict[int, Name]:
        """The names of all columns that nobody asked for, by number."""
        used = {id(column) for column in self.asked.values()}
        return {k: Name(c.name) for k, c in enumerate(self.columns) if id(c) not in used}

    @cached_property
    def cells(self) -> dict[tuple[int, str], dict[int, list[tuple[int, Unit | None]]]]:
        """By spelling and path: of each component the columns that may be it."""
        found: dict[tuple[int, str], dict[int, list[tuple[int, Unit | None]]]] = defaultdict(
            lambda: defaultdict(list)
        )
        for k, name in self.names.items():
            for reading in name.readings:
                hits = found[reading.spelling, reading.path][reading.component]
                hits.append((k, reading.unit))
        return found

    def of(self, group: str, chosen: Mapping[str, Choice]) -> Iterator[Choice]:
        """Every spelling all of whose names are there; each set of columns once."""
        seen: dict[tuple[int, ...], Choice] = {}
        for (number, _), cells in self.cells.items():
            spelling = SPELLINGS[number]
            if spelling.group == group and self._is_possible(spelling, chosen):
                choice = self._whole(spelling, cells)
                if choice is not None:
                    seen.setdefault(tuple(map(id, choice.columns)), choice)
        yield from seen.values()

    def _is_possible(self, spelling: Spelling, chosen: Mapping[str, Choice]) -> bool:
        keys = {name.key for name in self.names.values()}
        return (not spelling.beside or spelling.beside in chosen) and not spelling.unless & keys

    def _whole(self, spelling: Spelling, cells: Cells) -> Choice | None:
        ours = GROUPS[spelling.group]
        columns: list[Column] = []
        units: list[Unit | None] = []
        doubt = spelling.doubt
        for component, name in enumerate(ours):
            if name in self.asked:
                column = self.asked[name]
                columns.append(column)
                units.append(Name(column.name).unit(spelling.group) or OWN)
                continue
            hits = cells.get(component, ())
            exact = [hit for hit in hits if self.columns[hit[0]].name.strip() == name]
            hits = exact or hits
            if not hits:
                return None
            if len(hits) > 1:
                both = shown_names([self.columns[k] for k, _ in hits])
                doubt = doubt or f"{both} are alike"
            columns.append(self.columns[hits[0][0]])
            units.append(hits[0][1])
        is_own = all(is_ours(column.name) for column in columns) and spelling.keys == ours
        if not is_own and self.numbered_beside(spelling.keys):
            return None
        rank = Rank.OURS if is_own else Rank.USUAL
        if any(name in self.asked for name in ours):
            rank = Rank.ASKED
        return Choice(spelling.group, tuple(columns), tuple(units), rank, spelling.remark, doubt)

    def numbered_beside(self, keys: Sequence[str]) -> list[Column]:
        """The columns whose names are a letter and a digit as these are, and others than these."""
        letters = {key[0] for key in keys if _NUMBERED.fullmatch(key)}
        return [
            self.columns[k]
            for k, name in self.names.items()
            if _NUMBERED.fullmatch(name.key) and name.key[0] in letters and name.key not in keys
        ]
