"""The attitude in a CCSDS AEM (504.0-B), as text (KVN) or XML, every number exactly as written.

The quaternion of a message is e sin(phi/2), cos(phi/2), of the rotation by which the axes of REF_FRAME_A
become those of REF_FRAME_B: it takes components in B to components in A. One of the frames has to be that
of the body, SC_BODY. Where it is B, the quaternion is ours, body to space; where it is A, its conjugate
is. ATTITUDE_DIR = B2A, of version 1 alone, means the inverse. ANGVEL is the angular velocity of B with
respect to A in degrees a second, resolved in ANGVEL_FRAME. Times count from START_TIME.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import cache
from math import nan
from pathlib import Path
from typing import BinaryIO, Final

from mpmath import mp

from taylor_verify.scenes.reading.faults import Faults, Refused, cut
from taylor_verify.solvers.files.formats import aem_text, aem_xml
from taylor_verify.solvers.files.formats.aem_segment import (
    ANGULAR_VELOCITY,
    DERIVATIVE,
    QUATERNION,
    Segment,
)
from taylor_verify.solvers.files.formats.column import (
    MOST_ALIKE,
    Column,
    Table,
    add_more_alike,
    shown,
)
from taylor_verify.solvers.files.formats.epochs import seconds
from taylor_verify.solvers.values import Value, exact

_BODY: Final = "SC_BODY"
# Frames that turn with the earth or with an orbit: equations of motion have other terms in them.
_TURNING: Final = (
    *("ITRF", "DTRF", "EFG", "WGS", "GTOD", "TDR", "GRC"),
    *("LVLH", "VVLH", "RTN", "RSW", "RIC", "QSW", "TNW", "NTW", "VNC", "SEZ", "NSW"),
)
_NOT_UNIFORM: Final = ("UT1", "GMST", "SCLK", "MET", "MRT")
_BITS: Final = 400
_SCALAR_FIRST: Final = (3, 0, 1, 2)

Row = Sequence[Value]


def is_text(file: BinaryIO) -> bool:
    """Return True for a file that begins like a CCSDS message in text, whatever its name."""
    start = file.read(64)
    file.seek(0)
    return start.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"CCSDS_")


def read(file: BinaryIO, path: Path, part: str) -> Table:
    """Return t, q0 ... q3 and, where the message has it, w1 w2 w3; ``part`` is the number of a segment."""
    start = file.read(64).lstrip(b"\xef\xbb\xbf \t\r\n")
    file.seek(0)
    is_xml = start.startswith(b"<")
    segments = aem_xml.segments(file, path) if is_xml else aem_text.segments(file, path)
    segment = _chosen(segments, part, path)
    reverse = _check_frames(segment, path)
    numbers = _Numbers(segment, path)
    times = numbers.times()
    quaternions = list(numbers.rows(QUATERNION))
    rates = list(numbers.rates())
    if numbers.faults.lines:
        raise Refused(numbers.faults.lines)
    turned = [_body_to_space(q, reverse) for q in quaternions]
    columns = [Column("t", times), *_quaternion_columns(segment, reverse)]
    velocity, notes = _angular_velocity(segment, reverse, turned, rates, path)
    return Table(columns + velocity, (*_read_as(segment, path), *notes))


def _chosen(segments: Sequence[Segment], part: str, path: Path) -> Segment:
    numbers = [str(number) for number in range(1, len(segments) + 1)]
    if not segments:
        raise Refused([f"expected a segment with attitude data, got none @ {path}"])
    if not part and len(segments) > 1:
        mend = f"name one: FILE#1 ... FILE#{numbers[-1]}"
        raise Refused([f"expected one segment, got {len(segments)} @ {path} ({mend})"])
    if part and part not in numbers:
        raise Refused([f"expected a segment from 1 to {numbers[-1]}, got `#{cut(part)}` @ {path}"])
    return segments[int(part or 1) - 1]


def _check_frames(segment: Segment, path: Path) -> bool:
    """Return True if the quaternion takes components in space to components in the body."""
    a, b = segment.frame("A"), segment.frame("B")
    if a.startswith(_BODY) is b.startswith(_BODY):
        raise Refused(
            [
                f"expected {_BODY} as one of REF_FRAME_A and REF_FRAME_B, got {cut(a)} and {cut(b)} @ "
                f"{path} (a scene's axes are those of the body)"
            ]
        )
    space = b if a.startswith(_BODY) else a
    if space.startswith(_TURNING) and not space.endswith("_INERTIAL"):
        raise Refused([f"expected an inertial frame beside {_BODY}, got {cut(space)} @ {path}"])
    direction = segment.metadata.get("ATTITUDE_DIR", "A2B").upper()
    if direction not in ("A2B", "B2A"):
        raise Refused([f"expected ATTITUDE_DIR = A2B or B2A, got {cut(direction)} @ {path}"])
    return a.startswith(_BODY) is not (direction == "B2A")


class _Numbers:
    """The numbers of a segment, exactly; what is none is a fault, and a NaN in its place."""

    def __init__(self, segment: Segment, path: Path) -> None:
        self.segment, self.path, self.faults = segment, path, Faults()

    def times(self) -> list[Fraction]:
        """Seconds since START_TIME."""
        system = self.segment.metadata["TIME_SYSTEM"].upper()
        if system in _NOT_UNIFORM:
            self.faults.add("a TIME_SYSTEM like UTC, TAI or TT", cut(system), str(self.path))
            return []
        is_utc, zero = system == "UTC", Fraction(0)
        try:
            zero = seconds(self.segment.metadata["START_TIME"], is_utc)
        except ValueError as error:
            start = cut(self.segment.metadata["START_TIME"])
            self.faults.add(str(error), start, f"{self.path}, START_TIME")
        epochs = self._each("EPOCH", lambda text: seconds(text, is_utc))
        return [Fraction(epoch) - zero for epoch in epochs if isinstance(epoch, Fraction)]

    def rows(self, names: Sequence[str]) -> Iterator[Row]:
        columns = [list(self._each(name, exact)) for name in names]
        return zip(*columns, strict=True)

    def rates(self) -> Iterator[Row]:
        """The angular velocities or the derivatives of quaternions, as the message has them."""
        for names in (ANGULAR_VELOCITY, DERIVATIVE):
            if names[0] in self.segment.columns:
                yield from self.rows(names)

    def _each(self, name: str, value: Callable[[str], Value]) -> Iterator[Value]:
        wrong = 0
        for row, text in enumerate(self.segment.columns.get(name, ()), start=1):
            try:
                yield value(text)
            except ValueError as error:
                wrong += 1
                if wrong <= MOST_ALIKE:
                    self.faults.add(str(error), shown(text), f"{self.path}, state {row}, {name}")
                yield nan
        add_more_alike(self.faults, wrong, f"{self.path}, {name}")


# What the numbers mean.


def _body_to_space(q: Row, reverse: bool) -> Row:
    """The quaternion with its scalar first."""
    ordered = tuple(q[i] for i in _SCALAR_FIRST)
    return _conjugate(ordered) if reverse else ordered


def _angular_velocity(
    segment: Segment, reverse: bool, turned: Sequence[Row], rates: Sequence[Row], path: Path
) -> tuple[list[Column], list[str]]:
    """w1 w2 w3 in body axes and radians a second, where the message has them."""
    if segment.kind == "QUATERNION/DERIVATIVE":
        dots = [_body_to_space(rate, reverse) for rate in rates]
        velocities = [_of_derivative(q, dot) for q, dot in zip(turned, dots, strict=True)]
        return _columns(velocities), ["w1 w2 w3 are twice conj(q) dq/dt, of Q1_DOT ... QC_DOT"]
    if segment.kind != "QUATERNION/ANGVEL":
        rate = "X_RATE Y_RATE Z_RATE are rates of Euler angles, and are not read"
        return [], [rate] if segment.kind == "QUATERNION/RATE" else []
    frame = segment.metadata.get("ANGVEL_FRAME", "").upper()
    in_body = _is_body(segment, frame, path)
    sign = -1 if segment.frame("A").startswith(_BODY) else 1
    velocities = [[sign * _degree() * v for v in rate] for rate in rates]
    if not in_body:
        velocities = [_in_body(q, v) for q, v in zip(turned, velocities, strict=True)]
    return _columns(velocities), [f"w1 w2 w3 are ANGVEL in {frame}, degrees a second"]


def _is_body(segment: Segment, frame: str, path: Path) -> bool:
    names = {"REF_FRAME_A": segment.frame("A"), "REF_FRAME_B": segment.frame("B")}
    frame = names.get(frame, frame)
    if frame not in names.values():
        expected = " or ".join(names.values())
        raise Refused([f"expected ANGVEL_FRAME = {expected}, got {cut(frame) or 'none'} @ {path}"])
    return frame.startswith(_BODY)


def _columns(rows: Sequence[Row]) -> list[Column]:
    columns = zip(*rows, strict=True)
    return [Column(f"w{i}", list(values)) for i, values in enumerate(columns, start=1)]


def _quaternion_columns(segment: Segment, reverse: bool) -> Iterator[Column]:
    """q0 ... q3 as text, so that the number of printed digits is known."""
    for i, place in enumerate(_SCALAR_FIRST):
        texts = segment.columns[QUATERNION[place]]
        yield Column(f"q{i}", [_negative(t) for t in texts] if reverse and i else texts)


def _negative(text: str) -> str:
    return text.removeprefix("-") if text.startswith("-") else f"-{text.removeprefix('+')}"


def _read_as(segment: Segment, path: Path) -> Iterator[str]:
    space = next(f for f in (segment.frame("A"), segment.frame("B")) if not f.startswith(_BODY))
    yield f"t counts from START_TIME = {cut(segment.metadata['START_TIME'])}"
    yield f"{cut(space)} is taken for the space axes of the scene"


# Quaternions, scalar first.


def _product(a: Row, b: Row) -> tuple[Value, ...]:
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


def _conjugate(q: Row) -> tuple[Value, ...]:
    return q[0], -q[1], -q[2], -q[3]


def _of_derivative(q: Row, dot: Row) -> list[Value]:
    """omega of q' = q (0, omega) / 2."""
    return [2 * entry for entry in _divided(_product(_conjugate(q), dot)[1:], q)]


def _in_body(q: Row, v: Row) -> list[Value]:
    """A vector of space axes in body axes."""
    return _divided(_product(_product(_conjugate(q), (Fraction(0), *v)), q)[1:], q)


def _divided(vector: Row, q: Row) -> list[Value]:
    square = sum(entry * entry for entry in q)
    return [entry / square if square else nan for entry in vector]


@cache
def _degree() -> Fraction:
    """pi / 180, rounded to 400 bits."""
    with mp.workprec(_BITS):
        return Fraction(*map(int, (mp.pi / 180).as_integer_ratio()))
