"""Trajectories as somebody else would have them in a file, and documents that are drawn."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from mpmath import mp

import taylor_verify
from taylor_verify.draw.drawn_course import motion
from taylor_verify.exact.route import solution
from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.judge.files.judgement import FileJudgement
from taylor_verify.judge.velocities import velocity
from taylor_verify.models.problem import adopt
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

Columns = dict[str, list[float]]
Sound = Mapping[str, Sequence[float]]
VECTORS = {
    "omega": ("w1", "w2", "w3"),
    "linear_impulse": ("x1", "x2", "x3"),
    "angular_impulse": ("y1", "y2", "y3"),
    "centre": ("c1", "c2", "c3"),
}
QUATERNION = ("q0", "q1", "q2", "q3")
MATRIX = tuple(f"r{i}{k}" for i in (1, 2, 3) for k in (1, 2, 3))


@lru_cache
def exact_columns(name: str, matrix: bool = False) -> Mapping[str, tuple[float, ...]]:
    """The columns of a shipped scene at some of its own samples, the angular velocity among them."""
    scene = load(name)
    instants = scene.clock.instants
    columns = columns_at(scene, [*instants[:-1:4], instants[-1]], matrix=matrix)
    return {column: tuple(values) for column, values in columns.items()}


def columns_at(scene: Scene, instants: Sequence[Fraction], matrix: bool = False) -> Columns:
    """The exact motion at the doubles nearest to these instants, as doubles."""
    times = [float(t) for t in instants]
    given = adopt(scene, rung("f64"), tuple(map(Fraction, times))).given
    motion = dict(solution(given).evaluate(given.clock.elapsed, 40))
    columns: Columns = {"t": times}
    with mp.workdps(40):
        if isinstance(given.body, ImmersedBody):
            motion["omega"] = velocity("omega", given.body, motion)
        for quantity, names in VECTORS.items():
            if quantity in motion:
                columns |= named(names, motion[quantity])
        if "attitude" in motion and matrix:
            columns |= named(MATRIX, [R.reshape(9) for R in motion["attitude"]])
        elif "attitude" in motion:
            columns |= named(QUATERNION, [quaternion(R) for R in motion["attitude"]])
        for group in given.groups:
            if group.name in given.states:
                columns |= named(group.columns, motion[group.name])
    return columns


def named(names: Sequence[str], rows: Any) -> Columns:
    return {name: [float(row[i]) for row in rows] for i, name in enumerate(names)}


def quaternion(R: Any) -> list[Any]:
    """q with q0 > 0, from the column of 4 q q^T - 1 that has the largest diagonal entry."""
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    fourfold = [1 + trace, *(1 - trace + 2 * R[i, i] for i in range(3))]
    mixed = {
        (0, 1): R[2, 1] - R[1, 2], (0, 2): R[0, 2] - R[2, 0], (0, 3): R[1, 0] - R[0, 1],
        (1, 2): R[0, 1] + R[1, 0], (1, 3): R[0, 2] + R[2, 0], (2, 3): R[1, 2] + R[2, 1],
    }  # fmt: skip
    k = fourfold.index(max(fourfold))
    column = [fourfold[k] if i == k else mixed[min(i, k), max(i, k)] for i in range(4)]
    return [entry / (2 * mp.sqrt(fourfold[k])) for entry in column]


def rows_of(columns: Mapping[str, Sequence[float]], names: Sequence[str]) -> Any:
    """The rows of some columns, (n, k)."""
    return np.array([columns[name] for name in names]).T


def write_csv(
    path: Path, columns: Mapping[str, Sequence[Any]], text: Callable[[Any], str] = repr
) -> str:
    lines = [",".join(columns)]
    lines += [",".join(map(text, row)) for row in zip(*columns.values(), strict=True)]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def file_judgement(file: str, scene: str | Scene, **options: Any) -> FileJudgement:
    """The judgement of one file."""
    judged = taylor_verify.check(scene, file, **options)
    assert isinstance(judged, FileJudgement)
    return judged


# Sound columns, and what a file of another convention would have.


def replaced(sound: Sound, names: Sequence[str], rows: object) -> Columns:
    """The columns with these rows in place of those of the names."""
    return {**{k: list(v) for k, v in sound.items()}, **named(names, rows)}


def scalar_last(sound: Sound) -> Columns:
    return replaced(sound, QUATERNION, np.roll(rows_of(sound, QUATERNION), -1, axis=1))


def conjugate(sound: Sound) -> Columns:
    return replaced(sound, QUATERNION, rows_of(sound, QUATERNION) * [1, -1, -1, -1])


def in_space_axes(sound: Sound) -> Columns:
    """omega as most engines have it, by the attitude of the columns."""
    R = rotations(rows_of(sound, QUATERNION))
    return replaced(
        sound, VECTORS["omega"], (R @ rows_of(sound, VECTORS["omega"])[:, :, None])[:, :, 0]
    )


# Documents


@cache
def document(scene: str) -> dict[str, Any]:
    """Return the motion of a scene in few rows: what tests ask of it holds of every row."""
    return motion(load(scene), 60)
