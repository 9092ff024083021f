"""The columns of a file that are ours: as asked for, by our own names, or by one usual spelling.

A group is taken whole and from one spelling. What is asked for comes before our own names, and these before
usual ones. Two usual spellings of one group, and one column in two groups, are faults: nothing is
guessed. All other columns are ignored, and named.
"""

from __future__ import annotations

import difflib
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Final, NamedTuple

import numpy as np

from taylor_verify.records.faults import Faults, cut
from taylor_verify.solvers.files.columns.assigned import Request, asked_columns
from taylor_verify.solvers.files.columns.choice import (
    MOST_NAMED,
    Candidates,
    Choice,
    Rank,
    shown_names,
)
from taylor_verify.solvers.files.columns.column_units import OWN, known_units
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.columns.names import GROUP_OF, GROUPS, SPELLINGS
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.columns.spelling import Turn
from taylor_verify.solvers.files.formats.column import Column, listed
from taylor_verify.solvers.files.stated_step import STEP_COLUMNS

# Printed by `publish reference` beside the motion, or a statement of the step: no part of the motion.
_SILENT: Final = ("radius", *STEP_COLUMNS)
# In the order in which a description of the attitude is taken.
ATTITUDES: Final = ("quaternion", "attitude", *FORMS)


class Taken(NamedTuple):
    """A column of the file that is ours: the scene's number is ``factor`` times the file's."""

    name: str
    column: Column
    factor: Fraction = Fraction(1)


class Selection(NamedTuple):
    """The columns that are taken, and sentences about what was taken and what was not.

    The ``attitudes`` are descriptions of one; ``in_space`` are the velocities along space axes.
    """

    columns: tuple[Taken, ...]
    notes: tuple[str, ...]
    attitudes: tuple[Choice, ...] = ()
    in_space: tuple[str, ...] = ()

    @property
    def is_doubtful(self) -> bool:
        """True if the only attitude is a quaternion whose scalar is the first or the last number."""
        return len(self.attitudes) == 1 and bool(self.attitudes[0].doubt)


def select(
    columns: Sequence[Column],
    wanted: Request,
    place: str,
    faults: Faults,
    others: Collection[str] = (),
) -> Selection:
    """Return the columns that are ours, and record what is wrong with them as faults.

    Groups of the ``others`` mean nothing in the scene: what is no clear choice of one is ignored.
    """
    names = [Name(column) for column in columns]
    before = len(faults.lines)
    asked, units = asked_columns(wanted, names, place, faults)
    chooser = _Chooser(Candidates(names, asked, units), place, faults)
    chooser.others = set(others) - {GROUP_OF.get(name, name) for name in asked}
    if len(faults.lines) > before:
        # The rest of a group that was asked for in vain is no second fault.
        chooser.doubted |= {GROUP_OF.get(name, name) for name, _ in wanted}
    chooser.choose()
    # Numbers of a group that is not whole are read too, so that all faults are said at once.
    taken = [Taken(name.text, name.column) for name in chooser.half if faults.lines]
    for choice in chooser.chosen.values():
        for ours, name, unit in zip(GROUPS[choice.group], choice.names, choice.units, strict=True):
            taken.append(Taken(ours, name.column, (unit or OWN).factor))
    notes = [choice.note for choice in chooser.chosen.values() if choice.note]
    attitudes = tuple(chooser.chosen[group] for group in ATTITUDES if group in chooser.chosen)
    sentences = (*notes, *chooser.notes, *chooser.left_out())
    in_space = [g for g, c in chooser.chosen.items() if c.spelling.turn is Turn.SPACE_AXES]
    return Selection(tuple(taken), sentences, attitudes, tuple(in_space))


