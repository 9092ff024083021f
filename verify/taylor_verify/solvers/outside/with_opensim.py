# /// script
# requires-python = ">=3.11,<3.14"
# dependencies = ["opensim==4.6", "numpy==2.4.6"]
# [tool.taylor-verify]
# title = "Simbody, by OpenSim"
# models = ["euler"]
# loads = false
# data = "tensor"
# [tool.taylor-verify.settings]
# step = 0.01
# integrator = [
#   "RungeKuttaMerson", "ExplicitEuler", "RungeKutta2", "RungeKutta3", "RungeKuttaFeldberg",
#   "SemiExplicitEuler2", "Verlet",
# ]
# ///
"""Simbody, by OpenSim: a body on a free joint, a full tensor, in doubles, with a fixed step.

The coordinates of the joint are angles about the axes x, y, z of the body, so that a motion near a turn
of 90 degrees about y loses digits. Omega and the attitude are read in space axes. There is no damping,
no sleep and no cap to switch off. There is no wheel beyond Python 3.13.
"""

from __future__ import annotations

from typing import Any

from free_body import Engine, FreeBody, Settings, Solved, answer, stepped


def solve(body: FreeBody, settings: Settings) -> Solved:
    import opensim

    opensim.Logger.setLevelString("error")

    def start() -> Engine:
        model, solid, state = model_of(body)
        manager = opensim.Manager(model)
        method = getattr(opensim.Manager, f"IntegratorMethod_{settings.integrator}")
        manager.setIntegratorMethod(method)
        manager.setIntegratorFixedStepSize(settings.step)
        manager.setWriteToStorage(False)
        manager.initialize(state)
        done = 0

        def advance(steps: int) -> None:
            nonlocal done, state
            done += steps
            state = manager.integrate(done * settings.step)

        def row() -> Any:
            model.realizeVelocity(state)
            turn = solid.getTransformInGround(state).R().convertRotationToQuaternion()
            omega = solid.getAngularVelocityInGround(state)
            return body.row_from_space(
                [omega.get(i) for i in range(3)], [turn.get(i) for i in range(4)]
            )

        return advance, row

    return stepped(body, settings.step, start)


def model_of(body: FreeBody) -> tuple[Any, Any, Any]:
    """Return the model, its body and its state at the start."""
    import numpy
    import opensim

    (a, d, e), (_, b, f), (_, _, c) = body.inertia
    model = opensim.Model()
    model.setGravity(opensim.Vec3(0.0))
    tensor = opensim.Inertia(a, b, c, d, e, f)
    solid = opensim.Body("solid", 1.0, opensim.Vec3(0.0), tensor)
    joint = opensim.FreeJoint("joint", model.getGround(), solid)
    model.addBody(solid)
    model.addJoint(joint)
    state = model.initSystem()
    turn = opensim.Rotation(opensim.Quaternion(*body.attitude))
    angles = turn.convertRotationToBodyFixedXYZ()
    for k in range(3):
        joint.get_coordinates(k).setValue(state, angles.get(k))

    def omega_of(speeds: Any) -> list[float]:
        for k, speed in enumerate(speeds):
            joint.get_coordinates(k).setSpeedValue(state, float(speed))
        model.realizeVelocity(state)
        omega = solid.getAngularVelocityInGround(state)
        return [omega.get(i) for i in range(3)]

    # The speeds of the joint are whatever makes this omega.
    rates = numpy.array([omega_of(row) for row in numpy.eye(3)]).T
    omega_of(numpy.linalg.solve(rates, body.omega_in_space))
    return model, solid, state


if __name__ == "__main__":
    answer(solve)
