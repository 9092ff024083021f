"""Answers from files and trajectories as material for the search, and its causes as sentences."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain
from typing import TYPE_CHECKING, Final

import numpy as np

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.causes.answer import Answer, Motion, steady_signs
from taylor_verify.judge.causes.budget import Budget, Spent
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.changed_scene import changed_scene
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.exact_motion import ExactMotion
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.missing_load import missing_load
from taylor_verify.judge.causes.own_rates import ASIDE, rates_of_attitudes
from taylor_verify.judge.causes.plugged import plugged_causes
from taylor_verify.judge.causes.printed import half_units
from taylor_verify.judge.causes.proof import LEAVES, may_leave
from taylor_verify.judge.causes.search import causes_of
from taylor_verify.judge.conventions.axes import quaternion_columns
from taylor_verify.judge.conventions.fits import Conventions
from taylor_verify.judge.conventions.readings import readings, rotations
from taylor_verify.judge.judgement import Judgement
from taylor_verify.models.acting import Acting
from taylor_verify.models.problem import Problem, adopt
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.records.answers import LikelyCause, MissingLoad
from taylor_verify.records.quantities import MOMENTA, VELOCITIES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.bodies import Body, ImmersedBody
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.vocabulary import INERTIA, VECTORS
from taylor_verify.scenes.scene import Scene
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
_WITH_TERMS: Final = frozenset({"rotor"})
_MOVING: Final = frozenset(chain(*MOMENTA.values(), VELOCITIES))
# Names in the texts of loads whose values are those of another body if the mass changes.
_OF_MASS: Final = frozenset((*INERTIA, *(f"{letter}{i}" for letter in "xy" for i in (1, 2, 3))))
_DIGITS: Final = 20
# R^T R of printed digits is off by less.
_NO_ROTATION: Final = 1e-5
# Of longer files every second row is examined, or every third, and so on.
_MOST_ROWS: Final = 1500
# The search for causes is silent if float64 or a decomposition fails, or at the end of its budget.
_SILENT: Final = (OverflowError, np.linalg.LinAlgError, Spent, Unsettled)
# Rates of attitudes need as many rows.
_FEWEST_ATTITUDES: Final = 20
# Work for each component of v.
_BUDGET: Final = 120_000.0
_BUDGET_WITHOUT_CLOSED_FORM: Final = 3_000_000.0


def are_known(body: Body) -> bool:
    """Return True if every part of the body has its terms in the search."""
    return body.others <= _WITH_TERMS and body.manufactured is None


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
            known = explained(answer)
            # A convention reaches the rounding of what it reads: no load is missing there.
            is_read = not _MOVING.isdisjoint(conventions.readings)
            return replace(known, facts=facts, missing_load=() if is_read else known.missing_load)
    return Explained(facts=facts)


def _no_rotation(file: TrajectoryFile) -> tuple[str, ...]:
    """Return the fact that the matrices of a file are no rotations, where they are not."""
    if "attitude" not in file.groups:
        return ()
    R = file.groups["attitude"].doubles().reshape(-1, 3, 3)
    with np.errstate(all="ignore"):
        off = np.max(np.abs(R.transpose(0, 2, 1) @ R - np.eye(3)), axis=(1, 2))
    wrong = np.flatnonzero(off > _NO_ROTATION)
    if not len(wrong):
        return ()
    worst = int(np.nanargmax(off))
    return (
        f"r11 ... r33 are no rotation: R^T R is off by {off[worst]:.2g} at t = "
        f"{float(file.times[worst]):.6g}, and by more than {_NO_ROTATION:g} since t = "
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
        answer = _of_trajectory(problem, trajectory, judged.verdicts)
        if answer is not None:
            known = explained(answer)
            causes, judged = known.causes, replace(judged, notes=(*judged.notes, *known.notes))
    named = (replace(cause, scene=scene.name, rung=problem.rung.name) for cause in causes)
    return replace(judged, causes=tuple(named))


def explained(answer: Answer) -> Explained:
    """Return the causes of an answer with their sentences; none at the end of the budget."""
    try:
        causes = causes_of(answer)
    except _SILENT:
        return Explained()
    causes = [*causes, *plugged_causes(answer)] if answer.has_rates else _of_frame(answer, causes)
    is_motion = bool(causes) and not any(map(_is_convention, causes))
    missing: tuple[MissingLoad, ...] = ()
    if not causes and answer.has_rates:
        with suppress(*_SILENT):
            missing = missing_load(answer)
    likely = tuple(_likely(cause, answer) for cause in causes)
    return Explained(likely, is_motion, missing_load=missing)


def _of_frame(answer: Answer, causes: Iterable[Cause]) -> list[Cause]:
    """Return the causes that explain the attitude, of a file that has no omega."""
    explains = may_leave(answer, ["attitude"], 1) if "attitude" in answer.failed else 0.0
    left = [(cause, cause.leaves.get("attitude", np.inf)) for cause in causes]
    return [replace(cause, leaves={"attitude": part}) for cause, part in left if part <= explains]


def _is_convention(cause: Cause) -> bool:
    return cause.kind in _READINGS or cause.name in _OTHER_BODIES


def _likely(cause: Cause, answer: Answer) -> LikelyCause:
    group = next(iter(cause.leaves), "omega")
    changed = changed_scene(answer.right, cause.changes)
    words = sentence(cause.title, cause.leaves, answer.worst, cause.alike, changed)
    leaves = max(cause.leaves.values(), default=1.0)
    name = cause.name.partition(":")[0]
    return LikelyCause(name, answer.quantity(group), leaves, words)


# Material.


def equations_of(given: Scene, has_momenta: bool) -> Equations:
    """Return the right equations of a scene."""
    body, parts = given.body, given.body.parts()
    energy = np.array(body.energy_matrix, dtype=float)
    mass = energy if given.model == "euler" else np.linalg.inv(energy)
    n, loads = len(mass), given.body.loads
    constant = [entry for name in body.load_names() for entry in parts[name]]
    added = body.added if isinstance(body, ImmersedBody) else None
    equations = replace(
        Equations.of_mass(mass, np.array(parts.get("rotor", (0, 0, 0)), dtype=float)),
        load=np.array(constant, dtype=float) if loads is None else np.zeros(n),
        has_momenta=has_momenta,
        start=float(given.clock.start),
        damping=float(body.damping),
        added=None if added is None else np.array(added, dtype=float),
    )
    if loads is None:
        return equations
    return replace(
        equations,
        acting=Acting(given, loads),
        texts=_texts(loads),
        is_hung=bool(loads.hung),
        names_mass=not loads.inputs.isdisjoint(_OF_MASS),
        reads=4 * loads.reads_attitude + 3 * loads.reads_centre,
        switches=np.array([float(s) for s in loads.switches]) if loads.switches else None,
        current=np.array(loads.current, dtype=float) if any(loads.current) else None,
    )


def _texts(loads: Loads) -> tuple[str, ...]:
    """Return the entries of the loads as texts."""
    entries = dict(loads.vectors)
    return tuple(
        str(entry) for name in VECTORS[loads.model] for entry in entries.get(name, ZERO_VECTOR)
    )


def material(
    given: Scene,
    file: Motion,
    has_momenta: bool,
    noise: tuple[Floats, float, float],
    verdicts: Iterable[Verdict],
    decimals: int | None = None,
    every: int = 1,
) -> Answer | None:
    """Return an answer to a rounded scene as material; None if nothing failed, or is comparable.

    ``every`` counts the rows of a file from one given row to the next.
    """
    failed = tuple(v.quantity for v in verdicts if v.verdict is Status.FAIL)
    right = equations_of(given, has_momenta)
    elapsed = np.array([float(t) for t in given.clock.elapsed])
    rows = _rows(elapsed, file)
    if len(rows) < 2 or not failed:
        return None
    exact = ExactMotion(given, file.c is not None or right.reads > 4)
    instants = [Fraction(0), *(given.clock.elapsed[k] for k in rows)]
    # Texts may read q1 q2 q3, whose signs are those of the scene's start.
    first = np.array(given.initial.attitude, dtype=float)
    truth = exact.at(instants, has_momenta).signed_as(first).at(np.s_[1:])
    start = exact.at(instants[:1], has_momenta=False).signed_as(first)
    compared = file.at(rows).signed_as(truth.first_attitude)
    return Answer(
        right,
        start,
        elapsed[rows],
        compared,
        truth,
        (_noise(noise[0], compared.v, truth.v), *noise[1:]),
        failed,
        Budget(_BUDGET * right.size if exact.has_closed_form else _BUDGET_WITHOUT_CLOSED_FORM),
        every * np.array(rows),
        decimals,
        scene=given,
    )


def _noise(noise: Floats, v: Floats, truth: Floats) -> Floats:
    """Return the noise of v; numbers that stand still while the truth moves by a unit were not rounded."""
    is_exact = (np.ptp(v, axis=0) == 0) & (np.ptp(truth, axis=0) > 2 * noise)
    return np.where(is_exact, 0.0, noise)


def _rows(elapsed: Floats, file: Motion) -> list[int]:
    """Return the rows of the longer side of the start, in the order away from it, up to the first flaw."""
    later, earlier = np.flatnonzero(elapsed >= 0), np.flatnonzero(elapsed <= 0)
    side = later if len(later) >= len(earlier) else earlier
    side = side[np.argsort(np.abs(elapsed[side]), kind="stable")]
    flawed = np.zeros(len(elapsed), dtype=bool)
    for part in (file.v, file.q, file.c):
        if part is not None:
            flawed |= ~np.all(np.isfinite(part) & (np.abs(part) < 1e100), axis=1)
    bad = np.flatnonzero(flawed[side])
    return [int(k) for k in (side[: bad[0]] if len(bad) else side)]


def material_of_file(
    file: TrajectoryFile,
    rung: Rung,
    conventions: Conventions,
    verdicts: Iterable[Verdict],
    every: int = 1,
) -> Answer | None:
    """Return a file as material; None if its body is unknown or its moving part is not whole.

    ``every`` counts the rows of the whole file from one row to the next.
    """
    given = adopt(conventions.world.scene, rung, conventions.world.times(file.times)).given
    if not are_known(given.body):
        return None
    names = [n for n in (MOMENTA[given.model], VELOCITIES) if set(n) <= set(file.groups)]
    if not names:
        return _of_attitudes(file, given, conventions, verdicts, every)
    read = [
        _read_by(file, given, conventions, names[0], attitudes, verdicts, every)
        for attitudes in _attitudes(file, given, conventions)
    ]
    known = [answer for answer in read if answer is not None]
    if not known:
        return None
    # Where the file's own attitude is wrong, the exact one is that of its space axes if it explains them.
    return next((each for each in known[1:] if each.off <= LEAVES * known[0].off), known[0])


def _of_attitudes(
    file: TrajectoryFile,
    given: Scene,
    conventions: Conventions,
    verdicts: Iterable[Verdict],
    every: int,
) -> Answer | None:
    """Return the attitudes of a rigid body, with their own rates, as material."""
    group, times = _frame_of(file), np.array([float(t) for t in file.times])
    if given.model != "euler" or not group or len(times) < _FEWEST_ATTITUDES:
        return None
    q, unit = _quaternions(file, group, conventions), 2 * half_units(file)[group]
    omega, noise = rates_of_attitudes(times, q, unit)
    inner = range(ASIDE, len(times) - ASIDE)
    instants = tuple(given.clock.instants[k] for k in inner)
    scene = replace(given, clock=replace(given.clock, instants=instants))
    failed = [replace(v, quantity="omega") for v in verdicts if v.verdict is Status.FAIL]
    motion = Motion(omega, q[inner])
    noises = (np.full(3, noise), unit, 0.0)
    answer = material(
        scene,
        motion,
        has_momenta=False,
        noise=noises,
        verdicts=[*verdicts, *failed[:1]],
        every=every,
    )
    return answer and replace(answer, has_rates=False)


def _quaternions(file: TrajectoryFile, group: str, conventions: Conventions) -> Floats:
    return steady_signs(quaternion_columns(_own_attitudes(file, group, conventions)))


def _read_by(
    file: TrajectoryFile,
    given: Scene,
    conventions: Conventions,
    names: tuple[str, ...],
    attitudes: Floats | None,
    verdicts: Iterable[Verdict],
    every: int,
) -> Answer | None:
    """Return a file as material, its space axes taken to body axes by these attitudes."""
    has_momenta = given.model == "kirchhoff" and names == MOMENTA[given.model]
    v, noise, units = [], [], half_units(file)
    for name in names:
        rows = _read(file, name, conventions, attitudes)
        v.append(rows)
        noise.append(np.full(3, units[name] * _ratio(rows, file.groups[name].doubles())))
    frame, q, c = _frame_of(file), None, None
    if frame:
        q = _quaternions(file, frame, conventions)
    if "centre" in file.groups:
        c = _read(file, "centre", conventions, attitudes)
    of_frame, of_centre = 2 * units.get(frame, 0.0), units.get("centre", 0.0)
    motion, noises = Motion(np.hstack(v), q, c), (np.concatenate(noise), of_frame, of_centre)
    return material(given, motion, has_momenta, noises, verdicts, _decimals(file.times), every)


def _frame_of(file: TrajectoryFile) -> str:
    """Return the group that has the file's attitudes; empty if none has."""
    return next((name for name in ("quaternion", "attitude") if name in file.groups), "")


