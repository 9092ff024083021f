# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["pybox3d==2026b0"]
# [tool.taylor-verify]
# title = "libbox3d, by pybox3d"
# models = ["euler"]
# loads = false
# data = "tensor"
# rungs = ["f32"]
# [tool.taylor-verify.settings]
# step = 0.01
# defaults = ["off", "shipped"]
# ///
"""The C library of pybox3d, in float32: a box of the density that has the moments of the body.

It is not the Box3D of the author of Box2D, which no registry has. Moments come from a shape alone. Omega is
in space axes, the quaternion scalar last. `defaults=shipped` leaves sleep as it comes, which is on.
"""

from __future__ import annotations

import math
from typing import Any

from free_body import Engine, FreeBody, Settings, Solved, answer, repeated, stepped
from question import Unsuited

ORIGIN = (0.0, 0.0, 0.0)


def solve(body: FreeBody, settings: Settings) -> Solved:
    import pybox3d

    turned = body.in_principal_axes()
    half = half_extents(turned.moments)
    w, x, y, z = turned.attitude

    def start() -> Engine:
        world = pybox3d.World(gravity=ORIGIN)
        world.sleeping_enabled = settings.defaults == "shipped"
        solid = pybox3d.RigidBody(ORIGIN, half, 1.0)
        solid.orientation = pybox3d.Quat(x, y, z, w)
        solid.angular_velocity = pybox3d.Vec3(*turned.omega_in_space)
        made = world.add_body(solid)

        def row() -> Any:
            q, omega = made.orientation, made.angular_velocity
            return turned.row_from_space((omega.x, omega.y, omega.z), (q.w, q.x, q.y, q.z))

        return repeated(lambda: world.step(settings.step)), row

    return stepped(turned, settings.step, start)


def half_extents(moments: Any) -> list[float]:
    """Return half the edges of a box of mass 1; raises Unsuited for moments that no box has."""
    half = sum(moments) / 2
    if min(squares := [half - moment for moment in moments]) <= 0:
        raise Unsuited(f"expected moments of a box, got {moments!r} @ inertia")
    return [math.sqrt(3.0 * square) for square in squares]


if __name__ == "__main__":
    answer(solve)
