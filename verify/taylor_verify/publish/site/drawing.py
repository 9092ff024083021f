"""A published SVG as the site carries it: the same picture in half the bytes.

Coordinates keep the digits that a screen can show, and a style that many marks share is written once,
as a class.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import Final

_COORDINATE: Final = re.compile(r"(\d\.\d)\d+")
_FONTS: Final = re.compile(r"font-family: [^;\"]*")
_METADATA: Final = re.compile(r"<metadata>.*?</metadata>", re.DOTALL)
_BLANKS: Final = re.compile(r"\s*\n\s*")
_STYLE: Final = re.compile(r' style="([^"]*)"')
_SHEET: Final = '<style type="text/css">'
# A class pays from the third mark on.
_FEW: Final = 2


def smaller(svg: str) -> str:
    """The drawing without what nobody sees; its title and its text stay."""
    plain = _FONTS.sub("font-family: sans-serif", _METADATA.sub("", svg))
    plain = _BLANKS.sub("\n", _COORDINATE.sub(r"\1", plain))
    if _SHEET not in plain:
        return plain
    shared = [style for style, n in Counter(_STYLE.findall(plain)).most_common() if n > _FEW]
    names = {style: f"s{number}" for number, style in enumerate(shared)}

    def named(found: re.Match[str]) -> str:
        return f' class="{names[found[1]]}"' if found[1] in names else found[0]

    rules = "".join(f".{name}{{{style}}}" for style, name in names.items())
    return _STYLE.sub(named, plain).replace(_SHEET, _SHEET + rules, 1)
