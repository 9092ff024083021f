"""The columns of a file that are ours: as asked for, by our own names, or by one usual spelling.

A group is taken whole and from one spelling. What is asked for comes before our own names, and these before
usual ones. Two usual spellings of one group, and one column in two groups, are faults: nothing is
guessed. All other columns are ignored, and named.
"""

from __future__ import annotations

import difflib
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Final

from taylor_verify.scenes.reading.faults import Faults, cut
from taylor_verify.solvers.files.columns.candidates import Candidates
from taylor_verify.solvers.files.columns.choice import (
    MOST_NAMED,
    Choice,
    Rank,
    scalar_requests,
    shown_names,
)
from taylor_verify.solvers.files.columns.names import GROUP_OF, GROUPS, SPELLINGS
from taylor_verify.solvers.files.columns.readings import Name, is_ours
from taylor_verify.solvers.files.columns.request import Request, asked_columns
from taylor_verify.solvers.files.columns.units import OWN, known_units
from taylor_verify.solvers.files.formats.column import Column
from taylor_verify.solvers.files.step import STEP_COLUMNS

# Printed by `publish reference` beside the motion, or a statement of the step: no part of the motion.
_SILENT: Final = ("radius", *STEP_COLUMNS)
_TWO_ATTITUDES: Final = ("quaternion", "attitude")


@dataclass(frozen=True)
class Taken:
    """A column of the file that is ours: the scene's number is ``factor`` times the file's."""

    name: str
    column: Column
    factor: Fraction = Fraction(1)


@dataclass(frozen=True)
class Selection:
    """The columns that are taken, and sentences about what was taken and what was not."""

    columns: tuple[Taken, ...]
    notes: tuple[str, ...]


def select(columns: Sequence[Column], wanted: Request, place: str, faults: Faults) -> Selection:
    """Return the columns that are ours, and record what is wrong with them as faults."""
    before = len(faults.lines)
    asked = asked_columns(wanted, columns, place, faults)
    chooser = _Chooser(Candidates(columns, asked), place, faults)
    if len(faults.lines) > before:
        # The rest of a group that was asked for in vain is no second fault.
        chooser.doubted |= {GROUP_OF.get(name, name) for name, _ in wanted}
    chosen = chooser.choices()
    # Numbers of a group that is not whole are read too, so that all faults are said at once.
    taken = [Taken(c.name.strip(), c) for c in chooser.half if faults.lines]
    for choice in chosen.values():
        for name, column, unit in zip(
            GROUPS[choice.group], choice.columns, choice.units, strict=True
        ):
            taken.append(Taken(name, column, (unit or OWN).factor))
    notes = [choice.note for choice in chosen.values() if choice.note]
    return Selection(tuple(taken), (*notes, *chooser.left_out(chosen)))


