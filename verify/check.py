"""Judge a solver of one's own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from verify.callable_module import make_callable
from verify.judge.judgement import Judgement
from verify.models.problem import Problem
from verify.run import run
from verify.scenes.precision import Rung
from verify.scenes.scene import Scene
from verify.solvers.solver import Callback


def check(
    scene: Scene | str, solve: Callable[[Problem], Any], rung: Rung | str = "f64"
) -> Judgement:
    """Judge ``solve(problem) -> states`` on a scene; states has shape (samples, n).

    Row k is the state at problem.times[k]: omega, q0..q3 or x, y, q0..q3, centre, untracked groups
    absent, in the scene's own units; ``problem.given`` holds the exact body, start and instants.
    """
    return run(scene, Callback(solve), rung)


make_callable(__name__, check)
