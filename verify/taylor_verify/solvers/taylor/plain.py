"""A free rigid body given to heyoka as the texts write it, in omega and with moments as literals.

I  principal moments of inertia        w  angular velocity, body axes

I1 w1' = (I2 - I3) w2 w3 and cyclically: Heinbockel (2.2.72) without moments.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any, NamedTuple, final

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.precision import Rung, held_exactly
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.cache import heyoka_cache_off
from taylor_verify.solvers.taylor.numbers import arithmetic, unavailable
from taylor_verify.solvers.trajectory import Outcome, Trajectory

Array = np.ndarray[Any, Any]

# heyoka's words, and what somebody who asks `outcome is time_limit` makes of them.
_READ = {"time_limit": Outcome.FINISHED, "err_nf_state": Outcome.NON_FINITE}


class Ran(NamedTuple):
    """The answer of a call: its outcome, the number of steps, and a row for each time."""

    outcome: Any
    steps: int
    rows: Array


def euler_equations(I: Sequence[Any]) -> list[Any]:
    """Return the equations as they are typed."""
    import heyoka as hy

    w1, w2, w3 = hy.make_vars("w1", "w2", "w3")
    return [
        (w1, w2 * w3 * (I[1] - I[2]) / I[0]),
        (w2, w3 * w1 * (I[2] - I[0]) / I[1]),
        (w3, w1 * w2 * (I[0] - I[1]) / I[2]),
    ]


def free_body(I: Sequence[Any], w: Array, times: Array, fp_type: Any = float) -> Ran:
    """Integrate from w at times[0] = 0 and sample at the times."""
    import heyoka as hy

    ta = hy.taylor_adaptive(euler_equations(I), w, fp_type=fp_type)
    outcome, _, _, steps, _, rows = ta.propagate_grid(times)
    return Ran(outcome, steps, rows)


@final
@dataclass(frozen=True)
class Plain(Solver):
    """``free_body`` as a solver, for problems that the judge adopts: principal axes, omega alone.

    The moments must be doubles, omega and the times numbers of the rung; then nothing of the data is
    rounded on the way in. ``typed`` gives the moments as numbers of the rung too.
    """

    name: str = "plain heyoka"
    setting: str = ""
    typed: bool = False
    counts_steps = True

    def unavailable(self, rung: Rung) -> str:
        return unavailable(rung)

    def solve(self, problem: Problem) -> Trajectory:
        heyoka_cache_off()
        began = perf_counter()
        body, start = problem.given.body, problem.given.initial
        assert isinstance(body, RigidBody)
        assert isinstance(start, Spin)
        numbers = arithmetic(problem.rung)
        diagonal = tuple(body.inertia[i][i] for i in range(3))
        moments = list(numbers.array(diagonal)) if self.typed else [float(I) for I in diagonal]
        w, times = numbers.array(start.omega), numbers.array(problem.given.clock.elapsed)
        ran = free_body(moments, w, times, numbers.fp_type)
        word = str(ran.outcome.name)
        outcome = _READ.get(word, Outcome.INTERRUPTED)
        quantities = {}
        if outcome is Outcome.FINISHED:
            rows = [[held_exactly(numbers.exact(v)) for v in row] for row in ran.rows]
            quantities["omega"] = np.array(rows, dtype=object)
        seconds = perf_counter() - began
        return Trajectory(outcome, quantities, word, steps=ran.steps, seconds=seconds)
