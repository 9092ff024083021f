"""The number of steps that a gate counts: a solver's own count, or the plausible part of a claim.

A gate grows with the square root of the steps, or in proportion to them where steps add the same amount.
So a false claim of many steps would give a wide gate. The judge knows the samples, the radians of the orbit
and the seconds that the answer took. It counts

    min(claim, WIDENING^2 (samples + STEPS_PER_RADIAN radians), STEPS_PER_SECOND seconds).

The first limit allows a gate that is WIDENING times as wide as the gate of a method that resolves every
sample and every hundredth of a radian; WIDENING^2 times where steps add the same amount. So 10^4 steps per
radian count: as many as an RK4 of step 1e-4 takes on an orbit of one radian per unit of time. The second
limit is what a processor can do: a step is some dozens of dependent operations.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from taylor_verify.judge.floor.attainable import orbit_of_run, radians
from taylor_verify.models.problem import Problem
from taylor_verify.records.reason import ClaimedSteps
from taylor_verify.solvers.solver import Solver

STEPS_PER_RADIAN: Final = 100
WIDENING: Final = 10
STEPS_PER_SECOND: Final = 10**8


@dataclass(frozen=True)
class Steps:
    """The counted steps, and the solver's claim if it is larger."""

    counted: int
    claim: ClaimedSteps | None = None


def count_steps(problem: Problem, solver: Solver, claimed: int, seconds: float | None) -> Steps:
    """Return the claimed steps, limited to a plausible number.

    ``seconds`` is the time that the answer took by the judge's own clock; None if it was not measured. The
    count of a solver of this package is taken as it is.
    """
    samples = len(problem.times)
    if solver.counts_steps or claimed <= samples:
        return Steps(claimed)
    orbit = orbit_of_run(problem.given, problem.scene, problem.rung.bits)
    turned = radians(orbit)
    most = int(WIDENING**2 * (samples + STEPS_PER_RADIAN * turned))
    limit = (
        f"{WIDENING}^2 x ({samples} samples + {STEPS_PER_RADIAN} for each of the {turned:.3g} radians "
        "of the orbit)"
    )
    if seconds is not None and STEPS_PER_SECOND * seconds < most:
        most = int(STEPS_PER_SECOND * seconds)
        limit = f"{STEPS_PER_SECOND:.0e} for each of the {seconds:.3g} seconds that it took"
    if claimed <= most:
        return Steps(claimed)
    return Steps(most, ClaimedSteps(claimed, most, limit))
