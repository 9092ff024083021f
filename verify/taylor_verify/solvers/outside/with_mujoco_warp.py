# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["mujoco-warp==4.0.0", "mujoco==4.0.0", "warp-lang==1.19.0", "numpy==2.4.6"]
# [tool.taylor-verify]
# title = "MuJoCo Warp"
# alike = ["mujoco"]
# models = ["euler"]
# rungs = ["f32"]
# loads = false
# data = "tensor"
# [tool.taylor-verify.settings]
# step = 0.0078125
# integrator = ["Euler", "implicitfast", "RK4"]
# inertia = ["full", "principal"]
# ///
"""MuJoCo Warp, on the processor: MuJoCo's model and integrators in float32.

The model is that of with_mujoco.py, compiled by MuJoCo in doubles. Warp compiles its kernels in the first
run, for a minute, and keeps them. Constraints are switched off: a free body has none.
"""

from __future__ import annotations

from typing import Any

from free_body import Engine, FreeBody, Settings, Solved, answer, repeated, stepped
from with_mujoco import compiled_inertia, mjcf, remark


def solve(body: FreeBody, settings: Settings) -> Solved:
    import warp

    warp.config.quiet = True
    import mujoco
    import mujoco_warp

    model = mujoco.MjModel.from_xml_string(mjcf(body, settings))
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    with warp.ScopedDevice("cpu"):
        on_device = mujoco_warp.put_model(model)

        def start() -> Engine:
            data = mujoco.MjData(model)
            data.qpos[3:7], data.qvel[3:6] = body.attitude, body.omega
            mujoco.mj_forward(model, data)
            state = mujoco_warp.put_data(model, data)

            def row() -> Any:
                return body.row(state.qvel.numpy()[0][3:6], state.qpos.numpy()[0][3:7])

            return repeated(lambda: mujoco_warp.step(on_device, state)), row

        return stepped(body, settings.step, start, remark(body, compiled_inertia(model), ""))


if __name__ == "__main__":
    answer(solve)
