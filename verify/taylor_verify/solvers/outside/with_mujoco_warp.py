# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["mujoco-warp==4.0.0", "numpy==2.4.6"]
# [tool.taylor-verify]
# title = "MuJoCo Warp"
# models = ["euler"]
# rungs = ["f32"]
# loads = false
# data = "tensor"
# [tool.taylor-verify.settings]
# step = 0.01
# integrator = ["RK4", "Euler", "implicitfast"]
# inertia = ["full", "principal"]
# ///
"""MuJoCo Warp, on the processor, in float32: the model of `with_mujoco.py`, compiled by MuJoCo.

Warp compiles its kernels in the first run, which takes a minute, and keeps them. Its other integrators
are not for a free body alone. There is no damping, no sleep and no cap.
"""

from __future__ import annotations

from typing import Any

from free_body import Engine, FreeBody, Settings, Solved, answer, repeated, stepped
from with_mujoco import mjcf


def solve(body: FreeBody, settings: Settings) -> Solved:
    import mujoco
    import mujoco_warp
    import warp

    warp.config.quiet = True
    model = mujoco.MjModel.from_xml_string(mjcf(body, settings))

    def start() -> Engine:
        data = mujoco.MjData(model)
        data.qpos[3:7] = body.attitude
        data.qvel[3:6] = body.omega
        mujoco.mj_forward(model, data)
        worlds = mujoco_warp.put_model(model), mujoco_warp.put_data(model, data)

        def row() -> Any:
            return body.row(worlds[1].qvel.numpy()[0][3:6], worlds[1].qpos.numpy()[0][3:7])

        return repeated(lambda: mujoco_warp.step(*worlds)), row

    return stepped(body, settings.step, start)


if __name__ == "__main__":
    answer(solve)
