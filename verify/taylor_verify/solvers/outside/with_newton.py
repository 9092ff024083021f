# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["newton==1.8.0", "numpy==2.4.6"]
# [tool.taylor-verify]
# title = "Newton"
# models = ["euler"]
# rungs = ["f32"]
# loads = false
# data = "tensor"
# [tool.taylor-verify.settings]
# step = 0.01
# solver = ["XPBD", "SemiImplicit", "Featherstone"]
# defaults = ["off", "shipped"]
# ///
"""Newton, on the processor, in float32: a body with a full tensor, without gravity.

`defaults=off` sets the angular damping of a solver to zero; `SemiImplicit` and `Featherstone` ship with
0.05. Warp compiles the kernels of a solver in its first run, which takes minutes, and keeps them. Omega
is in space axes, the quaternion scalar last. There is no sleep and no cap.
"""

from __future__ import annotations

from typing import Any

from free_body import Engine, FreeBody, Settings, Solved, answer, repeated, stepped


def solve(body: FreeBody, settings: Settings) -> Solved:
    import newton
    import numpy
    import warp

    warp.config.quiet = True
    model = model_of(body)
    undamped = {"angular_damping": 0.0} if settings.defaults == "off" else {}

    def start() -> Engine:
        solver = getattr(newton.solvers, f"Solver{settings.solver}")(model, **undamped)
        states = [model.state(), model.state()]
        moving = numpy.array([[0.0, 0.0, 0.0, *body.omega_in_space]], dtype=numpy.float32)
        states[0].body_qd.assign(moving)
        newton.eval_ik(model, states[0], states[0].joint_q, states[0].joint_qd)
        control = model.control()

        def step() -> None:
            states[0].clear_forces()
            solver.step(states[0], states[1], control, None, settings.step)
            states.reverse()

        def row() -> Any:
            x, y, z, w = states[0].body_q.numpy()[0][3:7]
            return body.row_from_space(states[0].body_qd.numpy()[0][3:6], (w, x, y, z))

        return repeated(step), row

    return stepped(body, settings.step, start)


def model_of(body: FreeBody) -> Any:
    import newton
    import warp

    w, x, y, z = body.attitude
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    place = warp.transform(warp.vec3(0.0, 0.0, 0.0), warp.quat(x, y, z, w))
    tensor = warp.mat33(*(entry for row in body.inertia for entry in row))
    builder.add_body(xform=place, mass=1.0, inertia=tensor, lock_inertia=True)
    return builder.finalize(device="cpu")


if __name__ == "__main__":
    answer(solve)
