# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["panda3d==1.10.16"]
# [tool.taylor-verify]
# title = "Panda3D"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# rungs = ["f32"]
# [tool.taylor-verify.methods]
# ode = "ODE, dWorldStep"
# ode-quick = "ODE, dWorldQuickStep"
# bullet = "Bullet, btRigidBody"
# [tool.taylor-verify.settings]
# rotation = ["infinitesimal", "finite"]
# defaults = ["off", "shipped"]
# step = 0.01
# ///
"""The physics engines in Panda3D, which hands their numbers on in float32: ODE and Bullet.

Omega is in space axes, the quaternion scalar first. ODE takes a full tensor, Bullet principal moments.
"""

from __future__ import annotations

from typing import Any

from free_body import (
    Engine,
    FreeBody,
    Settings,
    Solved,
    answer,
    in_space,
    pushed_body,
    pushed_once,
    stepped,
)

METHODS = {"ode": "step", "ode-quick": "quick_step", "bullet": "do_physics"}


def solve(body: FreeBody, settings: Settings) -> Solved:
    if settings.method == "bullet":
        turned = body.in_principal_axes()
        remark = pushed_once(turned)
        return stepped(turned, settings.step, lambda: bullet(turned, settings), remark)
    return stepped(body, settings.step, lambda: ode(body, settings), pushed_once(body))


def ode(body: FreeBody, settings: Settings) -> Engine:
    from panda3d import core, ode

    world = ode.OdeWorld()
    mass, made = ode.OdeMass(), ode.OdeBody(world)
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.inertia
    mass.set_parameters(1.0, 0.0, 0.0, 0.0, xx, yy, zz, xy, xz, yz)
    made.set_mass(mass)
    made.set_quaternion(core.Quat(*body.attitude))
    made.set_angular_vel(*body.omega_in_space)
    made.set_finite_rotation_mode(settings.rotation == "finite")
    if settings.defaults == "off":
        made.set_auto_disable_flag(False)
    go_on = getattr(world, METHODS[settings.method])

    def state() -> Any:
        return made.get_angular_vel(), made.get_quaternion()

    def push(moment: Any) -> None:
        made.add_torque(core.Vec3(*moment))

    return in_space(body, lambda: go_on(settings.step), state, push)


def bullet(turned: FreeBody, settings: Settings) -> Engine:
    from panda3d import bullet, core

    world, made = bullet.BulletWorld(), bullet.BulletRigidBodyNode("body")
    made.set_mass(1.0)
    made.set_inertia(core.Vec3(*turned.moments))
    made.set_transform(core.TransformState.make_quat(core.Quat(*turned.attitude)))
    world.attach(made)
    made.set_angular_velocity(core.Vec3(*turned.omega_in_space))
    if settings.defaults == "off":
        made.set_linear_damping(0.0)
        made.set_angular_damping(0.0)
        made.set_deactivation_enabled(False)

    def state() -> Any:
        return made.get_angular_velocity(), made.get_transform().get_quat()

    def push(moment: Any) -> None:
        made.apply_torque(core.Vec3(*moment))

    # No substeps: the step is that of the engine.
    return in_space(turned, lambda: world.do_physics(settings.step, 0), state, push)


if __name__ == "__main__":
    answer(solve, pushed_body)
