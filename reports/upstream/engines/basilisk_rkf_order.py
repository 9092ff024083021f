# /// script
# requires-python = ">=3.11"
# dependencies = ["bsk==2.12.1", "numpy>=2"]
# ///
"""RKF45 and RKF78 go on with the lower order of their pair.

Versions: Basilisk 2.12.1.

Expected: order 5 and 8. `RKAdaptiveCoefficients` says that `bStarArray` is of the higher order, and
`integrate` goes on with the states that it makes, `highOrderNextStep`.

Came: order 4 and 7, with tolerances that divide no step. (The comment on the class RKF45 says order 4.)

Evidence: `bStarArray` has Fehlberg's weights of order 4 (25/216, 1408/2565, ...) in svIntegratorRKF45.cpp,
and of order 7 (41/840 at the stages 0 and 10) in svIntegratorRKF78.cpp; `bArray` has the higher ones.
https://github.com/AVSLab/basilisk/tree/babdff7a60ae9654f269059f28d83c604ed8c5ad/src/simulation/dynamics
"""

import sys

import numpy as np
from Basilisk.simulation import spacecraft, svIntegrators
from Basilisk.utilities import SimulationBaseClass


def omega(integrator, step, end=10):
    simulation = SimulationBaseClass.SimBaseClass()
    simulation.CreateNewProcess("p").addTask(simulation.CreateNewTask("t", round(step * 1e9)))
    craft = spacecraft.Spacecraft()
    craft.hub.mHub, craft.hub.IHubPntBc_B = 1.0, [[1.2, 0, 0], [0, 2.1, 0], [0, 0, 2.7]]
    craft.hub.omega_BN_BInit = [[0.9], [-0.3], [0.5]]
    method = getattr(svIntegrators, f"svIntegrator{integrator}")(craft)
    method.absTol = 1e30
    craft.setIntegrator(method)
    simulation.AddModelToTask("t", craft)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(end * 10**9)
    simulation.ExecuteSimulation()
    return np.array(craft.scStateOutMsg.read().omega_BN_B)


closest = omega("RKF78", 1 / 64)
orders = []
for name, step, expected in (("RKF45", 1 / 8, 5), ("RKF78", 1 / 2, 8)):
    errors = [np.abs(omega(name, h) - closest).max() for h in (step, step / 2)]
    orders.append(expected - np.log2(errors[0] / errors[1]))
    print(f"{name}  expected order {expected}, got {expected - orders[-1]:.2f}, errors {errors}")
sys.exit(1 if max(orders) > 0.5 else 0)
