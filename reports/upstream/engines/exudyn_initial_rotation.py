# /// script
# requires-python = ">=3.11"
# dependencies = ["exudyn==1.13.6", "numpy>=2"]
# ///
"""`CreateRigidBody` with `initialRotationMatrix` makes another omega of `initialAngularVelocity`.

Versions: Exudyn 1.13.6.

Expected: the body begins with the angular velocity given, as it does with `referenceRotationMatrix`.

Came: another one, in every parametrization.

Evidence: `MainSystemCreateRigidBody` (exudyn/misc/mainSystemExtensions.py) turns the angular velocity into
rates of the parameters by `referenceRotationMatrix` alone, without `initialRotationMatrix`.
"""

import sys

import exudyn
import numpy as np
from exudyn import utilities

R = utilities.EulerParameters2RotationMatrix(np.array([1, 2, -1, 3]) / 15**0.5)
omega = [0.9, -0.3, 0.5]
wrong = 0.0
for node in ("RotationEulerParameters", "RotationRxyz", "RotationRotationVector"):
    for rotation in ("referenceRotationMatrix", "initialRotationMatrix"):
        container = exudyn.SystemContainer()
        system = container.AddSystem()
        body = system.CreateRigidBody(
            inertia=utilities.RigidBodyInertia(1.0, np.diag([1.2, 2.1, 2.7])),
            initialAngularVelocity=list(R @ omega),
            nodeType=getattr(exudyn.NodeType, node),
            returnDict=True,
            **{rotation: R},
        )
        system.Assemble()
        got = system.GetNodeOutput(
            body["nodeNumber"],
            exudyn.OutputVariableType.AngularVelocityLocal,
            configuration=exudyn.ConfigurationType.Initial,
        )
        wrong = max(wrong, np.abs(got - omega).max())
        print(f"{node:24} {rotation:24} expected {omega}, got {got}")
sys.exit(1 if wrong > 1e-9 else 0)
