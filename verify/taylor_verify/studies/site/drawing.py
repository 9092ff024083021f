"""A published SVG as the site carries it: in the font of its page, and without metadata."""

from __future__ import annotations

import re
from typing import Final

_FONTS: Final = re.compile(r"font-family: [^;\"}]*")
_METADATA: Final = re.compile(r"<metadata>.*?</metadata>\s*", re.DOTALL)


def smaller(svg: str) -> str:
    """Return the drawing without what nobody sees; its title and its text stay."""
    return _FONTS.sub("font-family: sans-serif", _METADATA.sub("", svg))
