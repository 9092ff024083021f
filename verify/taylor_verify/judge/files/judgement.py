"""The judgement of a trajectory file: first its conventions, then every quantity in it.

The file is read by the scene's conventions, or by the conventions that the search returned if the caller
accepts them. Rows before the scene's start and rows after it are two runs that begin at the start.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.causes.answers import NOT_LOOKED_FOR, causes_of_file
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.conventions.fits import Conventions, Finding
from taylor_verify.judge.conventions.search import conventions, is_far
from taylor_verify.judge.conventions.worlds import World
from taylor_verify.judge.files.coverage import (
    Extent,
    comparable,
    complete_verdict,
    coverage_notes,
    missing_groups,
    not_judged,
    span_notes,
)
from taylor_verify.judge.files.partial import partial_judgement
from taylor_verify.judge.files.rows import FileRows, first_flaw
from taylor_verify.judge.files.stored import storing, with_file_kinds
from taylor_verify.judge.floor.inputs import input_rounding
from taylor_verify.judge.initial import initial_verdict
from taylor_verify.judge.judgement import Judgement, unjudged
from taylor_verify.judge.regraded import Graded, graded, merged, verdict_of
from taylor_verify.judge.tolerances import NO_TOLERANCES, Tolerances
from taylor_verify.models.problem import NotRepresentable, adopt
from taylor_verify.records.answers import Convention, FileRead, LikelyCause
from taylor_verify.records.json_text import complete
from taylor_verify.records.quantities import COLUMNS, GROUPS, with_needs
from taylor_verify.records.reason import Cause
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import summary
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded, TrajectoryFile

# For a file the Taylor route goes at most this many times the scene's span.
_MOST_SPANS: Final = 100


@dataclass(frozen=True, repr=False)
class FileJudgement(Judgement):
    """The verdicts on a file, its conventions and notes.

    ``conventions`` are those that differ from the scene's, ``accepted`` is True if they were corrected.
    """

    file: TrajectoryFile
    conventions: tuple[Finding, ...] = ()
    accepted: bool = False

    @property
    def remarks(self) -> tuple[str, ...]:
        """The conventions that differ from the scene's and the notes, a sentence each."""
        return (*(finding.sentence for finding in self.conventions), *self.notes)

    def document(self) -> dict[str, Any]:
        """Return the document that `check --json` prints."""
        columns = (column for group in self.file.groups for column in COLUMNS[group])
        file = FileRead(self.file.name, len(self.file.times), ("t", *columns), self.notes)
        conventions = [
            Convention(
                about=finding.subject,
                found=finding.words,
                ambiguous=not finding.is_certain,
                corrected=self.accepted and finding.is_certain,
                sentence=finding.sentence,
                alternatives=finding.alternatives,
                error_without=finding.before,
                error_with=finding.after,
            )
            for finding in self.conventions
        ]
        return {
            "verdicts": [verdict.row() for verdict in self.verdicts],
            "summary": summary(self.verdicts),
            "conventions": complete(conventions),
            "causes": complete(self.causes),
            "file": complete(file),
        }


