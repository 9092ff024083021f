# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["motrixsim==0.10.1", "numpy==2.4.6"]
# [tool.taylor-verify]
# title = "MotrixSim"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# rungs = ["f32"]
# [tool.taylor-verify.settings]
# step = 0.01
# ///
"""MotrixSim: a body on a floating base, a full tensor, in float32, without gravity.

The model is MuJoCo's format, which it reads. Omega is taken in body axes, the quaternion scalar last. What
acts is an external torque, set before a step and held over it. There is no damping, no sleep and no
cap to switch off.
"""

from __future__ import annotations

from typing import Any

from free_body import (
    Engine,
    FreeBody,
    Settings,
    Solved,
    answer,
    pushed_body,
    pushed_once,
    repeated,
    stepped,
)


def solve(body: FreeBody, settings: Settings) -> Solved:
    import motrixsim
    import numpy

    model = motrixsim.load_mjcf_str(mjcf(body, settings.step))
    base, link = model.floating_bases[0], model.get_link("solid")
    w, x, y, z = body.attitude

    def start() -> Engine:
        data = motrixsim.SceneData(model)
        base.set_rotation(data, numpy.array([x, y, z, w], dtype=numpy.float32))
        base.set_local_angular_velocity(data, numpy.array(body.omega, dtype=numpy.float32))
        model.forward_kinematic(data)

        def state() -> Any:
            x, y, z, w = map(float, base.get_rotation(data))
            return base.get_local_angular_velocity(data), (w, x, y, z)

        def pushed_step() -> None:
            moment = numpy.array(body.moment(*state()), dtype=numpy.float32)
            link.add_external_torque(data, moment, local=True)
            model.step(data)

        advance = repeated(pushed_step if body.is_pushed else lambda: model.step(data))
        return advance, lambda: body.row(*state())

    return stepped(body, settings.step, start, pushed_once(body))


def mjcf(body: FreeBody, step: float) -> str:
    (a, d, e), (_, b, f), (_, _, c) = body.inertia
    tensor = " ".join(map(repr, (a, b, c, d, e, f)))
    return f"""
        <mujoco>
          <option timestep="{step!r}" gravity="0 0 0"/>
          <worldbody><body name="solid">
            <freejoint/><inertial pos="0 0 0" mass="1" fullinertia="{tensor}"/>
          </body></worldbody>
        </mujoco>"""


if __name__ == "__main__":
    answer(solve, pushed_body)
