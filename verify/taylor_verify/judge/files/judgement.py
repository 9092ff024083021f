"""The judgement of a trajectory file, and the search for its conventions if it does not fit.

The file is judged as it stands. Only if a row does not fit, its conventions are searched; if the caller
accepts them, the file is read by them and judged again. Rows before the scene's start and rows after it
are two runs that begin at the start.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from math import inf
from typing import Any, Final

import numpy as np

from taylor_verify.exact.conditioning.condition import is_far_decay
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.causes.likely import NOT_LOOKED_FOR, Explained, causes_of_file
from taylor_verify.judge.causes.material import are_known
from taylor_verify.judge.conventions.angle_meanings import with_angles
from taylor_verify.judge.conventions.convention_search import MOST_SPANS, conventions
from taylor_verify.judge.conventions.fits import EXPLAINS, Conventions, Finding
from taylor_verify.judge.conventions.meanings import space_axes
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
from taylor_verify.judge.files.file_rows import FileRows, first_flaw, first_zero_quaternion
from taylor_verify.judge.files.stored import storing, with_file_kinds
from taylor_verify.judge.first_row import initial_verdict
from taylor_verify.judge.floor.counted_steps import Steps
from taylor_verify.judge.floor.gimbal import with_angles_rounded
from taylor_verify.judge.floor.rounded_input import input_rounding
from taylor_verify.judge.gated import Gate, gates_of
from taylor_verify.judge.judged_rows import Run, run_record
from taylor_verify.judge.judgement import Judgement, unjudged
from taylor_verify.judge.load_notes import breaks_of, load_notes
from taylor_verify.judge.tolerances import NO_TOLERANCES, Tolerances
from taylor_verify.models.problem import NotRepresentable, adopt
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.answers import Convention, FileRead, MissingLoad
from taylor_verify.records.json_text import complete
from taylor_verify.records.quantities import is_state, with_needs
from taylor_verify.records.reason import Carried, Cause
from taylor_verify.records.record import Record
from taylor_verify.records.status import GRAVITY, Status
from taylor_verify.records.verdict import Verdict, summary
from taylor_verify.scenes.doubles import within_doubles
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded, TrajectoryFile

FAR_ROWS: Final = (
    "rows after t = {:.6g} are far beyond the scene and not judged: those before are wrong"
)
NO_CONVENTIONS: Final = (
    "no convention and no shift of time is corrected under the loads of this scene, which may read the "
    "time and the axes; causes are looked for"
)
_NO_JUDGEMENT: Final = (NotRepresentable, Unsettled)
# So few rows are not judged in place of all.
_FEWEST: Final = 8
# A file goes at most this many times the scene's span where it is dear, or no floor is known.
_FURTHEST: Final = 100


@dataclass(frozen=True, repr=False)
class FileJudgement(Judgement):
    """The verdicts on a file, its conventions and notes.

    ``conventions`` are those that differ from the scene's, ``accepted`` is True if they were corrected.
    ``breaks`` says where the equations of the scene are not smooth in time; empty where they are.
    ``missing_load`` is what explains the rows where no cause is proven.
    """

    file: TrajectoryFile
    conventions: tuple[Finding, ...] = ()
    accepted: bool = False
    breaks: str = ""
    missing_load: tuple[MissingLoad, ...] = ()

    @property
    def remarks(self) -> tuple[str, ...]:
        """The conventions that differ from the scene's and the notes, a sentence each."""
        return (*(finding.sentence for finding in self.conventions), *self.notes)

    def document(self) -> dict[str, Any]:
        """Return the document that `check --json` prints."""
        columns = (column for group in self.file.groups for column in self.file.columns[group])
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
            "missing_load": complete(self.missing_load),
            "file": complete(file),
        }


