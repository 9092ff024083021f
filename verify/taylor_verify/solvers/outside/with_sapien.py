# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "sapien==3.0.3",
#   "numpy==2.4.6",
# ]
# [tool.taylor-verify]
# title = "PhysX 5, by SAPIEN"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# rungs = ["f32"]
# [tool.taylor-verify.settings]
# solver = ["TGS", "PGS"]
# defaults = ["off", "shipped"]
# step = 0.01
# ///
"""PhysX on the CPU, in float32: a rigid dynamic body by either of its solvers, TGS or PGS.

TGS is what SAPIEN takes. SAPIEN switches the gyroscopic forces on, which PhysX leaves off. A body takes
principal moments, has omega in space axes and the quaternion scalar first. ``defaults=shipped`` leaves
angular damping, sleep and the cap of the angular velocity as SAPIEN sets them.
"""

from __future__ import annotations

import warnings
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

NO_CAP = 1e18


def solve(body: FreeBody, settings: Settings) -> Solved:
    import numpy

    turned = body.in_principal_axes()

    def start() -> Engine:
        # The scene keeps its system going.
        scene, made = scene_of(turned, settings)

        def state() -> Any:
            return made.angular_velocity, made.entity.pose.q

        def push(moment: Any) -> None:
            made.add_force_torque(numpy.zeros(3), numpy.array(moment))

        return in_space(turned, lambda: scene.physx_system.step(), state, push)

    return stepped(turned, settings.step, start, pushed_once(turned))


def scene_of(turned: FreeBody, settings: Settings) -> tuple[Any, Any]:
    # SAPIEN warns that there is no Vulkan to draw with.
    warnings.simplefilter("ignore")
    import numpy
    import sapien

    config = sapien.physx.PhysxSceneConfig()
    config.gravity = numpy.zeros(3)
    config.enable_tgs = settings.solver == "TGS"
    sapien.physx.set_scene_config(config)
    system = sapien.physx.PhysxCpuSystem()
    system.timestep = settings.step
    made = sapien.physx.PhysxRigidDynamicComponent()
    made.mass, made.inertia = 1.0, numpy.array(turned.moments)
    if settings.defaults == "off":
        made.linear_damping = made.angular_damping = 0.0
        made.sleep_threshold = 0.0
        made.max_angular_velocity = NO_CAP
    entity = sapien.Entity()
    entity.add_component(made)
    scene = sapien.Scene([system])
    scene.add_entity(entity)
    entity.pose = sapien.Pose(q=turned.attitude)
    made.angular_velocity = numpy.array(turned.omega_in_space)
    return scene, made


if __name__ == "__main__":
    answer(solve, pushed_body)
