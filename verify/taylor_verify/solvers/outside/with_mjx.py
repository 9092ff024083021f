# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "mujoco-mjx==3.17.0",
#   "mujoco==3.17.0",
#   "jax==0.10.2",
#   "jaxlib==0.10.2",
#   "numpy==2.4.6",
#   "scipy==1.17.1",
# ]
# [tool.taylor-verify]
# title = "MuJoCo MJX on JAX"
# alike = ["mujoco"]
# models = ["euler"]
# rungs = ["f32", "f64"]
# loads = false
# data = "tensor"
# [tool.taylor-verify.settings]
# step = 0.002
# integrator = ["Euler", "implicitfast", "RK4"]
# inertia = ["full", "principal"]
# ///
"""MJX: MuJoCo's model and integrators in JAX, in float32 as it comes, or in float64.

The model is that of with_mujoco.py, compiled by MuJoCo in doubles. A stretch between two samples is one
compiled loop.
"""

from __future__ import annotations

from typing import Any

from free_body import Engine, FreeBody, Settings, Solved, answer, stepped
from with_mujoco import compiled_inertia, mjcf, remark

DOUBLE_BITS = 53


def solve(body: FreeBody, settings: Settings) -> Solved:
    import jax

    jax.config.update("jax_enable_x64", body.question.bits == DOUBLE_BITS)
    import mujoco
    from mujoco import mjx

    model = mujoco.MjModel.from_xml_string(mjcf(body, settings))
    on_device = mjx.put_model(model)

    def steps_of(state: Any, steps: Any) -> Any:
        return jax.lax.fori_loop(0, steps, lambda _, now: mjx.step(on_device, now), state)

    stretch = jax.jit(steps_of)

    def start() -> Engine:
        data = mujoco.MjData(model)
        data.qpos[3:7], data.qvel[3:6] = body.attitude, body.omega
        mujoco.mj_forward(model, data)
        state = mjx.put_data(model, data)

        def advance(steps: int) -> None:
            nonlocal state
            state = jax.block_until_ready(stretch(state, steps))

        return advance, lambda: body.row(state.qvel[3:6].tolist(), state.qpos[3:7].tolist())

    return stepped(body, settings.step, start, remark(body, compiled_inertia(model), ""))


if __name__ == "__main__":
    answer(solve)
