"""A free rigid body given to heyoka as the texts write it, in omega and with moments as literals.

I1 w1' = (I2 - I3) w2 w3 and cyclically: Heinbockel (2.2.72) without moments. It is the twin of the driver
that has no bound on its steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter
from typing import final

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.decimal_point import decimal_point
from taylor_verify.numbers.precision import Rung, exact_value, held_exactly
from taylor_verify.solvers.solver import Solver, float64_alone, refused
from taylor_verify.solvers.taylor.numbers import unavailable
from taylor_verify.solvers.taylor.package import heyoka_cache_off
from taylor_verify.solvers.taylor.way import outcome_of
from taylor_verify.solvers.trajectory import Outcome, Trajectory


@final
@dataclass(frozen=True)
class Plain(Solver):
    """heyoka by itself, in doubles, for problems in principal axes that ask for omega alone."""

    name: str = "plain heyoka"
    counts_steps = True

    def unavailable(self, rung: Rung) -> str:
        return float64_alone(self.name, rung) or unavailable(rung)

    @decimal_point()
    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unsuited(problem):
            return refused(reason)
        import heyoka as hy

        heyoka_cache_off()
        began, given = perf_counter(), problem.given
        I = [float(row[i]) for i, row in enumerate(given.body.energy_matrix)]
        w1, w2, w3 = hy.make_vars("w1", "w2", "w3")
        equations = [
            (w1, w2 * w3 * (I[1] - I[2]) / I[0]),
            (w2, w3 * w1 * (I[2] - I[0]) / I[1]),
            (w3, w1 * w2 * (I[0] - I[1]) / I[2]),
        ]
        integrator = hy.taylor_adaptive(equations, [float(w) for w in given.initial.moving])
        status, _, _, steps, _, rows = integrator.propagate_grid(
            list(map(float, given.clock.elapsed))
        )
        outcome = outcome_of(status)
        quantities = {}
        if outcome is Outcome.FINISHED:
            omega = [[held_exactly(exact_value(value)) for value in row] for row in rows]
            quantities["omega"] = np.array(omega, dtype=object)
        seconds = perf_counter() - began
        return Trajectory(outcome, quantities, str(status.name), steps=int(steps), seconds=seconds)