def _ratio(rows: Floats, columns: Floats) -> float:
    """Return the factor of a reading, by the sizes of the rows."""
    before, after = float(np.nanmax(np.abs(columns))), float(np.nanmax(np.abs(rows)))
    return after / before if before > 0 else 1.0


def _decimals(times: Iterable[Fraction]) -> int | None:
    """Return the number of decimals that the times need; None if they need more than six."""
    for digits in range(7):
        if all((time * 10**digits).denominator == 1 for time in times):
            return digits
    return None


def _of_trajectory(
    problem: Problem, trajectory: Trajectory, verdicts: Iterable[Verdict]
) -> Answer | None:
    """Return a trajectory as material."""
    given, rows = problem.given, trajectory.quantities
    names = MOMENTA[given.model]
    if not rows or not set(names) <= set(rows):
        return None
    v = np.hstack([rows[name].astype(float) for name in names])
    q = steady_signs(rows["quaternion"].astype(float)) if "quaternion" in rows else None
    c = rows["centre"].astype(float) if "centre" in rows else None
    unit = 8 * float(problem.rung.unit_roundoff)
    noise = (
        unit * np.max(np.abs(v), axis=0),
        unit,
        unit if c is None else unit * float(np.max(np.abs(c))),
    )
    return material(given, Motion(v, q, c), given.model == "kirchhoff", noise, verdicts)


