"""The Taylor integrator on a body beside its neighbours, in heyoka's batches: `taylor?bodies=64`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from time import perf_counter
from typing import Final, final

from taylor_verify.models.problem import Problem
from taylor_verify.models.rates import momenta
from taylor_verify.scenes.precision import Rung
from taylor_verify.solvers.solver import Solver, float64_alone
from taylor_verify.solvers.taylor.alike import Alike
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.taylor.lanes import prepare, propagate
from taylor_verify.solvers.taylor.together import answer
from taylor_verify.solvers.trajectory import Trajectory

# Each momentum of a neighbour is that of the body within a tenth, at multiples of the golden ratio:
# no two neighbours have the same steps.
_APART: Final = Fraction(1, 10)
_GOLDEN: Final = Fraction(6180339887, 10**10)


@final
@dataclass(frozen=True)
class Neighbours(Solver):
    """taylor on so many ``bodies`` side by side, of which one is asked for, and its seconds are its share.

    It measures what a body costs among many. The others have the same equations, and start within a tenth
    of its momenta. ``tolerance`` is as in Taylor.
    """

    name: str
    bodies: int
    setting: str = ""
    tolerance: Fraction | None = None
    counts_steps = True

    def unavailable(self, rung: Rung) -> str:
        return float64_alone(self.name, rung) or Taylor(tolerance=self.tolerance).unavailable(rung)

    def solve(self, problem: Problem) -> Trajectory:
        began = perf_counter()
        alike = _kept_alike(problem, self.bodies)
        prepare(alike.form, self.tolerance)
        ready = perf_counter()
        lanes = propagate(alike, self.tolerance)
        seconds = (perf_counter() - ready) / self.bodies
        return answer(problem, lanes, 0, seconds=seconds, compile_seconds=ready - began)


def neighbours(problem: Problem, count: int) -> list[Problem]:
    """Return the problem, and others that start near it: so many in all."""
    moving, rounded = momenta(problem.form), problem.rung.round
    problems = [problem]
    for k in range(1, count):
        shares = [2 * (_GOLDEN * (k * moving + i) % 1) - 1 for i in range(moving)]
        start = [
            rounded(momentum * (1 + _APART * share))
            for momentum, share in zip(problem.initial_momenta, shares, strict=False)
        ]
        others = (*start, *problem.initial_momenta[moving:])
        problems.append(replace(problem, initial_momenta=others))
    return problems


@lru_cache(maxsize=16)
def _kept_alike(problem: Problem, count: int) -> Alike:
    return Alike.of(neighbours(problem, count))
