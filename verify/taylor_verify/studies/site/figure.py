"""A motion that can be turned: Plotly's data as HTML within a page.

Colours are names after a dollar, which the style of the page resolves. Numbers are short, because nobody
sees the fourth digit of a point.
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

    ``box`` has the least and the greatest coordinate of each axis, and contains the whole drawing.
    """

    name: str
    title: str
    caption: str
    alt: str
    traces: Sequence[Trace]
    axes: Sequence[str]
    box: Sequence[tuple[float, float]]

    def html(self) -> str:
        """Return the figure as a block of HTML without empty lines."""
        box = [column(side) for side in self.box]
        document = {"traces": list(self.traces), "axes": list(self.axes), "box": box}
        text = json.dumps(document, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
        # Escaped, so that no text of the data can end the script element.
        stored = text.replace("<", "\\u003c")
        alt = escape(self.alt)
        return "\n".join(
            [
                f'<figure class="motion" id="{self.name}">',
                f'<div class="plot" role="img" aria-label="{alt}"></div>',
                f"<noscript><p>{alt}</p></noscript>",
                f"<figcaption><b>{escape(self.title)}.</b> {escape(self.caption)}</figcaption>",
                f'<script type="application/json">{stored}</script>',
                "</figure>",
            ]
        )


def column(values: Iterable[float], digits: int = 4) -> list[float | None]:
    """Return numbers rounded to ``digits``; None for one that is not finite."""
    rounded = [float(f"{value:.{digits - 1}e}") for value in values]
    return [
        None if not isfinite(v) else int(v) if v == int(v) and abs(v) < 1e6 else v for v in rounded
    ]