@dataclass
class _Chooser:
    candidates: Candidates
    place: str
    faults: Faults
    doubted: set[str] = field(default_factory=set)
    half: list[Column] = field(default_factory=list)

    def choices(self) -> dict[str, Choice]:
        """The choice of each group that the file has; faults of what is no clear choice."""
        chosen: dict[str, Choice] = {}
        for group in GROUPS:
            choice = self._choice(group, chosen)
            if choice is not None:
                chosen[group] = choice
        self._drop_one_attitude(chosen)
        self._refuse_shared(chosen)
        for group in GROUPS:
            if group in chosen:
                self._refuse_odd(chosen[group])
            elif group not in self.doubted:
                self._refuse_incomplete(group, chosen)
        return chosen

    @property
    def columns(self) -> Sequence[Column]:
        """All columns of the file."""
        return self.candidates.columns

    @property
    def asked(self) -> Mapping[str, Column]:
        """The columns that somebody asked for, by our names."""
        return self.candidates.asked

    # One group.

    def _choice(self, group: str, chosen: Mapping[str, Choice]) -> Choice | None:
        asked = [name for name in GROUPS[group] if name in self.asked]
        if len(asked) == len(GROUPS[group]):
            return self._as_asked(group)
        every = list(self.candidates.of(group, chosen))
        clear = [choice for choice in every if not choice.doubt]
        best = min((choice.rank for choice in clear), default=Rank.USUAL)
        clear = [choice for choice in clear if choice.rank == best]
        if len(clear) == 1:
            return clear[0]
        if clear:
            got = " and ".join(choice.shown for choice in clear[:3])
            self._doubt(group, f"{' '.join(GROUPS[group])} once", got)
        elif every:
            doubted = every[0]
            got = f"{doubted.shown}: {doubted.doubt}"
            self._doubt(group, " ".join(GROUPS[group]), got, scalar_requests(doubted))
        return None

    def _doubt(self, group: str, expected: str, got: str, request: str = "") -> None:
        self.doubted.add(group)
        ours = GROUPS[group]
        names = f"{ours[0]}=NAME" if len(ours) == 1 else f"{ours[0]}=NAME,{ours[1]}=NAME,..."
        mend = f"say which: --columns {request or names}"
        self.faults.add(expected, got, self.place, mend)

    def _as_asked(self, group: str) -> Choice:
        columns = tuple(self.asked[name] for name in GROUPS[group])
        units = tuple(Name(column.name).unit(group) or OWN for column in columns)
        remark = next((s.remark for s in SPELLINGS if s.keys == GROUPS[group]), "")
        return Choice(group, columns, units, Rank.ASKED, remark)

    # All groups.

    def _drop_one_attitude(self, chosen: dict[str, Choice]) -> None:
        both = [chosen[group] for group in _TWO_ATTITUDES if group in chosen]
        if len(both) < len(_TWO_ATTITUDES):
            return
        weaker = max(both, key=lambda choice: choice.rank)
        if both[0].rank != both[1].rank:
            del chosen[weaker.group]
            return
        got = " and ".join(choice.shown for choice in both)
        if weaker.rank is Rank.USUAL:
            mend = "say which: --columns q0=NAME,... or r11=NAME,..."
        else:
            got, mend = "q0 q1 q2 q3 and r11 ... r33", "keep one of them"
        self.faults.add("the attitude once", got, self.place, mend)

    def _refuse_shared(self, chosen: Mapping[str, Choice]) -> None:
        """Refuse a column that two groups would take."""
        groups: dict[int, list[str]] = defaultdict(list)
        for choice in chosen.values():
            for column in choice.columns:
                groups[id(column)].append(choice.group)
        shared = {tuple(names) for names in groups.values() if len(names) > 1}
        for names in sorted(shared):
            got = " or ".join(f"{chosen[n].shown} that may be {' '.join(GROUPS[n])}" for n in names)
            ours = " or ".join(f"{GROUPS[n][0]}=NAME,..." for n in names)
            self.faults.add("each column once", got, self.place, f"say which: --columns {ours}")

    def _refuse_odd(self, choice: Choice) -> None:
        """Refuse unknown units, numbered states beside our own names, and halves of a time."""
        for column, unit in zip(choice.columns, choice.units, strict=True):
            if unit is None:
                name = GROUPS[choice.group][choice.columns.index(column)]
                mend = (
                    f"convert its numbers; --columns {name}='{cut(column.name)}' takes them as they are, "
                    "in the scene's unit"
                )
                expected = f"a unit of {known_units(choice.group)}"
                place = f"{self.place}, column {cut(column.name)}"
                self.faults.add(expected, f"`{cut(Name(column.name).unit_text)}`", place, mend)
        if choice.rank is Rank.OURS:
            self._refuse_numbered(choice)
        if choice.group == "time" and choice.rank is not Rank.ASKED:
            self._refuse_split_time(choice)

    def _refuse_numbered(self, choice: Choice) -> None:
        """Refuse w1 w2 w3 that stand in a row of numbered columns: a state vector, perhaps."""
        ours = GROUPS[choice.group]
        others = self.candidates.numbered_beside(ours)
        if others:
            pairs = ",".join(f"{name}={name}" for name in ours)
            got = f"{shown_names(others)} beside them: are they the components of a state?"
            mend = f"say which: --columns {pairs}"
            self.faults.add(f"{' '.join(ours)} alone", got, self.place, mend)

    def _refuse_split_time(self, choice: Choice) -> None:
        """Refuse seconds whose fractions stand in a column of their own."""
        key = Name(choice.columns[0].name).key.removesuffix("s").removesuffix("sec")
        parts = {
            f"{key}nanosec",
            f"{key}nsec",
            f"{key}nsecs",
            f"{key}nanosecs",
            f"{key}nanoseconds",
        }
        for k, name in self.candidates.names.items():
            if name.key in parts and self.columns[k] is not choice.columns[0]:
                got = f"{choice.shown} `{cut(self.columns[k].name)}`"
                mend = "write their sum into one column, t"
                self.faults.add("one column of times", got, self.place, mend)

    def _refuse_incomplete(self, group: str, chosen: Mapping[str, Choice]) -> None:
        used = {id(column) for choice in chosen.values() for column in choice.columns}
        ours = GROUPS[group]
        own = {c.name.strip() for k, c in enumerate(self.columns) if k in self.candidates.names}
        own -= {c.name.strip() for c in self.columns if id(c) in used}
        present = own | set(self.asked)
        missing = [name for name in ours if name not in present]
        if group == "time":
            free = [self.columns[k] for k in self.candidates.names][:MOST_NAMED]
            named = f"; the columns are {shown_names(free)}" if free else ""
            mend = self._meant(missing, used) or f"name it: --columns t=NAME{named}"
            self.faults.add("a column `t` of times", "none", self.place, mend)
        elif len(missing) < len(ours):
            expected, got = f"all of {' '.join(ours)}", f"no {' '.join(missing)}"
            self.faults.add(expected, got, self.place, self._meant(missing, used))
            self.half += [c for c in self.columns if c.name.strip() in own & set(ours)]

    def _meant(self, missing: Sequence[str], used: set[int]) -> str:
        """A mend that names the columns that may be the missing ones."""
        free = {
            k: name for k, name in self.candidates.names.items() if id(self.columns[k]) not in used
        }
        pairs = []
        for ours in missing:
            group = GROUP_OF[ours]
            component = GROUPS[group].index(ours)
            same = [
                name.text.strip()
                for name in free.values()
                if any(
                    SPELLINGS[r.spelling].group == group and r.component == component
                    for r in name.readings
                )
            ]
            by_key = {name.key: name.text.strip() for name in free.values() if len(name.key) > 1}
            close = difflib.get_close_matches(ours, by_key, n=1)
            meant = [name for name in same if not is_ours(name)] or [by_key[key] for key in close]
            if meant and not is_ours(meant[0]):
                pairs.append((ours, meant[0]))
        if not pairs:
            return ""
        names = " ".join(f"`{cut(theirs)}`" for _, theirs in pairs)
        request = ",".join(f"{ours}={theirs}" for ours, theirs in pairs)
        return f"did you mean {names}? --columns {cut(request)}"

    # What is not taken.

    def left_out(self, chosen: Mapping[str, Choice]) -> Iterator[str]:
        """Sentences about groups of which a part is there, and about columns that are ignored."""
        used = {id(column) for choice in chosen.values() for column in choice.columns}
        for (number, _), cells in self.candidates.cells.items():
            spelling = SPELLINGS[number]
            if spelling.group in chosen or spelling.is_whole or len(cells) < 2:
                continue
            lacking = [n for i, n in enumerate(GROUPS[spelling.group]) if i not in cells]
            present = [self.columns[hits[0][0]] for _, hits in sorted(cells.items())]
            if lacking and not any(id(c) in used or is_ours(c.name) for c in present):
                yield f"{shown_names(present)} not taken: nothing in the file is {' '.join(lacking)}"
        ignored = [
            column
            for column in self.columns
            if id(column) not in used and column.name not in _SILENT
        ]
        if ignored:
            named, more = shown_names(ignored[:MOST_NAMED]), len(ignored) - MOST_NAMED
            yield f"ignored: {named}{f' and {more} more' if more > 0 else ''}"
