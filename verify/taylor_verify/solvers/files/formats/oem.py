"""The motion of the origin in a CCSDS OEM (502.0-B), every number exactly as written.

A state is an epoch, a position in km, a velocity in km/s and perhaps an acceleration, all in REF_FRAME.
The position is that of the body's origin in space, and the velocity is the origin's, along space axes.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from taylor_verify.records.faults import Faults, Refused, cut, refusal
from taylor_verify.solvers.files.formats.ccsds import Segment, is_turning, segment
from taylor_verify.solvers.files.formats.column import Column, Table
from taylor_verify.solvers.files.formats.content import Content

_STATE: Final = ("EPOCH", "X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT")
_ACCELERATION: Final = ("X_DDOT", "Y_DDOT", "Z_DDOT")
_REQUIRED: Final = ("REF_FRAME", "TIME_SYSTEM", "START_TIME")


def read(file: Content, path: Path, part: str) -> Table:
    """Return t, c1 c2 c3 and the velocity in space axes; ``part`` is the number of a segment."""
    read, faults = segment(file, path, part, "oem", _names), Faults()
    frame = read.metadata["REF_FRAME"]
    if is_turning(frame):
        raise refusal("a REF_FRAME that does not turn", cut(frame), path)
    columns = [Column("t", read.times(path, faults))]
    for k, name in enumerate("XYZ", start=1):
        columns.append(Column(f"c{k} [km]", read.columns[name]))
        columns.append(Column(f"velocity_space_{k} [km/s]", read.columns[f"{name}_DOT"]))
    if faults.lines:
        raise Refused(faults.lines)
    return Table(columns, read.notes(frame))


def _names(read: Segment, width: int, place: str) -> Sequence[str]:
    read.require(_REQUIRED, place)
    names = (*_STATE, *_ACCELERATION) if width == len(_STATE + _ACCELERATION) else _STATE
    if width not in (0, len(names)):
        raise refusal("an epoch, X Y Z and X_DOT Y_DOT Z_DOT", f"{width} values", place)
    return names
