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
from math import nan
from pathlib import Path
from typing import Final, TypeVar

from taylor_verify.models.algebra import apply, dot, transpose
from taylor_verify.models.frame import attitude_rate, rotation
from taylor_verify.records.faults import Faults, Refused, cut, refusal
from taylor_verify.solvers.files.columns.units import DEGREE
from taylor_verify.solvers.files.formats.aem_euler import (
    angle_columns,
    negative,
    quaternion,
    sequence,
)
from taylor_verify.solvers.files.formats.aem_segment import (
    ANGLES,
    ANGULAR_VELOCITY,
    DERIVATIVE,
    QUATERNION,
    Segment,
    in_text,
    in_xml,
)
from taylor_verify.solvers.files.formats.column import Column, Table, alike, shown
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.epochs import seconds
from taylor_verify.solvers.values import Value, exact

_BODY: Final = "SC_BODY"
# Frames that turn with the earth or with an orbit: equations of motion have other terms in them.
_TURNING: Final = (
    *(
        "ITRF",
        "DTRF",
        "EFG",
        "WGS",
        "GTOD",
        "TDR",
        "GRC",
        "LVLH",
        "VVLH",
        "RTN",
        "RSW",
        "RIC",
        "QSW",
    ),
    *("TNW", "NTW", "VNC", "SEZ", "NSW"),
)
_NOT_UNIFORM: Final = ("UT1", "GMST", "SCLK", "MET", "MRT")
_BLANK: Final = b"\xef\xbb\xbf \t\r\n"
# The scalar of ours comes first, that of a message last.
_SCALAR_FIRST: Final = (3, 0, 1, 2)
_UNIT_VECTORS: Final = ((1, 0, 0), (0, 1, 0), (0, 0, 1))

Row = Sequence[Value]
Kind = TypeVar("Kind")


def is_one(file: Content) -> bool:
    """Return True for a file that begins like a CCSDS message in text, whatever its name."""
    return _beginning(file).startswith(b"CCSDS_")


def is_turning(frame: str) -> bool:
    """Return True for a frame that turns with the earth or with an orbit."""
    return frame.upper().startswith(_TURNING) and not frame.upper().endswith("_INERTIAL")


def _beginning(file: Content) -> bytes:
    return file.beginning(64).lstrip(_BLANK)


def read(file: Content, path: Path, part: str) -> Table:
    """Return t, q0 ... q3 and, where the message has it, w1 w2 w3; ``part`` is the number of a segment."""
    is_xml = _beginning(file).startswith(b"<")
    segment = chosen(in_xml(file, path) if is_xml else in_text(file, path), part, path)
    reverse = _check_frames(segment, path)
    faults = Faults()
    times = _times(segment, path, faults)
    states = list(_rows(segment, ANGLES if segment.is_of_angles else QUATERNION, path, faults))
    rates = [
        rate
        for names in (ANGULAR_VELOCITY, DERIVATIVE)
        if names[0] in segment.columns
        for rate in _rows(segment, names, path, faults)
    ]
    if faults.lines:
        raise Refused(faults.lines)
    if segment.is_of_angles:
        axes = sequence(segment, path)
        turned = [quaternion(axes, angles, reverse) for angles in states]
        columns = [Column("t", times), *angle_columns(segment, reverse, path)]
    else:
        turned = [_body_to_space(q, reverse) for q in states]
        columns = [Column("t", times), *_quaternion_columns(segment, reverse)]
    velocities, note = _angular_velocities(segment, reverse, turned, rates, path)
    columns += [
        Column(f"w{i}", list(values))
        for i, values in enumerate(zip(*velocities, strict=True), start=1)
    ]
    space = next(f for f in (segment.frame("A"), segment.frame("B")) if not f.startswith(_BODY))
    notes = (
        f"t counts from START_TIME = {cut(segment.metadata['START_TIME'])}",
        f"{cut(space)} is taken for the space axes of the scene",
    )
    return Table(columns, (*notes, note) if note else notes)


def chosen(segments: Sequence[Kind], part: str, path: Path) -> Kind:
    """Return the segment of this number, or the only one."""
    last = len(segments)
    if not segments:
        raise refusal("a segment with states", "none", path)
    if not part and last > 1:
        raise refusal("one segment", last, path, f"name one: FILE#1 ... FILE#{last}")
    if part and part not in map(str, range(1, last + 1)):
        raise refusal(f"a segment from 1 to {last}", f"`#{cut(part)}`", path)
    return segments[int(part or 1) - 1]


def _check_frames(segment: Segment, path: Path) -> bool:
    """Return True if the quaternion takes components in space to components in the body."""
    a, b = segment.frame("A"), segment.frame("B")
    if a.startswith(_BODY) is b.startswith(_BODY):
        expected = f"{_BODY} as one of REF_FRAME_A and REF_FRAME_B"
        raise refusal(
            expected, f"{cut(a)} and {cut(b)}", path, "a scene's axes are those of the body"
        )
    space = b if a.startswith(_BODY) else a
    if is_turning(space):
        raise refusal(f"an inertial frame beside {_BODY}", cut(space), path)
    direction = segment.metadata.get("ATTITUDE_DIR", "A2B").upper()
    if direction not in ("A2B", "B2A"):
        raise refusal("ATTITUDE_DIR = A2B or B2A", cut(direction), path)
    return a.startswith(_BODY) is not (direction == "B2A")