@dataclass
class _Chooser:
    """The choice of each group so far, groups that are not clear, and names of incomplete groups.

    ``others`` are groups that mean nothing in the scene.
    """

    candidates: Candidates
    place: str
    faults: Faults
    chosen: dict[str, Choice] = field(default_factory=dict)
    doubted: set[str] = field(default_factory=set)
    half: list[Name] = field(default_factory=list)
    others: set[str] = field(default_factory=set)
    notes: list[str] = field(default_factory=list)

    def choose(self) -> None:
        """Choose the columns of each group that the file has; what is no clear choice is a fault."""
        for group in GROUPS:
            if choice := self._choice(group):
                self.chosen[group] = choice
        self._drop_others()
        self._drop_weaker_attitudes()
        self._refuse_shared()
        for group in GROUPS:
            if group in self.chosen:
                self._refuse_odd(self.chosen[group])
            elif group not in self.doubted | self.others:
                self._refuse_incomplete(group)

    @property
    def used(self) -> set[Name]:
        return {name for choice in self.chosen.values() for name in choice.names}

    # One group.

    def _choice(self, group: str) -> Choice | None:
        ours, asked = GROUPS[group], self.candidates.asked
        if asked.keys() >= set(ours):
            names = tuple(asked[name] for name in ours)
            units = tuple(self.candidates.asked_unit(name, group) for name in ours)
            spelling = next(s for s in SPELLINGS if s.keys == ours and not s.whose)
            return Choice(group, names, units, Rank.ASKED, spelling)
        every = self.candidates.of(group, self.chosen)
        clear = [choice for choice in every if not choice.doubt]
        best = min((choice.rank for choice in clear), default=Rank.BEHIND_A_WORD)
        alike = [choice for choice in clear if choice.rank == best]
        if clear := _distinct(self._of_best_frame(alike)):
            if len(clear) == 1:
                return clear[0]
            got = " and ".join(choice.shown for choice in clear[:3])
            self._doubt(group, f"{' '.join(ours)} once", got)
        elif len(every) == 1 and group == "quaternion":
            return every[0]
        elif every:
            self._doubt_one(every[0])
        return None

    def _of_best_frame(self, choices: Sequence[Choice]) -> list[Choice]:
        """Return the choices relative to the best frame, with a note on the others."""
        best = min((choice.spelling.precedence for choice in choices), default=None)
        self.notes += [
            f"{choice.shown} not taken: {choice.spelling.relation}"
            for choice in choices
            if choice.spelling.precedence != best
        ]
        return [choice for choice in choices if choice.spelling.precedence == best]

    def _doubt_one(self, choice: Choice) -> None:
        got = f"{choice.shown}: {choice.doubt}"
        self._doubt(choice.group, " ".join(GROUPS[choice.group]), got, choice.scalar_requests)

    def _doubt(self, group: str, expected: str, got: str, request: str = "") -> None:
        self.doubted.add(group)
        if group in self.others:
            return
        ours = GROUPS[group]
        names = f"{ours[0]}=NAME" if len(ours) == 1 else f"{ours[0]}=NAME,{ours[1]}=NAME,..."
        mend = f"say which: --columns {request or names}"
        self.faults.add(expected, got, self.place, mend)

    # All groups.

    def _drop_others(self) -> None:
        """Drop groups that mean nothing in the scene, where a unit or a column would be a fault."""
        for group in self.others & self.chosen.keys():
            choice = self.chosen.pop(group)
            if None not in choice.units and not self.used & set(choice.names):
                self.chosen[group] = choice

    def _drop_weaker_attitudes(self) -> None:
        """Keep the attitudes of the strongest rank and the best frame, and doubts that these settle."""
        every = [self.chosen[group] for group in ATTITUDES if group in self.chosen]
        sure = [choice for choice in every if not choice.doubt]
        is_usual = not any(choice.rank is Rank.ASKED for choice in sure)
        best = min((choice.rank for choice in sure), default=Rank.BEHIND_A_WORD)
        beside = range(Rank.BEHIND_A_WORD) if is_usual else ()
        strongest = self._of_best_frame([c for c in sure if c.rank == best or c.rank in beside])
        for choice in every:
            if choice.doubt and not sure and not choice.spelling.doubt:
                del self.chosen[choice.group]
                self._doubt_one(choice)
            elif choice not in strongest and not (choice.doubt and is_usual):
                del self.chosen[choice.group]
        if sum(choice.rank is Rank.OURS for choice in strongest) > 1:
            got = "q0 q1 q2 q3 and r11 ... r33"
            self.faults.add("the attitude once", got, self.place, "keep one of them")

    def _refuse_shared(self) -> None:
        """Refuse a column that two groups would take."""
        groups: dict[Name, list[str]] = defaultdict(list)
        for choice in self.chosen.values():
            for name in choice.names:
                groups[name].append(choice.group)
        for shared in sorted({tuple(names) for names in groups.values() if len(names) > 1}):
            got = " or ".join(
                f"{self.chosen[n].shown} that may be {' '.join(GROUPS[n])}" for n in shared
            )
            ours = " or ".join(f"{GROUPS[n][0]}=NAME,..." for n in shared)
            self.faults.add("each column once", got, self.place, f"say which: --columns {ours}")

    def _refuse_odd(self, choice: Choice) -> None:
        """Refuse unknown units, and numbered states beside our own names."""
        ours = GROUPS[choice.group]
        for own, name, unit in zip(ours, choice.names, choice.units, strict=True):
            if unit is None:
                mend = (
                    f"convert its numbers; --columns {own}='{cut(name.text)}' takes them as they are, "
                    "in the scene's unit"
                )
                place = f"{self.place}, column {cut(name.text)}"
                expected = f"a unit of {known_units(choice.group)}"
                self.faults.add(expected, f"`{cut(name.unit_text)}`", place, mend)
        if choice.rank is Rank.OURS and (others := self.candidates.numbered_beside(ours)):
            # w1 w2 w3 that stand in a row of numbered columns are a state vector, perhaps.
            got = f"{shown_names(others)} beside them: are they the components of a state?"
            mend = f"say which: --columns {','.join(f'{own}={own}' for own in ours)}"
            self.faults.add(f"{' '.join(ours)} alone", got, self.place, mend)

    def _refuse_incomplete(self, group: str) -> None:
        ours, used = GROUPS[group], self.used
        free = [name for name in self.candidates.free if name not in used]
        present = {name.text for name in free} | self.candidates.asked.keys()
        missing = [own for own in ours if own not in present]
        if group == "time":
            shown = shown_names(self.candidates.free[:MOST_NAMED])
            named = f"; the columns are {shown}" if shown else ""
            mend = _meant(missing, free) or f"name it: --columns t=NAME{named}"
            self.faults.add("a column `t` of times", "none", self.place, mend)
        elif len(missing) < len(ours):
            expected, got = f"all of {' '.join(ours)}", f"no {' '.join(missing)}"
            self.faults.add(expected, got, self.place, _meant(missing, free))
            self.half += [name for name in free if name.text in ours]

    # What is not taken.

    def left_out(self) -> Iterator[str]:
        """Yield sentences about groups of which a part is there, and about columns that are ignored."""
        used = self.used
        for (spelling, path), cells in self.candidates.cells.items():
            if spelling.group in self.chosen or spelling.is_whole or len(cells) < 2:
                continue
            if not self.candidates.may_be(spelling, path):
                continue
            lacking = [own for i, own in enumerate(GROUPS[spelling.group]) if i not in cells]
            present = [cells[i][0][0] for i in sorted(cells)]
            if lacking and not any(name in used or name.is_ours for name in present):
                yield f"{shown_names(present)} not taken: nothing in the file is {' '.join(lacking)}"
        ignored = [n for n in self.candidates.names if n not in used and n.text not in _SILENT]
        if ignored:
            yield f"ignored: {listed([f'`{cut(n.text)}`' for n in ignored], MOST_NAMED, ' ')}"


