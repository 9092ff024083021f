"""The ``[initial]`` table of a scene becomes a state.

Legend: ``linear_impulse`` x and ``angular_impulse`` y, or ``linear_velocity`` U of the origin and
``angular_velocity`` Omega in their place; ``attitude`` is the quaternion of R, v_space = R v_body,
or one of its other forms; ``centre`` is the body's origin in space.

A degree is pi/180 of a radian, which is irrational. Each rate is an exact multiple of pi: zero stays zero,
and 2 deg/s is minus twice -1 deg/s exactly. scenes.stand_in says what a scene holds in its place.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Final

from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import PI
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.scenes.bodies import Body, ImmersedBody
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.named_numbers import Shape, Value
from taylor_verify.scenes.reading.attitude import attitude
from taylor_verify.scenes.reading.table import Number, Table, exact_number, quantity
from taylor_verify.scenes.stand_in import STAND_IN_BITS, stand_in, written

IMPULSES: Final = ("linear_impulse", "angular_impulse")
VELOCITIES: Final = ("linear_velocity", "angular_velocity")
_RADIANS: Final = "rad/s"
_DEGREE: Final = PI / 180
# A turn a minute is 360 degrees in 60 seconds.
_DEGREES: Final = {"deg/s": 1, "rpm": 6}
_UNITS: Final = f"{_RADIANS}, {' or '.join(_DEGREES)}"


def state(
    kind: type[State], moving: Vector | None, place: Mapping[str, Value] | None
) -> State | None:
    """Return the initial state of a moving part and a place; None if one of them is None."""
    if moving is None or place is None:
        return None
    vectors = {name: moving[3 * k : 3 * k + 3] for k, name in enumerate(kind.MOVING)}
    values = {**vectors, **place}
    return kind(**{part.key: values[part.name] for part in kind.PARTS})


def place(table: Table, kind: type[State]) -> Mapping[str, Value] | None:
    """Return the parts of a state that do not move by equations of their own; None after a fault."""
    values = {
        part.name: attitude(table)
        if part.shape is Shape.QUATERNION
        else table.vector(part.name, default=ZERO_VECTOR)
        for part in kind.PARTS
        if part.name not in kind.MOVING
    }
    return None if None in values.values() else values


def turning(table: Table, body: Body | None) -> Vector | None:
    """Return omega of a rigid body, for which ``body`` is not needed; None after a fault."""
    del body
    return _rates(table, "omega")


def impulses(table: Table, body: Body | None) -> Vector | None:
    """Return x and y as written, or from the two velocities; None after a fault, or without a body."""
    by_velocity = [key for key in VELOCITIES if table.has(key)]
    by_impulse = [key for key in IMPULSES if table.has(key)]
    if by_velocity and by_impulse:
        given = (*by_impulse, *by_velocity)
        for key in given:
            if key == VELOCITIES[1]:
                _rates(table, key)
            else:
                table.vector(key)
        expected = "either the two impulses or the two velocities"
        pairs = (f"`{first}` with `{second}`" for first, second in (IMPULSES, VELOCITIES))
        keep = f"keep {', or '.join(pairs)}"
        table.fault(expected, " and ".join(f"`{key}`" for key in given), by_velocity[0], keep)
        return None
    if not by_velocity:
        linear, angular = (table.vector(key) for key in IMPULSES)
        return linear + angular if linear and angular else None
    for key in VELOCITIES:
        if key not in by_velocity:
            expected = f"both `{VELOCITIES[0]}` and `{VELOCITIES[1]}`"
            table.fault(expected, f"`{by_velocity[0]}` alone", key, f"add the key `{key}`")
    velocity = table.vector(VELOCITIES[0]) if VELOCITIES[0] in by_velocity else None
    spin = _rates(table, VELOCITIES[1]) if VELOCITIES[1] in by_velocity else None
    if velocity is None or spin is None or not isinstance(body, ImmersedBody):
        return None
    table.note(
        "The start is given by velocities: the impulses (x, y) = M (U, Omega) are formed exactly from the "
        "inertia of this body."
    )
    mass_matrix = tensors.inverse(written(body.energy_matrix))
    return tuple(map(stand_in, tensors.apply(mass_matrix, written(velocity + spin))))


# Angular velocities: bare numbers, or text with a unit such as "2 deg/s".


def _rates(table: Table, key: str) -> Vector | None:
    """Return an angular velocity in radians per unit of time; None after a fault.

    Where one entry has a unit, each of the others has one or is 0. A note says what was converted.
    """
    # Each unit once, in the order written.
    units = dict.fromkeys(unit for _, unit in filter(None, map(quantity, table.peek(key))))
    if not units:
        return table.vector(key)
    vector = table.vector(key, reader=Number(_in_radians))
    if any(unit in _DEGREES for unit in units):
        table.note(
            f"{table.path(key)} is given in {' and '.join(units)}, so the unit of time is the second. The "
            f"exact motion is that of these angles; solvers get them with {STAND_IN_BITS} bits at most."
        )
    return vector


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
        return stand_in(exact_number(text) * _DEGREES[unit] * _DEGREE)
    raise ValueError(f"an angular velocity in {_UNITS}")