def judge_file(
    file: TrajectoryFile,
    scene: Scene,
    rung: Rung,
    accept_conventions: bool = False,
    partial: bool = False,
    tolerances: Tolerances = NO_TOLERANCES,
    elsewhere: Sequence[str] = (),
) -> FileJudgement:
    """Judge a file as a result of arithmetic on the rung.

    solvers.files defines the columns. Times are absolute, in the scene's unit, and each row is compared
    at its own time. With ``accept_conventions`` the file's conventions are corrected before it is judged.
    If the file lacks a part of what the scene asks, there is a row `complete`: undecided, or vacuous if
    ``partial`` answers are accepted. ``tolerances`` replace the bounds. Groups ``elsewhere`` are judged in
    another part of the file. Raises Refused if nothing can be compared.
    """
    if file.apart:
        parts = (replace(file, apart=()), *file.apart)
        every = [name for part in parts for name in part.groups]
        options = (rung, accept_conventions, partial, tolerances, every)
        return _of_parts(file, [judge_file(part, scene, *options) for part in parts])
    groups = comparable(file, scene)
    has = (*groups, *elsewhere)
    plain = _Examined.of(file, scene, groups, rung)
    judged, examined = _examined(plain, scene, tolerances, accept_conventions)
    known, explained, notes = examined.known, Explained(), tuple[str, ...]()
    if judged.record is not None:
        lacks, about_span = _coverage(examined, scene, has, partial)
        judged, notes = replace(judged, verdicts=(*judged.verdicts, *lacks)), tuple(about_span)
    if any(verdict.verdict is Status.FAIL for verdict in judged.verdicts):
        explained = examined.explained or explained
        if known.findings or examined.explained is None:
            explained = causes_of_file(examined.in_body_axes, rung, known, judged)
        notes += _notes_of_failure(file, plain.scene, rung, known, explained)
        if len(examined.rows.times) < len(plain.rows.times):
            notes += (FAR_ROWS.format(float(examined.rows.times[-1])),)
    if judged.record is not None:
        notes += tuple(load_notes(plain.scene))
    left = () if accept_conventions else known.findings
    return FileJudgement(
        with_file_kinds(judged.verdicts, file, rung, left),
        judged.record,
        file,
        conventions=known.findings,
        accepted=accept_conventions,
        breaks=breaks_of(plain.scene),
        missing_load=explained.missing_load,
        causes=explained.causes,
        notes=(*file.notes, *coverage_notes(file, has, scene), *notes),
    )


@dataclass(frozen=True)
class _Examined:
    """A file under examination: its rows as they are judged, and what is known of them.

    ``scene`` asks for no more than the file has, and ``file`` has the groups that are compared. Causes are
    looked for by a judgement: before there is one, they are None.
    """

    file: TrajectoryFile
    scene: Scene
    rows: FileRows
    known: Conventions
    explained: Explained | None

    @classmethod
    def of(cls, file: TrajectoryFile, scene: Scene, groups: Sequence[str], rung: Rung) -> _Examined:
        """Return a file as it stands."""
        compared = replace(file, groups={name: file.groups[name] for name in groups})
        tracked = with_needs({scene.known_groups[name].quantity for name in groups})
        scene = replace(scene, track=scene.track & tracked, states=scene.states & tracked)
        along_space = {name: space_axes() for name in file.in_space if name in groups}
        known = Conventions((), World(scene), along_space)
        return cls(compared, scene, FileRows.of(compared, rung, known), known, Explained())

    @property
    def near(self) -> _Examined:
        """The file without the rows that are far beyond the scene's end."""
        clock = self.rows.scene.clock
        reach = MOST_SPANS * max(abs(t) for t in clock.elapsed)
        near = [k for k, t in enumerate(self.rows.times) if abs(t - clock.start) <= reach]
        file = self.file.at(near)
        return replace(self, file=file, rows=FileRows.of(file, self.rows.rung, self.known))

    @property
    def in_body_axes(self) -> TrajectoryFile:
        """The file without what it says is in space axes, for which nothing is searched."""
        groups = {n: rows for n, rows in self.file.groups.items() if n not in self.file.in_space}
        return replace(self.file, groups=groups)

    def searched(self, judged: Judgement | None, is_accepted: bool) -> _Examined:
        """Return what explains the rows, and their conventions; they are read by them if accepted."""
        rung, scene = self.rows.rung, self.scene
        file, angles = with_angles(self.file, scene, rung)
        examined = replace(self, file=file)
        rows, known, explained = examined.in_body_axes, self.known, self.explained
        if rows.groups:
            explained = None if judged is None else causes_of_file(rows, rung, known, judged)
            is_open = is_accepted or explained is None or not explained.is_motion
            # Under loads a unit of time alone is looked for: without one such a file is too far.
            if is_open and (scene.body.loads is None or judged is None):
                read = conventions(rows, scene, rung)
                known = replace(read, readings={**known.readings, **read.readings})
        if angles:
            known = replace(known, findings=(angles, *known.findings))
        as_read = FileRows.of(file, rung, known) if is_accepted else self.rows
        return replace(examined, rows=as_read, known=known, explained=explained)


