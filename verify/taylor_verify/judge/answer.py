"""The judgement of somebody's trajectory: conventions first, then every quantity it has.

The file is taken as the scene writes things, or as it was found to write them where that is accepted.
Rows before the scene's start and rows after it are two runs that begin at the start.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from operator import neg
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.causes.answers import causes_of_file
from taylor_verify.judge.complete import Extent, complete_verdict, not_judged
from taylor_verify.judge.conventions.readings import Reading
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
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.judge.floor.inputs import input_rounding
from taylor_verify.judge.floor.partial import partial_judgement
from taylor_verify.judge.initial import initial_verdict
from taylor_verify.judge.judgement import Judgement, unjudged
from taylor_verify.judge.regraded import Graded, graded, merged, verdict_of
from taylor_verify.judge.storage import with_file_kinds
from taylor_verify.judge.tolerances import NO_TOLERANCES, Tolerances
from taylor_verify.judge.velocities import has_velocities, momenta
from taylor_verify.models.problem import NotRepresentable, adopt
from taylor_verify.records.answers import Convention, FileRead, LikelyCause
from taylor_verify.records.json_text import complete
from taylor_verify.records.quantities import COLUMNS, MOMENTA, VELOCITIES
from taylor_verify.records.reason import Cause
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, summary
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded, TrajectoryFile
from taylor_verify.solvers.trajectory import ByRows

Array = np.ndarray[Any, Any]

# What is not dyadic in a file, and a correction, is rounded so far below the rung.
_SPARE_BITS: Final = 128
# How far the Taylor route is sent for a file.
_MOST_SPANS: Final = 100
# The columns that the states are read from; what is conserved may need any of them.
_MADE_OF: Final = {
    "omega": ("omega",),
    "impulse": ("linear_impulse", "angular_impulse", *VELOCITIES),
    "velocity": ("linear_velocity",),
    "attitude": ("quaternion", "attitude"),
    "centre": ("centre",),
}


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
    scene = replace(scene, track=scene.track & tracked(groups))
    found = Conventions((), World(scene), {})
    try:
        found = conventions(compared, scene, rung)
        answer = _Answer.of(compared, scene, rung, found if accept_conventions else None)
        judged = _judged(answer, compared, rung, found, tolerances)
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
    causes: tuple[LikelyCause, ...] = ()
    if failed:
        causes = causes_of_file(compared, rung, found, judged)
        notes += (*cut_off(file, rung), *single_precision(file, rung))
    left = [finding for finding in found.findings if not accept_conventions]
    verdicts = with_file_kinds(judged.verdicts, file, rung, left)
    return FileJudgement(
        verdicts,
        judged.record,
        file,
        found.findings,
        accept_conventions,
        notes,
        causes=causes,
    )


def _judged(
    answer: _Answer, file: TrajectoryFile, rung: Rung, found: Conventions, tolerances: Tolerances
) -> Judgement:
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
    sides = [_side(part, rung, file.name, tolerances) for part in answer.sides()]
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
class _Answer(ByRows):
    """Rows of a file, and the scene it is held against. ``times`` are those of all its rows.

    ``places`` are the rows that count, in the order away from the start.
    """

    scene: Scene
    times: Sequence[Fraction]
    file: TrajectoryFile
    rung: Rung
    readings: Mapping[str, Reading]
    places: range

    @classmethod
    def of(
        cls, file: TrajectoryFile, scene: Scene, rung: Rung, accepted: Conventions | None
    ) -> _Answer:
        places = range(len(file.times))
        if accepted is None:
            return cls(scene, file.times, file, rung, {}, places)
        world = accepted.world
        return cls(world.scene, world.times(file.times), file, rung, accepted.readings, places)

    @property
    def count(self) -> int:  # type: ignore[override]
        return len(self.places)

    @property
    def instants(self) -> tuple[Fraction, ...]:
        """The times of the rows that count."""
        return tuple(self.times[k] for k in self.places)

    def __iter__(self) -> Iterator[str]:
        made = MOMENTA[self.scene.model] if self.has_velocities else ()
        return iter((*self.file.groups, *made))

    def rows(self, places: Sequence[int]) -> dict[str, Array]:
        asked, bits = _within(self.places, places), self.rung.bits + _SPARE_BITS
        found = {name: rows.held(asked, bits) for name, rows in self.file.rows.items()}
        if "attitude" in found:
            found["attitude"] = found["attitude"].reshape(-1, 3, 3)
        if self.readings:
            R = _attitudes(self.scene, self.rung, tuple(self.times[k] for k in asked), bits)
            with mp.workprec(bits):
                for name, reading in self.readings.items():
                    found[name] = reading.read(found[name], R)
        if self.has_velocities:
            with mp.workprec(bits):
                found |= momenta(self.scene.body, found)
        return found

    @property
    def has_velocities(self) -> bool:
        """True if the impulses are made of the velocities, since the file has none of its own."""
        has = set(self.file.groups)
        stands_for = has_velocities(self.scene.body) and has.issuperset(VELOCITIES)
        return stands_for and not has & set(MOMENTA[self.scene.model])

    def sides(self) -> list[_Answer]:
        """The rows after the start and those before it, each in the order away from the start."""
        start, times, count = self.scene.clock.start, self.times, len(self.times)
        if times[0] <= times[-1]:
            at, beyond = bisect_left(times, start), bisect_right(times, start)
            earlier, here, later = range(at - 1, -1, -1), range(at, beyond), range(beyond, count)
        else:
            at = bisect_left(times, -start, key=neg)
            beyond = bisect_right(times, -start, key=neg)
            earlier, here, later = range(beyond, count), range(at, beyond), range(at - 1, -1, -1)
        if earlier and not later:
            sides = [range(earlier.start - earlier.step * len(here), earlier.stop, earlier.step)]
        else:
            first = later.start - later.step * len(here) if later else at
            sides = [range(first, later.stop, later.step) if later else here, earlier]
        return [replace(self, places=side) for side in sides if side]


def _within(rows: range, places: Sequence[int]) -> Sequence[int]:
    """The places of some of these rows in the file."""
    if isinstance(places, range) and places.step == 1:
        return rows[places.start : places.stop]
    return [rows[k] for k in places]


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


def _side(answer: _Answer, rung: Rung, name: str, tolerances: Tolerances) -> _Side:
    problem = adopt(answer.scene, rung, answer.instants)
    solver = Recorded(answer, setting=name, carries_velocities=answer.has_velocities)
    judged = partial_judgement(problem, solver, tolerances)
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
    """The place of the first value of a quantity that is no finite number; empty if there is none."""
    groups = [name for name in _MADE_OF.get(quantity, tuple(COLUMNS)) if name in file.groups]
    lost = {name: np.flatnonzero(~file.rows[name].finite) for name in groups}
    first = {name: int(rows[0]) for name, rows in lost.items() if len(rows)}
    if not first:
        return ""
    group = min(first, key=lambda name: first[name])
    row = first[group]
    name, value = next(
        (name, value)
        for name, value in zip(COLUMNS[group], file.groups[group][row], strict=True)
        if not isinstance(value, Fraction)
    )
    return f"{name} is {value} in row {row + 1}, t = {float(file.times[row]):g}"
