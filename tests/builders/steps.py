"""The order of convergence of a solver that takes a step, judged at several steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import Any, final

from builders.verdicts import by_quantity
from taylor_verify.judge.judgement import judgement
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.observed_order import SAME, Convergence, convergence
from taylor_verify.records.status import Status
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Trajectory

Answer = Callable[[Problem, float], Any]


@final
@dataclass(frozen=True)
class AtStep(Solver):
    """A function at one step; it counts as many steps as fit into the span."""

    answer: Answer
    step: float
    setting: str = ""
    name: str = "fixed step"

    def solve(self, problem: Problem) -> Trajectory:
        trajectory = Callback(lambda posed: self.answer(posed, self.step)).solve(problem)
        span = max(abs(t) for t in problem.given.clock.elapsed)
        return replace(trajectory, steps=ceil(float(span) / self.step))


def by_step(scene: Scene, answer: Answer, steps: Sequence[float]) -> dict[str, Convergence]:
    """The convergence of every quantity that is measured."""
    problem = pose(scene, rung("f64"))
    solvers = [AtStep(answer, step) for step in steps]
    judged = [by_quantity(judgement(problem, s, s.solve(problem))) for s in solvers]
    orders = {}
    for name in dict.fromkeys(
        n for rows in judged for n, row in rows.items() if row.at is not None
    ):
        rows = [each.get(name) for each in judged]
        errors = [r.max if r and r.verdict is not Status.UNDECIDED else None for r in rows]
        floors = [(row.attainable or 0.0) if row else 0.0 for row in rows]
        orders[name] = convergence(steps, errors, floors)
    return orders


def has_order(fit: Convergence, order: float) -> bool:
    """Return True if the steps show this order, within the scatter of local orders."""
    return fit.order is not None and abs(fit.order - order) <= SAME