def judge_file(
    file: TrajectoryFile,
    scene: Scene,
    rung: Rung,
    accept_conventions: bool = False,
    partial: bool = False,
    tolerances: Tolerances = NO_TOLERANCES,
) -> FileJudgement:
    """Judge a file as a result of arithmetic on the rung.

    solvers.files defines the columns. Times are absolute, in the scene's unit, and each row is compared
    at its own time. With ``accept_conventions`` the file's conventions are corrected before it is judged.
    If the file lacks a part of what the scene asks, there is a row `complete`: undecided, or vacuous if
    ``partial`` answers are accepted. ``tolerances`` replace the bounds. Raises Refused if nothing can be
    compared.
    """
    groups = comparable(file, scene)
    asked, notes = scene, (*file.notes, *coverage_notes(file, groups, scene))
    compared = replace(file, groups={name: file.groups[name] for name in groups})
    tracked = with_needs({GROUPS[name].quantity for name in groups})
    scene = replace(scene, track=scene.track & tracked)
    file_conventions = Conventions((), World(scene), {})
    try:
        file_conventions = conventions(compared, scene, rung)
        answer = FileRows.of(
            compared, scene, rung, file_conventions if accept_conventions else None
        )
        judged = _judged(answer, compared, rung, file_conventions, tolerances)
        extent = Extent.of(answer.scene, answer.times, rung)
        notes += tuple(span_notes(answer.scene, answer.times, extent))
        lack = list(not_judged(extent, missing_groups(groups, asked)))
        if lack and judged.record is not None:
            row = complete_verdict(scene, file.name, rung, lack, partial)
            judged = replace(judged, verdicts=(*judged.verdicts, row))
    except NotRepresentable as reason:
        judged = _alone(scene, file, rung, Status.REFUSED, str(reason), Cause.NOT_POSED)
    except Unsettled as doubt:
        judged = _alone(scene, file, rung, Status.UNDECIDED, str(doubt), Cause.NO_TRUTH)
    causes: tuple[LikelyCause, ...] = ()
    if any(verdict.verdict is Status.FAIL for verdict in judged.verdicts):
        causes = causes_of_file(compared, rung, file_conventions, judged)
        notes += () if Equations.are_known(scene.body) else (NOT_LOOKED_FOR,)
        stored = storing(file, rung)
        notes += () if stored is None else (stored.note,)
    left = () if accept_conventions else file_conventions.findings
    verdicts = with_file_kinds(judged.verdicts, file, rung, left)
    of_file = (file, file_conventions.findings, accept_conventions)
    return FileJudgement(verdicts, judged.record, *of_file, causes=causes, notes=notes)


def _judged(
    answer: FileRows,
    file: TrajectoryFile,
    rung: Rung,
    file_conventions: Conventions,
    tolerances: Tolerances,
) -> Judgement:
    """Judge the rows before and after the start, and return both judgements in one."""
    scene = answer.scene
    if file_conventions.world.scale != 1 and is_far(scene, answer.times):
        why = (
            f"{file_conventions.world.words}; as it stands the file asks for times far beyond the scene, "
            "which has no closed form, and they are not computed: the rows near the start are wrong already"
        )
        return _alone(scene, file, rung, Status.FAIL, why, Cause.TOO_FAR)
    if is_far(scene, answer.times, _MOST_SPANS):
        why = (
            f"the file goes more than {_MOST_SPANS} times as far as the scene, which has no closed "
            "form: its exact motion is not computed up to there"
        )
        return _alone(scene, file, rung, Status.UNDECIDED, why, Cause.TOO_FAR)
    gates: dict[str, list[Graded]] = {}
    records, start = [], float(scene.clock.start)
    for side in answer.sides():
        problem = adopt(side.scene, rung, side.instants)
        solver = Recorded(side, setting=file.name, carries_velocities=side.has_velocities)
        judged = partial_judgement(problem, solver, tolerances)
        if judged.record is None:
            return judged
        records.append(judged.record)
        inputs = input_rounding(problem.given, rung, problem.scene)
        for gate in graded(judged.verdicts, judged.record, inputs, float(rung.unit_roundoff)):
            gates.setdefault(gate.verdict.quantity, []).append(gate)
    verdicts = []
    for quantity, both in gates.items():
        is_sound = all(np.all(np.isfinite(side.errors)) for side in both)
        verdicts.append(verdict_of(both, "" if is_sound else first_flaw(file, quantity), start))
    every = [gate for both in gates.values() for gate in both]
    return Judgement((*initial_verdict(every, start), *verdicts), merged(records, every))


def _alone(
    scene: Scene, file: TrajectoryFile, rung: Rung, status: Status, why: str, cause: Cause
) -> Judgement:
    """Return one row for a file that was not compared."""
    return unjudged(scene, Recorded({}, setting=file.name), rung, status, why, cause)
