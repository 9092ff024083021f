"""The likely causes of the failures of a file or a trajectory, as sentences."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.causes.budget import Budget, Spent
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.cause_search import causes_of
from taylor_verify.judge.causes.changed_course import own_rows
from taylor_verify.judge.causes.changed_scene import changed_scene, changed_start
from taylor_verify.judge.causes.float_answer import Answer, Places
from taylor_verify.judge.causes.last_place import half_units
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.material import (
    are_known,
    material_of_file,
    material_of_trajectory,
)
from taylor_verify.judge.causes.missing_load import missing_load
from taylor_verify.judge.causes.plugged import plugged_causes
from taylor_verify.judge.causes.proof import may_leave
from taylor_verify.judge.causes.stepped_arcs import stepped
from taylor_verify.judge.conventions.fits import Conventions
from taylor_verify.judge.judgement import Judgement
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.answers import LikelyCause, MissingLoad
from taylor_verify.records.status import Status
from taylor_verify.solvers.trajectory import Trajectory
from taylor_verify.words.causes import missing_load_line, sentence

if TYPE_CHECKING:
    from taylor_verify.solvers.files.file import TrajectoryFile

NOT_LOOKED_FOR: Final = (
    "likely causes are not looked for: this body has terms of its own that the search does not know"
)
_READINGS: Final = frozenset({"convention", "clock", "stamps", "omega against attitude"})
# Other bodies that are conventions of a scene's text: judge.conventions.worlds reads a file by them.
_OTHER_BODIES: Final = frozenset(
    {"products of inertia with the other sign", "coupling B of the energy transposed"}
)
# R^T R is off by more, and by more than printed digits make of it: half a unit of six entries.
_NO_ROTATION: Final = 1e-5
_UNITS: Final = 8
# Of longer files every second row is examined, or every third, and so on.
_MOST_ROWS: Final = 1500
# The search for causes is silent if float64 or a decomposition fails, or at the end of its budget.
_SILENT: Final = (OverflowError, np.linalg.LinAlgError, Spent, Unsettled)
# A motion that has grown to so many times that of the scene runs away; so many rows before it may tell why.
_AWAY: Final = 10.0
_FEWEST_BEFORE: Final = 12
# What may be spent on the load that explains the rows: it is told where the search has ended.
_FOR_A_LOAD: Final = 600_000.0


@dataclass(frozen=True)
class Explained:
    """The likely causes of an answer, and facts; ``is_motion`` if none is a convention or a clock."""

    causes: tuple[LikelyCause, ...] = ()
    is_motion: bool = False
    facts: tuple[str, ...] = ()
    missing_load: tuple[MissingLoad, ...] = ()

    @property
    def notes(self) -> tuple[str, ...]:
        """The facts, and the load that is missing, as sentences."""
        return (*self.facts, *map(missing_load_line, filter(None, [self.missing_load])))


def causes_of_file(
    file: TrajectoryFile, rung: Rung, conventions: Conventions, judged: Judgement | None
) -> Explained:
    """Return the likely causes of the failures in a file, read by its conventions."""
    if judged is None:
        return Explained()
    count = len(file.times)
    every = max(1, -(-count // _MOST_ROWS))
    first = file.at(range(0, count, every))
    facts = _no_rotation(first)
    with np.errstate(all="ignore"), suppress(*_SILENT):
        answer = material_of_file(first, rung, conventions, judged.verdicts, every)
        if answer is not None:
            rows = {name: group.doubles() for name, group in first.groups.items()}
            own = _own_states(answer, rows, answer.places // every)
            known, facts = explained(answer, own), (*facts, *_lost_rows(file, answer))
            # A convention tells the story of the rows: no load is missing beside it.
            missing = () if conventions.findings else known.missing_load
            return replace(known, facts=facts, missing_load=missing)
    return Explained(facts=facts)


def _lost_rows(file: TrajectoryFile, answer: Answer) -> tuple[str, ...]:
    """Return the fact that some rows of a file are not finite or zero, and whether all others are right."""
    groups = {
        name: rows.doubles().reshape(len(file.times), -1) for name, rows in file.groups.items()
    }
    values = np.hstack([*groups.values()])
    is_zero = np.zeros(len(values), dtype=bool)
    for name in groups.keys() & {"quaternion", "attitude"}:
        is_zero |= np.all(groups[name] == 0, axis=1)
    wrong = np.flatnonzero(~np.all(np.isfinite(values), axis=1) | is_zero)
    if not len(wrong):
        return ()
    what = "zero" if np.all(is_zero[wrong]) else "not finite"
    times = [float(file.times[row]) for row in wrong]
    is_end = wrong[-1] == len(values) - 1 and len(wrong) == wrong[-1] - wrong[0] + 1 > 1
    if is_end:
        words, others = f"all rows from t = {times[0]:.6g} on are {what}", "those before"
    elif len(wrong) == 1:
        words, others = f"one row is {what} (t = {times[0]:.6g})", "all others"
    else:
        words = f"{len(wrong)} rows are {what} (first at t = {times[0]:.6g})"
        others = "all others"
    are_all = answer.count + len(wrong) == len(values)
    right = others if are_all else f"all of {answer.count} examined rows"
    return (f"{words}; {right} are right" if not answer.failed else words,)


def _no_rotation(file: TrajectoryFile) -> tuple[str, ...]:
    """Return the fact that the matrices of a file are no rotations, where they are not."""
    if "attitude" not in file.groups:
        return ()
    R = file.groups["attitude"].doubles().reshape(-1, 3, 3)
    with np.errstate(all="ignore"):
        off = np.max(np.abs(R.transpose(0, 2, 1) @ R - np.eye(3)), axis=(1, 2))
    least = max(_NO_ROTATION, _UNITS * half_units(file)["attitude"])
    wrong = np.flatnonzero(off > least)
    if not len(wrong):
        return ()
    worst = int(np.nanargmax(off))
    return (
        f"r11 ... r33 are no rotation: R^T R is off by {off[worst]:.2g} at t = "
        f"{float(file.times[worst]):.6g}, and by more than {least:.2g} since t = "
        f"{float(file.times[wrong[0]]):.6g}",
    )


def with_causes(judged: Judgement, problem: Problem, trajectory: Trajectory) -> Judgement:
    """Return the judgement of a trajectory with the likely causes of its failures added."""
    if not any(verdict.verdict is Status.FAIL for verdict in judged.verdicts):
        return judged
    scene, causes = problem.scene, tuple[LikelyCause, ...]()
    if not are_known(problem.given.body):
        return replace(judged, notes=(*judged.notes, NOT_LOOKED_FOR))
    with np.errstate(all="ignore"), suppress(*_SILENT):
        answer = material_of_trajectory(problem, trajectory, judged.verdicts)
        if answer is not None:
            own = _own_states(answer, trajectory.quantities, answer.places)
            known = explained(answer, own)
            causes, judged = known.causes, replace(judged, notes=(*judged.notes, *known.notes))
    named = (replace(cause, scene=scene.name, rung=problem.rung.name) for cause in causes)
    return replace(judged, causes=tuple(named))


def _own_states(
    answer: Answer, quantities: Mapping[str, np.ndarray[Any, Any]], places: Places
) -> dict[str, Floats]:
    """Return the rows of the scene's own states that failed, (rows, components), by their names."""
    states = () if answer.scene is None else answer.scene.own_states
    return {
        s.name: quantities[s.name].reshape(-1, len(s.components))[places].astype(float)
        for s in states
        if s.name in answer.quantities and s.name in quantities
    }


