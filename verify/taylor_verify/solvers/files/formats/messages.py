"""Columns of ROS messages: which types tell a motion, and which of their numbers are which columns.

sensor_msgs/Imu                orientation, body to space; angular_velocity in body axes
nav_msgs/Odometry              pose of the child frame in space; twist in axes of the child frame
geometry_msgs/PoseStamped      pose in the frame of the header, with covariance or without
geometry_msgs/TransformStamped the same as a transform
geometry_msgs/QuaternionStamped
geometry_msgs/TwistStamped     twist in axes of the frame of the header, with covariance or without

The time is the stamp of the header, to the nanosecond. Stamps of a clock, those after the year 2001, count
from the first message; others are the time of a simulation, and are taken as they are.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from operator import attrgetter
from pathlib import Path
from typing import Any, Final, NamedTuple

from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.reading.faults import Refused, cut
from taylor_verify.solvers.files.formats.column import ROWS, Column, Table

_SCALAR_FIRST: Final = ("w", "x", "y", "z")
_VECTOR: Final = ("x", "y", "z")
_SPEED: Final = ("u1", "u2", "u3")
# A second count that no simulation reaches, and every clock has since 2001.
_CLOCK: Final = 10**9
_MOST_LISTED: Final = 20

Fields = tuple[tuple[str, str], ...]


def _fields(quaternion: str = "", rate: str = "", place: str = "", speed: str = "") -> Fields:
    """Pairs of a column and the path of its number in a message."""
    groups = (
        (COLUMNS["quaternion"], quaternion, _SCALAR_FIRST),
        (COLUMNS["omega"], rate, _VECTOR),
        (COLUMNS["centre"], place, _VECTOR),
        (_SPEED, speed, _VECTOR),
    )
    return tuple(
        (column, f"{path}.{letter}")
        for names, path, letters in groups
        if path
        for column, letter in zip(names, letters, strict=True)
    )


def _pose(path: str) -> dict[str, str]:
    return {"quaternion": f"{path}.orientation", "place": f"{path}.position"}


def _twist(path: str) -> dict[str, str]:
    return {"rate": f"{path}.angular", "speed": f"{path}.linear"}


_TYPES: Final[Mapping[str, Fields]] = {
    "sensor_msgs/Imu": _fields("orientation", "angular_velocity"),
    "nav_msgs/Odometry": _fields(**_pose("pose.pose"), **_twist("twist.twist")),
    "geometry_msgs/PoseStamped": _fields(**_pose("pose")),
    "geometry_msgs/PoseWithCovarianceStamped": _fields(**_pose("pose.pose")),
    "geometry_msgs/TransformStamped": _fields("transform.rotation", place="transform.translation"),
    "geometry_msgs/QuaternionStamped": _fields("quaternion"),
    "geometry_msgs/TwistStamped": _fields(**_twist("twist")),
    "geometry_msgs/TwistWithCovarianceStamped": _fields(**_twist("twist.twist")),
}


class Topic(NamedTuple):
    """A topic of a recording: its name, the type of its messages, and how many there are."""

    name: str
    kind: str
    messages: int

    @property
    def type_name(self) -> str:
        return self.kind.replace("/msg/", "/")

    def __str__(self) -> str:
        return f"{cut(self.name)} ({cut(self.type_name)}, {self.messages} messages)"


def chosen(topics: Sequence[Topic], part: str, path: Path) -> Topic:
    """Return the topic that is asked for, or the one topic of a type that tells a motion."""
    asked = [topic for topic in topics if part.strip("/") in ("", topic.name.strip("/"))]
    if not asked:
        expected = f"a topic of the recording ({_listed(topics)})"
        raise Refused([f"expected {expected}, got `#{cut(part)}` @ {path}"])
    fit = [topic for topic in asked if topic.type_name in _TYPES and topic.messages]
    if not fit:
        expected = f"messages of the types {', '.join(_TYPES)}"
        raise Refused([f"expected {expected}, got {_listed(asked)} @ {path}"])
    if len(fit) > 1:
        mend = f"name one: FILE#{fit[0].name}"
        raise Refused([f"expected one topic, got {_listed(fit)} @ {path} ({mend})"])
    ROWS.check(fit[0].messages, f"{path}, topic {cut(fit[0].name)}")
    return fit[0]


def _listed(topics: Sequence[Topic]) -> str:
    more = len(topics) - _MOST_LISTED
    return (
        ", ".join(map(str, topics[:_MOST_LISTED])) + (f" and {more} more" if more > 0 else "")
        or "none"
    )


def table(topic: Topic, messages: Iterable[Any], path: Path) -> Table:
    """Return the columns of the messages of a topic, each number as the message holds it."""
    fields = _TYPES[topic.type_name]
    read = [(attrgetter(path_in), list[Any]()) for _, path_in in fields]
    stamps, frames, last = list[int](), "", None
    try:
        for message in messages:
            stamps.append(_stamp(message.header.stamp))
            for get, values in read:
                values.append(get(message))
            last = message
    except AttributeError as error:
        raise Refused(
            [f"expected messages of {topic.kind}, got one with {error} @ {path}"]
        ) from None
    frames = _frames(last) if last is not None else ""
    columns = {name: values for (name, _), (_, values) in zip(fields, read, strict=True)}
    notes = list(_notes(topic, fields, frames))
    if getattr(last, "orientation_covariance", [0])[0] == -1:
        # The definition of Imu: the message has no estimate of its orientation.
        columns = {name: values for name, values in columns.items() if name[0] != "q"}
        notes.append("orientation is not read: its covariance says, by -1, that there is none")
    times, note = _times(stamps)
    named = [Column("t", times), *(Column(name, values) for name, values in columns.items())]
    return Table(named, (*notes, note))


def _stamp(stamp: Any) -> int:
    """The nanoseconds of a stamp of ROS 2 or of ROS 1."""
    nanoseconds = stamp.nanosec if hasattr(stamp, "nanosec") else stamp.nsec
    return int(stamp.sec) * 10**9 + int(nanoseconds)


def _frames(message: Any) -> str:
    child = getattr(message, "child_frame_id", "")
    return cut(" to ".join(filter(None, (child, message.header.frame_id))))


def _times(stamps: Sequence[int]) -> tuple[list[Decimal], str]:
    """The stamps in seconds, and how they count."""
    is_clock = bool(stamps) and min(stamps) >= _CLOCK * 10**9
    zero = stamps[0] if is_clock else 0
    since = (
        f"counts from the first stamp, {zero // 10**9}.{zero % 10**9:09} s"
        if is_clock
        else "is the stamp of the header"
    )
    return [_seconds(stamp - zero) for stamp in stamps], f"t {since}"


def _seconds(nanoseconds: int) -> Decimal:
    return Decimal(nanoseconds).scaleb(-9)


def _notes(topic: Topic, fields: Fields, frames: str) -> Iterator[str]:
    yield f"read from topic {topic}" + (f", frame {frames}" if frames else "")
    groups = {path.rpartition(".")[0]: column for column, path in reversed(fields)}
    yield ", ".join(f"{column} ... are {path}" for path, column in reversed(groups.items()))
