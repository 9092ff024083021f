"""Files and trajectories as the material of hypotheses: body axes, float64, one row for each time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np

from taylor_verify.exact.route import solution
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Material
from taylor_verify.judge.causes.search import likely_causes
from taylor_verify.judge.conventions.fits import Conventions
from taylor_verify.judge.conventions.readings import readings, rotations
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.velocities import has_velocities, momenta
from taylor_verify.models.problem import Problem, adopt
from taylor_verify.records.answers import LikelyCause
from taylor_verify.records.quantities import MOMENTA, STATES, VELOCITIES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.trajectory import Trajectory

_DIGITS: Final = 20
_MOST_ROWS: Final = 4096


def causes_of_file(
    file: TrajectoryFile, rung: Rung, found: Conventions, judged: Judgement
) -> tuple[LikelyCause, ...]:
    """Return the likely causes of what failed in a file, read by its conventions.

    They are sought in the first rows of a long file: each acts from row to row.
    """
    first = file.at(range(min(len(file.times), _MOST_ROWS)))
    return _causes(lambda: _of_file(first, rung, found, judged.verdicts), found.world.scene)


def with_causes(judged: Judgement, problem: Problem, trajectory: Trajectory) -> Judgement:
    """Return the judgement of a trajectory with the likely causes of what failed."""
    if not any(verdict.verdict is Status.FAIL for verdict in judged.verdicts):
        return judged
    scene = problem.scene
    causes = _causes(lambda: _of_trajectory(problem, trajectory, judged.verdicts), scene)
    named = (replace(cause, scene=scene.name, rung=problem.rung.name) for cause in causes)
    return replace(judged, causes=tuple(named))


def _causes(material: Callable[[], Material | None], scene: Scene) -> tuple[LikelyCause, ...]:
    """The causes by float64; none where its range or a decomposition does not suffice."""
    try:
        with np.errstate(all="ignore"):
            made = material()
            return () if made is None or not made.failed else likely_causes(made, scene)
    except (OverflowError, np.linalg.LinAlgError):
        return ()


def _of_file(
    file: TrajectoryFile, rung: Rung, found: Conventions, verdicts: Iterable[Verdict]
) -> Material | None:
    """A file as material; None if its body is of another kind or has loads that change."""
    times = found.world.times(file.times)
    given = adopt(found.world.scene, rung, times).given
    if given.body.manufactured is not None or not Equations.are_known(given.body):
        return None
    attitudes = _attitudes(file, given, found)
    values = {name: _read(file, name, found, attitudes) for name in _momenta(file, given)}
    columns = [file.groups[name].doubles() for name in values]
    if not values and has_velocities(given.body) and set(VELOCITIES) <= set(file.groups):
        own = {name: _read(file, name, found, attitudes) for name in VELOCITIES}
        values = {name: rows.astype(float) for name, rows in momenta(given.body, own).items()}
    made = _material(given, values, _quaternions(attitudes), rung, verdicts)
    return replace(made, digits=file.digits, columns=np.hstack(columns) if columns else None)


def _of_trajectory(
    problem: Problem, trajectory: Trajectory, verdicts: Iterable[Verdict]
) -> Material | None:
    """A solver's trajectory as material; None if its body is of another kind or has loads that change."""
    given, rows = problem.given, trajectory.quantities
    is_other = given.body.manufactured is not None or not Equations.are_known(given.body)
    if is_other or not rows:
        return None
    values = {name: _doubles(rows[name]) for name in MOMENTA[given.model]}
    q = _doubles(rows["quaternion"]) if "quaternion" in rows else None
    unit = None if q is None else q / np.linalg.norm(q, axis=1, keepdims=True)
    return _material(given, values, unit, problem.rung, verdicts)


def _material(
    given: Scene,
    values: Mapping[str, Floats],
    quaternions: Floats | None,
    rung: Rung,
    verdicts: Iterable[Verdict],
) -> Material:
    needed, start = MOMENTA[given.model], given.initial
    nothing = np.full((len(given.clock.elapsed), 3), np.nan)
    attitude = np.array([float(value) for value in start.attitude])
    return Material(
        Equations.of(given.body),
        np.array([float(value) for value in start.moving]),
        attitude / np.linalg.norm(attitude),
        np.array([float(t) for t in given.clock.elapsed]),
        np.hstack([values.get(name, nothing) for name in needed]),
        quaternions,
        bits=rung.bits,
        failed={
            v.quantity: v for v in verdicts if v.verdict is Status.FAIL and v.quantity in STATES
        },
    )


def _momenta(file: TrajectoryFile, given: Scene) -> list[str]:
    return [name for name in MOMENTA[given.model] if name in file.groups]


def _read(file: TrajectoryFile, name: str, found: Conventions, attitudes: Floats | None) -> Floats:
    """A group of vectors in body axes; from space axes they are taken by the file's own attitude."""
    rows, reading = file.groups[name].doubles(), found.readings.get(name)
    if reading is None:
        return rows
    R = attitudes if attitudes is not None else np.full((len(rows), 3, 3), np.nan)
    return reading.read(rows, R)


def _attitudes(file: TrajectoryFile, given: Scene, found: Conventions) -> Floats | None:
    """The file's own attitudes; the exact ones where it has none and its omega is in space axes."""
    for group in ("quaternion", "attitude"):
        if group in file.groups:
            reading = found.readings.get(group, readings(group)[0])
            read = reading.read(file.groups[group].doubles(), np.empty(0))
            return rotations(read) if group == "quaternion" else read
    if not found.readings:
        return None
    tracked = replace(given, track=frozenset({"attitude"}))
    exact = solution(tracked).evaluate(given.clock.elapsed, _DIGITS)["attitude"]
    matrices: Floats = exact.astype(float)
    return matrices


def _quaternions(matrices: Floats | None) -> Floats | None:
    """Unit quaternions of rotation matrices (n, 3, 3), from the largest column of 4 q q^T."""
    if matrices is None:
        return None
    trace = np.trace(matrices, axis1=1, axis2=2)
    squares = np.empty((len(matrices), 4, 4))
    squares[:, 0, 0] = 1 + trace
    for i, k, m in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        squares[:, i + 1, i + 1] = 1 - trace + 2 * matrices[:, i, i]
        squares[:, 0, i + 1] = squares[:, i + 1, 0] = matrices[:, m, k] - matrices[:, k, m]
        mixed = matrices[:, i, k] + matrices[:, k, i]
        squares[:, i + 1, k + 1] = squares[:, k + 1, i + 1] = mixed
    largest = np.argmax(np.einsum("nii->ni", np.nan_to_num(squares)), axis=1)
    columns = squares[np.arange(len(squares)), largest]
    found: Floats = columns / np.linalg.norm(columns, axis=1, keepdims=True)
    return found


def _doubles(rows: Any) -> Floats:
    """Numbers as float64."""
    return np.array([[float(value) for value in row] for row in rows], dtype=float)
