# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "drake==1.51.1",
#   "numpy==2.4.6",
# ]
# [tool.taylor-verify]
# title = "Drake"
# models = ["euler"]
# loads = false
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
reads a rotation of it as if it were unit: so do we. Velocities are in space axes.
"""

from __future__ import annotations

from free_body import Engine, FreeBody, Settings, Solved, answer, stepped
from question import Row, unit


def solve(body: FreeBody, settings: Settings) -> Solved:
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import SpatialInertia, UnitInertia
    from pydrake.systems.analysis import (
        InitializeParams,
        ResetIntegratorFromFlags,
        Simulator,
    )

    is_discrete = settings.integrator == "discrete"
    plant = MultibodyPlant(time_step=settings.step if is_discrete else 0.0)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
    (a, d, e), (_, b, f), (_, _, c) = body.inertia
    inertia = SpatialInertia(1.0, [0, 0, 0], UnitInertia(a, b, c, d, e, f))
    plant.AddRigidBody("body", inertia)
    plant.Finalize()

    def start() -> Engine:
        simulator = Simulator(plant)
        context = simulator.get_mutable_context()
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

    return stepped(body, settings.step, start)


if __name__ == "__main__":
    answer(solve)
