"""The attitude at the start: a quaternion, or angles, a vector or an axis in its place.

The quaternion of an angle is irrational. The exact motion is that of the angle; a solver gets the
quaternion with 400 bits at most. Quarter turns in degrees are rational.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from fractions import Fraction
from typing import Final, NamedTuple

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Vector
from taylor_verify.records.faults import shown
from taylor_verify.scenes.motion import IDENTITY
from taylor_verify.scenes.reading.table import Table
from taylor_verify.scenes.stand_in import STAND_IN_BITS, stand_in
from taylor_verify.scenes.turns import AXES, Turn, length, product

# No two neighbours are one axis.
_SEQUENCE: Final = re.compile(r"([xyz])(?!\1)([xyz])(?!\2)[xyz]")
# The sine of a larger angle costs more bits than anybody asks for.
_MOST_ANGLE: Final = 10**20


def attitude(table: Table) -> Vector | None:
    """Return a quaternion of any norm but zero, scalar first, body to space; None after a fault."""
    written = [form for form in _FORMS if table.has(form)]
    quaternions = [_FORMS[form](table) for form in written]
    if len(written) > 1:
        got = " and ".join(f"`{form}`" for form in written)
        table.fault("one form of the attitude", got, written[1])
        return None
    return quaternions[0] if written else IDENTITY


def _quaternion(table: Table) -> Vector | None:
    if keys := table.peek_keys("attitude"):
        table.take("attitude", "4 numbers")
        table.fault("4 numbers, scalar first", "a table", "attitude", _of_table(keys))
        return None
    if len(three := table.peek("attitude")) == 3:
        table.take("attitude", "4 numbers")
        table.fault("4 numbers, scalar first", shown(three), "attitude", _of_three(three))
        return None
    entries = table.vector("attitude", length=4)
    if entries is not None and not any(entries):
        table.fault("a quaternion that is not zero", shown(list(entries)), "attitude")
        return None
    return entries


def _of_three(entries: list[object]) -> str:
    """Return the lines to write for three numbers, or rows, that stand in place of a quaternion."""
    if any(isinstance(entry, list) for entry in entries):
        return "a matrix is written as its quaternion, or as `rotation_vector = [..]`"
    numbers = f"[{', '.join(map(shown, entries))}]"
    return (
        f'yaw, pitch and roll are `euler = {{ sequence = "zyx", degrees = {numbers} }}`, a rotation '
        f"vector is `rotation_vector = {numbers}`, Rodrigues parameters are `mrp = {numbers}`"
    )


def _of_table(keys: tuple[str, ...]) -> str:
    """Return the lines to write for a table that stands in place of a quaternion."""
    others = [form for form in _FORMS if form != "attitude"]
    meant = [key for key in keys if key in others] or others
    lines = " or ".join(f"`{form} = ..`" for form in meant)
    return f"write {lines} in [initial], in place of `attitude`"


def _rodrigues(table: Table) -> Vector | None:
    """Return the quaternion of the axis times the tangent of a quarter of the angle, exactly."""
    vector = table.vector("mrp")
    if vector is None:
        return None
    square = tensors.dot(vector, vector)
    return (1 - square, *tensors.scaled(Fraction(2), vector))


def _rotation_vector(table: Table) -> Vector | None:
    """Return the quaternion of the axis times the angle in radians."""
    vector = table.vector("rotation_vector")
    if vector is None or not any(vector):
        return None if vector is None else IDENTITY
    if tensors.dot(vector, vector) > _MOST_ANGLE**2:
        table.fault(f"an angle of at most {_MOST_ANGLE}", shown(list(vector)), "rotation_vector")
        return None
    return _formed(table, "rotation_vector", [Turn(vector, length(vector))])


def _axis_angle(table: Table) -> Vector | None:
    inner = table.table("axis_angle")
    if inner is None:
        return None
    axis, angles = inner.vector("axis"), _angles(inner, None)
    inner.close()
    if axis is not None and not any(axis):
        inner.fault("an axis that is not zero", shown(list(axis)), "axis")
        return None
    if axis is None or angles is None:
        return None
    return _formed(table, "axis_angle", [Turn(axis, angles.each[0], angles.are_degrees)])


def _euler(table: Table) -> Vector | None:
    """Return the quaternion of three turns about axes that move along, in the order of the sequence."""
    if len(three := table.peek("euler")) == 3:
        table.take("euler", "a table")
        table.fault("a table", shown(three), "euler", _of_three(three))
        return None
    inner = table.table("euler")
    if inner is None:
        return None
    sequence, angles = inner.text("sequence"), _angles(inner, 3)
    inner.close()
    if sequence is not None and not _SEQUENCE.fullmatch(sequence):
        inner.fault('three axes such as "zyx" or "zxz"', shown(sequence), "sequence")
        return None
    if sequence is None or angles is None:
        return None
    axes = [AXES["xyz".index(letter)] for letter in sequence]
    pairs = zip(axes, angles.each, strict=True)
    return _formed(table, "euler", [Turn(axis, a, angles.are_degrees) for axis, a in pairs])


class _Angles(NamedTuple):
    each: Vector
    are_degrees: bool


def _angles(table: Table, count: int | None) -> _Angles | None:
    """Return so many angles, or a single number for None, in degrees or in radians."""
    units = [unit for unit in ("degrees", "radians") if table.has(unit)]
    if len(units) != 1:
        for unit in units:
            table.take(unit, "nothing")
        table.fault("either `degrees` or `radians`", "both" if units else "neither")
        return None
    if count is None:
        number = table.number(units[0])
        angles: Vector | None = None if number is None else (number,)
    else:
        angles = table.vector(units[0], length=count)
    if angles is None or any(abs(angle) > _MOST_ANGLE for angle in angles):
        if angles is not None:
            table.fault(f"angles of at most {_MOST_ANGLE}", shown(list(angles)), units[0])
        return None
    return _Angles(angles, units[0] == "degrees")


def _formed(table: Table, key: str, turns: list[Turn]) -> Vector:
    table.note(
        f"The attitude is given by {table.path(key)}: the exact motion is that of what is written; solvers "
        f"get its quaternion with {STAND_IN_BITS} bits at most."
    )
    return tuple(map(stand_in, product(turns)))


_FORMS: Final[dict[str, Callable[[Table], Vector | None]]] = {
    "attitude": _quaternion,
    "euler": _euler,
    "rotation_vector": _rotation_vector,
    "mrp": _rodrigues,
    "axis_angle": _axis_angle,
}
