"""Answers from files and trajectories as material for the search for causes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import chain
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.exact.conditioning.loaded import known
from taylor_verify.exact.route import solution
from taylor_verify.judge.causes.basis import basis
from taylor_verify.judge.causes.budget import Budget
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.energies import as_written
from taylor_verify.judge.causes.float_answer import Answer, Motion, velocities_of
from taylor_verify.judge.causes.last_place import half_units
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.own_rates import ASIDE, rates_of_attitudes
from taylor_verify.judge.causes.proof import LEAVES
from taylor_verify.judge.causes.quaternion_rows import matrices, steady_signs
from taylor_verify.judge.conventions.axis_orders import quaternion_columns
from taylor_verify.judge.conventions.fits import Conventions
from taylor_verify.judge.conventions.meanings import readings, rotations
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.models.acting import Acting
from taylor_verify.models.problem import Problem, adopt
from taylor_verify.numbers.precision import Rung, rung
from taylor_verify.numbers.tensors import inverse
from taylor_verify.records.quantities import MOMENTA, VELOCITIES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import Trajectory

if TYPE_CHECKING:
    from taylor_verify.solvers.files.file import TrajectoryFile

_WITH_TERMS: Final = frozenset({"rotor"})
MOVING: Final = frozenset(chain(*MOMENTA.values(), VELOCITIES))
# The digits of a judge of doubles.
_DIGITS: Final = truth_digits(rung("f64").bits)
# Rates of attitudes need as many rows.
_FEWEST_ATTITUDES: Final = 20
# Rates that are known to no more than this part tell no equation.
_TOO_COARSE: Final = 1e-2
# The work of a search; a motion without closed form takes as long itself.
_BUDGET: Final = 400_000.0
_BUDGET_WITHOUT_CLOSED_FORM: Final = 3_200_000.0


class ExactMotion:
    """The exact motion of a scene with its attitude, and with its centre if it ``has_centre``.

    Where the judge has asked about the scene it is the judge's, from one run.
    """

    def __init__(self, scene: Scene, has_centre: bool) -> None:
        self._scene = scene
        track = scene.track | {"attitude", *["centre"] * has_centre}
        self._exact = known(replace(scene, track=track), _DIGITS)
        self.has_closed_form = self._exact.route != "taylor"

    def at(self, elapsed: list[Fraction], has_momenta: bool) -> Motion:
        """Return the rows at these times since the start, with momenta or velocities. Raises Unsettled."""
        rows = self._exact.evaluate(elapsed, _DIGITS)
        q = steady_signs(quaternion_columns(rows["attitude"].astype(float)))
        c = rows["centre"].astype(float) if "centre" in rows else None
        return Motion(self._moving(rows, has_momenta), q, c)

    def _moving(self, rows: Mapping[str, Any], has_momenta: bool) -> Any:
        scene = self._scene
        v = np.hstack([rows[name].astype(float) for name in MOMENTA[scene.model]])
        if scene.model == "kirchhoff" and not has_momenta:
            return v @ np.array(scene.body.energy_matrix, dtype=float).T
        return v


def are_known(body: Body) -> bool:
    """Return True if every part of the body has its terms in the search."""
    return body.others <= _WITH_TERMS


def equations_of(given: Scene, has_momenta: bool) -> Equations:
    """Return the right equations of a scene."""
    body, parts = given.body, given.body.parts()
    energy = np.array(body.energy_matrix, dtype=float)
    # Rounded from the exact inverse, so that a scene which is printed has its own numbers.
    exactly = body.energy_matrix if given.model == "euler" else inverse(body.energy_matrix)
    mass = np.array(exactly, dtype=float)
    n, loads = len(mass), given.body.loads
    constant = [entry for name in body.load_names() for entry in parts[name]]
    acting = None if loads is None else Acting(given, loads)
    if acting is not None and _are_constant(acting.written):
        constant, acting = acting.loads(0.0, np.zeros(n)).tolist(), None
    added = body.added_mass
    return Equations(
        mass,
        rotor=np.array(parts.get("rotor", (0, 0, 0)), dtype=float),
        load=np.array(constant, dtype=float) if acting is None else np.zeros(n),
        extra=np.zeros((n, basis(n).count)),
        has_momenta=has_momenta,
        scene_mass=mass,
        start=float(given.clock.start),
        damping=float(body.damping),
        added=None if added is None else np.array(added, dtype=float),
        energy=as_written(energy, mass) if added is None else None,
        acting=acting,
    )


def _are_constant(loads: Loads) -> bool:
    """Return True if texts write no more than constant loads in body axes."""
    has_more = loads.inputs or loads.states or loads.rotor or loads.switches
    return not (has_more or any(loads.current))


def material(
    given: Scene,
    file: Motion,
    has_momenta: bool,
    noise: tuple[Floats, float, float],
    verdicts: Iterable[Verdict],
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
    motion = exact.at(instants, has_momenta).signed_as(first)
    start, truth = motion.at(np.s_[:1]), motion.at(np.s_[1:])
    start = replace(start, v=velocities_of(right, start.v))
    assert truth.q is not None
    compared = file.at(rows).signed_as(truth.q[0])
    return Answer(
        right,
        start,
        elapsed[rows],
        compared,
        truth,
        (_noise(noise[0], compared.v, truth.v), *noise[1:]),
        failed,
        Budget(_BUDGET if exact.has_closed_form else _BUDGET_WITHOUT_CLOSED_FORM),
        every * np.array(rows),
        scene=given,
    )


def _noise(noise: Floats, v: Floats, truth: Floats) -> Floats:
    """Return the noise of v; numbers that stand still while the truth moves by a unit were not rounded."""
    is_exact = (np.ptp(v, axis=0) == 0) & (np.ptp(truth, axis=0) > 2 * noise)
    return np.where(is_exact, 0.0, noise)


def _rows(elapsed: Floats, file: Motion) -> list[int]:
    """Return the rows of the longer side of the start, in the order away from it, without flawed ones."""
    later, earlier = np.flatnonzero(elapsed >= 0), np.flatnonzero(elapsed <= 0)
    side = later if len(later) >= len(earlier) else earlier
    side = side[np.argsort(np.abs(elapsed[side]), kind="stable")]
    flawed = np.zeros(len(elapsed), dtype=bool)
    for part in (file.v, file.q, file.c):
        if part is not None:
            flawed |= ~np.all(np.isfinite(part) & (np.abs(part) < 1e100), axis=1)
    return [int(k) for k in side if not flawed[k]]


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
        group, times = _frame_of(file), np.array([float(t) for t in file.times])
        if not group:
            return None
        units, centre = half_units(file), None
        q, unit = _quaternions(file, group, conventions), 2 * units[group]
        if "centre" in file.groups:
            centre = _read(file, "centre", conventions, None), units["centre"]
        return material_of_attitudes(given, times, q, unit, verdicts, every, centre)
    frame = _frame_of(file)
    own = _own_attitudes(file, frame, conventions) if frame else None
    in_space = not MOVING.isdisjoint(conventions.readings)
    if own is None and in_space:
        exact = solution(replace(given, track=frozenset({"attitude"})))
        own = exact.evaluate(given.clock.elapsed, _DIGITS)["attitude"].astype(float)
    answer = _read_by(file, given, conventions, names[0], own, verdicts, every)
    if answer is None or not (frame and in_space):
        return answer
    # Where the file's own attitude is wrong, the exact one is that of its space axes if it explains them.
    assert answer.truth.q is not None
    exact_ones = np.full((len(file.times), 3, 3), np.nan)
    places = answer.places // every
    exact_ones[places] = matrices(answer.truth.q)
    v = np.hstack([_read(file, name, conventions, exact_ones) for name in names[0]])[places]
    other = replace(answer, file=replace(answer.file, v=v))
    return other if other.off <= LEAVES * answer.off else answer


def material_of_attitudes(
    given: Scene,
    times: Floats,
    q: Floats,
    unit: float,
    verdicts: Iterable[Verdict],
    every: int = 1,
    centre: tuple[Floats, float] | None = None,
) -> Answer | None:
    """Return attitudes as material: with their own rates, or else with the exact motion and the centre.

    ``centre`` are its rows, and half a unit of their last digit.
    """
    if given.model != "euler" or len(times) < _FEWEST_ATTITUDES:
        return _of_frame_alone(given, q, unit, verdicts, every, centre)
    omega, noise = rates_of_attitudes(times, q, unit)
    if noise > _TOO_COARSE * np.max(np.abs(omega)):
        return _of_frame_alone(given, q, unit, verdicts, every, centre)
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
    return answer and replace(answer, has_rates=False, places=answer.places + every * ASIDE)


def _of_frame_alone(
    given: Scene,
    q: Floats,
    unit: float,
    verdicts: Iterable[Verdict],
    every: int,
    centre: tuple[Floats, float] | None,
) -> Answer | None:
    """Return attitudes and the centre beside the exact motion, for causes in these alone."""
    n, (c, of_centre) = len(given.body.energy_matrix), centre or (None, 0.0)
    motion, noises = Motion(np.zeros((len(q), n)), q, c), (np.zeros(n), unit, of_centre)
    answer = material(given, motion, n == 6, noises, verdicts, every=every)
    if answer is None:
        return None
    return replace(answer, file=replace(answer.file, v=answer.truth.v), has_rates=False)


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
    return material(given, motion, has_momenta, noises, verdicts, every)


def _frame_of(file: TrajectoryFile) -> str:
    """Return the group that has the file's attitudes; empty if none has."""
    return next((name for name in ("quaternion", "attitude") if name in file.groups), "")


def _ratio(rows: Floats, columns: Floats) -> float:
    """Return the factor of a reading, by the sizes of the rows."""
    before, after = (float(np.nanmax(np.abs(each), initial=0.0)) for each in (columns, rows))
    return after / before if before > 0 else 1.0


def material_of_trajectory(
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


def _own_attitudes(file: TrajectoryFile, group: str, conventions: Conventions) -> Floats:
    reading = conventions.readings.get(group, readings(group)[0])
    read = reading.read(file.groups[group].doubles(), np.empty(0))
    return rotations(read) if group == "quaternion" else read
