"""The segments of an AEM as XML. No entity is declared in such a file, and none is expanded."""

from __future__ import annotations

from mmap import ACCESS_READ, mmap
from pathlib import Path
from typing import BinaryIO, Final
from xml.etree import ElementTree

from taylor_verify.scenes.reading.faults import Refused, cut
from taylor_verify.solvers.files.formats.aem_segment import Segment, begun, state_names

_ROOT: Final = "aem"


def segments(file: BinaryIO, path: Path) -> list[Segment]:
    """Return the segments in order, each state read and forgotten before the next one."""
    with mmap(file.fileno(), 0, access=ACCESS_READ) as content:
        if content.find(b"<!DOCTYPE") >= 0 or content.find(b"<!ENTITY") >= 0:
            raise Refused([f"expected XML without a DOCTYPE, got one @ {path}"])
    read: list[Segment] = []
    try:
        for event, element in ElementTree.iterparse(file, ("start", "end")):
            tag = _tag(element)
            if event == "start":
                _check_kind(tag, path)
            elif tag == "metadata":
                read.append(begun(_texts(element), f"{path}, segment {len(read) + 1}"))
            elif tag == "attitudeState":
                _add(read, element, path)
                element.clear()
    except ElementTree.ParseError as error:
        raise Refused([f"expected XML, got a fault in it: {error} @ {path}"]) from None
    return read


def _check_kind(tag: str, path: Path) -> None:
    if tag in (
        "apm",
        "acm",
        "oem",
        "opm",
        "omm",
        "ocm",
        "cdm",
        "tdm",
        "rdm",
        "robot",
        "sdf",
        "mujoco",
    ):
        raise Refused([f"expected an attitude ephemeris (<{_ROOT}>), got <{tag}> @ {path}"])


def _add(read: list[Segment], element: ElementTree.Element, path: Path) -> None:
    place = f"{path}, segment {len(read)}"
    if not read:
        raise Refused([f"expected metadata before the states, got none @ {path}"])
    segment, texts = read[-1], _texts(element)
    # The names of the elements tell where the scalar is.
    names = state_names(segment, "2.0", place)
    names = tuple(name for name in names if not name.endswith("_RATE"))
    missing = [name for name in names if name not in texts]
    if missing:
        row = len(segment.columns.get("EPOCH", ())) + 1
        raise Refused(
            [f"expected {' '.join(names)}, got no {cut(missing[0])} @ {place}, state {row}"]
        )
    segment.add(names, [texts[name] for name in names], place)


def _texts(element: ElementTree.Element) -> dict[str, str]:
    return {_tag(one): one.text.strip() for one in element.iter() if one.text and one.text.strip()}


def _tag(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2]
