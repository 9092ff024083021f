"""Times of first solves, each in a new process with nothing loaded and nothing compiled.

A process that has solved before has loaded the libraries and compiled heyoka's code, so that it cannot
measure a cold start. Each setting starts in a new process, with an empty folder as heyoka's cache. The
solver is sent as bytes, so that its libraries are loaded when the new process reads it.
"""

from __future__ import annotations

import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from time import perf_counter
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from taylor_verify.scenes.scene import Scene
    from taylor_verify.tradeoff.setting import Setting

Answer = TypeVar("Answer")


def cold(
    scene: Scene, asked: Sequence[Setting], finished: Callable[[str], None] = lambda label: None
) -> dict[Setting, dict[str, float]]:
    """Solve with each setting in a new process, one after the other, and return the seconds by part.

    The parts are ``process`` (starting the process), ``importing`` (loading all libraries and posing the
    problem), ``compiling`` (what the solver did before its propagation), ``solving`` (the propagation),
    ``rest`` (making the answer exact) and ``whole`` (the time that the caller waits).

    Settings whose process dies, or whose solver cannot be sent to another process, are left out.
    ``finished`` is called with the label of each setting as it ends.
    """
    from taylor_verify.tradeoff.timing import cold_caches

    times = {}
    # The errors of pickling a lambda or a local function differ between versions.
    not_sent = (pickle.PicklingError, AttributeError, TypeError, BrokenProcessPool)
    for setting in asked:
        with cold_caches(), suppress(*not_sent):
            data = pickle.dumps((scene, setting.solver, setting.rung))
            began = perf_counter()
            parts = in_a_new_process(first_solve, data)
            whole = perf_counter() - began
            process = max(0.0, whole - sum(parts.values()))
            times[setting] = {"process": process, **parts, "whole": whole}
        finished(setting.label)
    return times


def in_a_new_process(function: Callable[..., Answer], *arguments: object) -> Answer:
    """Return the result of a function in a process that has loaded nothing.

    The process is spawned, because a fork would inherit memory, compiled code and hash seed.
    """
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return pool.submit(function, *arguments).result()


def first_solve(data: bytes) -> dict[str, float]:
    """Solve the pickled problem in a fresh process; return the seconds of each part."""
    began = perf_counter()
    scene, solver, rung = pickle.loads(data)
    from taylor_verify.models.problem import pose

    problem = pose(scene, rung)
    # Posing the problem loads the library of the solver, as in every run.
    solver.unavailable(rung)
    imported = perf_counter()
    trajectory = solver.solve(problem)
    ended = perf_counter()
    compiling, solving = trajectory.compile_seconds, trajectory.seconds
    return {
        "importing": imported - began,
        "compiling": compiling,
        "solving": solving,
        "rest": max(0.0, ended - imported - compiling - solving),
    }
