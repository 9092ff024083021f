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

from taylor_verify.models.algebra import dot
from taylor_verify.models.frame import attitude_rate
from taylor_verify.records.faults import Faults, Refused, cut, refusal
from taylor_verify.solvers.files.columns.forms import FORMS
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
_AXES: Final = str.maketrans("123", "xyz")
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
    columns = [Column("t", _times(segment, path, faults))]
    if segment.is_of_angles:
        columns += _angle_columns(segment, reverse, path)
    else:
        columns += _quaternion_columns(segment, reverse)
    rates, note = _angular_velocities(segment, reverse, path, faults)
    columns += rates
    if faults.lines:
        raise Refused(faults.lines)
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
    epochs = _numbers(segment, "EPOCH", path, faults, lambda text: seconds(text, is_utc))
    return [Fraction(epoch) - zero for epoch in epochs if isinstance(epoch, Fraction)]


def check_clock(system: str, path: Path) -> bool:
    """Return True for UTC, which has leap seconds; refuse a TIME_SYSTEM that is not uniform."""
    if system.upper() in _NOT_UNIFORM:
        raise refusal("a TIME_SYSTEM like UTC, TAI or TT", cut(system), path)
    return system.upper() == "UTC"


def _numbers(
    segment: Segment,
    name: str,
    path: Path,
    faults: Faults,
    value: Callable[[str], Value] = exact,
) -> Iterator[Value]:
    with alike(faults, f"{path}, {name}") as wrong:
        for row, text in enumerate(segment.columns.get(name, ()), start=1):
            try:
                yield value(text)
            except ValueError as error:
                wrong(str(error), shown(text), f"{path}, state {row}, {name}")
                yield nan


# What the numbers mean.


def _quaternion_columns(segment: Segment, reverse: bool) -> Iterator[Column]:
    """Yield q0 ... q3 as text, so that the number of printed digits is known."""
    for i, place in enumerate(_SCALAR_FIRST):
        texts = segment.columns[QUATERNION[place]]
        yield Column(f"q{i}", [_negative(t) for t in texts] if reverse and i else texts)


def _angular_velocities(
    segment: Segment, reverse: bool, path: Path, faults: Faults
) -> tuple[list[Column], str]:
    """Return the angular velocity, where the message has one, and a note."""
    if segment.kind == "QUATERNION/DERIVATIVE":
        states, rates = (
            [*zip(*(list(_numbers(segment, n, path, faults)) for n in names), strict=True)]
            for names in (QUATERNION, DERIVATIVE)
        )
        rows = [_of_derivative(q, dot, reverse) for q, dot in zip(states, rates, strict=True)]
        columns = [Column(f"w{i}", [row[i - 1] for row in rows]) for i in (1, 2, 3)]
        return columns, "w1 w2 w3 are twice conj(q) dq/dt, of Q1_DOT ... QC_DOT"
    if segment.kind.endswith(("/RATE", "/DERIVATIVE")):
        return [], "rates of Euler angles are not read"
    if not segment.kind.endswith("/ANGVEL"):
        return [], ""
    stated = segment.metadata.get("ANGVEL_FRAME", "").upper()
    frames = {"REF_FRAME_A": segment.frame("A"), "REF_FRAME_B": segment.frame("B")}
    frame = frames.get(stated, stated)
    if frame not in frames.values():
        raise refusal(f"ANGVEL_FRAME = {' or '.join(frames.values())}", cut(frame) or "none", path)
    stem = "w" if frame.startswith(_BODY) else "omega_space_"
    # ANGVEL is that of B relative to A.
    is_reversed = segment.frame("A").startswith(_BODY)
    columns = []
    for k, key in enumerate(ANGULAR_VELOCITY, start=1):
        texts = segment.columns[key]
        values = [_negative(text) for text in texts] if is_reversed else texts
        columns.append(Column(f"{stem}{k} [deg/s]", values))
    return columns, f"the angular velocity is ANGVEL in {stated}, degrees a second"


def _of_derivative(q: Row, derivative: Row, reverse: bool) -> Row:
    """Return w of q' = q (0, w) / 2, body to space: q' is linear in w, with columns |q|/2 long."""
    signs = (1, *[-1 if reverse else 1] * 3)
    ours, dots = (
        [sign * row[i] for sign, i in zip(signs, _SCALAR_FIRST, strict=True)]
        for row in (q, derivative)
    )
    square = sum(entry * entry for entry in q)
    columns = (attitude_rate(ours, unit) for unit in _UNIT_VECTORS)
    return [4 * dot(column, dots) / square if square else nan for column in columns]


# Euler angles: EULER_ROT_SEQ turns the axes of REF_FRAME_A into those of REF_FRAME_B.


def _sequence(segment: Segment, path: Path) -> str:
    """Return the sequence of axes, as `zyx`."""
    stated = segment.metadata.get("EULER_ROT_SEQ", "none")
    axes = stated.lower().translate(_AXES)
    if axes not in FORMS or len(axes) != len(ANGLES):
        raise refusal("EULER_ROT_SEQ like ZYX", cut(stated), path)
    return axes


def _angle_columns(segment: Segment, reverse: bool, path: Path) -> Iterator[Column]:
    """Yield the angles that turn the space axes into those of the body, in degrees, as text."""
    axes, texts = _sequence(segment, path), [segment.columns[name] for name in ANGLES]
    if reverse:
        axes, texts = axes[::-1], [[_negative(text) for text in each] for each in reversed(texts)]
    for k, each in enumerate(texts, start=1):
        yield Column(f"euler_{axes}_{k} [deg]", each)


def _negative(text: str) -> str:
    return text.removeprefix("-") if text.startswith("-") else f"-{text.removeprefix('+')}"
