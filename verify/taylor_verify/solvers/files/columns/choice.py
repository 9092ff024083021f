"""The choices that the names of a file leave for a group of columns, and the sentence about each."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import Final

from taylor_verify.records.faults import cut
from taylor_verify.solvers.files.columns.column_units import OWN, Unit, in_brackets
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.columns.names import GROUPS, TO_SPACE
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.columns.spelling import Spelling

MOST_NAMED: Final = 8
_NUMBERED: Final = re.compile(r"[a-z]\d")

# By component the names that may be it, each with its unit (None: not known).
Cells = Mapping[int, Sequence[tuple[Name, Unit | None]]]


class Rank(IntEnum):
    """The precedence of a choice, the strongest first."""

    ASKED = 0
    OURS = 1
    PROGRAM = 2
    USUAL = 3
    BEHIND_A_WORD = 4


@dataclass(frozen=True)
class Choice:
    """The columns of one group, in our order, each with its unit (None: not known)."""

    group: str
    names: tuple[Name, ...]
    units: tuple[Unit | None, ...]
    rank: Rank
    spelling: Spelling
    doubt: str = ""

    @property
    def shown(self) -> str:
        return shown_names(self.names)

    @property
    def scalar_requests(self) -> str:
        """The requests for a scalar that is the first of four columns, and for one that is the last."""
        if self.group != "quaternion":
            return ""
        names = [cut(name.text) for name in self.names]
        first, last = (
            ",".join(f"{own}={name}" for own, name in zip(GROUPS[self.group], order, strict=True))
            for order in (names, [names[-1], *names[:-1]])
        )
        return f"{first} for the first, {last} for the last"

    @property
    def note(self) -> str:
        """The sentence about what was taken; empty for our own names in the scene's units."""
        if self.doubt:
            return ""
        words = dict.fromkeys(unit.words for unit in self.units if unit and unit.words)
        is_plain = all(name.is_ours for name in self.names)
        if is_plain and not words and self.rank is not Rank.ASKED:
            return ""
        form, spelling = FORMS.get(self.group), self.spelling
        parts = [f"{self.shown} taken as {form.words if form else ' '.join(GROUPS[self.group])}"]
        parts += [TO_SPACE] if form and not spelling.turn else []
        parts += [self._remark] if self._remark and not is_plain and not form else []
        parts += [str(spelling.turn)] if spelling.turn else []
        parts += [f"in {' and in '.join(words)}"] if words else []
        parts += [f"the habit of {spelling.whose}"] if spelling.whose else []
        return ", ".join(parts)

    @property
    def _remark(self) -> str:
        """The remark on the names; the scalar of a quaternion stands where the manual says so."""
        is_of_manual = self.spelling.whose or self.rank is Rank.ASKED
        if self.group == "quaternion" and is_of_manual:
            return f"{shown_names(self.names[:1])} is the scalar"
        return self.spelling.remark


def shown_names(names: Sequence[Name]) -> str:
    if len(names) > MOST_NAMED:
        return f"`{cut(names[0].text)}` ... `{cut(names[-1].text)}`"
    return " ".join(f"`{cut(name.text)}`" for name in names)


