# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "mujoco==4.0.0",
#   "numpy==2.4.6",
# ]
# [tool.taylor-verify]
# title = "MuJoCo, a solid in a fluid"
# models = ["kirchhoff"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.methods]
# ellipsoid = "its own fluid model, by fluidshape"
# callback = "the exact load, by a passive force of ours"
# [tool.taylor-verify.settings]
# step = 0.002
# integrator = ["Euler", "implicit", "implicitfast", "RK4", "discrete"]
# ///
"""MuJoCo in a fluid: a body with a free joint, without gravity, contact, drag and lift.

`ellipsoid` is MuJoCo's own model of an ellipsoid in an ideal fluid: the density of the medium, and all
five coefficients of drag and lift zero. It has the forces of the added mass that go with the square
of velocities, and leaves out those that go with accelerations.

`callback` gives the whole load to MuJoCo's integrator: the body is a rigid sphere, and the passive
force is what makes its acceleration that of Kirchhoff's equations, under all that acts.

qvel[0:3] is the velocity in space axes, qvel[3:6] omega in body axes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from axes import conjugate, to_body
from equations import to_space
from free_body import Engine, Settings, Solved, answer, pushed_in_stages, stepped
from immersed_body import ImmersedBody, pushed_solid
from question import Unsuited, unit
from with_mujoco import require_integrator

Force = Callable[[Any, Any], None]


def solve(body: ImmersedBody, settings: Settings) -> Solved:
    import mujoco

    require_integrator(settings)
    sphere = mean(body.mass, 0), mean(body.mass, 3)
    if settings.method == "callback":
        m, j = sphere
        solid = f'<inertial pos="0 0 0" mass="{m!r}" diaginertia="{j!r} {j!r} {j!r}"/>'
        medium = 0.0
    else:
        solid, medium = ellipsoid(body), body.ellipsoid.fluid_density
    model = mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option timestep="{settings.step!r}" integrator="{settings.integrator}" gravity="0 0 0"
                  density="{medium!r}" viscosity="0"/>
          <worldbody><body><freejoint/>{solid}</body></worldbody>
        </mujoco>""")
    force = kirchhoff(body, *sphere) if settings.method == "callback" else None
    if force is None and body.is_pushed:
        raise Unsuited("expected a free ellipsoid, got loads that its fluid model lacks @ body")

    def start() -> Engine:
        mujoco.set_mjcb_passive(force)
        data = mujoco.MjData(model)
        data.qpos[:3], data.qpos[3:7] = body.centre, body.attitude
        data.qvel[:3], data.qvel[3:6] = body.velocity_in_space, body.omega
        mujoco.mj_forward(model, data)

        def row() -> Any:
            attitude = data.qpos[3:7]
            velocity = to_body(attitude, data.qvel[:3])
            return body.row(velocity, data.qvel[3:6], attitude, data.qpos[:3])

        return lambda steps: mujoco.mj_step(model, data, steps), row

    solved = stepped(body, settings.step, start, pushed_in_stages(body))
    mujoco.set_mjcb_passive(None)
    return solved


def mean(mass: Any, first: int) -> float:
    """Return the mean of three diagonal entries."""
    return float(sum(mass[i][i] for i in range(first, first + 3)) / 3)


def ellipsoid(body: ImmersedBody) -> str:
    """Return the geometry of which MuJoCo forms mass and added mass; raises Unsuited for other solids."""
    if body.ellipsoid is None:
        raise Unsuited("expected a homogeneous ellipsoid, got another solid @ body")
    axes = " ".join(map(repr, body.ellipsoid.semi_axes))
    return (
        f'<geom type="ellipsoid" size="{axes}" density="{body.ellipsoid.density!r}" '
        'contype="0" conaffinity="0" fluidshape="ellipsoid" fluidcoef="0 0 0 0 0"/>'
    )


def kirchhoff(body: ImmersedBody, mass: float, inertia: float) -> Force:
    """Return the passive force under which a sphere moves as the solid does."""
    import numpy

    energy = numpy.array(body.energy)

    def force(_: Any, data: Any) -> None:
        q, omega = unit(data.qpos[3:7]), data.qvel[3:6]
        # In floating point, because it is a part of each step.
        velocity = to_space(*conjugate(q), *data.qvel[:3])
        wrench = [0.0] * 6
        if body.is_pushed:
            wrench = body.wrench(velocity, omega, q, data.qpos[:3], data.time)
        rates = body.rates(velocity, omega, wrench)
        acceleration, angular = (energy @ rates).reshape(2, 3)
        # The velocity of the engine stands in space axes, which turn against the body.
        linear = mass * (acceleration + numpy.cross(omega, velocity))
        data.qfrc_passive[:3] = to_space(*q, *linear)
        data.qfrc_passive[3:6] = inertia * angular

    return force


if __name__ == "__main__":
    answer(solve, pushed_solid)
