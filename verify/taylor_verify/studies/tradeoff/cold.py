"""What the first solve of all takes: a process of its own, with nothing loaded and nothing compiled.

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
from dataclasses import asdict, dataclass
from time import perf_counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from taylor_verify.scenes.scene import Scene
    from taylor_verify.studies.tradeoff.setting import Setting


@dataclass(frozen=True)
class Cold:
    """Seconds of a first solve, part by part.

    ``process`` until the new process runs, ``importing`` the libraries, the solver's own among them, and
    posing the problem, ``compiling`` what the solver says went before its propagation, ``solving`` the
    propagation, ``rest`` the answer made exact, ``whole`` all of it as the caller waits for it.
    """

    process: float
    importing: float
    compiling: float
    solving: float
    rest: float
    whole: float

    def row(self) -> dict[str, float]:
        return asdict(self)


def cold(
    scene: Scene, asked: Sequence[Setting], finished: Callable[[str], None] | None = None
) -> dict[Setting, Cold]:
    """The first solves of these settings, one after the other.

    A setting whose process is lost, or whose solver cannot be sent to another process, has none.
    ``finished`` is told the label of each as it ends.
    """
    from taylor_verify.studies.tradeoff.timing import cold_caches

    found = {}
    for setting in asked:
        # What a lambda or a function of a function raises here differs between versions.
        with cold_caches(), suppress(pickle.PicklingError, AttributeError, TypeError):
            data = pickle.dumps((scene, setting.solver, setting.rung))
            taken = _in_a_new_process(data)
            if taken is not None:
                found[setting] = taken
        if finished is not None:
            finished(setting.label)
    return found


def _in_a_new_process(data: bytes) -> Cold | None:
    began = perf_counter()
    # Spawned: a fork would have all that this process has loaded and compiled.
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        try:
            parts = pool.submit(first_solve, data).result()
        except BrokenProcessPool:
            return None
        whole = perf_counter() - began
    return Cold(process=max(0.0, whole - sum(parts.values())), whole=whole, **parts)


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
