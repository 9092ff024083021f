"""What `check` costs a row, beside the exact motion of that row alone: a part of `make bench`.

Files are written from the exact motion, rounded to doubles. Of the file that fails, the clock is slow by a
millionth: then conventions and shifts of time are sought too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from taylor_verify.exact.route import solution
from taylor_verify.judge.files.judgement import judge_file
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.instants import EquallySpaced
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import read

ROWS: Final = (1_000, 10_000)
SCENES: Final = (
    *("euler/generic", "euler/with-attitude", "kirchhoff/whole-motion"),
    "kirchhoff/general-body",  # no closed form
)
SLOW_CLOCK: Final = 1 + Fraction(1, 10**6)


def sampled(name: str, rows: int) -> Scene:
    """Return the scene with so many equally spaced samples."""
    scene = load(name)
    start, end = scene.clock.start, scene.clock.instants[-1]
    instants = EquallySpaced(start, (end - start) / (rows - 1), rows)
    return replace(scene, clock=Clock(start, instants))


def write(scene: Scene, path: Path, clock: Fraction = Fraction(1)) -> None:
    """Write the exact motion, in doubles, as that of a clock that goes so much faster."""
    motion = solution(scene).motion(scene.clock.elapsed, truth_digits(53)).quantities
    columns = [[float(t * clock) for t in scene.clock.instants]]
    for rows in motion.values():
        columns += rows.reshape(len(rows), -1).astype(float).T.tolist()
    names = ["t", *(column for group in motion for column in COLUMNS[group])]
    lines = [",".join(map(repr, row)) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([",".join(names), *lines]) + "\n")


def actions(scene: Scene, folder: Path) -> list[Callable[[], object]]:
    """Return the exact motion of all rows, the judgement of a right file, and that of a slow clock's."""
    right, slow = folder / "right.csv", folder / "slow.csv"
    write(scene, right)
    write(scene, slow, SLOW_CLOCK)

    def motion() -> object:
        return solution(scene).motion(scene.clock.elapsed, truth_digits(53))

    def judged(path: Path) -> object:
        return judge_file(read(path), scene, rung("f64"))

    return [motion, partial(judged, right), partial(judged, slow)]


def judging(
    interleaved: Callable[[Sequence[Callable[[], object]], int], list[float]],
    line: Callable[..., str],
) -> None:
    """Print the table: microseconds of processor time a row, and the judgements over the exact motion."""
    print(
        "\nMicroseconds a row of a file that is judged on f64, and that over the exact motion alone."
    )
    print(line("", "rows", "exact", "right", "ratio", "slow clock", "ratio"))
    for name in SCENES:
        for rows in ROWS:
            with TemporaryDirectory() as folder:
                exact, right, slow = interleaved(actions(sampled(name, rows), Path(folder)), 2)
            each = [1e6 * seconds / rows for seconds in (exact, right, slow)]
            cells = (each[0], each[1], each[1] / each[0], each[2], each[2] / each[0])
            texts = (f"{cell:.1f}" if cell < 100 else f"{cell:.0f}" for cell in cells)
            print(line(name, f"{rows:,}", *texts))
