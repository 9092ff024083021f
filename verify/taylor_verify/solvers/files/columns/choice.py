"""One choice of the columns of a group, and the sentence about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

from taylor_verify.scenes.reading.faults import cut
from taylor_verify.solvers.files.columns.names import GROUPS
from taylor_verify.solvers.files.columns.readings import is_ours
from taylor_verify.solvers.files.columns.units import Unit
from taylor_verify.solvers.files.formats.column import Column

MOST_NAMED: Final = 8


class Rank(IntEnum):
    """The precedence of a choice, the strongest first."""

    ASKED = 0
    OURS = 1
    USUAL = 2


@dataclass(frozen=True)
class Choice:
    """The columns of one group, in our order, each with its unit (None: not known)."""

    group: str
    columns: tuple[Column, ...]
    units: tuple[Unit | None, ...]
    rank: Rank
    remark: str = ""
    doubt: str = ""

    @property
    def shown(self) -> str:
        return shown_names(self.columns)

    @property
    def note(self) -> str:
        """The sentence about what was taken; empty for our own names in the scene's units."""
        words = dict.fromkeys(unit.words for unit in self.units if unit and unit.words)
        is_plain = all(is_ours(column.name) for column in self.columns)
        if is_plain and not words and self.rank is not Rank.ASKED:
            return ""
        said = [self.remark] if self.remark and not is_plain else []
        said += [f"in {' and in '.join(words)}"] if words else []
        names = " ".join(GROUPS[self.group])
        return f"{self.shown} taken as {names}{''.join(f', {part}' for part in said)}"


def scalar_requests(choice: Choice) -> str:
    """The requests for a scalar that is the first of four columns, and for one that is the last."""
    names = [column.name.strip() for column in choice.columns]
    if choice.group != "quaternion":
        return ""
    first, last = (
        ",".join(
            f"{ours}={cut(name)}" for ours, name in zip(GROUPS[choice.group], order, strict=True)
        )
        for order in (names, [names[-1], *names[:-1]])
    )
    return f"{first} for the first, {last} for the last"


def shown_names(columns: Sequence[Column]) -> str:
    if len(columns) > MOST_NAMED:
        return f"`{cut(columns[0].name)}` ... `{cut(columns[-1].name)}`"
    return " ".join(f"`{cut(column.name)}`" for column in columns)
