"""The judgement of somebody's trajectory: conventions first, then every quantity it has.

The file is taken as the scene writes things, or as it was found to write them where that is accepted.
Rows before the scene's start and rows after it are two runs that begin at the start.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.causes.answers import causes_of_file
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

# The Taylor route goes no further than so many times the scene's span for a file.
_MOST_SPANS: Final = 100


@dataclass(frozen=True, repr=False)
class FileJudgement(Judgement):
    """The verdicts on a file, and what was found out about it.

    ``conventions`` are those that are not the scene's, ``accepted`` says whether they were corrected,
    ``notes`` are sentences about what was not compared and why.
    """

    file: TrajectoryFile
    conventions: tuple[Finding, ...] = ()
    accepted: bool = False
    notes: tuple[str, ...] = ()

    def document(self) -> dict[str, Any]:
        """Return the document that `check --json` prints."""
        columns = (column for group in self.file.groups for column in COLUMNS[group])
        file = FileRead(self.file.name, len(self.file.times), ("t", *columns), self.notes)
        conventions = [
            Convention(
                about=found.subject,
                found=found.words,
                ambiguous=not found.is_certain,
                corrected=self.accepted and found.is_certain,
                sentence=found.sentence,
                alternatives=found.alternatives,
                error_without=found.before,
                error_with=found.after,
            )
            for found in self.conventions
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
    """Judge a file as arithmetic of the rung.

    What its columns are is that of solvers.file; its times are absolute, in the scene's unit, and each
    row is compared at its own time. With ``accept_conventions`` what was found out about it is corrected
    before it is judged. A file that lacks a part of what the scene asks has a row `complete` that is
    undecided, or vacuous if a ``partial`` answer is asked for. ``tolerances`` take the place of bounds.
    Raises Refused if it has nothing to compare.
    """
    groups = comparable(file, scene)
    asked, notes = scene, (*file.notes, *coverage_notes(file, groups, scene))
    compared = replace(file, groups={name: file.groups[name] for name in groups})
    tracked = with_needs({GROUPS[name].quantity for name in groups})
    scene = replace(scene, track=scene.track & tracked)
    found = Conventions((), World(scene), {})
    try:
        found = conventions(compared, scene, rung)
        answer = FileRows.of(compared, scene, rung, found if accept_conventions else None)
        judged = _judged(answer, compared, rung, found, tolerances)
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
        causes = causes_of_file(compared, rung, found, judged)
        stored = storing(file, rung)
        notes += () if stored is None else (stored.note,)
    left = () if accept_conventions else found.findings
    verdicts = with_file_kinds(judged.verdicts, file, rung, left)
    of_file = (file, found.findings, accept_conventions, notes)
    return FileJudgement(verdicts, judged.record, *of_file, causes=causes)


def _judged(
    answer: FileRows, file: TrajectoryFile, rung: Rung, found: Conventions, tolerances: Tolerances
) -> Judgement:
    """The judgement of either side of the start, and of both together."""
    scene = answer.scene
    if found.world.scale != 1 and is_far(scene, answer.times):
        why = (
            f"{found.world.words}; as it stands the file asks for times far beyond the scene, which has "
            "no closed form, and they are not computed: the rows near the start are wrong already"
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