@dataclass(frozen=True)
class Candidates:
    """The names of a file, and those that the caller assigned to our names, some with ``units``."""

    names: Sequence[Name]
    asked: Mapping[str, Name]
    units: Mapping[str, Unit]

    @cached_property
    def free(self) -> list[Name]:
        """The names that nobody asked for."""
        asked = set(self.asked.values())
        return [name for name in self.names if name not in asked]

    @cached_property
    def _keys(self) -> set[str]:
        """The names without their units, and whole, for brackets that are a part of a name."""
        return {key for name in self.names for key in (name.key, name.whole_key)}

    @cached_property
    def cells(self) -> Mapping[tuple[Spelling, str], Cells]:
        """The names that may be each component, by spelling and path."""
        cells: dict[tuple[Spelling, str], dict[int, list[tuple[Name, Unit | None]]]] = {}
        for name in self.free:
            for reading in name.readings:
                cell = cells.setdefault((reading.spelling, reading.path), defaultdict(list))
                cell[reading.component].append((name, reading.unit))
        return cells

    def of(self, group: str, chosen: Mapping[str, Choice]) -> list[Choice]:
        """Return every spelling all of whose names are there; each set of columns once."""
        choices: dict[tuple[Name, ...], Choice] = {}
        for (spelling, path), cells in self.cells.items():
            if spelling.group != group or not self._is_possible(spelling, path, chosen):
                continue
            if whole := self._whole(spelling, path, cells):
                stronger = choices.get(whole.names, whole)
                choices[whole.names] = min(stronger, whole, key=lambda choice: choice.rank)
        return list(choices.values())

    def _is_possible(self, spelling: Spelling, path: str, chosen: Mapping[str, Choice]) -> bool:
        is_alone = spelling.beside in ("", *chosen) and not spelling.unless & self._keys
        return is_alone and self.may_be(spelling, path)

    def may_be(self, spelling: Spelling, path: str) -> bool:
        """Return True if the company of a spelling stands behind its path, and what it shuns does not."""
        if not self.has_signs(spelling):
            return False
        if not spelling.company and not spelling.apart_from:
            return True
        there = {key for key, place in self._parts if place == path}
        is_apart = not spelling.apart_from or not there.issuperset(spelling.apart_from)
        return is_apart and there.issuperset(spelling.company)

    def has_signs(self, spelling: Spelling) -> bool:
        """Return True if the file has a name by which the program of a spelling is known."""
        return not spelling.signs or any(
            all(any(key.endswith(sign) for key in self._keys) for sign in signs)
            for signs in spelling.signs
        )

    def asked_unit(self, own: str, group: str) -> Unit:
        """Return the unit of a column that is asked for."""
        return self.units.get(own) or self.asked[own].unit(group) or OWN

    @cached_property
    def _parts(self) -> set[tuple[str, str]]:
        """The names without a path and a unit, each with its path, of which some spelling knows."""
        readings = (reading for name in self.free for reading in name.readings)
        return {(r.spelling.keys[r.component], r.path) for r in readings}

    def _whole(self, spelling: Spelling, path: str, cells: Cells) -> Choice | None:
        ours, doubt = GROUPS[spelling.group], spelling.doubt
        names: list[Name] = []
        units: list[Unit | None] = []
        for component, own in enumerate(ours):
            hits = cells.get(component, ())
            if own in self.asked:
                hits = [(self.asked[own], self.asked_unit(own, spelling.group))]
            hits = [hit for hit in hits if hit[0].text == own] or hits
            if not hits:
                return None
            if len(hits) > 1:
                doubt = doubt or f"{shown_names([name for name, _ in hits])} are alike"
            names.append(hits[0][0])
            units.append(hits[0][1])
            # The clock of a file has its unit in its name.
            if hits[0][1] is OWN and spelling.group != "time":
                units[-1] = in_brackets(spelling.unit, spelling.group) or OWN
        is_own = all(name.is_ours for name in names) and spelling.keys == ours
        if not is_own and self.numbered_beside(spelling.keys):
            return None
        rank = Rank.OURS if is_own else Rank.PROGRAM if spelling.whose else Rank.USUAL
        if path.endswith("_") and not spelling.is_behind:
            rank = Rank.BEHIND_A_WORD
        if not self.asked.keys().isdisjoint(ours):
            rank = Rank.ASKED
        return Choice(spelling.group, tuple(names), tuple(units), rank, spelling, doubt)

    def numbered_beside(self, keys: Sequence[str]) -> list[Name]:
        """Return the names of a letter and a digit as these are, and others than these."""
        first = {key[0] for key in keys if _NUMBERED.fullmatch(key)}
        return [
            name
            for name in self.free
            if _NUMBERED.fullmatch(name.key) and name.key[0] in first and name.key not in keys
        ]