def _distinct(choices: Sequence[Choice]) -> list[Choice]:
    """Return the choices without those that have the numbers of one before."""
    distinct: list[Choice] = []
    for choice in choices:
        if not any(choice.units == other.units and _equal(choice, other) for other in distinct):
            distinct.append(choice)
    return distinct


def _equal(choice: Choice, other: Choice) -> bool:
    pairs = zip(choice.names, other.names, strict=True)
    return all(np.array_equal(a.column.values, b.column.values) for a, b in pairs)


def _meant(missing: Sequence[str], free: Sequence[Name]) -> str:
    """Return a mend that names the columns that may be the missing ones; empty for none."""
    by_key = {name.key: name for name in free if len(name.key) > 1}
    meant: Mapping[str, Name] = {}
    for own in missing:
        group = GROUP_OF[own]
        place = (group, GROUPS[group].index(own))
        close = difflib.get_close_matches(own, by_key, n=1)
        likely = [
            *(n for n in free if place in {(r.spelling.group, r.component) for r in n.readings}),
            *(by_key[key] for key in close),
        ]
        if strange := [name for name in likely if not name.is_ours]:
            meant = {**meant, own: strange[0]}
    if not meant:
        return ""
    request = ",".join(f"{own}={name.text}" for own, name in meant.items())
    shown = " ".join(f"`{cut(name.text)}`" for name in meant.values())
    return f"did you mean {shown}? --columns {cut(request)}"
