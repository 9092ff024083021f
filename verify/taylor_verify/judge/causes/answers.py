"""Conversion of files and trajectories to material for hypotheses: body axes, float64, a row per time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.exact.route import solution
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Material
from taylor_verify.judge.causes.search import likely_causes
from taylor_verify.judge.conventions.axes import quaternion_columns
from taylor_verify.judge.conventions.fits import Conventions
from taylor_verify.judge.conventions.readings import readings, rotations
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.velocities import has_velocities, momenta
from taylor_verify.models.problem import Problem, adopt
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.answers import LikelyCause
from taylor_verify.records.quantities import MOMENTA, STATES, VELOCITIES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import Trajectory

if TYPE_CHECKING:
    from taylor_verify.solvers.files.file import TrajectoryFile

NOT_LOOKED_FOR: Final = (
    "likely causes are not looked for: this body has terms or loads that the search does not know"
)
_DIGITS: Final = 20
_MOST_ROWS: Final = 4096
# If the range of float64 or a matrix decomposition fails, no cause is named.
_NO_CAUSE: Final = (OverflowError, np.linalg.LinAlgError)


def causes_of_file(
    file: TrajectoryFile, rung: Rung, conventions: Conventions, judged: Judgement
) -> tuple[LikelyCause, ...]:
    """Return the likely causes of the failures in a file, read by its conventions.

    Only the first rows of a long file are examined, because every cause acts from row to row.
    """
    first = file.at(range(min(len(file.times), _MOST_ROWS)))
    with np.errstate(all="ignore"), suppress(*_NO_CAUSE):
        return likely_causes(
            _of_file(first, rung, conventions, judged.verdicts), conventions.world.scene
        )
    return ()


def with_causes(judged: Judgement, problem: Problem, trajectory: Trajectory) -> Judgement:
    """Return the judgement of a trajectory with the likely causes of its failures added."""
    if not any(verdict.verdict is Status.FAIL for verdict in judged.verdicts):
        return judged
    scene, causes = problem.scene, tuple[LikelyCause, ...]()
    if not Equations.are_known(problem.given.body):
        return replace(judged, notes=(*judged.notes, NOT_LOOKED_FOR))
    with np.errstate(all="ignore"), suppress(*_NO_CAUSE):
        causes = likely_causes(_of_trajectory(problem, trajectory, judged.verdicts), scene)
    named = (replace(cause, scene=scene.name, rung=problem.rung.name) for cause in causes)
    return replace(judged, causes=tuple(named))


def _of_file(
    file: TrajectoryFile, rung: Rung, conventions: Conventions, verdicts: Iterable[Verdict]
) -> Material | None:
    """Return a file as material; None if its body is of another kind or has variable loads."""
    given = adopt(conventions.world.scene, rung, conventions.world.times(file.times)).given
    if not Equations.are_known(given.body):
        return None
    attitudes = _attitudes(file, given, conventions)
    groups = [name for name in MOMENTA[given.model] if name in file.groups]
    values = {name: _read(file, name, conventions, attitudes) for name in groups}
    columns = np.hstack([file.groups[name].doubles() for name in groups]) if groups else None
    if not groups and has_velocities(given.body) and set(VELOCITIES) <= set(file.groups):
        own = {name: _read(file, name, conventions, attitudes) for name in VELOCITIES}
        values = {name: rows.astype(float) for name, rows in momenta(given.body, own).items()}
    q = None if attitudes is None else _unit(quaternion_columns(attitudes))
    material = _material(given, values, q, rung, verdicts)
    return replace(material, digits=file.digits, columns=columns)


def _of_trajectory(
    problem: Problem, trajectory: Trajectory, verdicts: Iterable[Verdict]
) -> Material | None:
    """Return a trajectory as material; None if its body is of another kind or has variable loads."""
    given, rows = problem.given, trajectory.quantities
    if not rows or not Equations.are_known(given.body):
        return None
    values = {name: _doubles(rows[name]) for name in MOMENTA[given.model]}
    q = _unit(_doubles(rows["quaternion"])) if "quaternion" in rows else None
    return _material(given, values, q, problem.rung, verdicts)


def _material(
    given: Scene,
    values: Mapping[str, Floats],
    quaternions: Floats | None,
    rung: Rung,
    verdicts: Iterable[Verdict],
) -> Material:
    nothing = np.full((len(given.clock.elapsed), 3), np.nan)
    attitude = np.array(given.initial.attitude, dtype=float)
    return Material(
        Equations.of(given.body),
        np.array(given.initial.moving, dtype=float),
        attitude / np.linalg.norm(attitude),
        np.array(given.clock.elapsed, dtype=float),
        np.hstack([values.get(name, nothing) for name in MOMENTA[given.model]]),
        quaternions,
        bits=rung.bits,
        failed={
            v.quantity: v for v in verdicts if v.verdict is Status.FAIL and v.quantity in STATES
        },
    )


def _read(
    file: TrajectoryFile, name: str, conventions: Conventions, attitudes: Floats | None
) -> Floats:
    """Return a group of vectors in body axes; space axes are converted by the file's own attitude."""
    rows, reading = file.groups[name].doubles(), conventions.readings.get(name)
    if reading is None:
        return rows
    R = attitudes if attitudes is not None else np.full((len(rows), 3, 3), np.nan)
    return reading.read(rows, R)


def _attitudes(file: TrajectoryFile, given: Scene, conventions: Conventions) -> Floats | None:
    """Return the file's attitudes; the exact ones if it has none and its omega is in space axes."""
    for group in ("quaternion", "attitude"):
        if group in file.groups:
            reading = conventions.readings.get(group, readings(group)[0])
            read = reading.read(file.groups[group].doubles(), np.empty(0))
            return rotations(read) if group == "quaternion" else read
    if not conventions.readings:
        return None
    tracked = replace(given, track=frozenset({"attitude"}))
    exact: Floats = (
        solution(tracked).evaluate(given.clock.elapsed, _DIGITS)["attitude"].astype(float)
    )
    return exact


def _unit(quaternions: Floats) -> Floats:
    unit: Floats = quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)
    return unit


def _doubles(rows: Any) -> Floats:
    """Return numbers as float64."""
    return np.array([[float(value) for value in row] for row in rows], dtype=float)
