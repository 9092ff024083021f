"""A page on which a motion turns: one HTML file with its script and its numbers, and no network."""

from __future__ import annotations

import json
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any, Final

from taylor_verify.draw.moving import moving

_TEMPLATE: Final = Path(__file__).with_name("assets") / "turning.html"


def page(document: Mapping[str, Any]) -> str:
    """Return the page of a motion: one HTML file, which plays and turns and needs no network.

    ``document`` is that of draw.course.motion. Raises NotDrawn for a body that does not move.
    """
    shown = moving(document)
    text = json.dumps(shown, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    # The data stand in a script element, which no text of theirs may end.
    template = _TEMPLATE.read_text(encoding="utf-8").replace("TITLE", escape(shown["title"]), 1)
    return template.replace("DATA", text.replace("<", "\\u003c"), 1)
