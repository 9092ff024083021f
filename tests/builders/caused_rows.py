"""Rows of simulators with one fault, by SciPy, and the causes of a file of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from builders.scenes import scene_text
from builders.trajectories import QUATERNION, Columns, named, write_csv
from builders.wrong_dynamics import failure, turned
from taylor_verify.judge.causes.likely import explained
from taylor_verify.judge.causes.material import material_of_file
from taylor_verify.judge.conventions.fits import Conventions
from taylor_verify.judge.conventions.worlds import World
from taylor_verify.numbers.precision import rung
from taylor_verify.records.answers import LikelyCause
from taylor_verify.scenes.reading.reader import read
from taylor_verify.solvers.files.file import read as read_file

Array = np.ndarray[Any, np.dtype[np.float64]]
# The rates of v at a time, from v and q.
Law = Callable[[float, Array, Array], Array]
TENSOR = np.array([[2.3, 0.21, -0.14], [0.21, 1.7, 0.33], [-0.14, 0.33, 3.1]])
Q = np.array([-0.5, 0.3, -0.7, 0.2]) / np.linalg.norm([-0.5, 0.3, -0.7, 0.2])
TIMES = np.round(np.arange(0, 81) * 0.1, 6)
RIGID = scene_text(
    "inertia = [[2.3, 0.21, -0.14], [0.21, 1.7, 0.33], [-0.14, 0.33, 3.1]]\n{load}",
    "omega = [0.8, -0.5, 1.1]\nattitude = [-0.5, 0.3, -0.7, 0.2]",
    time="end = 8\nsamples = 81",
    top='track = ["attitude"]',
)


def rows(law: Law, v0: Sequence[float], q0: Array, times: Array, edges: Sequence[float]) -> Array:
    """The states at the times by SciPy, begun anew at each of the edges."""
    n, z, parts = len(v0), np.array([*v0, *q0]), []
    for begin, end in pairwise([times[0], *edges, times[-1]]):
        inside = times[(times > begin) & (times <= end)]
        solved = solve_ivp(
            lambda t, z: np.concatenate([law(t, z[:n], z[n:]), turned(z[n:], z[n - 3 : n])]),
            (begin, end - 1e-13),
            z,
            "DOP853",
            t_eval=np.minimum(inside, end - 1e-13),
            rtol=3e-14,
            atol=1e-16,
        )
        z = solved.y[:, -1]
        parts.append(solved.y.T)
    return np.vstack([[*v0, *q0], *parts])


def columns(times: Array, made: Array, names: Sequence[str]) -> Columns:
    q = made[:, len(names) :]
    unit = q / np.linalg.norm(q, axis=1, keepdims=True)
    return named(("t",), times[:, None]) | named(names, made[:, :-4]) | named(QUATERNION, unit)


def titles(path: Path, scene: str, made: Columns) -> list[str]:
    """The causes of a file whose states failed, without what they leave."""
    return [cause.sentence.partition("; leaves")[0] for cause in causes(path, scene, made)]


def causes(path: Path, scene: str, made: Columns) -> tuple[LikelyCause, ...]:
    asked, known = read(scene, "scene"), ("omega", "impulse", "attitude", "centre")
    file = read_file(str(write_csv(path / "mine.csv", made)))
    plain = Conventions((), World(asked), {})
    failures = [failure(asked, quantity) for quantity in known]
    with np.errstate(all="ignore"):
        answer = material_of_file(file, rung("f64"), plain, failures)
        return explained(answer).causes


def rigid(
    tensor: Array = TENSOR,
    moment: Law = lambda t, w, q: np.zeros(3),
    gyro: float = 1.0,
    edges: Sequence[float] = (),
    pace: float = 1.0,
) -> Columns:
    """The columns of a rigid body's omega and attitude, of a motion so much too fast."""
    made = rows(
        lambda t, w, q: np.linalg.solve(tensor, gyro * np.cross(tensor @ w, w) + moment(t, w, q)),
        [0.8, -0.5, 1.1],
        Q,
        TIMES * pace,
        edges,
    )
    return columns(TIMES, made, ("w1", "w2", "w3"))


def table(made: Columns) -> Array:
    return np.array([made[name] for name in ("w1", "w2", "w3", *QUATERNION)]).T
