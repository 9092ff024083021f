"""A page on which a motion turns: one HTML file with its script and its numbers, and no network."""

from __future__ import annotations

import json
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any, Final

_TEMPLATE: Final = Path(__file__).with_name("assets") / "turning.html"


def page(motion: Mapping[str, Any]) -> str:
    """Return the page of a motion, which plays and turns; ``motion`` is that of draw.moving.moving."""
    text = json.dumps(motion, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    # The data stand in a script element, which no text of theirs may end.
    template = _TEMPLATE.read_text(encoding="utf-8").replace("TITLE", escape(motion["title"]), 1)
    return template.replace("DATA", text.replace("<", "\\u003c"), 1)
