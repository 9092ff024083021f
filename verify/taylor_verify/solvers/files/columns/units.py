"""Units in the names of columns: ``wx [deg/s]``, ``t (ms)``, ``gyro_x_dps``.

A scene may be in any consistent set of units. ``s`` is read as the scene's unit of time, ``m`` as its unit
of length, and a rate is in radians per unit of time. A factor that holds pi is formed to 400 bits, as
those of a scene are.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from mpmath import mp

from taylor_verify.numbers.precision import exact_value
from taylor_verify.records.quantities import GROUPS
from taylor_verify.scenes.stand_in import STAND_IN_BITS
from taylor_verify.solvers.files.columns.forms import FORMS


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
_RATES: Final = "radians per unit of time"
# Dimension by dimension: the factor, its words, and the ways to write it.
_WRITTEN: Final[Mapping[str, Sequence[tuple[Fraction, str, str]]]] = {
    "time": (
        (Fraction(1), "the scene's unit of time", "s sec secs second seconds"),
        (
            Fraction(1, 1000),
            "thousandths of the scene's unit of time",
            "ms msec millisecond milliseconds",
        ),
        (
            Fraction(1, 10**6),
            "millionths of the scene's unit of time",
            "us usec microsecond microseconds",
        ),
        (Fraction(1, 10**9), "1e-9 of the scene's unit of time", "ns nsec nanosecond nanoseconds"),
        (Fraction(60), "sixties of the scene's unit of time", "min mins minute minutes"),
        (Fraction(3600), "3600 of the scene's unit of time", "h hr hour hours"),
        (Fraction(86400), "86400 of the scene's unit of time", "d day days"),
    ),
    "rate": (
        (
            Fraction(1),
            _RATES,
            "rad/s rads/s rad/sec rads rad.s^-1 rad.s-1 rads^-1 radps rad_per_s 1/s radian/second",
        ),
        (Fraction(1, 1000), f"thousandths of {_RATES}", "mrad/s"),
        (
            DEGREE,
            "degrees per unit of time",
            "deg/s deg/sec degs degps deg_per_s dps degree/second",
        ),
        (
            _of_pi(Fraction(1, 30)),
            "turns per minute, the unit of time being the second",
            "rpm rev/min revolution/minute revolutions_per_minute",
        ),
        (_of_pi(Fraction(2)), "turns per unit of time", "rev/s rps"),
    ),
    "angle": (
        (Fraction(1), "radians", "rad rads radian radians -"),
        (DEGREE, "degrees", "deg degs degree degrees"),
        (Fraction(1, 1000), "thousandths of a radian", "mrad milliradian"),
        (DEGREE / 3600, "seconds of arc", "arcsec"),
        (_of_pi(Fraction(2)), "turns", "rev turns"),
    ),
    "velocity": (
        (
            Fraction(1),
            "the scene's unit of velocity",
            "m/s m/sec m.s^-1 m.s-1 ms^-1 mps m_per_s meter/second",
        ),
        (Fraction(1, 100), "hundredths of the scene's unit of velocity", "cm/s"),
        (Fraction(1, 1000), "thousandths of the scene's unit of velocity", "mm/s"),
        (Fraction(1000), "1000 of the scene's unit of velocity", "km/s"),
    ),
    "length": (
        (Fraction(1), "the scene's unit of length", "m metre metres meter meters"),
        (Fraction(1, 100), "hundredths of the scene's unit of length", "cm"),
        (Fraction(1, 1000), "thousandths of the scene's unit of length", "mm"),
        (Fraction(1000), "1000 of the scene's unit of length", "km"),
    ),
    "impulse": ((Fraction(1), "the scene's unit of impulse", "n.s ns kg.m/s kgm/s"),),
    "moment of impulse": (
        (Fraction(1), "the scene's unit of angular impulse", "n.m.s nms kg.m^2/s kgm2/s kgm^2/s"),
    ),
    "number": ((Fraction(1), "plain numbers", "-"),),
}
# The dimension of each group of columns.
DIMENSION: Final[Mapping[str, str]] = {
    "time": "time",
    **{name: group.dimension for name, group in GROUPS.items()},
    **{form.name: "angle" if form.angles else "number" for form in FORMS.values()},
}
_GREEK: Final = str.maketrans(
    {
        "ω": "omega",
        "η": "eta",
        "ε": "eps",
        "μ": "u",
        "φ": "phi",
        "θ": "theta",
        "ψ": "psi",
        "°": "deg",
        "·": ".",
        "*": ".",
    }
)


def plain(text: str) -> str:
    """Return a text in small letters, with Greek letters and signs by name, without outer blanks."""
    normal = unicodedata.normalize("NFKC", text.replace("°", "deg")).lower()
    return normal.translate(_GREEK).strip(" \t\r\n\ufeff\"'")


def _key(text: str) -> str:
    return re.sub(r"\s+", "", plain(text))


def letters(text: str) -> str:
    """Return the small letters and the digits of a text."""
    return re.sub(r"[^a-z0-9]", "", text)


_IN_BRACKETS: Final = {
    dimension: {
        _key(text): Unit(factor, words) for factor, words, texts in rows for text in texts.split()
    }
    for dimension, rows in _WRITTEN.items()
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
    return ", ".join(texts.split()[0] for _, _, texts in _WRITTEN[DIMENSION[group]])
