"""A spelling: the names that a program, or usage, has for the columns of a group."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, StrEnum


class Frame(IntEnum):
    """The frame that a quantity is relative to, the one of the equations of motion first."""

    INERTIAL = 0
    UNSAID = 1
    LOCAL = 2
    EARTH = 3
    ANGLES = 4

    @property
    def words(self) -> str:
        return _FRAMES[self]


_FRAMES = {
    Frame.INERTIAL: "relative to space",
    Frame.UNSAID: "relative to a frame that their names do not say",
    Frame.LOCAL: "relative to the local horizon",
    Frame.EARTH: "relative to the turning earth",
    Frame.ANGLES: "perhaps rates of Euler angles",
}


class Turn(StrEnum):
    """The way from a program's convention to ours."""

    NONE = ""
    TO_BODY = "space axes to body axes"
    SPACE_AXES = "in space axes"


@dataclass(frozen=True)
class Spelling:
    """Names of all components of a group; ``remark`` is said wherever it is taken.

    ``is_whole`` names have no path in front of them: the x of ``acceleration.x`` is no position. A spelling
    is taken only ``beside`` another group, and not where a name of ``unless`` is in the file. It is taken
    with all names of ``company`` behind the same path, and not with all names of ``apart_from``. One with a
    ``doubt`` is taken only if something else in the file settles it: the doubt says what.

    ``whose`` is the program that writes these names, perhaps behind a word and _ (``is_behind``). It is
    known by all names of one of ``signs`` in the file. Its manual may state a ``unit``, the ``frame`` that
    the motion is relative to, and the convention, by the ``turn`` to ours.
    """

    group: str
    keys: tuple[str, ...]
    remark: str = ""
    is_whole: bool = False
    beside: str = ""
    unless: frozenset[str] = frozenset()
    company: tuple[str, ...] = ()
    apart_from: tuple[str, ...] = ()
    doubt: str = ""
    whose: str = ""
    is_behind: bool = False
    signs: tuple[tuple[str, ...], ...] = ()
    unit: str = ""
    frame: Frame = Frame.UNSAID
    turn: Turn = Turn.NONE

    @property
    def precedence(self) -> tuple[Frame, bool]:
        """The place among spellings of one quantity: relative to space and in body axes first."""
        return self.frame, self.turn is Turn.SPACE_AXES

    @property
    def relation(self) -> str:
        """A phrase on the frame, or on the axes."""
        return str(self.turn) if self.turn is Turn.SPACE_AXES else self.frame.words
