"""The colours of the pictures by name, on light and on dark paper.

A trace names its colour, ``$f64`` or ``$scipy RK45``; the script that draws it looks the name up in
the table of the theme. On light paper they are those of the published pictures, on dark paper the same
hues, lightened until a line has the contrast of 3 that WCAG 2.1 (1.4.11) asks for. The rungs, told
apart by their lightness too, run from dark to light there, so that the finest stands out on both.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from taylor_verify.publish.pictures.palette import FAINT, INK, QUIET, contrast
from taylor_verify.publish.pictures.style import look_of, look_of_line, look_of_rung
from taylor_verify.records.precisions import FORMATS, place_of_rung

DARK_PAPER: Final = "#15181C"
LINE_CONTRAST: Final = 3.0

# What a digits map and a polhode count up in: one hue darker by steps, and cool to warm.
_FIXED: Final = {
    "ink": (INK, "#E8E8E4"),
    "quiet": (QUIET, "#A6ABB2"),
    "faint": (FAINT, "#31363D"),
    "paper": ("#FFFFFF", DARK_PAPER),
    "surface": ("#C9CED6", "#59616C"),
    "accent": ("#0B5A8A", "#86C5EC"),
    "alarm": ("#A83C00", "#F0976A"),
    "low": ("#2F7DB5", "#4FA3DC"),
    "middle": ("#8A6AA8", "#A98BC9"),
    "high": ("#C4500A", "#EE8A4E"),
    "class0": ("#FFFFFF", "#1B1F24"),
    "class1": ("#DCE9F5", "#1E3A54"),
    "class3": ("#A9CCE8", "#22557F"),
    "class6": ("#6CA6D4", "#3A7FB8"),
    "class12": ("#2F78B4", "#7DB4DF"),
    "class24": ("#0B3F73", "#CFE4F6"),
}
_BEYOND: Final = "#F4F4F0"
# matplotlib's markers, in Plotly's words.
_SYMBOLS: Final = {
    "o": "circle",
    "s": "square",
    "^": "triangle-up",
    "v": "triangle-down",
    "<": "triangle-left",
    ">": "triangle-right",
    "D": "diamond",
    "d": "diamond-tall",
    "p": "pentagon",
    "h": "hexagon",
    "8": "octagon",
    "*": "star",
    "P": "cross",
    "X": "x",
}
_DASHES: Final = {0: "solid", 2: "dash", 4: "dashdot"}
_SHORTEST_DASH: Final = 2.0


class Palette:
    """Every colour that the pictures of one site have asked for, by name."""

    def __init__(self) -> None:
        self._found = dict(_FIXED)

    def rung(self, name: str) -> str:
        """The token of a rung's colour, which is that of taylor on it."""
        light = look_of_rung(name).colour
        return self._token(name, light, FORMATS[name].dark if name in FORMATS else _BEYOND)

    def family(self, name: str, rung: str) -> str:
        """The token of a family of solvers; taylor goes by the rung."""
        if name.split()[0] == "taylor":
            return self.rung(rung)
        light = look_of(name, rung).colour
        return self._token(name, light, on_dark(light))

    def line(self, number: int) -> str:
        """The token of the n-th line that is neither a rung nor a solver."""
        light = look_of_line(number).colour
        return self._token(f"line{number}", light, on_dark(light))

    def _token(self, name: str, light: str, dark: str) -> str:
        self._found[name] = (light, dark)
        return f"${name}"

    def document(self) -> dict[str, dict[str, str]]:
        """By theme and name, in alphabetical order: pages are made in any order."""
        names = sorted(self._found)
        return {
            "light": {name: self._found[name][0] for name in names},
            "dark": {name: self._found[name][1] for name in names},
        }


def on_dark(colour: str) -> str:
    """The same hue, as light as a line on dark paper has to be."""
    while contrast(colour, DARK_PAPER) < LINE_CONTRAST:
        colour = _lighter(colour)
    return colour


def marker_of(family: str, rung: str) -> dict[str, Any]:
    """Plotly's marker of a family, without its colour."""
    look = look_of(family, rung)
    # A star with corners is matplotlib's way to draw what has no name there.
    symbol = _SYMBOLS.get(look.marker, "circle") if isinstance(look.marker, str) else "star"
    return {"symbol": symbol, "size": round(look.size * 1.7, 1)}


def line_of(family: str, rung: str) -> dict[str, Any]:
    """Plotly's line of a family, without its colour."""
    look = look_of(family, rung)
    dotted = look.dashes and look.dashes[0] < _SHORTEST_DASH
    return {"dash": "dot" if dotted else _DASHES[len(look.dashes)], "width": look.width * 1.3}


def rungs_upwards(rungs: Iterable[str]) -> list[str]:
    """The rungs, each once, the shortest first."""
    return sorted({*rungs}, key=place_of_rung)


def _lighter(colour: str) -> str:
    """A tenth of the way to white."""
    found = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return "#" + "".join(f"{value + (255 - value + 9) // 10:02X}" for value in found)
