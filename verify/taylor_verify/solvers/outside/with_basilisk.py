# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["bsk==2.12.1"]
# [tool.taylor-verify]
# title = "Basilisk"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.settings]
# integrator = ["RK4", "Euler", "RK2", "RKF45", "RKF78"]
# step = 0.01
# defaults = ["off", "shipped"]
# ///
"""Basilisk's spacecraft: a hub with a full tensor, attitude by modified Rodrigues parameters, in doubles.

RK4 is what Basilisk takes where nothing is set. RKF45 and RKF78 divide a step whose estimated error is
above their tolerances, 1e-4 relative and 1e-8 absolute with ``defaults=shipped``; else these are lifted,
and each step is as long as asked. Both go on with the lower order of their pair, 4 and 7. Time is
counted in whole nanoseconds. There is no damping, no sleep and no cap to switch off. What acts on the
body is an external torque, set before a step and held over it.
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
    stepped,
)

SECOND = 10**9
ADAPTIVE = ("RKF45", "RKF78")
# Larger than any error: no step is divided.
NO_TOLERANCE = 1e30


def solve(body: FreeBody, settings: Settings) -> Solved:
    step = nanoseconds(settings.step)

    def start() -> Engine:
        simulation, craft, torque = spacecraft_of(body, settings, step)
        clock = 0

        def advance(steps: int) -> None:
            nonlocal clock
            clock += steps * step
            if body.is_pushed:
                state = craft.scStateOutMsg.read()
                moment = body.moment(state.omega_BN_B, quaternion(state.sigma_BN))
                torque.extTorquePntB_B = [[entry] for entry in moment]
            simulation.ConfigureStopTime(clock)
            simulation.ExecuteSimulation()

        def row() -> Any:
            state = craft.scStateOutMsg.read()
            return body.row(state.omega_BN_B, quaternion(state.sigma_BN))

        return advance, row

    return stepped(body, settings.step, start, pushed_once(body))


def nanoseconds(step: float) -> int:
    """Return the step in nanoseconds; exit with a sentence where it is no whole number of them."""
    count = round(step * SECOND)
    # A decimal step is rounded once, and its product once more.
    if not abs(step * SECOND - count) <= 2.0**-51 * count:
        raise SystemExit(f"Basilisk: expected a step of whole nanoseconds, got {step!r} @ step")
    return count


def spacecraft_of(body: FreeBody, settings: Settings, step: int) -> tuple[Any, Any, Any]:
    from Basilisk.simulation import extForceTorque, spacecraft, svIntegrators
    from Basilisk.utilities import SimulationBaseClass

    simulation = SimulationBaseClass.SimBaseClass()
    simulation.CreateNewProcess("process").addTask(simulation.CreateNewTask("task", step))
    craft = spacecraft.Spacecraft()
    craft.hub.mHub = 1.0
    craft.hub.r_BcB_B = [[0.0], [0.0], [0.0]]
    craft.hub.IHubPntBc_B = [list(row) for row in body.inertia]
    craft.hub.omega_BN_BInit = [[w] for w in body.omega]
    craft.hub.sigma_BNInit = [[s] for s in rodrigues(body.attitude)]
    integrator = getattr(svIntegrators, f"svIntegrator{settings.integrator}")(craft)
    if settings.integrator in ADAPTIVE and settings.defaults == "off":
        integrator.absTol = NO_TOLERANCE
    craft.setIntegrator(integrator)
    # Older versions lose an integrator that nobody else holds.
    simulation.integrator = integrator
    torque = extForceTorque.ExtForceTorque()
    craft.addDynamicEffector(torque)
    simulation.AddModelToTask("task", craft)
    simulation.AddModelToTask("task", torque)
    simulation.InitializeSimulation()
    return simulation, craft, torque


def rodrigues(q: Any) -> list[float]:
    """Return the modified Rodrigues parameters, those of the two that are at most 1 long."""
    sign = -1.0 if q[0] < 0 else 1.0
    return [sign * entry / (1.0 + abs(q[0])) for entry in q[1:]]


def quaternion(sigma: Any) -> list[float]:
    square = sum(s * s for s in sigma)
    return [(1.0 - square) / (1.0 + square), *(2.0 * s / (1.0 + square) for s in sigma)]


if __name__ == "__main__":
    answer(solve, pushed_body)
