"""Units in the names of columns: ``wx [deg/s]``, ``t (ms)``, ``gyro_x_dps``.

A scene may be in any consistent set of units. ``s`` is read as the scene's unit of time, ``m`` as its unit
of length, and a rate is in radians per unit of time. A factor that holds pi is formed to 400 bits, as
those of a scene are.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from mpmath import mp

from taylor_verify.numbers.precision import exact_value
from taylor_verify.records.quantities import GROUPS
from taylor_verify.scenes.stand_in import STAND_IN_BITS
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.columns.programs import entries_of, letters


@dataclass(frozen=True)
class Unit:
    """A unit of a file: the scene's number is ``factor`` times the file's; ``words`` say what it is."""

    factor: Fraction
    words: str


# The scene's own unit, of a column whose name has none.
OWN: Final = Unit(Fraction(1), "")


def _of_pi(rational: Fraction) -> Fraction:
    with mp.workprec(STAND_IN_BITS):
        return exact_value(mp.convert(rational) * mp.pi)


# A degree in radians.
DEGREE: Final = _of_pi(Fraction(1, 180))


def _unit(factor: str, words: str) -> Unit:
    """Return the unit of a factor such as ``1/1000``, ``pi/180`` or ``2*pi``."""
    times, pi, over = factor.partition("pi")
    rational = Fraction(f"{times.strip('*') or 1}{over}") if pi else Fraction(factor)
    return Unit(_of_pi(rational) if pi else rational, words)


_TABLE: Final = tuple(entries_of("units.txt", ("dimension", "factor", "words", "texts")))
# The dimension of each group of columns.
DIMENSION: Final[Mapping[str, str]] = {
    "time": "time",
    **{name: group.dimension for name, group in GROUPS.items()},
    **{form.name: "angle" if form.angles else "number" for form in FORMS.values()},
}
_GREEK: Final = str.maketrans(
    {"ω": "omega", "η": "eta", "ε": "eps", "μ": "u", "φ": "phi", "θ": "theta", "ψ": "psi"}
)
_SIGNS: Final = str.maketrans({"°": "deg", "·": ".", "*": "."})


def plain(text: str) -> str:
    """Return a text in small letters, with Greek letters and signs by name, without outer blanks."""
    normal = unicodedata.normalize("NFKC", text.replace("°", "deg")).lower()
    return normal.translate(_GREEK | _SIGNS).strip(" \t\r\n\ufeff\"'")


def _key(text: str) -> str:
    return re.sub(r"\s+", "", plain(text))


_IN_BRACKETS: Final[Mapping[str, Mapping[str, Unit]]] = {
    dimension: {
        _key(text): _unit(row["factor"], row["words"])
        for row in _TABLE
        for text in row["texts"].split()
        if row["dimension"] == dimension
    }
    for dimension in {row["dimension"] for row in _TABLE}
}
_AS_SUFFIX: Final = {
    dimension: {letters(text): unit for text, unit in units.items() if text[0].isalpha()}
    for dimension, units in _IN_BRACKETS.items()
}


def in_brackets(text: str, group: str) -> Unit | None:
    """Return the unit of a group that stands in brackets behind a name; None for an unknown one."""
    return _IN_BRACKETS[DIMENSION[group]].get(_key(text))


def as_suffix(text: str, group: str) -> Unit | None:
    """Return the unit of a group that ends a name, in letters and digits alone: ``dps``."""
    return _AS_SUFFIX[DIMENSION[group]].get(text)


def known_units(group: str) -> str:
    """Return the first spelling of every unit of a group, in one line."""
    rows = (row for row in _TABLE if row["dimension"] == DIMENSION[group])
    return ", ".join(row["texts"].split()[0] for row in rows)
