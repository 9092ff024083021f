"""A segment of a CCSDS AEM: its metadata and its states, as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from taylor_verify.scenes.reading.faults import Refused, cut
from taylor_verify.solvers.files.formats.column import ROWS

QUATERNION: Final = ("Q1", "Q2", "Q3", "QC")
DERIVATIVE: Final = ("Q1_DOT", "Q2_DOT", "Q3_DOT", "QC_DOT")
ANGULAR_VELOCITY: Final = ("ANGVEL_X", "ANGVEL_Y", "ANGVEL_Z")
# What a state holds, in the order of QUATERNION_TYPE = LAST. X_RATE ... are rates of Euler angles.
_STATES: Final[Mapping[str, tuple[str, ...]]] = {
    "QUATERNION": QUATERNION,
    "QUATERNION/DERIVATIVE": QUATERNION + DERIVATIVE,
    "QUATERNION/RATE": (*QUATERNION, "X_RATE", "Y_RATE", "Z_RATE"),
    "QUATERNION/ANGVEL": QUATERNION + ANGULAR_VELOCITY,
}
_REQUIRED: Final = ("REF_FRAME_A", "REF_FRAME_B", "TIME_SYSTEM", "START_TIME", "ATTITUDE_TYPE")


@dataclass
class Segment:
    """``metadata`` by keyword; ``columns`` by the name of what a state holds, EPOCH among them."""

    metadata: Mapping[str, str]
    columns: dict[str, list[str]] = field(default_factory=dict)

    def add(self, names: Sequence[str], cells: Sequence[str], place: object) -> None:
        """Add a state; refuse one that has not as many numbers as its type."""
        if len(cells) != len(names):
            raise Refused([f"expected {' '.join(names)}, got {len(cells)} values @ {place}"])
        for name, cell in zip(names, cells, strict=True):
            self.columns.setdefault(name, []).append(cell)
        ROWS.check(len(self.columns["EPOCH"]), place)

    @property
    def kind(self) -> str:
        return self.metadata["ATTITUDE_TYPE"].upper()

    def frame(self, letter: str) -> str:
        return self.metadata[f"REF_FRAME_{letter}"].upper()


def begun(metadata: Mapping[str, str], place: object) -> Segment:
    """Return the segment with these metadata; refuse it if it says too little or is of another type."""
    missing = [name for name in _REQUIRED if name not in metadata]
    if missing:
        raise Refused([f"expected {', '.join(_REQUIRED)}, got no {', '.join(missing)} @ {place}"])
    segment = Segment(metadata)
    if segment.kind not in _STATES:
        raise Refused(
            [
                f"expected an ATTITUDE_TYPE of quaternions ({', '.join(_STATES)}), got "
                f"{cut(segment.kind)} @ {place} (write QUATERNION or QUATERNION/ANGVEL)"
            ]
        )
    return segment


def state_names(segment: Segment, version: str, place: object) -> tuple[str, ...]:
    """The order of the values in a line; version 1 says where the scalar stands, later it is last."""
    names = _STATES[segment.kind]
    default = "" if version.startswith("1") else "LAST"
    where = segment.metadata.get("QUATERNION_TYPE", default).upper()
    if where not in ("FIRST", "LAST"):
        got = where or "none"
        raise Refused([f"expected QUATERNION_TYPE = FIRST or LAST, got {cut(got)} @ {place}"])
    if where == "FIRST":
        names = ("QC", *QUATERNION[:3], *names[4:])
        if segment.kind == "QUATERNION/DERIVATIVE":
            names = (*names[:4], "QC_DOT", *DERIVATIVE[:3])
    return ("EPOCH", *names)
