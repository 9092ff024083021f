# /// script
# requires-python = ">=3.11"
# dependencies = ["sapien==3.0.3", "numpy>=2"]
# ///
"""The momentum of a free body grows with every step of the solver TGS, by rounding.

Versions: PhysX 5.3.1 on the CPU, as in SAPIEN 3.0.3.

Expected: rounding of float32 that goes as the root of the steps, as with PGS.

Came: with TGS the square of the momentum grows in proportion to the number of steps, some 7e-7 a step.

Evidence: `copyToSolverBodyData` stores sqrt(I) omega and `integrateCoreStep` turns it back by I^(-1/2)
(DyTGSDynamics.cpp), two matrices of float32 whose product is not quite 1: a factor in each step. PGS
stores omega itself. The same steps in NumPy's float32 grow with that detour and not without.
"""

import sys
import warnings

import numpy as np

warnings.simplefilter("ignore")  # no Vulkan to draw with
import sapien  # noqa: E402

MOMENTS, START = np.array([1.2, 2.1, 2.7]), np.array([0.9, -0.3, 0.5])
growth = {}
for tgs in (True, False):
    for step in (2.0**-10, 2.0**-11):
        config = sapien.physx.PhysxSceneConfig()
        config.gravity, config.enable_tgs = np.zeros(3), tgs
        sapien.physx.set_scene_config(config)
        system = sapien.physx.PhysxCpuSystem()
        system.timestep = step
        body = sapien.physx.PhysxRigidDynamicComponent()
        body.mass, body.inertia = 1.0, MOMENTS
        body.angular_damping = body.sleep_threshold = 0.0
        entity = sapien.Entity()
        entity.add_component(body)
        scene = sapien.Scene([system])
        scene.add_entity(entity)
        body.angular_velocity = START
        for _ in range(round(10 / step)):
            system.step()
        R = sapien.Pose(q=entity.pose.q).to_transformation_matrix()[:3, :3].astype(float)
        H = MOMENTS * (R.T @ body.angular_velocity)
        growth[tgs, step] = H @ H / ((MOMENTS * START) @ (MOMENTS * START)) - 1
        print(f"{'TGS' if tgs else 'PGS'}  step {step}: |H|^2 has grown by {growth[tgs, step]:.1e}")
sys.exit(1 if growth[True, 2.0**-11] > 1e-3 + abs(growth[False, 2.0**-11]) else 0)