def _read(
    file: TrajectoryFile, name: str, conventions: Conventions, attitudes: Floats | None
) -> Floats:
    """Return a group of vectors in body axes; space axes are converted by the file's own attitude."""
    rows, reading = file.groups[name].doubles(), conventions.readings.get(name)
    if reading is None:
        return rows
    R = attitudes if attitudes is not None else np.full((len(rows), 3, 3), np.nan)
    return reading.read(rows, R)


def _attitudes(file: TrajectoryFile, given: Scene, conventions: Conventions) -> list[Floats | None]:
    """Return the attitudes that may take space axes to body axes: the file's own and the exact ones."""
    group, has_readings = _frame_of(file), bool(_MOVING & set(conventions.readings))
    own = [_own_attitudes(file, group, conventions)] if group else []
    if not has_readings:
        return [*own, None][:1]
    exact = solution(replace(given, track=frozenset({"attitude"})))
    return [*own, exact.evaluate(given.clock.elapsed, _DIGITS)["attitude"].astype(float)]


def _own_attitudes(file: TrajectoryFile, group: str, conventions: Conventions) -> Floats:
    reading = conventions.readings.get(group, readings(group)[0])
    read = reading.read(file.groups[group].doubles(), np.empty(0))
    return rotations(read) if group == "quaternion" else read
