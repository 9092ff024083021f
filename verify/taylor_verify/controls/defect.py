"""A defect: a sound solver with one thing broken, and what of it the physics lets through."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, final

from taylor_verify.models.form import Equations
from taylor_verify.models.problem import Problem
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Trajectory

# The shipped scenes on which most defects show: a free body, and a solid in a fluid.
BRICK: Final = "euler/nesc-brick"
SCREW: Final = "kirchhoff/whole-motion"


@final
@dataclass(frozen=True)
class Defect(Solver):
    """A solver with one thing broken, beside its sound ``twin``.

    ``scene`` is a shipped scene on which it shows and ``gate`` the quantity named for it, which must
    fail there. ``passes`` are the quantities of that scene that pass all the same, by the physics
    that ``why`` gives; every other one fails. The start passes too, unless the answer is wrong from the
    start (``wrong_start``). ``honest`` tells a solver that says it failed.

    What is broken is any of: ``recast``, the problem that is solved in place of the one asked;
    ``equations``, its right-hand sides; ``solver``, who answers; ``spoil``, the answer.
    """

    name: str
    scene: str
    gate: str
    passes: frozenset[str] = frozenset()
    what: str = ""
    why: str = ""
    recast: Callable[[Problem], Problem] | None = None
    equations: Equations | None = None
    solver: Solver = field(default_factory=Taylor)
    spoil: Callable[[Problem, Trajectory], Trajectory] | None = None
    twin: Solver = field(default_factory=Taylor)
    honest: bool = False
    wrong_start: bool = False
    told: bool = False
    setting: str = "control"

    def solve(self, problem: Problem) -> Trajectory:
        asked = problem
        if self.recast is not None:
            problem = self.recast(problem)
        if self.equations is not None:
            problem = problem.with_equations(self.equations)
        trajectory = self.solver.solve(problem)
        return self.spoil(asked, trajectory) if self.spoil is not None else trajectory