def explained(answer: Answer, own: Mapping[str, Floats] | None = None) -> Explained:
    """Return the causes of an answer with their sentences; none at the end of the budget.

    ``own`` are the rows of own states that failed.
    """
    causes: list[Cause] = []
    with suppress(*_SILENT):
        answer, causes = _causes(answer)
    causes = [*causes, *plugged_causes(answer)] if answer.has_rates else _of_frame(answer, causes)
    are_readings = (cause.kind in _READINGS or cause.name in _OTHER_BODIES for cause in causes)
    is_motion = bool(causes) and not any(are_readings)
    missing: tuple[MissingLoad, ...] = ()
    if not causes and answer.has_rates and not set(answer.moving).isdisjoint(answer.failed):
        with suppress(*_SILENT):
            missing = missing_load(replace(answer, budget=Budget(_FOR_A_LOAD)))
    likely = tuple(_likely(cause, answer, own or {}) for cause in causes)
    return Explained(likely, is_motion, missing_load=missing)


def _causes(answer: Answer) -> tuple[Answer, list[Cause]]:
    """Return the causes of an answer, or of its rows before it runs away, with the rows that have them."""
    far = np.any(np.abs(answer.file.v) > _AWAY * answer.sizes, axis=1)
    before = answer.at(np.s_[: int(np.argmax(far))])
    if before.count < _FEWEST_BEFORE:
        return answer, causes_of(answer)
    with suppress(*_SILENT), answer.budget.at_most(answer.budget.left / 2):
        if causes := causes_of(answer):
            return answer, causes
    last = before.times[-1] + answer.right.start
    words = f"up to t = {last:.6g}, before the motion runs away"
    causes = causes_of(before)
    return before, [
        replace(cause, where=": ".join(filter(None, (words, cause.where)))) for cause in causes
    ]


def _of_frame(answer: Answer, causes: Iterable[Cause]) -> list[Cause]:
    """Return the causes that explain the attitude, or the centre, of a file that has no velocities."""
    frame = [name for name in answer.failed if name in ("attitude", "centre")]
    explain = {name: may_leave(answer, [name], 1) for name in frame}
    some = [
        replace(
            cause, leaves={name: part for name, part in cause.leaves.items() if name in explain}
        )
        for cause in causes
    ]
    return [
        cause
        for cause in some
        if cause.leaves and all(part <= explain[name] for name, part in cause.leaves.items())
    ]


def _likely(cause: Cause, answer: Answer, own: Mapping[str, Floats]) -> LikelyCause:
    group = next(iter(cause.leaves), "omega")
    changed = changed_scene(answer.right, cause.changes)
    if changed and "mass" in cause.changes and not cause.where:
        start = changed_start(answer, cause.changes["mass"])
        changed += f"; and in [initial] {start}" * bool(start)
    parts, errors = _left_of_states(answer, cause, own) if changed and own else ({}, {})
    all_left, all_errors = {**cause.leaves, **parts}, {**answer.worst, **errors}
    words = sentence(cause.title, all_left, all_errors, cause.alike, changed)
    leaves = max(cause.leaves.values(), default=1.0)
    name = cause.name.partition(":")[0]
    return LikelyCause(name, answer.quantity(group), leaves, words)


def _left_of_states(
    answer: Answer, cause: Cause, own: Mapping[str, Floats]
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the parts of the errors of own states that a cause leaves, and these errors."""
    parts, errors = dict[str, float](), dict[str, float]()
    with suppress(*_SILENT):
        answer = replace(answer, budget=Budget(_FOR_A_LOAD))
        moved = stepped(answer, cause.method) if cause.method else answer
        right, changed = own_rows(answer, {}), own_rows(moved, cause.changes)
        for name, rows in own.items():
            error = float(np.max(np.abs(rows - right[name])))
            if error > 0 and name in changed:
                parts[name], errors[name] = (
                    float(np.max(np.abs(rows - changed[name]))) / error,
                    error,
                )
    return parts, errors
