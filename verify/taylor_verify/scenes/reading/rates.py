"""Angular velocities of a scene: bare numbers, or text with a unit such as ``"2 deg/s"``.

A degree is pi/180 of a radian, which is irrational. It is rounded once to 400 bits, and each rate is
an exact multiple of that one rational: zero stays zero, and 2 deg/s is minus twice -1 deg/s exactly.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Final

from taylor_verify.scenes.bodies import COEFFICIENT_BITS
from taylor_verify.scenes.precision import exact_value, rounded
from taylor_verify.scenes.reading.table import Table, exact_number, quantity
from taylor_verify.scenes.tensors import Vector

_RADIANS: Final = "rad/s"
# A turn a minute is 360 degrees in 60 seconds.
_DEGREES: Final = {"deg/s": 1, "rpm": 6}
_UNITS: Final = f"{_RADIANS}, {' or '.join(_DEGREES)}"
_GUARD_BITS: Final = 40


def rates(table: Table, key: str) -> Vector | None:
    """Return an angular velocity in radians per unit of time; None beside a fault.

    Where one entry has a unit, each of the others has one or is 0. A note says what was converted.
    """
    # Each unit once, in the order written.
    units = dict.fromkeys(unit for _, unit in filter(None, map(quantity, table.peek(key))))
    if not units:
        return table.vector(key)
    vector = table.vector(key, number=_in_radians)
    if any(unit in _DEGREES for unit in units):
        table.note(
            f"{table.path(key)} is given in {' and '.join(units)}, so the unit of time is the second. "
            f"pi/180 is rounded to {COEFFICIENT_BITS} bits (120 digits), and each component is an exact "
            "multiple of that rational: ratios of components are those written."
        )
    return vector


@cache
def degree() -> Fraction:
    """Return pi/180, rounded once to 400 bits."""
    from mpmath import mp

    with mp.workprec(COEFFICIENT_BITS + _GUARD_BITS):
        return rounded(exact_value(+mp.degree), COEFFICIENT_BITS)


def _in_radians(value: object) -> Fraction:
    parts = quantity(value)
    if parts is None:
        number = exact_number(value)
        if number:
            raise ValueError(f"a unit, as its neighbours have one ({_UNITS})")
        return number
    text, unit = parts
    if unit == _RADIANS:
        return exact_number(text)
    if unit in _DEGREES:
        return exact_number(text) * _DEGREES[unit] * degree()
    raise ValueError(f"an angular velocity in {_UNITS}")
