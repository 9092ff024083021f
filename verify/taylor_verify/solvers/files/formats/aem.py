"""The attitude in a CCSDS AEM (504.0-B), every number exactly as written.

The quaternion of a message is e sin(phi/2), cos(phi/2), of the rotation by which the axes of REF_FRAME_A
become those of REF_FRAME_B: it takes components in B to components in A. One of the frames has to be that
of the body, SC_BODY. Where it is B, the quaternion is ours, body to space; where it is A, its conjugate
is. ATTITUDE_DIR = B2A, of version 1 alone, means the inverse. ANGVEL is the angular velocity of B with
respect to A in degrees a second, resolved in ANGVEL_FRAME. The axis of a spin is the third one of the body.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from decimal import Context, Decimal, Inexact, InvalidOperation
from fractions import Fraction
from math import nan
from pathlib import Path
from typing import Any, Final

from taylor_verify.models.algebra import apply, transpose
from taylor_verify.models.frame import rotation
from taylor_verify.numbers.rotation import conjugate, product
from taylor_verify.records.faults import Faults, Refused, cut, refusal
from taylor_verify.solvers.files.columns.column_units import DEGREE
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.formats.ccsds import Segment, is_turning, segment
from taylor_verify.solvers.files.formats.column import Column, Table
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.values import Value, exact

_QUATERNION: Final = ("Q1", "Q2", "Q3", "QC")
_ANGLES: Final = ("ANGLE_1", "ANGLE_2", "ANGLE_3")
_SPIN: Final = ("SPIN_ALPHA", "SPIN_DELTA", "SPIN_ANGLE", "SPIN_ANGLE_VEL")
_ANGULAR_VELOCITY: Final = ("ANGVEL_X", "ANGVEL_Y", "ANGVEL_Z")
# Of version 1: it does not say if they are an angular velocity, or rates of angles.
_RATE: Final = ("X_RATE", "Y_RATE", "Z_RATE")
# What a state holds, in the order of QUATERNION_TYPE = LAST.
_STATES: Final[Mapping[str, tuple[str, ...]]] = {
    "QUATERNION": _QUATERNION,
    "QUATERNION/DERIVATIVE": (*_QUATERNION, *(f"{name}_DOT" for name in _QUATERNION)),
    "QUATERNION/RATE": _QUATERNION + _RATE,
    "QUATERNION/ANGVEL": _QUATERNION + _ANGULAR_VELOCITY,
    "EULER_ANGLE": _ANGLES,
    "EULER_ANGLE/DERIVATIVE": (*_ANGLES, *(f"{name}_DOT" for name in _ANGLES)),
    "EULER_ANGLE/RATE": _ANGLES + _RATE,
    "EULER_ANGLE/ANGVEL": _ANGLES + _ANGULAR_VELOCITY,
    "SPIN": _SPIN,
    "SPIN/NUTATION": (*_SPIN, "NUTATION", "NUTATION_PER", "NUTATION_PHASE"),
    "SPIN/NUTATION_MOM": (*_SPIN, "MOMENTUM_ALPHA", "MOMENTUM_DELTA", "NUTATION_VEL"),
}
_REQUIRED: Final = ("REF_FRAME_A", "REF_FRAME_B", "TIME_SYSTEM", "START_TIME", "ATTITUDE_TYPE")
_BODY: Final = "SC_BODY"
_AXES: Final = str.maketrans("123", "xyz")
# The scalar of ours comes first, that of a message last.
_SCALAR_FIRST: Final = (3, 0, 1, 2)
_UNIT_VECTORS: Final = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
# An angle has no more than a hundred digits.
_EXACTLY: Final = Context(prec=100, traps=[InvalidOperation, Inexact])

Row = Sequence[Any]


def read(file: Content, path: Path, part: str) -> Table:
    """Return t, the attitude and, where the message has it, w1 w2 w3; ``part`` numbers a segment."""
    read, faults = segment(file, path, part, "aem", _names), Faults()
    reverse = _check_frames(read, path)
    columns = [Column("t", read.times(path, faults))]
    if _is_of(read, "SPIN"):
        columns += _spin_columns(read, reverse, path)
    elif _is_of(read, "EULER_ANGLE"):
        axes, angles = _sequence(read, reverse, path), _in_turn(read, _ANGLES, reverse)
        columns += _euler_columns(axes, angles)
    else:
        columns += _quaternion_columns(read, reverse)
    rates, note = _angular_velocities(read, reverse, path, faults)
    if faults.lines:
        raise Refused(faults.lines)
    space = next(f for f in (_frame(read, "A"), _frame(read, "B")) if not f.startswith(_BODY))
    return Table([*columns, *rates], (*read.notes(space), *filter(None, [note])))


def _kind(read: Segment) -> str:
    return read.metadata["ATTITUDE_TYPE"].upper()


def _is_of(read: Segment, kind: str) -> bool:
    return _kind(read).partition("/")[0] == kind


def _frame(read: Segment, letter: str) -> str:
    return read.metadata[f"REF_FRAME_{letter}"].upper()


def _names(read: Segment, width: int, place: str) -> Sequence[str]:
    """Return what a state holds, in the order of a line; the scalar is last unless version 1 says first."""
    read.require(_REQUIRED, place)
    if _kind(read) not in _STATES:
        expected = f"an ATTITUDE_TYPE of {', '.join(_STATES)}"
        raise refusal(expected, cut(_kind(read)), place, "write QUATERNION or QUATERNION/ANGVEL")
    names: Sequence[str] = ("EPOCH", *_STATES[_kind(read)])
    is_of_1 = read.version.startswith("1")
    if _is_of(read, "EULER_ANGLE") and is_of_1 and read.metadata.get("EULER_ROT_SEQ") != "123":
        # It names the angles by their axes, and programs write them in turn.
        expected = "Euler angles of version 2, or EULER_ROT_SEQ = 123"
        raise refusal(expected, f"version {cut(read.version)}", place, "write quaternions")
    if width and _is_of(read, "QUATERNION"):
        names = _in_order(
            names, read.metadata.get("QUATERNION_TYPE", "" if is_of_1 else "LAST"), place
        )
    if width not in (0, len(names)):
        raise refusal(" ".join(names), f"{width} values", place)
    return [name for name in names if width or name not in _RATE]


def _in_order(names: Sequence[str], stated: str, place: str) -> Sequence[str]:
    """Return names of numbers with the scalars where QUATERNION_TYPE says."""
    if stated.upper() not in ("FIRST", "LAST"):
        raise refusal("QUATERNION_TYPE = FIRST or LAST", cut(stated or "none"), place)
    if stated.upper() == "LAST":
        return names
    ordered = list(names)
    for k in (1, 5) if "QC_DOT" in names else (1,):
        ordered.insert(k, ordered.pop(k + 3))
    return ordered


def _check_frames(read: Segment, path: Path) -> bool:
    """Return True if the quaternion takes components in space to components in the body."""
    a, b = _frame(read, "A"), _frame(read, "B")
    if a.startswith(_BODY) is b.startswith(_BODY):
        expected = f"{_BODY} as one of REF_FRAME_A and REF_FRAME_B"
        raise refusal(
            expected, f"{cut(a)} and {cut(b)}", path, "a scene's axes are those of the body"
        )
    space = b if a.startswith(_BODY) else a
    if is_turning(space):
        raise refusal(f"an inertial frame beside {_BODY}", cut(space), path)
    direction = read.metadata.get("ATTITUDE_DIR", "A2B").upper()
    if direction not in ("A2B", "B2A"):
        raise refusal("ATTITUDE_DIR = A2B or B2A", cut(direction), path)
    return a.startswith(_BODY) is not (direction == "B2A")


# The attitude, as text, so that the number of printed digits is known.


def _quaternion_columns(read: Segment, reverse: bool) -> Iterator[Column]:
    for i, place in enumerate(_SCALAR_FIRST):
        texts = read.columns[_QUATERNION[place]]
        yield Column(f"q{i}", [_negative(t) for t in texts] if reverse and i else texts)


def _sequence(read: Segment, reverse: bool, path: Path) -> str:
    """Return the axes of the turns from the space axes to those of the body, as `zyx`."""
    stated = read.metadata.get("EULER_ROT_SEQ", "none")
    axes = stated.lower().translate(_AXES)
    if axes not in FORMS or len(axes) != len(_ANGLES):
        raise refusal("EULER_ROT_SEQ like ZYX", cut(stated), path)
    return axes[::-1] if reverse else axes


def _in_turn(read: Segment, names: Sequence[str], reverse: bool) -> list[list[str]]:
    """Return angles, or their rates, in the order of the turns from space to body."""
    texts = [read.columns[name] for name in names]
    if not reverse:
        return texts
    return [[_negative(text) for text in each] for each in reversed(texts)]


def _euler_columns(axes: str, texts: Sequence[Sequence[str]]) -> list[Column]:
    return [Column(f"euler_{axes}_{k} [deg]", each) for k, each in enumerate(texts, start=1)]


def _spin_columns(read: Segment, reverse: bool, path: Path) -> list[Column]:
    """Return turns about z, x, z; the third axis has right ascension SPIN_ALPHA, declination SPIN_DELTA."""
    if reverse:
        got = f"{_BODY} as REF_FRAME_A, or ATTITUDE_DIR = B2A"
        raise refusal(f"{_BODY} as REF_FRAME_B of {_kind(read)}", got, path)
    alpha, delta, angle, _ = (read.columns[name] for name in _SPIN)
    first = [_plus_quarter(text) for text in alpha]
    second = [_plus_quarter(_negative(text)) for text in delta]
    return _euler_columns("zxz", [first, second, angle])


def _plus_quarter(text: str) -> str:
    """Return an angle and a quarter turn, in degrees; what has no such sum becomes no number."""
    try:
        return str(_EXACTLY.add(Decimal(text), 90))
    except (InvalidOperation, Inexact):
        return f"{text} + 90"


def _negative(text: str) -> str:
    return text.removeprefix("-") if text.startswith("-") else f"-{text.removeprefix('+')}"


# The angular velocity.


def _angular_velocities(
    read: Segment, reverse: bool, path: Path, faults: Faults
) -> tuple[list[Column], str]:
    """Return the angular velocity, where the message has one, and a note."""
    kind = _kind(read)
    if kind.endswith("/ANGVEL"):
        return _stated(read, path)
    if kind == "QUATERNION/DERIVATIVE":
        states, dots = (
            _rows([read.columns[name + end] for name in _QUATERNION], path, faults)
            for end in ("", "_DOT")
        )
        rows = [_of_quaternion(*row, reverse) for row in zip(states, dots, strict=False)]
        return _columns(rows), "w1 w2 w3 are twice conj(q) dq/dt, of Q1_DOT ... QC_DOT"
    if kind == "EULER_ANGLE/DERIVATIVE":
        axes = _sequence(read, reverse, path)
        angles, rates = (
            _rows(_in_turn(read, [name + end for name in _ANGLES], reverse), path, faults)
            for end in ("", "_DOT")
        )
        rows = [_of_angles(axes, *row) for row in zip(angles, rates, strict=False)]
        return _columns(rows), "w1 w2 w3 are those of the angles and of ANGLE_1_DOT ..."
    if _is_of(read, "SPIN"):
        return _of_spin(read)
    if not kind.endswith("/RATE"):
        return [], ""
    why = "version 1 does not say if they are an angular velocity or rates of angles"
    return [], f"{' '.join(_RATE)} of {kind} are not read: {why}"


def _stated(read: Segment, path: Path) -> tuple[list[Column], str]:
    stated = read.metadata.get("ANGVEL_FRAME", "").upper()
    frames = {"REF_FRAME_A": _frame(read, "A"), "REF_FRAME_B": _frame(read, "B")}
    frame = frames.get(stated, stated)
    if frame not in frames.values():
        raise refusal(f"ANGVEL_FRAME = {' or '.join(frames.values())}", cut(frame) or "none", path)
    stem = "w" if frame.startswith(_BODY) else "omega_space_"
    # ANGVEL is that of B relative to A.
    is_reversed = _frame(read, "A").startswith(_BODY)
    columns = []
    for k, key in enumerate(_ANGULAR_VELOCITY, start=1):
        texts = read.columns[key]
        values = [_negative(text) for text in texts] if is_reversed else texts
        columns.append(Column(f"{stem}{k} [deg/s]", values))
    return columns, f"the angular velocity is ANGVEL in {stated}, degrees a second"


def _of_spin(read: Segment) -> tuple[list[Column], str]:
    """Return the rate about an axis that stays where it is; about one that moves there are other rates."""
    *axis, _, rate = (read.columns[name] for name in _SPIN)
    left = ", ".join(("SPIN_ANGLE_VEL", *_STATES[_kind(read)][len(_SPIN) :]))
    if any(len(set(texts)) > 1 for texts in axis):
        return [], f"{left} are not read: the axis of the spin moves, and w1 w2 are not in the file"
    zeros = ["0"] * len(rate)
    columns = [
        Column(f"w{k} [deg/s]", each) for k, each in enumerate((zeros, zeros, rate), start=1)
    ]
    return columns, "w3 is SPIN_ANGLE_VEL, and w1 w2 are 0: the axis of the spin stands still"


def _rows(texts: Sequence[Sequence[str]], path: Path, faults: Faults) -> list[Row]:
    """Return the numbers by rows up to the first fault."""
    rows: list[Row] = []
    for row in zip(*texts, strict=True):
        try:
            rows.append([exact(text) for text in row])
        except ValueError as error:
            faults.add(str(error), cut(" ".join(row)), f"{path}, state {len(rows) + 1}")
            break
    return rows


def _columns(rows: Sequence[Row]) -> list[Column]:
    return [Column(f"w{k}", [row[k - 1] for row in rows]) for k in (1, 2, 3)]


def _of_quaternion(q: Row, derivative: Row, reverse: bool) -> Row:
    """Return w of q' = q (0, w) / 2, body to space."""
    signs = (1, *[-1 if reverse else 1] * 3)
    ours, dots = (
        [sign * row[i] for sign, i in zip(signs, _SCALAR_FIRST, strict=True)]
        for row in (q, derivative)
    )
    square = sum(entry * entry for entry in q)
    turning = product(conjugate(ours), dots)[1:]
    return [2 * part / square if square else nan for part in turning]


def _of_angles(axes: str, angles: Row, rates: Row) -> Row:
    """Return the sum of the rates about their axes, each turned back by the turns that follow it."""
    numbers = [*angles, *rates]
    if not all(isinstance(number, Fraction) for number in numbers):
        return [nan] * 3
    omega: list[Value] = [Fraction(0)] * 3
    for k, (axis, rate) in enumerate(zip(axes, rates, strict=True)):
        later = [Fraction(0)] * (k + 1) + [angle * DEGREE for angle in angles[k + 1 :]]
        q = FORMS[axes].quaternion(later)
        square = sum(part * part for part in q)
        in_body = apply(transpose(rotation(q)), _UNIT_VECTORS["xyz".index(axis)])
        omega = [w + rate * DEGREE * s / square for w, s in zip(omega, in_body, strict=True)]
    return omega
