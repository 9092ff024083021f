# /// script
# requires-python = ">=3.11"
# dependencies = ["exudyn==1.10.0", "numpy>=2"]
# ///
"""Before 1.11.0 the implicit Lie group integrators turn the attitude with twice the error.

Versions: Exudyn 1.10.0 and before; mended in 1.11.0.

Expected: the rotation of a free body by the settings as they ship is the best that they offer.

Came: the rotation of GeneralizedAlpha and of TrapezoidalIndex2 is off by twice as much as it has to be. In
1.10.0 `lieGroupSimplifiedKinematicRelations`, False as shipped, has the smaller error where it is True;
since 1.11.0 where it is False. The angular velocity is the same in all versions.

Evidence: the tracker log (docs/RST/trackerlog.rst, 1.10.6, issue 2142) improves the implicit Lie group
integrator where that setting is False. In main/src/Solver/CSolverImplicitSecondOrder.cpp the question
`!(useLieGroupIntegration && lieGroupSimplifiedKinematicRelations)` has become `!(useLieGroupIntegration &&
!lieGroupSimplifiedKinematicRelations)`: https://github.com/jgerstmayr/EXUDYN, commit e44aca1b. In 1.9.0 and
before the setting does nothing, or is not there.
"""

import sys

import exudyn
import numpy as np
from exudyn import utilities


def rotation(solver, step, simplified=None):
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    node = system.CreateRigidBody(
        inertia=utilities.RigidBodyInertia(1.0, np.diag([1.2, 2.1, 2.7])),
        initialAngularVelocity=[0.9, -0.3, 0.5],
        nodeType=exudyn.NodeType.RotationRotationVector,
        returnDict=True,
    )["nodeNumber"]
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = round(5 / step), 5
    settings.timeIntegration.newton.relativeTolerance = 1e-12
    if hasattr(settings, "solution"):
        settings.solution.file.write = False
    else:  # before 1.13
        settings.solutionSettings.writeSolutionToFile = False
    if simplified is not None:
        alpha = settings.timeIntegration.generalizedAlpha
        alpha.lieGroupSimplifiedKinematicRelations = simplified
    system.SolveDynamic(settings, solverType=getattr(exudyn.DynamicSolverType, solver))
    return np.array(system.GetNodeOutput(node, exudyn.OutputVariableType.RotationMatrix))


best, ratios = rotation("RK67", 0.001), []
for solver in ("GeneralizedAlpha", "TrapezoidalIndex2"):
    shipped, old, new = (
        np.abs(rotation(solver, 0.01, each) - best).max() for each in (None, True, False)
    )
    print(f"{solver}: as shipped off by {shipped:.3e}; simplified {old:.3e}, not {new:.3e}")
    ratios.append(shipped / min(old, new))
sys.exit(1 if max(ratios) > 1.5 else 0)