def _examined(
    plain: _Examined, asked: Scene, tolerances: Tolerances, is_accepted: bool
) -> tuple[Judgement, _Examined]:
    """Return the judgement of a file, and the file with what explains it; one that fits is not searched."""
    judged, examined = None, plain
    if not _is_far(plain.rows):
        try:
            with within_doubles(asked, Unsettled):
                judged = _judged(plain.rows, tolerances)
        except _NO_JUDGEMENT as doubt:
            return _without_truth(plain.rows, doubt), plain
        if _fits(judged):
            return judged, plain
    # What the search cannot tell is no matter of the verdict.
    with suppress(*_NO_JUDGEMENT), within_doubles(asked, Unsettled):
        examined = plain.searched(judged, is_accepted)
    if judged is None or (is_accepted and examined.known.findings):
        try:
            with within_doubles(asked, Unsettled):
                return _judged_within_reach(examined, tolerances)
        except _NO_JUDGEMENT as doubt:
            return _without_truth(examined.rows, doubt), examined
    return judged, examined


def _without_truth(rows: FileRows, doubt: Exception) -> Judgement:
    """Return one row that says why the rows are not judged."""
    if isinstance(doubt, NotRepresentable):
        return _alone(rows, Status.REFUSED, str(doubt), Cause.NOT_POSED)
    return _alone(rows, Status.UNDECIDED, str(doubt), Cause.NO_TRUTH)


def _coverage(
    examined: _Examined, asked: Scene, has: Sequence[str], partial: bool
) -> tuple[list[Verdict], list[str]]:
    """Return a row on what the file lacks, none if it is whole, and notes on its span."""
    rows = examined.rows
    extent = Extent.of(rows.scene, rows.times, rows.rung)
    lack = list(not_judged(extent, missing_groups(has, asked)))
    asks = (examined.scene, examined.file.name, rows.rung, lack, partial)
    notes = list(span_notes(rows.scene, rows.times, extent))
    return [complete_verdict(*asks)] if lack else [], notes


def _notes_of_failure(
    file: TrajectoryFile, scene: Scene, rung: Rung, known: Conventions, explained: Explained
) -> tuple[str, ...]:
    """Return the sentences on a file that fails: facts, and what was not looked for."""
    notes, stored = explained.notes, storing(file, rung)
    notes += () if are_known(scene.body) else (NOT_LOOKED_FOR,)
    notes += () if scene.body.loads is None or known.findings else (NO_CONVENTIONS,)
    return notes if stored is None else (*notes, stored.note)


def _of_parts(file: TrajectoryFile, judged: Sequence[FileJudgement]) -> FileJudgement:
    """Return the judgement of a file by those of its parts, each of which has rows of its own.

    A state is judged in the part that has all of its rows.
    """
    verdicts: dict[str, Verdict] = {}
    for verdict in (verdict for part in judged for verdict in part.verdicts):
        before = verdicts.get(verdict.quantity, verdict)
        is_worse = GRAVITY.index(verdict.verdict) < GRAVITY.index(before.verdict)
        if before is verdict or is_state(verdict.quantity) or is_worse:
            verdicts[verdict.quantity] = verdict
    conventions = {finding.sentence: finding for part in judged for finding in part.conventions}
    causes = {cause.sentence: cause for part in judged for cause in part.causes}
    return replace(
        judged[0],
        file=file,
        verdicts=tuple(verdicts.values()),
        conventions=tuple(conventions.values()),
        causes=tuple(causes.values()),
        notes=tuple(dict.fromkeys(note for part in judged for note in part.notes)),
        missing_load=next((part.missing_load for part in judged if part.missing_load), ()),
    )


