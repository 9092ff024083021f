"""Looks of solvers and rungs, the same in every picture, and settings of all pictures.

A look is a colour, a marker and a line. Each pair of colour and marker belongs to one family, and the line
shows the kind of solver. Neighbours of one kind differ in lightness, so that families can be distinguished
in colour, in grey and with any colour vision. Colours follow Okabe and Ito
(https://jfly.uni-koeln.de/color) and Tol (SRON/EPS/TN/09-002), darkened until a line has the
contrast of 3 that WCAG 2.1 (1.4.11) asks for.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Final
from zlib import crc32

from taylor_verify.records.precisions import FORMATS, bits_of, place_of_rung

Dashes = tuple[float, ...]

SOLID: Final[Dashes] = ()
DASHED: Final[Dashes] = (5.0, 1.6)
DOTTED: Final[Dashes] = (1.2, 1.4)
DASHDOT: Final[Dashes] = (6.0, 1.4, 1.2, 1.4)

# Text, thin lines, grids and paper. Text on paper has the contrast that WCAG 2.1 requires (1.4.3).
INK: Final = "#1A1A1A"
QUIET: Final = "#6A6A6A"
FAINT: Final = "#E2E2E2"
PAPER: Final = "#FFFFFF"

# In points; the width in inches: that of a page with margins of an inch on both A4 and letter.
PAGE_WIDTH: Final = 6.3
FONT_SIZE: Final = 9
SMALL: Final = 7.5


@dataclass(frozen=True)
class Look:
    """The look of one family; ``dashes`` are on and off lengths in line widths, empty for a solid line.

    ``marker`` is matplotlib's name of it, or (corners, 1, angle) for a star.
    """

    colour: str
    marker: str | tuple[int, int, int]
    dashes: Dashes = SOLID
    width: float = 1.1
    size: float = 4.5

    @property
    def line(self) -> dict[str, Any]:
        """The keywords of matplotlib for the line and its marks."""
        return {
            "color": self.colour,
            "marker": self.marker,
            "markersize": self.size,
            "markeredgecolor": PAPER,
            "markeredgewidth": 0.4,
            "linewidth": self.width,
            "linestyle": (0, self.dashes) if self.dashes else "solid",
        }


@dataclass(frozen=True)
class Kind:
    """Solvers of one kind: their heading, and a look for each by the words in its name."""

    name: str
    heading: str
    dashes: Dashes
    entries: tuple[tuple[str, str, str], ...]


TAYLOR: Final = "taylor"
OTHERS: Final = "others"
PROCESS: Final = "process"

# A star is larger, because it looks smaller at the same width.
_SIZES: Final = {"*": 6.5, "d": 5.5}
_BEYOND: Final = ("p", "h", "8", "*", "P", "X")

# All kinds in reading order. If two entries fit a name, the one with more words counts.
KINDS: Final = (
    Kind(
        "scipy",
        "SciPy, adaptive step",
        SOLID,
        (
            ("scipy rk45", "#C48600", "o"),
            ("scipy dop853", "#882255", "D"),
            ("scipy radau", "#1C8578", "^"),
            ("scipy bdf", "#0A3A1A", "v"),
            ("scipy lsoda", "#A83C00", "p"),
        ),
    ),
    Kind(
        "geometric",
        "geometric, fixed step",
        DASHED,
        (
            ("geometric implicit midpoint", "#7E7E7E", "P"),
            ("geometric splitting", "#3F2206", "X"),
            ("geometric moser veselov", "#949430", "<"),
            ("geometric preprocessed moser veselov", "#4A4A10", ">"),
            ("geometric lie rk4", "#B13FA0", "h"),
        ),
    ),
    Kind(
        "reference",
        "many digits, closed form",
        DOTTED,
        (
            ("mpmath odefun", "#444444", "*"),
            ("closed form", "#BB5566", "d"),
        ),
    ),
    Kind(
        OTHERS,
        "other libraries",
        DASHDOT,
        (
            ("diffrax tsit5", "#E0714F", "o"),
            ("diffrax dopri8", "#99334D", "s"),
            ("cvode adams", "#35A080", "^"),
            ("cvode bdf", "#225522", "v"),
            ("cyrk", "#A89018", "D"),
            ("extensisq", "#663333", "p"),
            ("rebound", "#D9758E", "h"),
            ("numbalsoda", "#225555", "X"),
        ),
    ),
)

# Stars for unknown names, chosen by a hash of the name; no known family has a star.
_UNKNOWN_COLOURS: Final = ("#C48600", "#882255", "#2F9E8F", "#0E5F2A", "#C04FAF", "#333333")
_UNKNOWN_CORNERS: Final = (3, 4, 5, 6, 7)
_UNKNOWN_ANGLES: Final = (0, 20)
# Their number is coprime to that of the colours, so that pairs repeat late.
_LINE_MARKERS: Final = ("o", "s", "^", "D", "v", "P", "X")


def kind_of(family: str) -> str:
    """Return the name of the family's kind: ``taylor``, one of `KINDS`, or ``others`` if unknown."""
    words = _words(family)
    if words[:1] == [TAYLOR]:
        return TAYLOR
    if named := _named(words):
        return named[0].name
    return next((kind.name for kind in KINDS if kind.name in words[:1]), OTHERS)


