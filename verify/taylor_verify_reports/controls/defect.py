"""A defect: a sound solver with one thing broken, and the quantities that pass all the same."""

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

    ``scene`` is a shipped scene on which the defect shows. ``gate`` is the quantity that must fail there.
    ``passes`` are the quantities of that scene that pass all the same; ``why`` gives the physics of it.
    Every other quantity fails. The start passes too, unless the answer is wrong from the start
    (``wrong_start``). ``honest`` is True for a solver that says that it failed. ``is_common`` is True for a
    defect that published simulators or textbooks have: it stands in the short table.

    Any of these is broken: ``recast``, which changes the problem that is solved; ``equations``, its
    right-hand sides; ``solver``, which answers; ``spoil``, which changes the answer.
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
    is_common: bool = False
    setting: str = "control"

    def solve(self, problem: Problem) -> Trajectory:
        asked = problem
        if self.recast is not None:
            problem = self.recast(problem)
        if self.equations is not None:
            problem = problem.with_equations(self.equations)
        trajectory = self.solver.solve(problem)
        return self.spoil(asked, trajectory) if self.spoil is not None else trajectory
