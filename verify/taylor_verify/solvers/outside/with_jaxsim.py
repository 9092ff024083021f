# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["jaxsim==0.9.0", "jax==0.10.2", "numpy==2.4.6"]
# [tool.uv]
# no-binary-package = ["pptree"]
# [tool.taylor-verify]
# title = "JaxSim"
# models = ["euler"]
# loads = false
# data = "tensor"
# [tool.taylor-verify.settings]
# integrator = ["SemiImplicitEuler", "RungeKutta4"]
# step = 0.001
# ///
"""JaxSim: a body of one link, a full tensor, in float64, without gravity.

A stretch between two samples is one compiled loop. Omega is in body axes, the quaternion scalar first.
There is no damping, no sleep and no cap to switch off. The body is described as SDF. Its third integrator,
RungeKutta4Fast, ends with an exception for a body without joints.
"""

from __future__ import annotations

from typing import Any

from free_body import Engine, FreeBody, Settings, Solved, answer, stepped

SDF = """<sdf version="1.7"><model name="body"><link name="body"><inertial><mass>1</mass><inertia>
<ixx>{!r}</ixx><iyy>{!r}</iyy><izz>{!r}</izz><ixy>{!r}</ixy><ixz>{!r}</ixz><iyz>{!r}</iyz>
</inertia></inertial></link></model></sdf>"""


def solve(body: FreeBody, settings: Settings) -> Solved:
    import jax

    jax.config.update("jax_enable_x64", True)  # noqa: FBT003 (JAX takes it by position)
    import jaxsim
    from jaxsim.api.data import JaxSimModelData
    from jaxsim.api.model import step

    model = model_of(body, settings)

    def steps_of(state: Any, steps: Any) -> Any:
        return jax.lax.fori_loop(0, steps, lambda _, now: step(model, now), state)

    stretch = jax.jit(steps_of)

    def start() -> Engine:
        state = JaxSimModelData.build(
            model,
            base_quaternion=jax.numpy.array(body.attitude),
            base_angular_velocity=jax.numpy.array(body.omega),
            velocity_representation=jaxsim.VelRepr.Body,
        )

        def advance(steps: int) -> None:
            nonlocal state
            state = jax.block_until_ready(stretch(state, steps))

        def row() -> Any:
            return body.row(state.base_velocity[3:].tolist(), state.base_quaternion.tolist())

        return advance, row

    return stepped(body, settings.step, start)


def model_of(body: FreeBody, settings: Settings) -> Any:
    import rod
    from jaxsim.api.model import IntegratorType, JaxSimModel

    (a, d, e), (_, b, f), (_, _, c) = body.inertia
    described = rod.Sdf.load(SDF.format(a, b, c, d, e, f), is_urdf=False)
    return JaxSimModel.build_from_model_description(
        described.models()[0],
        time_step=settings.step,
        integrator=IntegratorType[settings.integrator],
        gravity=0.0,
    )


if __name__ == "__main__":
    answer(solve)
