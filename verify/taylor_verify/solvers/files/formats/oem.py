"""The position in a CCSDS OEM (502.0-B), as text (KVN) or XML, every number exactly as written.

A state is an epoch, a position in km and a velocity in km/s, in REF_FRAME. The position is that of the
body's origin in space; the velocity is in space axes, and is not read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Final

from taylor_verify.records.faults import cut, refusal
from taylor_verify.solvers.files.formats.aem import check_clock, chosen, is_turning
from taylor_verify.solvers.files.formats.aem_segment import Message, lines_of_message
from taylor_verify.solvers.files.formats.column import ROWS, Column, Table
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.epochs import seconds

_VERSION: Final = "CCSDS_OEM_VERS"
_BEGINNING: Final = 1024
_ROOT: Final = re.compile(rb"<(?:\w+:)?oem\b")
_STATE: Final = ("EPOCH", "X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT")
_REQUIRED: Final = ("REF_FRAME", "TIME_SYSTEM", "START_TIME")
# An epoch, a position, a velocity, and perhaps an acceleration.
_LENGTHS: Final = (7, 10)


@dataclass
class _Segment:
    """Metadata by keyword, and the cells of each state with its place."""

    metadata: dict[str, str] = field(default_factory=dict)
    states: list[tuple[str, list[str]]] = field(default_factory=list)


def is_one(file: Content) -> bool:
    """Return True for a file that begins like an orbit ephemeris, as text or XML."""
    start = file.beginning(_BEGINNING).lstrip(b"\xef\xbb\xbf \t\r\n")
    return start.startswith(_VERSION.encode()) or (
        start[:1] == b"<" and _ROOT.search(start) is not None
    )


def read(file: Content, path: Path, part: str) -> Table:
    """Return t and c1 c2 c3; ``part`` is the number of a segment."""
    is_xml = file.beginning(_BEGINNING).lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")
    segments = _in_xml(file, path) if is_xml else list(_segments(file, path))
    segment = chosen(segments, part, path)
    metadata = segment.metadata
    if missing := [name for name in _REQUIRED if name not in metadata]:
        raise refusal(", ".join(_REQUIRED), f"no {', '.join(missing)}", path)
    frame, start = metadata["REF_FRAME"], metadata["START_TIME"]
    if is_turning(frame):
        raise refusal("a REF_FRAME that does not turn", cut(frame), path)
    is_utc = check_clock(metadata["TIME_SYSTEM"], path)
    zero = _seconds(start, is_utc, f"{path}, START_TIME")
    times = [_seconds(cells[0], is_utc, place) - zero for place, cells in segment.states]
    columns = [Column("t", times)]
    for k in (1, 2, 3):
        columns.append(Column(f"c{k} [km]", [cells[k] for _, cells in segment.states]))
    notes = (
        f"t counts from START_TIME = {cut(start)}",
        f"{cut(frame)} is taken for the space axes of the scene",
        "the velocities are in space axes, and are not read",
    )
    return Table(columns, notes)


def _seconds(text: str, is_utc: bool, place: str) -> Fraction:
    try:
        return seconds(text, is_utc)
    except ValueError as error:
        raise refusal(str(error), cut(text), place) from None


def _segments(file: Content, path: Path) -> Iterator[_Segment]:
    """Yield the segments; covariances are passed over."""
    segment, block = _Segment(), ""
    for place, line in lines_of_message(file, path):
        word, equals, value = (part.strip() for part in line.partition("="))
        if word == "META_START":
            if segment.states:
                yield segment
            segment, block = _Segment(), "META"
        elif word in ("META_STOP", "COVARIANCE_STOP"):
            block = ""
        elif word == "COVARIANCE_START":
            block = "COVARIANCE"
        elif equals and block == "META":
            segment.metadata[word.upper()] = value
        elif block == "META":
            raise refusal("KEYWORD = value", repr(cut(line)), place)
        elif not equals and not block:
            cells = line.split()
            if len(cells) not in _LENGTHS:
                raise refusal(
                    "an epoch, X Y Z and X_DOT Y_DOT Z_DOT", f"{len(cells)} values", place
                )
            segment.states.append((place, cells))
            ROWS.check(len(segment.states), path)
    if block:
        raise refusal(f"{block}_STOP", "the end of the file", path)
    if segment.states:
        yield segment


def _in_xml(file: Content, path: Path) -> list[_Segment]:
    """Return the segments of a message in XML."""
    segments: list[_Segment] = []

    def begin(metadata: Mapping[str, str], place: str) -> None:
        del place
        segments.append(_Segment(dict(metadata)))

    def add(texts: Mapping[str, str], place: str) -> None:
        if missing := [name for name in _STATE if name not in texts]:
            raise refusal(" ".join(_STATE), f"no {missing[0]}", place)
        segments[-1].states.append((place, [texts[name] for name in _STATE]))
        ROWS.check(len(segments[-1].states), path)

    Message(path, "oem", "stateVector", begin, add).read(file.binary)
    return segments
