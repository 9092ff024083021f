"""The ways to read the name of a column: a name of the table, a path in front of it, a unit behind it.

``/imu/angular_velocity.x [deg/s]`` is the path ``/imu``, the name ``angularvelocityx`` and the unit
``deg/s``. Brackets that hold an index belong to the name: ``omega[0]``, ``R(1,2)``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Final, NamedTuple

from taylor_verify.solvers.files.columns.column_units import (
    OWN,
    Unit,
    as_suffix,
    in_brackets,
    plain,
)
from taylor_verify.solvers.files.columns.names import GROUP_OF, PLACES
from taylor_verify.solvers.files.columns.programs import letters
from taylor_verify.solvers.files.columns.spelling import Frame, Spelling
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
# Words of the body, behind which q0 q1 q2 q3 are its quaternion.
_OF_ATTITUDE: Final = frozenset(
    ["attitude", "att", "orientation", "pose", "odometry", "odom", "base", "body", "quat"]
)
# Words for the frame that a motion is relative to. Of an angular velocity some may mean its axes.
_FRAMES: Final[Mapping[str, Frame]] = {
    **dict.fromkeys(["bi", "ib", "bn", "i2b", "b2i"], Frame.INERTIAL),
    **dict.fromkeys(["bl", "lb", "bo", "ob"], Frame.LOCAL),
    **dict.fromkeys(["be", "eb"], Frame.EARTH),
}
_FRAMES_OR_AXES: Final[Mapping[str, Frame]] = {
    **dict.fromkeys(["inertial", "eci", "j2000", "icrf", "gcrf", "eme2000"], Frame.INERTIAL),
    **dict.fromkeys(["ned", "enu", "lvlh", "orbit", "orbital", "hill", "rtn"], Frame.LOCAL),
    **dict.fromkeys(["ecef", "itrf"], Frame.EARTH),
}
_IN_BODY_AXES: Final = "b"
_VELOCITIES: Final = ("omega", "linear_velocity")


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

    @classmethod
    @lru_cache(4096)
    def of(cls, text: str) -> Name:
        """Return a name without a column; headers and objects repeat many."""
        return cls(Column(text, ()))

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

    @property
    def is_time(self) -> bool:
        """True for a name that a time may have."""
        return any(reading.spelling.group == "time" for reading in self.readings)

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
        return (*readings.values(), *self._between_frames())

    def _between_frames(self) -> tuple[Reading, ...]:
        """Return the readings of a name that has a frame in its middle: ``q_eci_w``."""
        *path, name = re.split(r"[/.]", self._parts[0])
        words = re.findall(r"[^_\[\](),\s]+", name)
        frames = [word for word in words[1:] if word in _FRAMES or word in _FRAMES_OR_AXES]
        if not frames:
            return ()
        bare = "_".join(word for word in words if word not in (*frames, _IN_BODY_AXES))
        return tuple(
            reading._replace(
                spelling=_relative(reading.spelling, frames), path="/".join((*path, *frames))
            )
            for reading in self._of("", bare)
            if reading.spelling.group not in _VELOCITIES or frames[0] in _FRAMES
        )

    def _of(self, path: str, name: str) -> Iterator[Reading]:
        brackets = self._parts[1]
        words = re.split(r"[^a-z0-9]+", path)
        for spelling, component in _places(name, path):
            unit = OWN if brackets is None else in_brackets(brackets, spelling.group)
            yield Reading(_relative(spelling, words), component, path, unit)
        for stem, end in _without_units(name) if brackets is None else ():
            for spelling, component in _places(stem, path):
                if unit := as_suffix(end, spelling.group):
                    yield Reading(spelling, component, path, unit)


def _places(name: str, path: str) -> Iterator[tuple[Spelling, int]]:
    key, is_possible = letters(name), _is_behind if path.endswith("_") else _is_after
    for spelling, component in PLACES.get(key, ()):
        if is_possible(spelling, key, path):
            yield spelling, component


def _is_after(spelling: Spelling, key: str, path: str) -> bool:
    """Return True for a spelling that may stand alone, or behind a path.

    The w1 of motor.w1 is no angular velocity, nor the x of acceleration.x a position.
    """
    is_terse = _TERSE.fullmatch(key) is not None and not spelling.whose
    if spelling.group == "quaternion" and is_terse:
        is_terse = _OF_ATTITUDE.isdisjoint(re.split(r"[^a-z]+", path))
    return not spelling.is_behind and not (path and (spelling.is_whole or is_terse))


def _is_behind(spelling: Spelling, key: str, path: str) -> bool:
    """Return True for a spelling that may stand behind a word and _: base_orn_x."""
    if spelling.is_behind:
        return True
    is_terse = spelling.is_whole or (_TERSE.fullmatch(key) is not None and key[0] != "q")
    is_state = spelling.group != "time" and not spelling.doubt and not is_terse
    return is_state and _NO_STATE.isdisjoint(re.split(r"[^a-z]+", path))


def _relative(spelling: Spelling, words: Sequence[str]) -> Spelling:
    """Return a spelling with the frame that words beside it say, where it has none of its own."""
    known = _FRAMES if spelling.group in _VELOCITIES else {**_FRAMES, **_FRAMES_OR_AXES}
    frames = [known[word] for word in words if word in known]
    if not frames or spelling.group == "time" or spelling.frame is not Frame.UNSAID:
        return spelling
    return replace(spelling, frame=frames[0])


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