def _fits(judged: Judgement) -> bool:
    """Return True if all states pass as the file stands, so that no convention is needed to explain them.

    A tolerance that is nearly as large as the motion could let a wrong convention pass.
    """
    states = [verdict for verdict in judged.verdicts if is_state(verdict.quantity)]
    return all(
        verdict.verdict is Status.PASS and (verdict.tolerance or 0.0) <= EXPLAINS
        for verdict in states
    )


def _judged(answer: FileRows, tolerances: Tolerances) -> Judgement:
    """Judge the rows before and after the start; of each quantity the worse verdict counts."""
    records, gates = list[Record](), dict[str, list[Gate]]()
    for side in answer.sides():
        problem = adopt(side.scene, side.rung, side.instants)
        solver = Recorded(side, setting=side.file.name, carries_velocities=side.has_velocities)
        run = Run(problem, solver, solver.solve(problem), tolerances)
        inputs = with_angles_rounded(
            input_rounding(problem.given, side.rung, problem.scene),
            side.file,
            side.places,
            float(side.rung.unit_roundoff),
        )
        of_side = gates_of(run, Steps(0), inputs)
        records.append(run_record(run, [gate.record for gate in of_side]))
        for gate in of_side:
            gates.setdefault(gate.errors.quantity, []).append(gate)
    every = [gate for sides in gates.values() for gate in sides]
    verdicts = [_verdict_of(sides, answer.file) for sides in gates.values()]
    record = max(records, key=lambda each: len(each.times))
    return Judgement((*initial_verdict(every, Carried.ROW), *verdicts), record)


def _verdict_of(sides: Sequence[Gate], file: TrajectoryFile) -> Verdict:
    """Return the worse verdict on a quantity over both directions of time, or that nearer to its bound."""
    verdict = min((gate.verdict for gate in sides), key=_gravity)
    is_finite = all(np.isfinite(gate.errors.values).all() for gate in sides)
    if is_finite:
        return verdict
    cause, flaw = Cause.NOT_FINITE, first_flaw(file, verdict.quantity)
    if not flaw:
        cause, flaw = Cause.NO_ATTITUDE, first_zero_quaternion(file)
    return replace(verdict, reason=verdict.reason.with_remark(cause, flaw)) if flaw else verdict


def _gravity(verdict: Verdict) -> tuple[int, float]:
    ratio = verdict.ratio if verdict.tolerance is None else verdict.max
    return GRAVITY.index(verdict.verdict), -inf if ratio is None or ratio != ratio else -ratio


def _judged_within_reach(
    examined: _Examined, tolerances: Tolerances
) -> tuple[Judgement, _Examined]:
    """Judge the rows, those near the scene's end first where others are far."""
    answer, world = examined.rows, examined.known.world
    is_far = _is_far(answer)
    if is_far and world.scale != 1:
        why = (
            f"{world.words}; as it stands the file asks for times far beyond the scene, and they are not "
            "computed: the rows near the start are wrong already"
        )
        return _alone(answer, Status.FAIL, why, Cause.TOO_FAR), examined
    if is_far and len((near := examined.near).rows.times) >= _FEWEST:
        judged = _judged(near.rows, tolerances)
        if any(verdict.verdict is Status.FAIL for verdict in judged.verdicts):
            return judged, near
    if _is_far(answer, _FURTHEST):
        why = (
            f"the file goes more than {_FURTHEST} times as far as the scene: its exact motion is not "
            "computed up to there"
        )
        return _alone(answer, Status.UNDECIDED, why, Cause.TOO_FAR), examined
    return _judged(answer, tolerances), examined


def _is_far(answer: FileRows, spans: int = MOST_SPANS) -> bool:
    """Return True for rows more than ``spans`` spans away, where the truth is dear or no floor is known."""
    scene, times = answer.scene, answer.times
    reach = max(abs(t - scene.clock.start) for t in (times[0], times[-1]))
    if reach <= spans * max(abs(t) for t in scene.clock.elapsed):
        return False
    return is_far_decay(scene, reach) or solution(scene).route == "taylor"


def _alone(answer: FileRows, status: Status, why: str, cause: Cause) -> Judgement:
    """Return one row for a file that was not compared."""
    solver = Recorded({}, setting=answer.file.name)
    return unjudged(answer.scene, solver, answer.rung, status, why, cause)
