"""Columns of ROS messages: the types that tell a motion, and the columns that their numbers are.

sensor_msgs/Imu                orientation, body to space; angular_velocity in body axes
nav_msgs/Odometry              pose of the child frame in space; twist in axes of the child frame
geometry_msgs/PoseStamped      pose in the frame of the header, with covariance or without
geometry_msgs/TransformStamped the same as a transform
geometry_msgs/QuaternionStamped
geometry_msgs/TwistStamped     twist in axes of the frame of the header, with covariance or without

The time is the stamp of the header, to the nanosecond.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from operator import attrgetter
from pathlib import Path
from typing import Any, Final, NamedTuple

from taylor_verify.records.faults import cut, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.solvers.files.formats.column import ROWS, Column, Table, listed

_MOST_LISTED: Final = 20
MESSAGE_BYTES: Final = Limit(2**20, "bytes in a message", "one that tells a motion has a thousand")

# The path in a message of each group of columns.
Paths = Mapping[str, str]


def _pose(path: str) -> Paths:
    return {"quaternion": f"{path}.orientation", "centre": f"{path}.position"}


def _twist(path: str) -> Paths:
    return {"omega": f"{path}.angular", "linear_velocity": f"{path}.linear"}


_TYPES: Final[Mapping[str, Paths]] = {
    "sensor_msgs/Imu": {"quaternion": "orientation", "omega": "angular_velocity"},
    "nav_msgs/Odometry": {**_pose("pose.pose"), **_twist("twist.twist")},
    "geometry_msgs/PoseStamped": _pose("pose"),
    "geometry_msgs/PoseWithCovarianceStamped": _pose("pose.pose"),
    "geometry_msgs/TransformStamped": {
        "quaternion": "transform.rotation",
        "centre": "transform.translation",
    },
    "geometry_msgs/QuaternionStamped": {"quaternion": "quaternion"},
    "geometry_msgs/TwistStamped": _twist("twist"),
    "geometry_msgs/TwistWithCovarianceStamped": _twist("twist.twist"),
}
_ORDER: Final = ("quaternion", "omega", "centre", "linear_velocity")


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
        raise refusal(f"a topic of the recording ({_listed(topics)})", f"`#{cut(part)}`", path)
    fit = [topic for topic in asked if topic.type_name in _TYPES and topic.messages]
    if not fit:
        raise refusal(f"messages of the types {', '.join(_TYPES)}", _listed(asked), path)
    if len(fit) > 1:
        raise refusal("one topic", _listed(fit), path, f"name one: FILE#{fit[0].name}")
    ROWS.check(fit[0].messages, f"{path}, topic {cut(fit[0].name)}")
    return fit[0]


def _listed(topics: Sequence[Topic]) -> str:
    return listed([*map(str, topics)], _MOST_LISTED) or "none"


def table(topic: Topic, messages: Iterable[Any], path: Path) -> Table:
    """Return the columns of the messages of a topic, each number as the message holds it."""
    stated = _TYPES[topic.type_name]
    paths = {group: stated[group] for group in _ORDER if group in stated}
    columns = {column: list[Any]() for group in paths for column in COLUMNS[group]}
    numbers = attrgetter(
        *(
            f"{path_in}.{letter}"
            for group, path_in in paths.items()
            for letter in "wxyz"[-len(COLUMNS[group]) :]
        )
    )
    stamps, last = list[int](), None
    try:
        for message in messages:
            stamps.append(_nanoseconds(message.header.stamp))
            for values, number in zip(columns.values(), numbers(message), strict=True):
                values.append(number)
            last = message
    except AttributeError as error:
        raise refusal(f"messages of {topic.kind}", f"one with {error}", path) from None
    notes = [f"read from topic {topic}{_frames(last) if last is not None else ''}"]
    notes += [", ".join(f"{COLUMNS[group][0]} ... are {paths[group]}" for group in paths)]
    if getattr(last, "orientation_covariance", [0])[0] == -1:
        # The definition of Imu: the message has no estimate of its orientation.
        columns = {name: values for name, values in columns.items() if name[0] != "q"}
        notes.append("orientation is not read: its covariance says, by -1, that there is none")
    times = [Decimal(stamp).scaleb(-9) for stamp in stamps]
    read = [Column("stamp", times), *(Column(name, values) for name, values in columns.items())]
    return Table(read, tuple(notes))


def _nanoseconds(stamp: Any) -> int:
    """Return the nanoseconds of a stamp of ROS 2 or of ROS 1."""
    below = stamp.nanosec if hasattr(stamp, "nanosec") else stamp.nsec
    return int(stamp.sec) * 10**9 + int(below)


def _frames(message: Any) -> str:
    frames = (getattr(message, "child_frame_id", ""), message.header.frame_id)
    named = cut(" to ".join(filter(None, frames)))
    return f", frame {named}" if named else ""