# The numbers of a segment, exactly; what is none is a fault, and a NaN in its place.


def _times(segment: Segment, path: Path, faults: Faults) -> list[Fraction]:
    """Return the seconds since START_TIME."""
    is_utc = check_clock(segment.metadata["TIME_SYSTEM"], path)
    start = segment.metadata["START_TIME"]
    try:
        zero = seconds(start, is_utc)
    except ValueError as error:
        zero = Fraction(0)
        faults.add(str(error), cut(start), f"{path}, START_TIME")
    epochs = _numbers(segment, "EPOCH", lambda text: seconds(text, is_utc), path, faults)
    return [Fraction(epoch) - zero for epoch in epochs if isinstance(epoch, Fraction)]


def check_clock(system: str, path: Path) -> bool:
    """Return True for UTC, which has leap seconds; refuse a TIME_SYSTEM that is not uniform."""
    if system.upper() in _NOT_UNIFORM:
        raise refusal("a TIME_SYSTEM like UTC, TAI or TT", cut(system), path)
    return system.upper() == "UTC"


def _rows(segment: Segment, names: Sequence[str], path: Path, faults: Faults) -> Iterator[Row]:
    return zip(*(list(_numbers(segment, n, exact, path, faults)) for n in names), strict=True)


def _numbers(
    segment: Segment, name: str, value: Callable[[str], Value], path: Path, faults: Faults
) -> Iterator[Value]:
    with alike(faults, f"{path}, {name}") as wrong:
        for row, text in enumerate(segment.columns.get(name, ()), start=1):
            try:
                yield value(text)
            except ValueError as error:
                wrong(str(error), shown(text), f"{path}, state {row}, {name}")
                yield nan


# What the numbers mean.


def _body_to_space(q: Row, reverse: bool) -> Row:
    """Return the quaternion with its scalar first."""
    scalar, *vector = (q[i] for i in _SCALAR_FIRST)
    return (scalar, *(-entry for entry in vector)) if reverse else (scalar, *vector)


def _quaternion_columns(segment: Segment, reverse: bool) -> Iterator[Column]:
    """Yield q0 ... q3 as text, so that the number of printed digits is known."""
    for i, place in enumerate(_SCALAR_FIRST):
        texts = segment.columns[QUATERNION[place]]
        yield Column(f"q{i}", [negative(t) for t in texts] if reverse and i else texts)


def _angular_velocities(
    segment: Segment, reverse: bool, turned: Sequence[Row], rates: Sequence[Row], path: Path
) -> tuple[list[Row], str]:
    """Return w1 w2 w3 in body axes and radians a second, where the message has them, and a note."""
    if segment.kind == "QUATERNION/RATE":
        return [], "X_RATE Y_RATE Z_RATE are rates of Euler angles, and are not read"
    if segment.kind == "QUATERNION/DERIVATIVE":
        dots = [_body_to_space(rate, reverse) for rate in rates]
        velocities = [_of_derivative(q, dot) for q, dot in zip(turned, dots, strict=True)]
        return velocities, "w1 w2 w3 are twice conj(q) dq/dt, of Q1_DOT ... QC_DOT"
    if segment.kind in ("EULER_ANGLE/DERIVATIVE", "EULER_ANGLE/RATE"):
        return [], "rates of Euler angles are not read"
    if not segment.kind.endswith("/ANGVEL"):
        return [], ""
    stated = segment.metadata.get("ANGVEL_FRAME", "").upper()
    frames = {"REF_FRAME_A": segment.frame("A"), "REF_FRAME_B": segment.frame("B")}
    frame = frames.get(stated, stated)
    if frame not in frames.values():
        raise refusal(f"ANGVEL_FRAME = {' or '.join(frames.values())}", cut(frame) or "none", path)
    sign = -1 if segment.frame("A").startswith(_BODY) else 1
    velocities = [[sign * DEGREE * v for v in rate] for rate in rates]
    if not frame.startswith(_BODY):
        velocities = [_in_body(q, v) for q, v in zip(turned, velocities, strict=True)]
    return velocities, f"w1 w2 w3 are ANGVEL in {stated}, degrees a second"


def _of_derivative(q: Row, derivative: Row) -> Row:
    """Return w of q' = q (0, w) / 2: q' is linear in w, with columns orthogonal and |q|/2 long."""
    columns = (attitude_rate(q, unit) for unit in _UNIT_VECTORS)
    return _divided([4 * dot(column, derivative) for column in columns], q)


def _in_body(q: Row, v: Row) -> Row:
    """Return a vector of space axes in body axes."""
    return _divided(apply(transpose(rotation(q)), v), q)


def _divided(vector: Row, q: Row) -> Row:
    square = sum(entry * entry for entry in q)
    return [entry / square if square else nan for entry in vector]
