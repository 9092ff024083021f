"""The chain for one scene: scene, problem, trajectory, truth and judgement.

The module is callable, so that `taylor_verify.run(scene, solver, rung)` is this chain.
"""

from __future__ import annotations

from dataclasses import replace
from os import PathLike
from time import perf_counter

from taylor_verify.callable_module import make_callable
from taylor_verify.judge.costs import SOLVING, Costs, total
from taylor_verify.judge.initial import with_initial
from taylor_verify.judge.judgement import Judgement, judgement, unjudged
from taylor_verify.judge.verdict import Status
from taylor_verify.models.problem import NotRepresentable, pose
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.reader import as_scene
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import as_solver
from taylor_verify.solvers.solver import Lack, Solver, raised
from taylor_verify.solvers.trajectory import Outcome


def run(
    scene: Scene | str | PathLike[str], solver: Solver | str = "taylor", rung: Rung | str = "f64"
) -> Judgement:
    """Solve one scene on one rung and judge the answer.

    The scene is a Scene, a path or the name of a shipped scene; the solver a Solver or a name such as
    ``taylor?tol=1e-9`` or ``process:./mine``; the rung a Rung or ``f32 f64 f80 f128 mpN``. The Judgement
    has a Verdict on the start and for each tracked and each conserved quantity. That a solver fails, or
    that this machine lacks a rung, is a verdict.

    Raises scenes.faults.Refused for a scene that cannot be read, and ValueError for a name that is
    no solver or no rung. What the rung cannot hold is a verdict, not an error.
    """
    scene, solver, rung = as_scene(scene), as_solver(solver), rung_named(rung)
    if missing := solver.unavailable(rung):
        lack = missing.outcome if isinstance(missing, Lack) else Outcome.UNSUITED
        return unjudged(scene, solver, rung, Status.UNAVAILABLE, missing, lack)
    try:
        problem = pose(scene, rung)
    except NotRepresentable as reason:
        return unjudged(scene, solver, rung, Status.REFUSED, str(reason))
    if unsuited := solver.unsuited(problem):
        return unjudged(scene, solver, rung, Status.UNAVAILABLE, unsuited, Outcome.UNSUITED)
    costs = Costs()
    began = perf_counter()
    with costs.of(SOLVING):
        try:
            trajectory = solver.solve(problem)
        except SystemExit as end:
            # A solver of one's own: its end is a failed run, and not the end of the caller.
            trajectory = raised(end)
    seconds = perf_counter() - began
    found = judgement(problem, solver, trajectory, seconds)
    found = with_initial(found, float(problem.given.clock.start))
    return replace(found, costs=total([costs.seconds, found.costs]))


make_callable(__name__, run)
