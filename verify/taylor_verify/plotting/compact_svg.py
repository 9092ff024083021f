"""Compact SVG of a picture, with a third of matplotlib's bytes and the same appearance.

Coordinates have two digits after the point, a hundredth of a point of print. A style that many marks share
is written once, as a class, and the family of fonts once for all. A line goes on from point to point. Names
are short, and groups and names without references are left out. The tool scour writes a style at every
mark, and makes maps of digits and time diagrams up to twice as large.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from decimal import Decimal
from itertools import pairwise
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
_FAMILY: Final = re.compile(r"font-family:[^;]*; ?")
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
    _shorten_names(root)
    _share_font(root)
    _share_styles(root)
    for element in root.iter():
        element.tail = "\n"
        if len(element):
            element.text = "\n"
    return _HEADING + ElementTree.tostring(root, encoding="unicode")


def _shorten_numbers(element: Element) -> None:
    for name in _COORDINATES:
        # A path with steps is short already.
        if name in element.attrib and not (name == "d" and "l" in element.attrib["d"]):
            text = _NUMBER.sub(_two_digits, element.attrib[name])
            element.attrib[name] = _path(text) if name == "d" else text
    if _NO_TURN.match(element.get("transform", "")):
        del element.attrib["transform"]


def _two_digits(number: re.Match[str]) -> str:
    text = f"{float(number[0]):.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _path(text: str) -> str:
    """Return the commands without blanks, and each line by its way from point to point."""
    parts, points = "", list[str]()
    for letter, numbers in _PATH.findall(text):
        if letter == "L" and points:
            points += numbers.split()
            continue
        parts += _line(points)
        points = numbers.split() if letter in ("M", "L") else []
        parts += letter + " ".join(points[:2] or numbers.split())
    return parts + _line(points)


def _line(points: Sequence[str]) -> str:
    """Return the commands from the first point on to all others; nothing for one point or none."""
    values = [Decimal(point) for point in points]
    steps = [
        _step(after - before)
        for xs in (values[::2], values[1::2])
        for before, after in pairwise(xs)
    ]
    half = len(steps) // 2
    ways = [step for both in zip(steps[:half], steps[half:], strict=True) for step in both]
    return "l" + " ".join(ways).replace(" -", "-") if ways else ""


def _step(way: Decimal) -> str:
    text = f"{way.normalize():f}"
    return re.sub(r"^(-?)0\.", r"\1.", text)


def _drop_unused_names(root: Element) -> None:
    texts = (text for one in root.iter() for text in (one.text or "", *one.attrib.values()))
    used = {name for text in texts for name in _REFERENCE.findall(text)}
    for element in root.iter():
        if element.get("id") not in used:
            element.attrib.pop("id", None)


def _shorten_names(root: Element) -> None:
    named = [element for element in root.iter() if "id" in element.attrib]
    names = {element.attrib["id"]: f"i{number}" for number, element in enumerate(named)}
    for element in named:
        element.set("id", names[element.attrib["id"]])

    def short(reference: re.Match[str]) -> str:
        return f"#{names.get(reference[1], reference[1])}"

    for element in root.iter():
        for key, value in element.attrib.items():
            element.set(key, _REFERENCE.sub(short, value))


def _unwrap_plain_groups(element: Element) -> None:
    """Replace each group without attributes by its contents."""
    for child in element:
        _unwrap_plain_groups(child)
    element[:] = [
        one
        for child in element
        for one in (child if child.tag == f"{{{_SVG}}}g" and not child.attrib else [child])
    ]


def _share_font(root: Element) -> None:
    """Say the family of fonts once, if all texts have the same."""
    sheet = next(root.iter(f"{{{_SVG}}}style"), None)
    styles = [element.attrib.get("style", "") for element in root.iter()]
    families = {match[0] for style in styles for match in _FAMILY.finditer(style)}
    if sheet is None or len(families) != 1:
        return
    for element in root.iter():
        if "style" in element.attrib:
            element.set("style", _FAMILY.sub("", element.attrib["style"]))
    sheet.text = f"{sheet.text or ''}\ntext{{{families.pop().strip('; ')}}}"


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
