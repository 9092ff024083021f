# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "drake==1.51.1",
#   "numpy==2.4.6",
# ]
# [tool.taylor-verify]
# title = "Drake"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.settings]
# step = 0.001
# integrator = [
#   "discrete",
#   "runge_kutta2",
#   "runge_kutta3",
#   "runge_kutta5",
#   "bogacki_shampine3",
#   "explicit_euler",
#   "semi_explicit_euler",
#   "implicit_euler",
#   "velocity_implicit_euler",
#   "radau1",
#   "radau3",
# ]
# ///
"""Drake: a floating body without gravity, in a discrete plant or by an integrator with a fixed step.

`integrator=discrete` is a plant with a time step, which contact needs; any other is a continuous plant
under that scheme, its error control off. Drake does not normalise the quaternion of its state, and
reads a rotation of it as if it were unit: so do we. Velocities are in space axes. What acts on the body
enters by a port of the plant: each stage of an integrator asks for it, and a discrete plant once a step.
"""

from __future__ import annotations

from typing import Any

from axes import to_body, to_space
from free_body import (
    Engine,
    FreeBody,
    Settings,
    Solved,
    answer,
    pushed_body,
    pushed_in_stages,
    pushed_once,
    stepped,
)
from question import Row, unit


def solve(body: FreeBody, settings: Settings) -> Solved:
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import SpatialInertia, UnitInertia
    from pydrake.systems.analysis import (
        InitializeParams,
        ResetIntegratorFromFlags,
        Simulator,
    )
    from pydrake.systems.framework import DiagramBuilder

    is_discrete = settings.integrator == "discrete"
    builder = DiagramBuilder()
    plant = builder.AddSystem(MultibodyPlant(time_step=settings.step if is_discrete else 0.0))
    plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
    (a, d, e), (_, b, f), (_, _, c) = body.inertia
    inertia = SpatialInertia(1.0, [0, 0, 0], UnitInertia(a, b, c, d, e, f))
    plant.AddRigidBody("body", inertia)
    plant.Finalize()
    if body.is_pushed:
        pushed(builder, plant, body)
    diagram = builder.Build()

    def start() -> Engine:
        simulator = Simulator(diagram)
        context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
        plant.SetPositions(context, [*body.attitude, 0, 0, 0])
        plant.SetVelocities(context, [*body.omega_in_space, 0, 0, 0])
        if not is_discrete:
            ResetIntegratorFromFlags(simulator, settings.integrator, settings.step)
            simulator.get_mutable_integrator().set_fixed_step_mode(True)
        # A discrete plant would make its first step on initialization.
        simulator.Initialize(InitializeParams(suppress_initialization_events=True))
        done = 0

        def advance(steps: int) -> None:
            nonlocal done
            done += steps
            simulator.AdvanceTo(done * settings.step)

        def row() -> Row:
            attitude = unit(plant.GetPositions(context)[:4])
            return body.row_from_space(plant.GetVelocities(context)[:3], attitude)

        return advance, row

    remark = pushed_once(body) if is_discrete else pushed_in_stages(body)
    return stepped(body, settings.step, start, remark)


def pushed(builder: Any, plant: Any, body: FreeBody) -> None:
    """Connect a system that has the moment on the body as its output."""
    from pydrake.common.value import Value
    from pydrake.multibody.math import SpatialForce
    from pydrake.multibody.plant import ExternallyAppliedSpatialForce
    from pydrake.systems.framework import LeafSystem

    class Push(LeafSystem):
        def __init__(self) -> None:
            super().__init__()
            self.DeclareVectorInputPort("state", 13)
            output = self.DeclareAbstractOutputPort(
                "forces", lambda: Value[list[ExternallyAppliedSpatialForce]](), self.push
            )
            self.output = output

        def push(self, context: Any, output: Any) -> None:
            state = self.get_input_port().Eval(context)
            attitude, omega = unit(state[:4]), state[7:10]
            force = ExternallyAppliedSpatialForce()
            force.body_index = plant.GetBodyByName("body").index()
            moment = body.moment(to_body(attitude, omega), attitude, context.get_time())
            force.F_Bq_W = SpatialForce(to_space(attitude, moment), [0, 0, 0])
            output.set_value([force])

    push = builder.AddSystem(Push())
    builder.Connect(plant.get_state_output_port(), push.get_input_port())
    builder.Connect(push.get_output_port(), plant.get_applied_spatial_force_input_port())


if __name__ == "__main__":
    answer(solve, pushed_body)
