"""The segments of an AEM as text, one `KEYWORD = value` in a line and blocks of data lines (KVN)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, Final

from taylor_verify.scenes.reading.faults import Refused, cut
from taylor_verify.scenes.reading.limit import Limit
from taylor_verify.solvers.files.formats.aem_segment import Segment, begun, state_names

_LINE: Final = Limit(4096, "characters in a line", "the standard allows 254")
VERSION: Final = "CCSDS_AEM_VERS"


def segments(file: BinaryIO, path: Path) -> list[Segment]:
    """Return the segments in order; refuse a line that is neither metadata nor a state."""
    version, metadata, read = "", dict[str, str](), list[Segment]()
    names: tuple[str, ...] = ()
    block = ""
    for place, line in _lines(file, path):
        word, equals, value = (part.strip() for part in line.partition("="))
        if word in ("META_START", "DATA_START"):
            block = word.removesuffix("_START")
            metadata = {} if block == "META" else metadata
            if block == "DATA":
                read.append(begun(metadata, place))
                names = state_names(read[-1], version, place)
        elif word in ("META_STOP", "DATA_STOP"):
            block = ""
        elif block == "DATA" and not equals:
            read[-1].add(names, line.split(), place)
        elif equals and block == "META":
            metadata[word.upper()] = value
        elif equals and word.startswith("CCSDS_"):
            version = _version(word, value, place)
        elif not equals or block == "DATA":
            raise Refused(
                [f"expected KEYWORD = value or a block of data, got {cut(line)!r} @ {place}"]
            )
    if block:
        raise Refused([f"expected {block}_STOP, got the end of the file @ {path}"])
    return read


def _version(word: str, value: str, place: object) -> str:
    if word != VERSION:
        raise Refused(
            [
                f"expected an attitude ephemeris ({VERSION}), got {cut(word)} @ {place} "
                "(no other message of the CCSDS is read)"
            ]
        )
    return value


def _lines(file: BinaryIO, path: Path) -> Iterator[tuple[str, str]]:
    """The lines with their places; blank lines and comments are left out."""
    number = 0
    while line := file.readline(_LINE.most + 1):
        number += 1
        place = f"{path}, line {number}"
        _LINE.check(len(line), place)
        try:
            text = line.decode("utf-8-sig").strip()
        except UnicodeDecodeError:
            raise Refused([f"expected text in UTF-8, got other bytes @ {place}"]) from None
        if text and text.split(maxsplit=1)[0] != "COMMENT":
            yield place, text
