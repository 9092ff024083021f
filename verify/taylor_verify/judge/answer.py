"""The judgement of somebody's trajectory: conventions first, then every quantity it has.

The file is taken as the scene writes things, or as it was found to write them where that is accepted.
Rows before the scene's start and rows after it are two runs that begin at the start.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.arithmetic import truth_digits
from taylor_verify.judge.complete import Extent, complete_verdict, not_judged
from taylor_verify.judge.conventions.search import Conventions, Finding, conventions, is_far
from taylor_verify.judge.conventions.worlds import World
from taylor_verify.judge.file_notes import (
    comparable,
    coverage_notes,
    cut_off,
    missing_groups,
    no_end,
    no_start,
    noun,
    single_precision,
    tracked,
)
from taylor_verify.judge.gyroscopic import gyroscopic_cause
from taylor_verify.judge.initial import initial_verdict
from taylor_verify.judge.inputs import input_rounding
from taylor_verify.judge.judgement import Judgement, unjudged
from taylor_verify.judge.partial import partial_judgement
from taylor_verify.judge.regraded import Graded, graded, merged, verdict_of
from taylor_verify.judge.storage import with_file_kinds
from taylor_verify.models.problem import NotRepresentable, adopt
from taylor_verify.records.answers import Convention, FileRead, LikelyCause
from taylor_verify.records.json_text import complete
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.records.reason import Cause
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, summary
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.file import Recorded, TrajectoryFile
from taylor_verify.solvers.values import held

Array = np.ndarray[Any, Any]

# What is not dyadic in a file, and a correction, is rounded so far below the rung.
_SPARE_BITS: Final = 128
# How far the Taylor route is sent for a file.
_MOST_SPANS: Final = 100
# The columns that the states are read from; what is conserved may need any of them.
_MADE_OF: Final = {
    "omega": ("omega",),
    "impulse": ("linear_impulse", "angular_impulse"),
    "attitude": ("quaternion", "attitude"),
    "centre": ("centre",),
}


@dataclass(frozen=True, repr=False)
class FileJudgement(Judgement):
    """The verdicts on a file, and what was found out about it.

    ``conventions`` are those that are not the scene's, ``accepted`` says whether they were corrected,
    ``notes`` are sentences about what was not compared and why, ``causes`` explain wrong dynamics.
    """

    file: TrajectoryFile
    conventions: tuple[Finding, ...] = ()
    accepted: bool = False
    notes: tuple[str, ...] = ()
    causes: tuple[LikelyCause, ...] = ()

    def document(self) -> dict[str, Any]:
        """Return the document that `check --json` prints."""
        groups = self.file.groups
        file = FileRead(
            self.file.name,
            len(self.file.times),
            ("t", *(column for group in groups for column in COLUMNS[group])),
            self.notes,
        )
        return {
            "verdicts": [verdict.row() for verdict in self.verdicts],
            "summary": summary(self.verdicts),
            "conventions": [complete(self._convention(finding)) for finding in self.conventions],
            "causes": [complete(cause) for cause in self.causes],
            "file": complete(file),
        }

    def _convention(self, found: Finding) -> Convention:
        return Convention(
            about=found.subject,
            found=found.words,
            ambiguous=not found.is_certain,
            corrected=self.accepted and found.is_certain,
            sentence=found.sentence,
            alternatives=found.alternatives,
            error_without=found.before,
            error_with=found.after,
        )


def judge_file(
    file: TrajectoryFile,
    scene: Scene,
    rung: Rung,
    accept_conventions: bool = False,
    partial: bool = False,
) -> FileJudgement:
    """Judge a file as arithmetic of the rung.

    What its columns are is that of solvers.file; its times are absolute, in the scene's unit, and each
    row is compared at its own time. With ``accept_conventions`` what was found out about it is corrected
    before it is judged. A file that lacks a part of what the scene asks has a row `complete` that is
    undecided, or vacuous if a ``partial`` answer is asked for. Raises Refused if it has nothing to
    compare.
    """
    groups = comparable(file, scene)
    asked, notes = scene, tuple(coverage_notes(file, groups, scene))
    compared = replace(file, groups={name: file.groups[name] for name in groups})
    scene = replace(scene, track=scene.track & tracked(groups))
    found = Conventions((), World(scene), {})
    try:
        found = conventions(compared, scene, rung)
        answer = _Answer.of(compared, scene, rung, found if accept_conventions else None)
        judged = _judged(answer, compared, rung, found)
        extent = Extent.of(answer.scene, answer.times, rung)
        notes += (
            *no_start(answer.scene, answer.times),
            *no_end(answer.scene, answer.times, extent),
        )
        lack = list(not_judged(extent, [noun(name) for name in missing_groups(groups, asked)]))
        if lack and judged.record is not None:
            complete = complete_verdict(scene, file.name, rung, lack, partial)
            judged = replace(judged, verdicts=(*judged.verdicts, complete))
    except NotRepresentable as reason:
        judged = _alone(scene, file, rung, Status.REFUSED, str(reason), Cause.NOT_POSED)
    except Unsettled as doubt:
        judged = _alone(scene, file, rung, Status.UNDECIDED, str(doubt), Cause.NO_TRUTH)
    failed = {v.quantity for v in judged.verdicts if v.verdict is Status.FAIL}
    causes = gyroscopic_cause(compared, scene, rung, found) if "omega" in failed else ()
    if failed:
        notes += (*cut_off(file, rung), *single_precision(file, rung))
    left = [finding for finding in found.findings if not accept_conventions]
    verdicts = with_file_kinds(judged.verdicts, file, rung, left)
    return FileJudgement(
        verdicts, judged.record, file, found.findings, accept_conventions, notes, causes
    )


def _judged(answer: _Answer, file: TrajectoryFile, rung: Rung, found: Conventions) -> Judgement:
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
    sides = [_side(part, rung, file.name) for part in answer.sides()]
    unfinished = next((side.judgement for side in sides if side.judgement.record is None), None)
    if unfinished is not None:
        return unfinished
    return _united(sides, file, float(scene.clock.start))


def _alone(
    scene: Scene, file: TrajectoryFile, rung: Rung, status: Status, why: str, cause: Cause
) -> Judgement:
    """Return one row for a file that was not compared."""
    return unjudged(scene, Recorded({}, setting=file.name), rung, status, why, cause)


# The file as held numbers, corrected where that was accepted.


@dataclass(frozen=True)
class _Answer:
    """Times and quantities of a run, and the scene it is held against."""

    scene: Scene
    times: tuple[Fraction, ...]
    quantities: Mapping[str, Array]

    @classmethod
    def of(
        cls, file: TrajectoryFile, scene: Scene, rung: Rung, accepted: Conventions | None
    ) -> _Answer:
        bits = rung.bits + _SPARE_BITS
        quantities = {name: held(rows, bits) for name, rows in file.groups.items()}
        if "attitude" in quantities:
            quantities["attitude"] = quantities["attitude"].reshape(-1, 3, 3)
        if accepted is None:
            return cls(scene, file.times, quantities)
        world = accepted.world
        scene, times = world.scene, world.times(file.times)
        if accepted.readings:
            R = _attitudes(scene, rung, times, bits)
            with mp.workprec(bits):
                for name, reading in accepted.readings.items():
                    quantities[name] = reading.read(quantities[name], R)
        return cls(scene, times, quantities)

    def sides(self) -> list[_Answer]:
        """The rows after the start and those before it, each in the order away from the start."""
        start = self.scene.clock.start
        later = sorted((k for k, t in enumerate(self.times) if t >= start), key=self._distance)
        earlier = sorted((k for k, t in enumerate(self.times) if t < start), key=self._distance)
        at_start = [k for k in later if self.times[k] == start]
        if earlier and later == at_start:
            later, earlier = [], at_start + earlier
        return [self._rows(rows) for rows in (later, earlier) if rows]

    def _distance(self, row: int) -> Fraction:
        return abs(self.times[row] - self.scene.clock.start)

    def _rows(self, rows: list[int]) -> _Answer:
        quantities = {name: values[rows] for name, values in self.quantities.items()}
        return _Answer(self.scene, tuple(self.times[k] for k in rows), quantities)


def _attitudes(scene: Scene, rung: Rung, times: tuple[Fraction, ...], bits: int) -> Array:
    """The exact R at these times, for vectors that are in space axes."""
    given = replace(adopt(scene, rung, times).given, track=frozenset({"attitude"}))
    digits = truth_digits(bits, 0)
    return solution(given).motion(given.clock.elapsed, digits)["attitude"]


# The judgement of either side of the start, and of both.


@dataclass(frozen=True)
class _Side:
    judgement: Judgement
    gates: list[Graded]


def _side(answer: _Answer, rung: Rung, name: str) -> _Side:
    problem = adopt(answer.scene, rung, answer.times)
    judged = partial_judgement(problem, Recorded(answer.quantities, setting=name))
    if judged.record is None:
        return _Side(judged, [])
    inputs = input_rounding(problem.given, rung, problem.scene)
    return _Side(judged, graded(judged, inputs, float(rung.unit_roundoff)))


def _united(sides: Sequence[_Side], file: TrajectoryFile, start: float) -> Judgement:
    gates = [gate for side in sides for gate in side.gates]
    names = list(dict.fromkeys(gate.verdict.quantity for gate in gates))
    verdicts = [
        _verdict([g for g in gates if g.verdict.quantity == name], file, start) for name in names
    ]
    initial = initial_verdict(gates, start)
    records = [side.judgement.record for side in sides if side.judgement.record is not None]
    first = (initial,) if initial is not None else ()
    return Judgement((*first, *verdicts), merged(records, gates))


def _verdict(sides: Sequence[Graded], file: TrajectoryFile, start: float) -> Verdict:
    is_sound = all(np.all(np.isfinite(side.errors)) for side in sides)
    flaw = "" if is_sound else _flaw(file, sides[0].verdict.quantity)
    return verdict_of(sides, flaw, start)


def _flaw(file: TrajectoryFile, quantity: str) -> str:
    """Where the first value of a quantity stands that is no finite number; empty if there is none."""
    groups = _MADE_OF.get(quantity, tuple(COLUMNS))
    for row, time in enumerate(file.times):
        for group in groups:
            values = file.groups[group][row] if group in file.groups else ()
            for name, value in zip(COLUMNS[group], values, strict=False):
                if not isinstance(value, Fraction):
                    return f"{name} is {value} in row {row + 1}, t = {float(time):g}"
    return ""