def heading_of(kind: str) -> str:
    """Return the heading of a kind of solvers."""
    return next((one.heading for one in KINDS if one.name == kind), "taylor, by rung")


def look_of(family: str, rung: str) -> Look:
    """Return the look of a family on a rung; the rung matters for taylor alone."""
    words = _words(family)
    if words in ([TAYLOR], [TAYLOR, rung]):
        return look_of_rung(rung)
    named = _named(words)
    if named is None:
        return _unknown(" ".join(words), kind_of(family))
    kind, (_, colour, marker) = named
    return Look(colour, marker, kind.dashes, size=_SIZES.get(marker, 4.5))


def look_of_rung(rung: str) -> Look:
    """Return the look of taylor on a rung, or of a rung in pictures without solvers."""
    if rung in FORMATS:
        format = FORMATS[rung]
        return Look(format.colour, format.marker, width=format.width, size=format.size)
    marker = _BEYOND[bits_of(rung) % len(_BEYOND)]
    return Look("#000000", marker, DASHED, width=1.2, size=_SIZES.get(marker, 5.0))


def look_of_line(number: int) -> Look:
    """Return the look of the n-th line of a picture without solvers; neighbours differ."""
    colour = _UNKNOWN_COLOURS[number % len(_UNKNOWN_COLOURS)]
    return Look(colour, _LINE_MARKERS[number % len(_LINE_MARKERS)])


def place(family: str, rung: str) -> tuple[int, int, int, str]:
    """Return a key to sort families by: taylor first by rung, then kinds and names as above."""
    kind, named = kind_of(family), _named(_words(family))
    if kind == TAYLOR:
        return (0, *place_of_rung(rung)[:2], family)
    known_looks = [look for one in KINDS for look in one.entries]
    number = known_looks.index(named[1]) if named else len(known_looks)
    return (1 + [one.name for one in KINDS].index(kind), number, 0, family)


def settings() -> dict[str, Any]:
    """Return matplotlib's rcParams of every picture; all others have their defaults."""
    return {
        "font.family": ["DejaVu Sans", "sans-serif"],
        "font.size": FONT_SIZE,
        "axes.labelsize": FONT_SIZE,
        "axes.titlesize": FONT_SIZE,
        "axes.titleweight": "bold",
        "axes.titlelocation": "left",
        "xtick.labelsize": SMALL,
        "ytick.labelsize": SMALL,
        "text.color": INK,
        "axes.labelcolor": INK,
        "axes.edgecolor": QUIET,
        "xtick.color": QUIET,
        "ytick.color": QUIET,
        "xtick.labelcolor": INK,
        "ytick.labelcolor": INK,
        "axes.linewidth": 0.6,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.axisbelow": True,
        "grid.color": FAINT,
        "grid.linewidth": 0.5,
        # Dashes are in points, and independent of the width of the line.
        "lines.scale_dashes": True,
        # Text can be searched and read aloud, and ids are the same in every run.
        "svg.fonttype": "none",
        "svg.hashsalt": "taylor-verify",
        # TrueType can be searched, and journals require it.
        "pdf.fonttype": 42,
    }


def _named(words: list[str]) -> tuple[Kind, tuple[str, str, str]] | None:
    """Return the longest entry of `KINDS` whose words are all in the name."""
    if words[:1] == [PROCESS]:
        # The other words are a user's command, and name no solver of ours.
        return None
    fitting = [
        (kind, entry) for kind in KINDS for entry in kind.entries if {*_words(entry[0])} <= {*words}
    ]
    return max(fitting, key=lambda pair: len(_words(pair[1][0])), default=None)


def _words(name: str) -> list[str]:
    """Return the words of ``scipy:RK45?rtol=1e-3`` or ``scipy RK45``: scipy and rk45."""
    return re.findall(r"[a-z0-9]+", name.lower().partition("?")[0])


def _unknown(name: str, kind: str) -> Look:
    number = crc32(name.encode())
    number, colour = divmod(number, len(_UNKNOWN_COLOURS))
    number, corners = divmod(number, len(_UNKNOWN_CORNERS))
    angle = _UNKNOWN_ANGLES[number % len(_UNKNOWN_ANGLES)]
    dashes = next((one.dashes for one in KINDS if one.name == kind), SOLID)
    return Look(_UNKNOWN_COLOURS[colour], (_UNKNOWN_CORNERS[corners], 1, angle), dashes, size=7.0)
