# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "exudyn==1.13.6",
#   "numpy==2.4.6",
# ]
# [tool.taylor-verify]
# title = "Exudyn"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.settings]
# integrator = [
#   "GeneralizedAlpha", "TrapezoidalIndex2", "RK44", "RK67", "DOPRI5", "RK33", "ODE23",
#   "ExplicitMidpoint", "ExplicitEuler", "VelocityVerlet",
# ]
# coordinates = ["RotationVector", "EulerParameters", "Rxyz"]
# step = 0.01
# ///
"""Exudyn: a rigid body with a full tensor, on SO(3) by Lie group integration or by coordinates, in doubles.

GeneralizedAlpha is what Exudyn takes where nothing is set. With the coordinates RotationVector every
integrator works on the group; the explicit ones refuse EulerParameters, which have a constraint. The
two with an error estimate, DOPRI5 and ODE23, take the given step too: their tolerances are lifted. There
is no damping, no sleep and no cap to switch off. The start is the reference configuration: in 1.13.6 an
``initialRotationMatrix`` makes another omega of the one that is given. One run has all samples, as
sensors, because to go on after a stop begins GeneralizedAlpha anew. What acts on the body is the user
function of a torque in body axes, which is asked for in each stage of a step. GeneralizedAlpha carries its
accelerations over a jump of the torque, and has order 1 there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from free_body import FreeBody, Settings, Solved, answer, pushed_body, pushed_in_stages
from question import Unsuited, twice

IMPLICIT = ("GeneralizedAlpha", "TrapezoidalIndex2")
# Larger than any error: no step is refused or divided.
NO_TOLERANCE = 1e30


def solve(body: FreeBody, settings: Settings) -> Solved:
    if settings.coordinates == "EulerParameters" and settings.integrator not in IMPLICIT:
        raise Unsuited(
            f"expected {' or '.join(IMPLICIT)} with EulerParameters, "
            f"got {settings.integrator} @ integrator"
        )
    import exudyn

    counts = body.steps(settings.step)
    # The longest time between two records that meets all samples.
    every = math.gcd(*counts)
    # A container keeps the system that is in it.
    container = exudyn.SystemContainer()
    system, sensors = system_of(container, body, f"Rotation{settings.coordinates}")
    solver = getattr(exudyn.DynamicSolverType, settings.integrator)
    asked = simulation_settings(settings.step, counts[-1], every)
    if body.is_pushed:
        pushed = Pushed(body, system, settings.step)
        _, seconds, more = twice(
            lambda: pushed.solve(lambda: system.SolveDynamic(asked, solverType=solver))
        )
        return Solved(
            [pushed.of[count] for count in counts],
            counts[-1],
            evaluations=0,
            seconds=seconds,
            compile_seconds=more,
            remark=pushed_in_stages(body),
        )
    _, seconds, more = twice(lambda: system.SolveDynamic(asked, solverType=solver))
    omegas, matrices = (system.GetSensorStoredData(sensor) for sensor in sensors)
    rows = []
    for instant, count in zip(body.instants, counts, strict=True):
        time, *omega = omegas[count // every]
        if not abs(time - instant) <= 1e-6 * settings.step:
            raise SystemExit(f"Exudyn: expected a record at t = {instant!r}, got {time!r}")
        rows.append(body.row(omega, quaternion(matrices[count // every][1:])))
    return Solved(rows, counts[-1], evaluations=0, seconds=seconds, compile_seconds=more)


class Pushed:
    """A torque on the body by what acts on it, and the rows ``of`` each number of steps."""

    def __init__(self, body: FreeBody, system: Any, step: float) -> None:
        self._body, self._system, self._step = body, system, step
        self.of: list[Any] = []
        system.CreateTorque(
            bodyNumber=0, bodyFixed=True, loadVectorUserFunction=lambda _, t, __: self._moment(t)
        )
        system.SetPreStepUserFunction(lambda _, __: self._before_step())
        system.Assemble()

    def solve(self, go: Callable[[], Any]) -> None:
        self.of = []
        self._body.begin()
        go()
        self._before_step()

    def _before_step(self) -> bool:
        state = self._state()
        self._body.row(*state)
        self._body.goes_on(len(self.of), self._step)
        self.of.append(self._body.row(*state))
        return True

    def _moment(self, t: float) -> list[float]:
        return list(self._body.moment(*self._state(), t))

    def _state(self) -> tuple[list[float], list[float]]:
        import exudyn

        shown = exudyn.OutputVariableType
        outputs = (shown.AngularVelocityLocal, shown.RotationMatrix)
        omega, matrix = (self._system.GetNodeOutput(0, output) for output in outputs)
        return list(omega), quaternion(matrix.ravel() if hasattr(matrix, "ravel") else matrix)


def system_of(container: Any, body: FreeBody, node: str) -> tuple[Any, tuple[Any, Any]]:
    """Return the system and its sensors of omega in body axes and of the rotation matrix."""
    import exudyn
    import numpy
    from exudyn import utilities

    system = container.AddSystem()
    made = system.CreateRigidBody(
        inertia=utilities.RigidBodyInertia(mass=1.0, inertiaTensor=numpy.array(body.inertia)),
        referenceRotationMatrix=utilities.EulerParameters2RotationMatrix(body.attitude),
        initialAngularVelocity=list(body.omega_in_space),
        nodeType=getattr(exudyn.NodeType, node),
        returnDict=True,
    )
    shown = exudyn.OutputVariableType
    sensors = [
        system.AddSensor(
            utilities.SensorNode(
                nodeNumber=made["nodeNumber"], storeInternal=True, outputVariableType=output
            )
        )
        for output in (shown.AngularVelocityLocal, shown.RotationMatrix)
    ]
    system.Assemble()
    return system, (sensors[0], sensors[1])


def simulation_settings(step: float, steps: int, every: int) -> Any:
    import exudyn

    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = steps * step
    settings.timeIntegration.automaticStepSize = False
    settings.timeIntegration.adaptiveStep = False
    settings.timeIntegration.absoluteTolerance = NO_TOLERANCE
    settings.timeIntegration.relativeTolerance = NO_TOLERANCE
    if hasattr(settings, "solution"):
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = every * step
    else:
        # The names before 1.13.
        settings.solutionSettings.writeSolutionToFile = False
        settings.solutionSettings.sensorsWritePeriod = every * step
    return settings


def quaternion(matrix: Any) -> list[float]:
    from exudyn import utilities

    return list(utilities.RotationMatrix2EulerParameters([matrix[i : i + 3] for i in (0, 3, 6)]))


if __name__ == "__main__":
    answer(solve, pushed_body)
