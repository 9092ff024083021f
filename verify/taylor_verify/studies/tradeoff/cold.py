"""The first solve of all: a process of its own, with nothing loaded and nothing compiled.

A process that has solved before has the libraries in its memory and heyoka's code compiled, so a cold
figure cannot be had from it. Each setting is begun in a new one, with an empty folder as heyoka's
cache; the solver comes there as bytes, so that reading it loads what it needs.
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
    from taylor_verify.studies.tradeoff.setting import Setting

Answer = TypeVar("Answer")


def cold(
    scene: Scene, asked: Sequence[Setting], finished: Callable[[str], None] = lambda label: None
) -> dict[Setting, dict[str, float]]:
    """Return the seconds of the first solves of these settings, one after the other, part by part.

    ``process`` until the new process runs, ``importing`` the libraries, the solver's own among them, and
    posing the problem, ``compiling`` what the solver says went before its propagation, ``solving`` the
    propagation, ``rest`` the answer made exact, ``whole`` all of it as the caller waits for it.

    A setting whose process is lost, or whose solver cannot be sent to another process, has none.
    ``finished`` is called with the label of each as it ends.
    """
    from taylor_verify.studies.tradeoff.timing import cold_caches

    times = {}
    # What a lambda or a function of a function raises in pickling differs between versions.
    unsent = (pickle.PicklingError, AttributeError, TypeError, BrokenProcessPool)
    for setting in asked:
        with cold_caches(), suppress(*unsent):
            data = pickle.dumps((scene, setting.solver, setting.rung))
            began = perf_counter()
            parts = in_a_new_process(first_solve, data)
            whole = perf_counter() - began
            process = max(0.0, whole - sum(parts.values()))
            times[setting] = {"process": process, **parts, "whole": whole}
        finished(setting.label)
    return times


def in_a_new_process(function: Callable[..., Answer], *arguments: object) -> Answer:
    """Return what a function returns in a process that has loaded nothing.

    It is spawned: a fork would have this process's memory, its compiled code and its hash seed.
    """
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return pool.submit(function, *arguments).result()


def first_solve(data: bytes) -> dict[str, float]:
    """Solve the pickled problem in a process that has done nothing; return the seconds of each part."""
    began = perf_counter()
    scene, solver, rung = pickle.loads(data)
    from taylor_verify.models.problem import pose

    problem = pose(scene, rung)
    # The question loads the library of the solver, as in every run.
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
