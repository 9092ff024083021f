"""A motion that can be turned: what Plotly draws, in plain data, as HTML within a page.

Colours are names with a dollar before them, which the style of the page resolves. Numbers are short:
no eye sees the fourth digit of a point.
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
    """A picture in space by its ``name`` on the page, with a text in its stead and titles of the axes.

    ``box`` is the least and the greatest coordinate that each axis shows: nothing drawn is outside.
    """

    name: str
    title: str
    caption: str
    alt: str
    traces: Sequence[Trace]
    axes: Sequence[str]
    box: Sequence[tuple[float, float]]

    def html(self) -> str:
        """Return the figure as a block of HTML, no line of which is empty."""
        box = [column(side) for side in self.box]
        document = {"traces": list(self.traces), "axes": list(self.axes), "box": box}
        text = json.dumps(document, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
        # No text of the data may end the script element.
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
    """Return numbers with so many digits each; None for one that no axis has a place for."""
    rounded = [float(f"{value:.{digits - 1}e}") for value in values]
    return [
        None if not isfinite(v) else int(v) if v == int(v) and abs(v) < 1e6 else v for v in rounded
    ]
