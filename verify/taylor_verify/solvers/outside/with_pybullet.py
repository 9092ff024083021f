# /// script
# requires-python = ">=3.11,<3.12"
# dependencies = [
#   "pybullet==3.2.7",
#   "numpy==1.26.4",
# ]
# [tool.taylor-verify]
# title = "Bullet, by PyBullet"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.settings]
# body = ["multibody", "rigid"]
# defaults = ["off", "shipped"]
# step = 0.01
# ///
"""Bullet in doubles: a btMultiBody, as PyBullet makes it where nothing is said, or a btRigidBody.

It takes principal moments, has omega in space axes and the quaternion scalar last. The rigid body has
the implicit gyroscopic impulse of Bullet since 2.83. ``defaults=shipped`` leaves damping, sleep and the
cap of joint velocities as they come; a turn of more than an eighth of a circle in one step is cut short
either way. The wheels of pybullet 3.2.7 end with Python 3.11, and building it takes a compiler: so it
runs with Python 3.11, which uv brings.
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

NO_CAP = 1e30


def solve(body: FreeBody, settings: Settings) -> Solved:
    import pybullet

    turned = body.in_principal_axes()

    def start() -> Engine:
        pybullet.resetSimulation()
        pybullet.setTimeStep(settings.step)
        made = body_of(turned, settings)

        def state() -> Any:
            _, (x, y, z, w) = pybullet.getBasePositionAndOrientation(made)
            _, omega = pybullet.getBaseVelocity(made)
            return omega, (w, x, y, z)

        def push(moment: Any) -> None:
            pybullet.applyExternalTorque(made, -1, list(moment), pybullet.WORLD_FRAME)

        return in_space(turned, pybullet.stepSimulation, state, push)

    pybullet.connect(pybullet.DIRECT)
    return stepped(turned, settings.step, start, pushed_once(turned))


def body_of(turned: FreeBody, settings: Settings) -> int:
    import pybullet

    w, x, y, z = turned.attitude
    made: int = pybullet.createMultiBody(
        baseMass=1.0,
        baseOrientation=[x, y, z, w],
        useMaximalCoordinates=settings.body == "rigid",
    )
    # A rigid body whose moments are given without its mass becomes static.
    pybullet.changeDynamics(made, -1, mass=1.0, localInertiaDiagonal=list(turned.moments))
    if settings.defaults == "off":
        pybullet.changeDynamics(
            made,
            -1,
            linearDamping=0.0,
            angularDamping=0.0,
            jointDamping=0.0,
            maxJointVelocity=NO_CAP,
            activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
        )
    pybullet.resetBaseVelocity(made, [0.0, 0.0, 0.0], list(turned.omega_in_space))
    return made


if __name__ == "__main__":
    answer(solve, pushed_body)
