# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "mujoco==4.0.0",
#   "numpy==2.4.6",
# ]
# [tool.taylor-verify]
# title = "MuJoCo"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.settings]
# step = 0.002
# integrator = ["Euler", "implicit", "implicitfast", "RK4", "discrete"]
# inertia = ["full", "principal"]
# given = ["per-stage", "per-step"]
# ///
"""MuJoCo: a body with a free joint, without gravity, geometry and damping.

`inertia=full` hands over the tensor as `fullinertia`, and MuJoCo's compiler finds the principal axes.
`inertia=principal` hands over ours, as `diaginertia` and `quat`, and tells the compiler's error from
that of the integrator. The remark says how far the compiled tensor is from the one that was given.
What acts on the body is a passive force with `given=per-stage`, which MuJoCo asks for in each stage of a
step; with `given=per-step` it is an applied one, set before a step and held over it.

qvel[3:6] is omega in body axes, qpos[3:7] the attitude, scalar first.
"""

from __future__ import annotations

from typing import Any

from axes import principal
from free_body import (
    Engine,
    FreeBody,
    Settings,
    Solved,
    answer,
    pushed_body,
    pushed_in_stages,
    pushed_once,
    repeated,
    stepped,
)


def solve(body: FreeBody, settings: Settings) -> Solved:
    import mujoco

    require_integrator(settings)
    model = mujoco.MjModel.from_xml_string(mjcf(body, settings))

    pushed_in_steps = body.is_pushed and settings.given == "per-step"
    pushed_in_calls = body.is_pushed and not pushed_in_steps

    def push(model: Any, data: Any) -> None:
        data.qfrc_passive[3:6] = body.moment(data.qvel[3:6], data.qpos[3:7], data.time)

    def start() -> Engine:
        data = mujoco.MjData(model)
        data.qpos[3:7] = body.attitude
        data.qvel[3:6] = body.omega
        mujoco.set_mjcb_passive(push if pushed_in_calls else None)
        mujoco.mj_forward(model, data)

        def pushed_step() -> None:
            data.qfrc_applied[3:6] = body.moment(data.qvel[3:6], data.qpos[3:7])
            mujoco.mj_step(model, data)

        return (
            repeated(pushed_step)
            if pushed_in_steps
            else lambda steps: mujoco.mj_step(model, data, steps),
            lambda: body.row(data.qvel[3:6], data.qpos[3:7]),
        )

    pushed = pushed_once(body) if pushed_in_steps else pushed_in_stages(body)
    try:
        return stepped(body, settings.step, start, remark(body, compiled_inertia(model), pushed))
    finally:
        mujoco.set_mjcb_passive(None)


def require_integrator(settings: Settings) -> None:
    """Exit with a sentence where this version of MuJoCo has no such integrator."""
    import mujoco

    if not hasattr(mujoco.mjtIntegrator, f"mjINT_{settings.integrator.upper()}"):
        have = f"MuJoCo {mujoco.__version__}"
        raise SystemExit(
            f"expected an integrator of {have}, got {settings.integrator} @ integrator"
        )


def mjcf(body: FreeBody, settings: Settings, geom: str = "") -> str:
    """Return the model in MuJoCo's own format; repr of a double is read back as that double."""
    (a, d, e), (_, b, f), (_, _, c) = body.inertia
    inertia = f'fullinertia="{numbers([a, b, c, d, e, f])}"'
    if settings.inertia == "principal":
        moments, turn = principal(body.inertia)
        inertia = f'diaginertia="{numbers(moments)}" quat="{numbers(turn)}"'
    return f"""
        <mujoco>
          <option timestep="{settings.step!r}" integrator="{settings.integrator}" gravity="0 0 0"/>
          <worldbody><body>
            <freejoint/>
            <inertial pos="0 0 0" mass="1" {inertia}/>
            {geom}
          </body></worldbody>
        </mujoco>"""


def numbers(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)


def compiled_inertia(model: Any) -> list[list[float]]:
    """Return the tensor in body axes that the compiler has made of the one in the model."""
    import mujoco
    import numpy

    axes = numpy.zeros(9)
    mujoco.mju_quat2Mat(axes, model.body_iquat[1])
    R = axes.reshape(3, 3)
    tensor: list[list[float]] = (R @ numpy.diag(model.body_inertia[1]) @ R.T).tolist()
    return tensor


def remark(body: FreeBody, compiled: list[list[float]], pushed: str) -> str:
    """Return a sentence on how far the compiled tensor is from the one that was given."""
    given = [entry for row in body.inertia for entry in row]
    has = [entry for row in compiled for entry in row]
    error = max(abs(a - b) for a, b in zip(given, has, strict=True)) / max(map(abs, given))
    compiling = f"the compiled inertia is off by {error:.1e} of its largest entry"
    return "; ".join(filter(None, (compiling, pushed)))


if __name__ == "__main__":
    answer(solve, pushed_body)
