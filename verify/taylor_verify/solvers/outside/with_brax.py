# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "brax==0.14.2",
#   "mujoco==3.17.0",
#   "mujoco-mjx==3.17.0",
#   "jax==0.10.2",
#   "jaxlib==0.10.2",
#   "numpy==2.4.6",
#   "scipy==1.17.1",
# ]
# [tool.taylor-verify]
# title = "Brax"
# models = ["euler"]
# rungs = ["f32", "f64"]
# loads = false
# data = "tensor"
# [tool.taylor-verify.methods]
# generalized = "generalized coordinates, as MuJoCo has them"
# spring = "impulses at the joints"
# positional = "positions by extended position-based dynamics"
# [tool.taylor-verify.settings]
# step = 0.002
# inertia = ["full", "principal"]
# ///
"""Brax: its three pipelines, in float32 as they come, or in float64. Its damping is zero as it comes.

The model is that of with_mujoco.py, compiled by MuJoCo in doubles. A stretch between two samples is one
compiled loop. A link has its attitude and its omega in space axes.
"""

from __future__ import annotations

from importlib import import_module
from types import SimpleNamespace
from typing import Any

from free_body import Engine, FreeBody, Settings, Solved, answer, stepped
from question import Row, unit
from with_mujoco import compiled_inertia, mjcf, remark

DOUBLE_BITS = 53
# Brax reads no model without one; it touches nothing, and the inertia is stated beside it.
GEOM = '<geom size="0.1" contype="0" conaffinity="0"/>'


def solve(body: FreeBody, settings: Settings) -> Solved:
    import jax

    jax.config.update("jax_enable_x64", body.question.bits == DOUBLE_BITS)
    import mujoco
    from brax.io import mjcf as reader
    from jax import numpy

    pipeline = import_module(f"brax.{settings.method}.pipeline")
    # The pipelines have one integrator each.
    asked = SimpleNamespace(**vars(settings), integrator="Euler")
    model = mujoco.MjModel.from_xml_string(mjcf(body, asked, GEOM))
    system = reader.load_model(model)
    no_actuators = numpy.zeros(0)

    def steps_of(state: Any, steps: Any) -> Any:
        def one(_: Any, now: Any) -> Any:
            return pipeline.step(system, now, no_actuators)

        return jax.lax.fori_loop(0, steps, one, state)

    stretch = jax.jit(steps_of)

    def start() -> Engine:
        places = numpy.array([0.0, 0.0, 0.0, *body.attitude])
        state = jax.jit(pipeline.init)(system, places, numpy.array([0.0, 0.0, 0.0, *body.omega]))

        def advance(steps: int) -> None:
            nonlocal state
            state = jax.block_until_ready(stretch(state, steps))

        def row() -> Row:
            attitude = unit(state.x.rot[0].tolist())
            return body.row_from_space(state.xd.ang[0].tolist(), attitude)

        return advance, row

    return stepped(body, settings.step, start, remark(body, compiled_inertia(model), ""))


if __name__ == "__main__":
    answer(solve)
