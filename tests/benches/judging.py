"""Judgements: bodies of a sweep, and rows of a file beside their exact motion."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from builders.scenes import sampled

from benches.ratio import Action, Ratio, Side, Target
from taylor_verify.batch.sweeps.chunk import Chunk, judge
from taylor_verify.batch.sweeps.questions import questions
from taylor_verify.exact.route import solution
from taylor_verify.judge.files.judgement import judge_file
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.judge.tolerances import Tolerances
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.registry import solver_named

_RUNG: Final = rung("f64")
# SciPy takes a sixth of the time of a body so, and passes the one tolerance and fails the other.
_SOLVER: Final = "scipy:DOP853?rtol=1e-6&atol=1e-9"
PASSING, FAILING = 1e-1, 1e-12
_BODIES: Final = 8
_ROWS: Final = 1000
_FILES: Final = ("euler/generic", "euler/with-attitude", "kirchhoff/whole-motion")
# A clock that is slow by a millionth: shifts of time and conventions are sought too.
_SLOW: Final = 1 + Fraction(1, 10**6)

_FAILS: Final = Target(
    1.3, "a failing body needs its numbers for the table: what explains them is for the worst ones"
)
_PASSES: Final = Target(1 / 60, "60 bodies a second and core: 100,000 in half an hour")


def chunks(tolerance: float) -> Iterator[Chunk]:
    """Yield chunks of satellites, always new ones: what was made of a scene is known for a while."""
    drawn = questions("satellites", 10**6)
    for number in count():
        first, stop = number * _BODIES, (number + 1) * _BODIES
        yield Chunk(number, first, stop, drawn, _SOLVER, _RUNG.name, Tolerances(tolerance))


def _swept(tolerance: float) -> Action:
    return Action(judge, partial(next, chunks(tolerance)), _BODIES)


def _passing_over_solve() -> tuple[Side, Side]:
    solver = solver_named(_SOLVER)

    def solve(chunk: Chunk) -> object:
        asked = chunk.questions.questions(chunk.first, chunk.stop)
        scenes = [each.scene for each in asked if isinstance(each.scene, Scene)]
        return [solver.solve(pose(scene, _RUNG)) for scene in scenes]

    return _swept(PASSING), Action(solve, partial(next, chunks(PASSING)), _BODIES)


def _failing_over_passing() -> tuple[Side, Side]:
    return _swept(FAILING), _swept(PASSING)


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
        "sweep/passing",
        "a satellite of a sweep that SciPy solves and that passes, over drawing, posing and solving it",
        _passing_over_solve,
        limit=_PASSES,
        unit="body",
    )
    yield Ratio(
        "sweep/failing",
        "a satellite of a sweep that fails, over the same kind that passes",
        _failing_over_passing,
        _FAILS,
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
