"""The segments of a CCSDS AEM: metadata and states as they are written, in text (KVN) or in XML."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from taylor_verify.records.faults import cut, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.records.markup import Markup
from taylor_verify.solvers.files.formats.column import ELEMENTS, ROWS
from taylor_verify.solvers.files.formats.content import Content

QUATERNION: Final = ("Q1", "Q2", "Q3", "QC")
DERIVATIVE: Final = ("Q1_DOT", "Q2_DOT", "Q3_DOT", "QC_DOT")
ANGULAR_VELOCITY: Final = ("ANGVEL_X", "ANGVEL_Y", "ANGVEL_Z")
ANGLES: Final = ("ANGLE_1", "ANGLE_2", "ANGLE_3")
# What a state holds, in the order of QUATERNION_TYPE = LAST. X_RATE ... are rates of Euler angles.
_STATES: Final[Mapping[str, tuple[str, ...]]] = {
    "QUATERNION": QUATERNION,
    "QUATERNION/DERIVATIVE": QUATERNION + DERIVATIVE,
    "QUATERNION/RATE": (*QUATERNION, "X_RATE", "Y_RATE", "Z_RATE"),
    "QUATERNION/ANGVEL": QUATERNION + ANGULAR_VELOCITY,
    "EULER_ANGLE": ANGLES,
    "EULER_ANGLE/DERIVATIVE": ANGLES + tuple(f"{name}_DOT" for name in ANGLES),
    "EULER_ANGLE/RATE": (*ANGLES, "X_RATE", "Y_RATE", "Z_RATE"),
    "EULER_ANGLE/ANGVEL": ANGLES + ANGULAR_VELOCITY,
}
_REQUIRED: Final = ("REF_FRAME_A", "REF_FRAME_B", "TIME_SYSTEM", "START_TIME", "ATTITUDE_TYPE")
_LINE: Final = Limit(4096, "characters in a line", "the standard allows 254")
_VERSION: Final = "CCSDS_AEM_VERS"
_METADATA: Final = "metadata"
# Roots of XML that is another document.
_OTHER: Final = "apm acm aem oem opm omm ocm cdm tdm rdm robot sdf mujoco"


@dataclass
class Segment:
    """``metadata`` by keyword; ``columns`` by the name of what a state holds, EPOCH among them."""

    metadata: Mapping[str, str]
    columns: dict[str, list[str]] = field(default_factory=dict)

    def check(self, place: object) -> None:
        """Refuse metadata that say too little, or are of another type."""
        if missing := [name for name in _REQUIRED if name not in self.metadata]:
            raise refusal(", ".join(_REQUIRED), f"no {', '.join(missing)}", place)
        if self.kind not in _STATES:
            expected = f"an ATTITUDE_TYPE of {', '.join(_STATES)}"
            raise refusal(expected, cut(self.kind), place, "write QUATERNION or QUATERNION/ANGVEL")

    def add(self, names: Sequence[str], cells: Sequence[str], place: object) -> None:
        """Add a state; refuse one that has not as many numbers as its type."""
        if len(cells) != len(names):
            raise refusal(" ".join(names), f"{len(cells)} values", place)
        for name, cell in zip(names, cells, strict=True):
            self.columns.setdefault(name, []).append(cell)
        ROWS.check(len(self.columns["EPOCH"]), place)

    @property
    def kind(self) -> str:
        return self.metadata["ATTITUDE_TYPE"].upper()

    @property
    def is_of_angles(self) -> bool:
        return self.kind.startswith("EULER_ANGLE")

    def _refuse_angles_by_axis(self, version: str, place: object) -> None:
        """Refuse angles of version 1: it names them by their axes, and programs write them in turn."""
        if version.startswith("1") and self.metadata.get("EULER_ROT_SEQ") != "123":
            expected = "Euler angles of version 2, or EULER_ROT_SEQ = 123"
            raise refusal(expected, f"version {cut(version)}", place, "write quaternions")

    def frame(self, letter: str) -> str:
        return self.metadata[f"REF_FRAME_{letter}"].upper()

    def state_names(self, version: str, place: object) -> tuple[str, ...]:
        """Return the order of the values in a line; the scalar is last, but where version 1 says so."""
        if self.is_of_angles:
            self._refuse_angles_by_axis(version, place)
            return ("EPOCH", *_STATES[self.kind])
        default = "" if version.startswith("1") else "LAST"
        where = self.metadata.get("QUATERNION_TYPE", default).upper()
        if where not in ("FIRST", "LAST"):
            raise refusal("QUATERNION_TYPE = FIRST or LAST", cut(where or "none"), place)
        names = _STATES[self.kind]
        if where == "FIRST":
            names = ("QC", *QUATERNION[:3], *names[4:])
            if self.kind == "QUATERNION/DERIVATIVE":
                names = (*names[:4], "QC_DOT", *DERIVATIVE[:3])
        return ("EPOCH", *names)


# Text: a `KEYWORD = value` in a line, and blocks of data lines.


def in_text(file: Content, path: Path) -> list[Segment]:
    """Return the segments in order; refuse a line that is neither metadata nor a state."""
    version, block, metadata = "", "", dict[str, str]()
    read, names = list[Segment](), tuple[str, ...]()
    for place, line in lines_of_message(file, path):
        word, equals, value = (part.strip() for part in line.partition("="))
        if word == "META_START":
            block, metadata = "META", {}
        elif word == "DATA_START":
            block = "DATA"
            read.append(Segment(metadata))
            read[-1].check(place)
            names = read[-1].state_names(version, place)
        elif word in ("META_STOP", "DATA_STOP"):
            block = ""
        elif block == "DATA" and not equals:
            read[-1].add(names, line.split(), place)
        elif equals and block == "META":
            metadata[word.upper()] = value
        elif equals and word.startswith("CCSDS_"):
            if word != _VERSION:
                expected = f"an attitude ephemeris ({_VERSION})"
                raise refusal(expected, cut(word), place, "no other message of the CCSDS is read")
            version = value
        elif not equals or block == "DATA":
            raise refusal("KEYWORD = value or a block of data", repr(cut(line)), place)
    if block:
        raise refusal(f"{block}_STOP", "the end of the file", path)
    return read


def lines_of_message(file: Content, path: Path) -> Iterator[tuple[str, str]]:
    """Yield the lines with their places; blank lines and comments are left out."""
    for number, line in enumerate(file.lines(_LINE), start=1):
        text = line.strip()
        if text and text.split(maxsplit=1)[0] != "COMMENT":
            yield f"{path}, line {number}", text


# XML.


def in_xml(file: Content, path: Path) -> list[Segment]:
    """Return the segments in order, each state read and forgotten before the next one."""
    segments: list[Segment] = []

    def begin(metadata: Mapping[str, str], place: str) -> None:
        segments.append(Segment(metadata))
        segments[-1].check(place)

    def add(texts: Mapping[str, str], place: str) -> None:
        _add(segments[-1], texts, place)

    Message(path, "aem", "attitudeState", begin, add).read(file.binary)
    return segments


Take = Callable[[Mapping[str, str], str], None]


class Message(Markup):
    """A message of the CCSDS: metadata and states are handed over where their elements end.

    ``root`` is the element of the message, ``state`` that of a state.
    """

    def __init__(self, path: Path, root: str, state: str, begin: Take, add: Take) -> None:
        super().__init__(path, ELEMENTS)
        self._root, self._state, self._take_metadata, self._take_state = root, state, begin, add
        self._segments = 0
        # The texts of the elements since the last one that was read, and that of the open element.
        self._texts: dict[str, str] = {}
        self._text = ""

    def begin(self, name: str, attributes: Mapping[str, str]) -> None:
        del attributes
        tag = _local(name)
        if tag in _OTHER.split() and tag != self._root:
            raise refusal("an attitude or orbit ephemeris (<aem>, <oem>)", f"<{tag}>", self.path)
        if tag in (_METADATA, self._state):
            self._texts = {}
        self._text = ""

    def text(self, text: str) -> None:
        self._text += text
        _LINE.check(len(self._text), self.place)

    def end(self, name: str) -> None:
        tag = _local(name)
        self._segments += tag == _METADATA
        place = f"{self.path}, segment {self._segments}"
        if tag == _METADATA:
            self._take_metadata(self._texts, place)
        elif tag == self._state and not self._segments:
            raise refusal("metadata before the states", "none", self.path)
        elif tag == self._state:
            self._take_state(self._texts, place)
        elif text := self._text.strip():
            self._texts[tag] = text
        self._text = ""


def _add(segment: Segment, texts: Mapping[str, str], place: str) -> None:
    # The names of the elements tell where the scalar is.
    names = [name for name in segment.state_names("2.0", place) if not name.endswith("_RATE")]
    if missing := [name for name in names if name not in texts]:
        row = len(segment.columns.get("EPOCH", ())) + 1
        raise refusal(" ".join(names), f"no {cut(missing[0])}", f"{place}, state {row}")
    segment.add(names, [texts[name] for name in names], place)


def _local(name: str) -> str:
    """Return the name of an element without its prefix."""
    return name.rpartition(":")[2]
