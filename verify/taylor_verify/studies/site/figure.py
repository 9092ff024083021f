"""A picture of the site: what Plotly draws, in plain data, and what it shows in words.

A picture has one drawing or a choice of several, of which one is seen at a time. Colours are names with
a dollar before them (`looks`), numbers are short: no eye sees the fourth digit of a point.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import log10
from typing import Any, Final

Trace = dict[str, Any]
Layout = dict[str, Any]

# Heights that the style sheet knows: a graph, a wide one, a body in space.
GRAPH, WIDE, SPACE = "graph", "wide", "space"

_DIGITS: Final = 4


@dataclass(frozen=True)
class Drawing:
    """One of the choices: its name, Plotly's traces, and what of the layout is its own."""

    label: str
    traces: Sequence[Trace]
    layout: Layout = field(default_factory=dict)


@dataclass(frozen=True)
class Figure:
    """A picture with its ``name`` on the page, a heading, a caption and a text in its stead.

    ``columns`` are what several traces share, numbers or a ``base`` of their own keys: a trace has
    ``@name`` in its place.
    ``units`` are the roundoffs by which a trace, named by its legend group, can be divided.
    ``shape`` is one of the heights of the style sheet; ``asks`` is what the choices are called,
    ``first`` the one that is seen first;
    ``lines`` named ones on the vertical axis ask for a height of their own;
    ``fallback`` the SVG file, from the top of the site, that is shown without a script.
    """

    name: str
    title: str
    caption: str
    alt: str
    drawings: Sequence[Drawing]
    layout: Layout = field(default_factory=dict)
    columns: dict[str, Any] = field(default_factory=dict)
    units: dict[str, float] = field(default_factory=dict)
    shape: str = GRAPH
    asks: str = "show"
    first: int = 0
    lines: int = 0
    fallback: str | None = None

    @property
    def choices(self) -> list[str]:
        """The names of the drawings where there is something to choose."""
        return [one.label for one in self.drawings] if len(self.drawings) > 1 else []

    def json(self) -> str:
        """The data as they stand in the page, in a script element that no text of theirs can end."""
        document = {
            "layout": self.layout,
            "columns": _shared(self.columns),
            "units": self.units,
            "drawings": [{"data": list(one.traces), "layout": one.layout} for one in self.drawings],
        }
        text = json.dumps(document, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
        return text.replace("<", "\\u003c")


def _shared(columns: Mapping[str, Any]) -> dict[str, Any]:
    """Of equal columns the first has what they are, and the others its name."""
    found: dict[str, Any] = {}
    for name, numbers in columns.items():
        found[name] = next((f"@{one}" for one in found if found[one] == numbers), numbers)
    return found


def short(value: float | None, digits: int = _DIGITS) -> float | None:
    """A number with so many digits; None for one that no axis has a place for."""
    if value is None or not math.isfinite(value):
        return None
    found = float(f"{value:.{digits - 1}e}")
    return int(found) if found == int(found) and abs(found) < 1e6 else found


def column(values: Iterable[float | None], digits: int = _DIGITS) -> list[float | None]:
    return [short(value, digits) for value in values]


def on_log(values: Iterable[float | None], digits: int = 3) -> list[float | None]:
    """Numbers for a logarithmic axis: what is not above zero has no place there."""
    return [short(value, digits) if value is not None and value > 0 else None for value in values]


def decades(values: Iterable[float | None]) -> dict[str, list[int | None]]:
    """Numbers for a logarithmic axis as hundredths of a decade, which the script takes back."""
    found = (value if value is not None and value > 0 else None for value in values)
    return {"decades": [None if value is None else round(100 * log10(value)) for value in found]}


def log_axis(title: str, **more: Any) -> Layout:
    return {"type": "log", "title": {"text": title}, **more}


def axis(title: str, **more: Any) -> Layout:
    return {"title": {"text": title}, **more}


def components(rows: Sequence[Sequence[float]]) -> list[list[float | None]]:
    """Rows of three as three columns."""
    return [column(row[i] for row in rows) for i in range(3)]


def merged(*parts: Mapping[str, Any]) -> dict[str, Any]:
    """One mapping of all, the later ones before the earlier."""
    return {name: value for part in parts for name, value in part.items()}
