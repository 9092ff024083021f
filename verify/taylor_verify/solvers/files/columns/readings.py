"""The ways to read the name of a column: a name of the table, a path in front of it, a unit behind it.

``/imu/angular_velocity.x [deg/s]`` is the path ``/imu``, the name ``angularvelocityx`` and the unit
``deg/s``. Brackets that hold an index belong to the name: ``omega[0]``, ``R(1,2)``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

from taylor_verify.solvers.files.columns.names import GROUP_OF, PLACES
from taylor_verify.solvers.files.columns.spelling import Spelling
from taylor_verify.solvers.files.columns.units import (
    OWN,
    Unit,
    as_suffix,
    in_brackets,
    letters,
    plain,
)
from taylor_verify.solvers.files.formats.column import Column

_BRACKETS: Final = re.compile(r"(?P<name>.*\S)\s*[\[({](?P<inside>[^\[\](){}]*)[\])}]")
# An index, a component, or the variable of a function of time.
_INDEX: Final = re.compile(r"[\d\s,;:]+|[wxyz]{1,2}|")
_OF_TIME: Final = "t"
# Names of one letter and a digit say too little behind a path.
_TERSE: Final = re.compile(r"[a-z]\d")
_LONGEST_SUFFIX: Final = 3
# A longer name has no readings: each path in it would be tried.
_LONGEST: Final = 200
# Words in front of a name that is then no state of the body.
_OF_NO_STATE: Final = (
    "cmd command des desired ref reference target goal sp setpoint err error bias cov std var acc accel "
    "b dot euler angle wheel wheels rw rotor motor cmg joint prop thruster noise"
)
_NO_STATE: Final = frozenset(_OF_NO_STATE.split())


class Reading(NamedTuple):
    """A spelling that a name may belong to, its component there, and the path in front of it.

    ``unit`` is None where the brackets hold no unit of this group. A path that ends in _ is a word.
    """

    spelling: Spelling
    component: int
    path: str
    unit: Unit | None


@dataclass(frozen=True, eq=False)
class Name:
    """The name of a column, as its file writes it but for blanks around it."""

    column: Column

    @cached_property
    def text(self) -> str:
        return self.column.name.strip()

    @property
    def is_ours(self) -> bool:
        """True for a name that is ours to the letter."""
        return self.text in GROUP_OF

    @cached_property
    def _parts(self) -> tuple[str, str | None]:
        """The name in plain letters, and the text of brackets behind it that are no index."""
        name = plain(self.text[:_LONGEST])
        bracketed = _BRACKETS.fullmatch(name)
        if bracketed is None:
            return name, None
        inside = bracketed["inside"].strip()
        if _INDEX.fullmatch(inside):
            return name, None
        return bracketed["name"], None if inside == _OF_TIME else inside

    @property
    def unit_text(self) -> str:
        """The text of the brackets behind the name, empty where there are none."""
        return self._parts[1] or ""

    @cached_property
    def key(self) -> str:
        """All letters and digits of the name, the unit left out."""
        return letters(self._parts[0])

    @cached_property
    def whole_key(self) -> str:
        """All letters and digits of the name, those in brackets too."""
        return letters(plain(self.text[:_LONGEST]))

    def unit(self, group: str) -> Unit | None:
        """Return the unit of a column that is of this group, by its brackets or the end of its name."""
        name, brackets = self._parts
        if brackets is not None:
            return in_brackets(brackets, group)
        suffixed = (as_suffix(end, group) for _, end in _without_units(name))
        return next((unit for unit in suffixed if unit is not None), OWN)

    @property
    def is_known(self) -> bool:
        """True for a name that needs no sign of a program beside it."""
        return any(not reading.spelling.signs for reading in self.readings)

    @cached_property
    def readings(self) -> tuple[Reading, ...]:
        """Possible readings; for each spelling the reading with the shortest path and without a suffix."""
        if len(self.text) > _LONGEST:
            return ()
        readings: dict[tuple[Spelling, int], Reading] = {}
        matched: set[str] = set()
        brackets = self._parts[1]
        if brackets and not in_brackets(brackets, "time") and self.whole_key in PLACES:
            # The brackets belong to the name: P_{inertial}.
            return tuple(Reading(*place, "", OWN) for place in _places(self.whole_key, ""))
        for path, name in _tails(self._parts[0]):
            # The T of IMU.T is a temperature.
            if path and name == "t" and self.text.endswith("T"):
                continue
            # A program's names are known behind any path: ATT.Roll is no attitude's roll of anybody.
            every = [
                reading
                for reading in self._of(path, name)
                if reading.spelling.whose or reading.spelling.group not in matched
            ]
            for reading in every:
                readings.setdefault((reading.spelling, reading.component), reading)
            matched |= {reading.spelling.group for reading in every}
            if matched and path.endswith("_"):
                break
        return tuple(readings.values())

    def _of(self, path: str, name: str) -> Iterator[Reading]:
        brackets = self._parts[1]
        for spelling, component in _places(name, path):
            unit = OWN if brackets is None else in_brackets(brackets, spelling.group)
            yield Reading(spelling, component, path, unit)
        for stem, end in _without_units(name) if brackets is None else ():
            for spelling, component in _places(stem, path):
                if unit := as_suffix(end, spelling.group):
                    yield Reading(spelling, component, path, unit)


def _places(name: str, path: str) -> Iterator[tuple[Spelling, int]]:
    key = letters(name)
    for spelling, component in PLACES.get(key, ()):
        if (
            _is_behind(spelling, key, path)
            if path.endswith("_")
            else _is_after(spelling, key, path)
        ):
            yield spelling, component


def _is_after(spelling: Spelling, key: str, path: str) -> bool:
    """Return True for a spelling that may stand alone, or behind a path.

    The w1 of motor.w1 is no angular velocity, nor the x of acceleration.x a position.
    """
    is_terse = _TERSE.fullmatch(key) is not None and not spelling.whose
    return not spelling.is_behind and not (path and (spelling.is_whole or is_terse))


def _is_behind(spelling: Spelling, key: str, path: str) -> bool:
    """Return True for a spelling that may stand behind a word and _: base_orn_x."""
    if spelling.is_behind:
        return True
    is_terse = spelling.is_whole or (_TERSE.fullmatch(key) is not None and key[0] != "q")
    is_state = spelling.group != "time" and not spelling.doubt and not is_terse
    return is_state and _NO_STATE.isdisjoint(re.split(r"[^a-z]+", path))


def _tails(name: str) -> Iterator[tuple[str, str]]:
    """Yield the name, and what is left of it behind longer and longer paths, then behind words and _."""
    yield "", name
    for separator in re.finditer(r"[/.]", name):
        if separator.start():
            yield name[: separator.start()], name[separator.end() :]
    for separator in re.finditer("_", name):
        if separator.start():
            yield name[: separator.end()], name[separator.end() :]


def _without_units(name: str) -> Iterator[tuple[str, str]]:
    """Yield the name without some of its later words, and the letters of these, the longest end first."""
    words = re.split(r"([_\s./-]+)", name)
    for last in range(len(words), 1, -2):
        for first in range(max(2, last + 1 - 2 * _LONGEST_SUFFIX), last + 1, 2):
            yield "".join(words[: first - 1] + words[last:]), letters("".join(words[first:last:2]))
