"""Segments of a message of the CCSDS, an AEM or an OEM: metadata and states as text (KVN) or XML has them.

In text a line is `KEYWORD = value`, or a state; those of an AEM stand in a block of data. In XML a state is
an element of named numbers. Covariances are passed over.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Final

from taylor_verify.records.faults import Faults, cut, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.records.markup import Markup
from taylor_verify.solvers.files.formats.column import ELEMENTS, ROWS, alike, shown
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.epochs import seconds

_LINE: Final = Limit(4096, "characters in a line", "the standard allows 254")
_BEGINNING: Final = 1024
_BLANK: Final = b"\xef\xbb\xbf \t\r\n"
_METADATA: Final = "metadata"
_STATES: Final[Mapping[str, str]] = {"aem": "attitudeState", "oem": "stateVector"}
# Roots of XML that is another document.
_OTHER: Final = "apm acm opm omm ocm cdm tdm rdm robot sdf mujoco"
_BLOCKS: Final = ("META", "DATA", "COVARIANCE")
# Frames that turn with the earth or with an orbit: equations of motion have other terms in them.
_TURNING: Final = (
    *("ITRF", "DTRF", "EFG", "WGS", "GTOD", "TDR", "GRC"),
    *("LVLH", "VVLH", "RTN", "RSW", "RIC", "QSW", "TNW", "NTW", "VNC", "SEZ", "NSW"),
)
_NOT_UNIFORM: Final = ("UT1", "GMST", "SCLK", "MET", "MRT")


@dataclass
class Segment:
    """``metadata`` by keyword; ``columns`` by the name of what a state holds, EPOCH among them.

    ``version`` is that of a message in text, and empty for XML, which names its numbers.
    """

    version: str = ""
    metadata: dict[str, str] = field(default_factory=dict)
    columns: dict[str, list[str]] = field(default_factory=dict)
    _orders: dict[int, Sequence[str]] = field(default_factory=dict)

    def order(self, names: Names, width: int, place: str) -> Sequence[str]:
        """Return the names of what a state of so many values holds, asked for once."""
        if width not in self._orders:
            self._orders[width] = names(self, width, place)
        return self._orders[width]

    def require(self, names: Sequence[str], place: object) -> None:
        """Refuse metadata that lack a keyword."""
        if missing := [name for name in names if name not in self.metadata]:
            raise refusal(", ".join(names), f"no {', '.join(missing)}", place)

    def add(self, names: Sequence[str], cells: Sequence[str], place: object) -> None:
        """Add a state."""
        for name, cell in zip(names, cells, strict=True):
            self.columns.setdefault(name, []).append(cell)
        ROWS.check(len(self.columns["EPOCH"]), place)

    # Times.

    def times(self, path: Path, faults: Faults) -> list[Fraction]:
        """Return the seconds since START_TIME."""
        system = self.metadata["TIME_SYSTEM"].upper()
        if system in _NOT_UNIFORM:
            raise refusal("a TIME_SYSTEM like UTC, TAI or TT", cut(system), path)
        start, is_utc = self.metadata["START_TIME"], system == "UTC"
        try:
            zero = seconds(start, is_utc)
        except ValueError as error:
            zero = Fraction(0)
            faults.add(str(error), cut(start), f"{path}, START_TIME")
        times: list[Fraction] = []
        with alike(faults, f"{path}, EPOCH") as wrong:
            for row, text in enumerate(self.columns["EPOCH"], start=1):
                try:
                    times.append(seconds(text, is_utc) - zero)
                except ValueError as error:
                    wrong(str(error), shown(text), f"{path}, state {row}, EPOCH")
        return times

    def notes(self, space: str) -> tuple[str, str]:
        """Return sentences on the zero of times and on the space axes."""
        return (
            f"t counts from START_TIME = {cut(self.metadata['START_TIME'])}",
            f"{cut(space)} is taken for the space axes of the scene",
        )


# The names of what a state holds, in the order of a line with so many values. It refuses other metadata.
Names = Callable[[Segment, int, str], Sequence[str]]


def kind(file: Content) -> str:
    """Return `aem` or `oem` for a file that begins like such a message; empty for any other."""
    start = file.beginning(_BEGINNING).lstrip(_BLANK)
    if start.startswith(b"CCSDS_"):
        return "oem" if start.startswith(b"CCSDS_OEM_VERS") else "aem"
    if not start.startswith(b"<"):
        return ""
    return next((r for r in _STATES if re.search(rb"<(?:\w+:)?%s\b" % r.encode(), start)), "")


def is_turning(frame: str) -> bool:
    """Return True for a frame that turns with the earth or with an orbit."""
    return frame.upper().startswith(_TURNING) and not frame.upper().endswith("_INERTIAL")


def segment(file: Content, path: Path, part: str, root: str, names: Names) -> Segment:
    """Return the segment of this number, or the only one, of a message of this kind."""
    if file.beginning(_BEGINNING).lstrip(_BLANK).startswith(b"<"):
        message = _Message(path, root, names)
        message.read(file.binary)
        segments = [each for each in message.segments if each.columns]
    else:
        segments = _in_text(file, path, root, names)
    last = len(segments)
    if not segments:
        raise refusal("a segment with states", "none", path)
    if not part and last > 1:
        raise refusal("one segment", last, path, f"name one: FILE#1 ... FILE#{last}")
    if part and part not in map(str, range(1, last + 1)):
        raise refusal(f"a segment from 1 to {last}", f"`#{cut(part)}`", path)
    return segments[int(part or 1) - 1]


# Text.


def _in_text(file: Content, path: Path, root: str, names: Names) -> list[Segment]:
    """Return the segments in order; refuse a line that is neither metadata nor a state."""
    keyword, read, block, version = f"CCSDS_{root.upper()}_VERS", list[Segment](), "", ""
    for place, line in _lines(file, path):
        word, equals, value = (part.strip() for part in line.partition("="))
        name, _, end = word.rpartition("_")
        if name in _BLOCKS and end in ("START", "STOP"):
            block = name if end == "START" else ""
            read += [Segment(version)] if (name, end) == ("META", "START") else []
        elif equals and block == "META":
            read[-1].metadata[word.upper()] = value
        elif word.startswith("CCSDS_") and equals and not block:
            if word != keyword:
                expected = f"an attitude ephemeris ({keyword})"
                raise refusal(expected, cut(word), place, "no other message of the CCSDS is read")
            version = value
            if not version.startswith(("1", "2")):
                raise refusal("version 1 or 2", cut(version), place)
        elif not equals and read and block == ("DATA" if root == "aem" else ""):
            cells = line.split()
            read[-1].add(read[-1].order(names, len(cells), place), cells, place)
        elif block != "COVARIANCE" and not (equals and not block):
            raise refusal("KEYWORD = value or a block of data", repr(cut(line)), place)
    if block:
        raise refusal(f"{block}_STOP", "the end of the file", path)
    if read and not version:
        raise refusal(f"{keyword} = 1.0 or 2.0", "no version", path)
    return [segment for segment in read if segment.columns]


def _lines(file: Content, path: Path) -> Iterator[tuple[str, str]]:
    """Yield the lines with their places; blank lines and comments are left out."""
    for number, line in enumerate(file.lines(_LINE), start=1):
        text = line.strip()
        if text and text.split(maxsplit=1)[0] != "COMMENT":
            yield f"{path}, line {number}", text


# XML.


class _Message(Markup):
    """A message in XML: each state is read where its element ends, and forgotten before the next one."""

    def __init__(self, path: Path, root: str, names: Names) -> None:
        super().__init__(path, ELEMENTS)
        self._state, self._names = _STATES[root], names
        self.segments: list[Segment] = []
        # The texts of the elements since the last one that was read, and that of the open element.
        self._texts: dict[str, str] = {}
        self._text = ""

    def begin(self, name: str, attributes: Mapping[str, str]) -> None:
        del attributes
        tag = _local(name)
        if tag in _OTHER.split():
            raise refusal("an attitude or orbit ephemeris (<aem>, <oem>)", f"<{tag}>", self.path)
        if tag in (_METADATA, self._state):
            self._texts = {}
        self._text = ""

    def text(self, text: str) -> None:
        self._text += text
        _LINE.check(len(self._text), self.place)

    def end(self, name: str) -> None:
        tag = _local(name)
        if tag == _METADATA:
            self.segments.append(Segment(metadata=self._texts))
        elif tag == self._state and not self.segments:
            raise refusal("metadata before the states", "none", self.path)
        elif tag == self._state:
            self._add(self.segments[-1])
        elif text := self._text.strip():
            self._texts[tag] = text
        self._text = ""

    def _add(self, segment: Segment) -> None:
        row = len(segment.columns.get("EPOCH", ())) + 1
        place = f"{self.path}, segment {len(self.segments)}, state {row}"
        names = segment.order(self._names, 0, place)
        if missing := [name for name in names if name not in self._texts]:
            raise refusal(" ".join(names), f"no {cut(missing[0])}", place)
        segment.add(names, [self._texts[name] for name in names], place)


def _local(name: str) -> str:
    """Return the name of an element without its prefix."""
    return name.rpartition(":")[2]
