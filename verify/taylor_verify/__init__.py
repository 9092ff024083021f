"""The reference that rigid-body and ideal-fluid simulations are measured against.

    load(scene)                  a scene file or shipped scene, in exact numbers
    exact(scene, times, digits)  the exact motion
    run(scene, solver, rung)     solve, compare with the exact motion, judge
    check(scene, solve_or_file)  judge a solver, or a trajectory, of one's own
    recommend(scene, error)      the fastest setting that reaches an error, ready to run

Every name is imported when it is first used, so that `import taylor_verify` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

# These modules are callable, because a room and the function it is for share a name.
_CALLABLE = ("check", "exact", "run")

__all__ = ["check", "exact", "load", "recommend", "run"]


def __getattr__(name: str) -> Any:
    if name == "load":
        return import_module("taylor_verify.scenes.reader").load
    if name == "recommend":
        return import_module("taylor_verify.trade.recommend").recommend
    if name in _CALLABLE:
        return import_module(f"taylor_verify.{name}")
    raise AttributeError(f"module 'taylor_verify' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *__all__]
