"""The precision ladder: a record of every number format, and the names mpN of MPFR's numbers.

To add a format is to add it to ``FORMATS``, and its number type to solvers/taylor/numbers.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True)
class Format:
    """A binary number format of hardware or of compilers.

    It has ``bits`` of significand, and exponents up to ``emax`` as IEEE 754 counts them.
    ``numpy`` is the name of NumPy's type, empty where NumPy has none. Pictures draw it in ``colour``, with
    a line of ``width`` and markers of ``size`` points.
    """

    name: str
    bits: int
    emax: int
    numpy: str
    colour: str
    marker: str
    width: float
    size: float

    @property
    def emin(self) -> int:
        """The least exponent of a number with all its digits."""
        return 1 - self.emax


# Light to dark and thin to thick with the digits that a format has: where formats agree, as they do at
# coarse tolerances, the lines lie in each other.
FORMATS: Final[Mapping[str, Format]] = {
    each.name: each
    for each in (
        Format("f32", 24, 127, "float32", colour="#3F9BD1", marker="o", width=0.9, size=3.0),
        Format("f64", 53, 1023, "float64", colour="#0072B2", marker="s", width=1.5, size=4.2),
        Format("f80", 64, 16383, "longdouble", colour="#5A2A9A", marker="^", width=2.1, size=5.4),
        Format("f128", 113, 16383, "", colour="#1A1040", marker="D", width=2.7, size=5.6),
    )
}
# The precisions that the standard set runs on.
LADDER: Final = (*FORMATS, "mp237")
RUNG_PATTERN: Final = f"^({'|'.join(FORMATS)}|mp[1-9][0-9]*)$"
_MPFR: Final = re.compile(r"mp([1-9][0-9]{0,3})")


def bits_of(rung: str) -> int:
    """Return the bits of a rung's significand; 0 for a name that is no rung."""
    if rung in FORMATS:
        return FORMATS[rung].bits
    match = _MPFR.fullmatch(rung)
    return int(match[1]) if match else 0


def place_of_rung(rung: str) -> tuple[int, int, str]:
    """Return a key to sort rungs by: the named formats, then mpN by N, then any other name."""
    bits = bits_of(rung)
    return (0 if rung in FORMATS else 1 if bits else 2), bits, rung
