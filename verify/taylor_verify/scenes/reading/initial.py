"""The ``[initial]`` table of a scene becomes a state.

Legend: ``linear_impulse`` x and ``angular_impulse`` y, or ``linear_velocity`` U of the origin and
``angular_velocity`` Omega in their place; ``attitude`` is the quaternion of R, v_space = R v_body;
``centre`` is the body's origin in space.
"""

from __future__ import annotations

from typing import Final

from taylor_verify.scenes.bodies import COEFFICIENT_BITS, Body, ImmersedBody
from taylor_verify.scenes.motion import IDENTITY, Impulse, Quaternion, Spin
from taylor_verify.scenes.reading.faults import shown
from taylor_verify.scenes.reading.rates import rates
from taylor_verify.scenes.reading.table import Table
from taylor_verify.scenes.tensors import ZERO_VECTOR, Vector

IMPULSES: Final = ("linear_impulse", "angular_impulse")
VELOCITIES: Final = ("linear_velocity", "angular_velocity")


def spin(table: Table, body: Body | None = None) -> Spin | None:
    """Return the initial state of a rigid body, whatever the body; None beside a fault."""
    del body
    omega = rates(table, "omega")
    attitude = _attitude(table)
    return Spin(omega, attitude) if omega and attitude else None


def turned(table: Table) -> Spin | None:
    """Return the attitude alone: a manufactured motion has the rest."""
    attitude = _attitude(table)
    return Spin(ZERO_VECTOR, attitude) if attitude else None


def impulse(table: Table, body: Body | None) -> Impulse | None:
    """Return the initial state of a solid in a fluid; None beside a fault, or without a body."""
    pair = _impulses(table, body)
    start = placed(table)
    return Impulse(*pair, start.attitude, start.centre) if pair and start else None


def placed(table: Table) -> Impulse | None:
    """Return attitude and centre alone: a manufactured motion has the rest."""
    attitude = _attitude(table)
    centre = table.vector("centre", default=ZERO_VECTOR)
    return Impulse(ZERO_VECTOR, ZERO_VECTOR, attitude, centre) if attitude and centre else None


def _impulses(table: Table, body: Body | None) -> tuple[Vector, Vector] | None:
    """x and y as written, or of the two velocities."""
    by_velocity = [key for key in VELOCITIES if table.has(key)]
    by_impulse = [key for key in IMPULSES if table.has(key)]
    if by_velocity and by_impulse:
        _refuse_both(table, by_impulse, by_velocity)
        return None
    if not by_velocity:
        linear, angular = (table.vector(key) for key in IMPULSES)
        return (linear, angular) if linear and angular else None
    for key in VELOCITIES:
        if key not in by_velocity:
            expected = f"both `{VELOCITIES[0]}` and `{VELOCITIES[1]}`"
            table.fault(expected, f"`{by_velocity[0]}` alone", key, f"add the key `{key}`")
    velocity = table.vector(VELOCITIES[0]) if VELOCITIES[0] in by_velocity else None
    turning = rates(table, VELOCITIES[1]) if VELOCITIES[1] in by_velocity else None
    if velocity is None or turning is None or not isinstance(body, ImmersedBody):
        return None
    table.note(_formed(body))
    return body.impulses(velocity, turning)


def _refuse_both(table: Table, by_impulse: list[str], by_velocity: list[str]) -> None:
    for key in (*by_impulse, *by_velocity):
        table.take(key, "nothing")
    expected = "either the two impulses or the two velocities"
    got = " and ".join(f"`{key}`" for key in (*by_impulse, *by_velocity))
    table.fault(expected, got, by_velocity[0], f"keep {_pair(IMPULSES)}, or {_pair(VELOCITIES)}")


def _pair(keys: tuple[str, str]) -> str:
    return " with ".join(f"`{key}`" for key in keys)


def _formed(body: ImmersedBody) -> str:
    """The sentence on where the impulses come from."""
    shape = (
        "" if body.ellipsoid is None else f", of coefficients rounded to {COEFFICIENT_BITS} bits"
    )
    return (
        "The start is given by velocities: the impulses (x, y) = M (U, Omega) are formed exactly from the "
        f"inertia of this body{shape}."
    )


def _attitude(table: Table) -> Quaternion | None:
    """A quaternion of any norm but zero, scalar first."""
    entries = table.vector("attitude", default=IDENTITY, length=4)
    if entries is None:
        return None
    if not any(entries):
        table.fault("a quaternion that is not zero", shown(list(entries)), "attitude")
        return None
    q0, q1, q2, q3 = entries
    return (q0, q1, q2, q3)
