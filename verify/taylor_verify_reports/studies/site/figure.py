"""Picture of a motion that can be turned: Plotly's data as HTML within a page.

A colour is a name after a dollar sign, which the page's script replaces by a colour of the style. Numbers
have few digits, because nobody sees more of a point.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from math import isfinite
from typing import Any

Trace = dict[str, Any]


@dataclass(frozen=True)
class Figure:
    """A picture in space: its ``name`` on the page, its alternative text and the titles of its axes.

    ``traces`` are Plotly's. ``box`` has the least and the greatest coordinate of each axis, and contains
    the whole drawing.
    """

    name: str
    title: str
    caption: str
    alt: str
    traces: Sequence[Trace]
    axes: Sequence[str]
    box: Sequence[tuple[float, float]]

    def html(self) -> str:
        """Return the figure as a block of HTML without empty lines, which would end it in Markdown."""
        box = [column(side) for side in self.box]
        document = {"traces": list(self.traces), "axes": list(self.axes), "box": box}
        text = json.dumps(document, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
        # No text of the data may end the script element.
        escaped = text.replace("<", "\\u003c")
        alt = escape(self.alt)
        return "\n".join(
            [
                f'<figure class="motion" id="{self.name}">',
                f'<div class="plot" role="img" aria-label="{alt}"></div>',
                f"<noscript><p>{alt}</p></noscript>",
                f"<figcaption><b>{escape(self.title)}.</b> {escape(self.caption)}</figcaption>",
                f'<script type="application/json">{escaped}</script>',
                "</figure>",
            ]
        )


def column(values: Iterable[float], digits: int = 4) -> list[float | None]:
    """Return numbers rounded to ``digits`` significant digits; None for a number that is not finite."""
    return [_short(float(f"{value:.{digits - 1}e}")) for value in values]


def _short(value: float) -> float | None:
    """Return a number that JSON writes shortly: an integer has no decimal point."""
    if not isfinite(value):
        return None
    return int(value) if value == int(value) and abs(value) < 1e6 else value
