"""Judgements: bodies by hundreds beside single ones, and rows of a file beside their exact motion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np
from builders.satellites import satellites
from taylor_verify.batch.bodies import judged
from taylor_verify.models.bodies import Bodies
from taylor_verify.solvers.taylor.lanes import propagate

from benches.ratio import Action, Ratio, Side, Target
from benches.scenes import sampled
from taylor_verify.exact.route import solution
from taylor_verify.judge.files.judgement import judge_file
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.models.problem import pose
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.run import run
from taylor_verify.scenes.instants import EquallySpaced
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.taylor.driver import Taylor

_RUNG: Final = rung("f64")
# Random satellites are sampled so: some hundred radians.
_CLOCK: Final = Clock(Fraction(0), EquallySpaced(Fraction(0), Fraction(1), 101))
_TOGETHER, _UNJUDGED, _ALONE = 300, 1000, 8
# One of its satellites, as many as usual, takes the chain by itself: it costs as much as a hundred others.
_SEED: Final = 6
_ROWS: Final = 1000
_FILES: Final = ("euler/generic", "euler/with-attitude", "kirchhoff/whole-motion")
# A clock that is slow by a millionth: shifts of time and conventions are sought too.
_SLOW: Final = 1 + Fraction(1, 10**6)

_JUDGED: Final = Target(1 / 500, "500 bodies a second and core: 100,000 in three minutes")
_SOLVED: Final = Target(1 / 15_000, "15,000 bodies a second and core, as heyoka's batch allows")


def _drawn(bodies: int, tracks_attitude: bool = False) -> list[Scene]:
    """Return the satellites of every round: read anew, for a scene remembers what was made of it."""
    drawn = satellites(bodies, _SEED, tracks_attitude)
    return [replace(scene, clock=_CLOCK) for scene in drawn]


def _judged_over_runs(tracks_attitude: bool) -> tuple[Side, Side]:
    def runs(scenes: Sequence[Scene]) -> object:
        return [run(scene, "taylor", "f64") for scene in scenes]

    return (
        Action(judged, partial(_drawn, _TOGETHER, tracks_attitude), _TOGETHER),
        Action(runs, partial(_drawn, _ALONE, tracks_attitude), _ALONE),
    )


def _lanes_over_solves() -> tuple[Side, Side]:
    draw = np.random.default_rng(1)
    inertia = draw.uniform(0.2, 2, (3, _UNJUDGED))
    inertia = inertia.sum(axis=0) - inertia
    omega = draw.normal(size=(3, _UNJUDGED))
    times = np.tile(np.arange(101.0), (_UNJUDGED, 1))

    def solves(scenes: Sequence[Scene]) -> object:
        return [Taylor().solve(pose(scene, _RUNG)) for scene in scenes]

    return (
        Action(lambda _: propagate(Bodies.of(inertia, omega, times)), units=_UNJUDGED),
        Action(solves, partial(_drawn, _ALONE), _ALONE),
    )


def write(scene: Scene, path: Path, clock: Fraction) -> None:
    """Write the exact motion, in doubles, as that of a clock that goes so much faster."""
    motion = solution(scene).motion(scene.clock.elapsed, truth_digits(53)).quantities
    columns = [[float(t * clock) for t in scene.clock.instants]]
    for rows in motion.values():
        columns += rows.reshape(len(rows), -1).astype(float).T.tolist()
    names = ["t", *(column for group in motion for column in COLUMNS[group])]
    lines = [",".join(map(repr, row)) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([",".join(names), *lines]) + "\n")


def _file_over_motion(name: str, clock: Fraction) -> tuple[Side, Side]:
    scene, folder = sampled(load(name), _ROWS), TemporaryDirectory()
    write(scene, Path(folder.name) / "file.csv", clock)

    def judge(_: None) -> object:
        return judge_file(read(Path(folder.name) / "file.csv"), scene, _RUNG)

    def motion(_: None) -> object:
        return solution(scene).motion(scene.clock.elapsed, truth_digits(53))

    return Action(judge, units=_ROWS), Action(motion, units=_ROWS)


def ratios() -> Iterator[Ratio]:
    """Yield what judgements cost."""
    yield Ratio(
        "bodies/solved",
        f"one of {_UNJUDGED:,} satellites in heyoka's batch, over one that is posed and solved by itself",
        _lanes_over_solves,
        limit=_SOLVED,
        unit="body",
    )
    for tracks_attitude in (False, True):
        yield Ratio(
            f"bodies/judged{'-with-attitude' if tracks_attitude else ''}",
            f"one of {_TOGETHER} satellites that are judged together, over one by the whole chain",
            partial(_judged_over_runs, tracks_attitude),
            limit=None if tracks_attitude else _JUDGED,
            unit="body",
        )
    asked = [(name, Fraction(1)) for name in _FILES] + [(_FILES[0], _SLOW)]
    for name, clock in asked:
        yield Ratio(
            f"check/{name}{'/slow-clock' if clock != 1 else ''}",
            f"a row of {_ROWS:,} in a file that is read and judged, over its exact motion",
            partial(_file_over_motion, name, clock),
            unit="row",
        )
