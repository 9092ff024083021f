"""The reference that rigid-body and ideal-fluid simulations are measured against.

    load(scene)                     a scene file or shipped scene, in exact numbers
    exact(scene, times, digits)     the exact motion
    events(scene, text, until)      all times of an event, none missed
    enclose(rates, start, times)    the motion of equations of one's own, with proven error bounds
    solve(scene, solver, rung)      the trajectory of a solver, not yet judged
    run(scene, solver, rung)        solve, compare with the exact motion, judge
    run_many(scenes, solver, rungs) the same for many scenes on all cores
    certify(scene, answer)          proven bounds of the error of a dense answer, for all times
    sweep(family)                   many bodies and starts, with the worst of them
    check(scene, solve_or_file)     judge a solver, or a trajectory, of one's own
    explain(scene, rung)            the equations, the orbit and the terms of each bound
    tradeoff(scene)                 time against error for every setting
    recommend(scene, error)         the fastest setting that reaches an error, ready to run

These are plain functions. The modules that they are imported from here import what they need when a
function is called, so that `import taylor_verify` is quick. Some of those modules share the name of their
function: write `from taylor_verify.exact.route import solution`, never `taylor_verify.exact.route`.
"""

from typing import TYPE_CHECKING, Any

# A module is imported before its function takes the name: Python sets a submodule as an attribute of
# its package only once, when it is first imported.
from taylor_verify.certify import certify
from taylor_verify.check import check
from taylor_verify.exact import enclose, events, exact
from taylor_verify.explain import explain
from taylor_verify.records.version import __version__
from taylor_verify.run import run, solve
from taylor_verify.run_many import run_many
from taylor_verify.scenes import load
from taylor_verify.sweep import sweep
from taylor_verify.tradeoff import recommend, tradeoff

if TYPE_CHECKING:
    from taylor_verify.types import (
        Certificate,
        Judgement,
        Motion,
        Problem,
        Recommendation,
        Refused,
        Scene,
        Trajectory,
        Verdict,
    )

__all__ = [
    "Certificate",
    "Judgement",
    "Motion",
    "Problem",
    "Recommendation",
    "Refused",
    "Scene",
    "Trajectory",
    "Verdict",
    "__version__",
    "certify",
    "check",
    "enclose",
    "events",
    "exact",
    "explain",
    "load",
    "recommend",
    "run",
    "run_many",
    "solve",
    "sweep",
    "tradeoff",
]


def __getattr__(name: str) -> Any:
    """Return a type by its name: they need numbers, and are imported when they are asked for."""
    from taylor_verify import types

    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(types, name)
