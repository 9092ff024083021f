"""Many free bodies are judged in arrays as each of them is by the judge of one body."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from taylor_verify.exact.euler.tops import Tops
from taylor_verify.judge.bodies.floor import floors
from taylor_verify.judge.bodies.measured import measured
from taylor_verify.judge.bodies.shifts import Errors
from taylor_verify.judge.bodies.verdicts import Run, are_unit, gates, verdicts
from taylor_verify.judge.initial import with_initial
from taylor_verify.judge.judgement import judgement
from taylor_verify.models.bodies import Bodies
from taylor_verify.models.problem import pose
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.pairs import Pairs
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import as_solver
from taylor_verify.solvers.trajectory import of_rows
from tests.builders.satellites import bodies_of, near_the_separatrix, satellites

F64, SAMPLES, STEPS = rung("f64"), 41, 640
ROUNDOFF = float(F64.unit_roundoff)
# A reason shows four digits, of which the last may be rounded otherwise.
CLOSE, SHOWN = 1e-4, 1e-3
NUMBERS = ("max", "mean", "final", "at", "attainable", "bound", "ratio", "ratio_at", "change")
SHIFTS = ("time_shift", "residual", "remains", "trend")
# Shifts of time at the samples, in the unit of each body.
SHARES = tuple(Fraction(k, SAMPLES - 1) for k in range(SAMPLES))
SHARE = np.array(SHARES, dtype=float)
LATE = np.full(SAMPLES, 1e-12)
NOISE = np.random.default_rng(4).standard_normal((7, 1, SAMPLES))
COURSES = {
    "constant": LATE,
    "drifting": 1e-12 * (1 + SHARE),
    "wandering": 1e-12 * NOISE[0, 0],
    "constant but for one sample": np.where(np.arange(SAMPLES) == 7, 2e-11, LATE),
    "drifting but for one sample": np.where(np.arange(SAMPLES) == 7, 4e-11, LATE * (1 + SHARE)),
}


def _tops(bodies: Bodies) -> Tops:
    return Tops(bodies.scaled_inverse, Pairs(bodies.starts[:3]), bodies.quaternion)


def _rows(bodies: Bodies, shifts: Any, noise: float) -> Any:
    """Exact rows (7, n, m) at shifted times, with noise."""
    states = _tops(bodies).states(bodies.grid - shifts)
    assert states.quaternion is not None
    return np.concatenate([states.momentum.hi, states.quaternion.hi]) + noise * NOISE


def _together(scenes: list[Scene], bodies: Bodies, rows: Any) -> list[list[Verdict]]:
    tops, steps = _tops(bodies), np.full(len(scenes), STEPS)
    compared = measured(tops, rows, bodies.grid)
    base = floors(tops, bodies.grid[:, -1], steps, SHARES)
    assert base.is_known.all()
    what = Run("closed-form:ellipj", F64, bodies.times, bodies.time, steps, 1, 0.0)
    every = gates(compared, base, tops.inverse, ROUNDOFF)
    return [*verdicts(what, dict(enumerate(scenes)), every, compared, base).values()]


def _alone(scene: Scene, unit: float, rows: Any) -> list[Verdict]:
    problem = pose(scene, F64)
    size = unit / float(problem.units.momentum)
    answer = np.concatenate([size * rows[:3], rows[3:]]).T.tolist()
    trajectory = of_rows(problem, answer, steps=STEPS, seconds=0.0)
    judged = judgement(problem, as_solver("closed-form:ellipj"), trajectory)
    return list(with_initial(judged, 0.0).verdicts)


def _agree(scenes: list[Scene], shifts: Any, noise: float) -> set[str]:
    """Compare both judges, and return the kinds of the shifts."""
    bodies = bodies_of(scenes)
    rows = _rows(bodies, shifts, noise)
    kinds = set()
    for k, judged in enumerate(_together(scenes, bodies, rows)):
        alone = {v.quantity: v for v in _alone(scenes[k], bodies.unit[k], rows[:, k])}
        assert len(judged) > 5
        for verdict in judged:
            other = alone[verdict.quantity]
            assert verdict.shift == other.shift
            kinds |= {verdict.shift or ""}
            for name in NUMBERS + SHIFTS:
                expected = getattr(other, name)
                assert getattr(verdict, name) == (
                    expected and pytest.approx(expected, rel=CLOSE, abs=0)
                )
            floor, expected = verdict.reason.floor, other.reason.floor
            assert floor is not None
            assert expected is not None
            assert (floor.carried, floor.steps) == (expected.carried, expected.steps)
            assert floor.growth == (expected.growth and pytest.approx(expected.growth, rel=SHOWN))
    return kinds


@pytest.mark.parametrize("course", COURSES)
def test_shifts_of_time_are_those_of_one_body(course: str) -> None:
    """Kind, size, trend and what remains agree, also where one sample does not share the shift."""
    assert course.split()[0] in _agree(satellites(2, 11, True), COURSES[course], 0.0)


@pytest.mark.parametrize("scenes", [satellites(3, 12, True), near_the_separatrix()[::2]])
def test_errors_and_floors_are_those_of_one_body(scenes: list[Scene]) -> None:
    """Errors that no shift explains, their floors and their ratios agree."""
    assert "none" in _agree(scenes, 0.0, 1e-12)


def test_a_quaternion_is_a_unit_quaternion_to_its_roundings() -> None:
    """The excess is |q| - 1; it is clear up to a quarter of the bound, ten roundings of each step."""
    bodies = bodies_of(satellites(3, 12, True))
    rows = _rows(bodies, 0.0, 0.0)
    tops, steps = _tops(bodies), np.full(3, STEPS)
    base = floors(tops, bodies.grid[:, -1], steps, SHARES)
    limit = 10 / 4 * ROUNDOFF * (1 + STEPS)
    rows[3:, 1:, -1] *= 1 + limit * np.array([0.9, 1.1])
    excess = measured(tops, rows, bodies.grid).excess
    assert excess is not None
    q = rows[3:, 2, -1]
    square = sum(Fraction(entry) ** 2 for entry in q.tolist())
    assert excess[2, -1] == pytest.approx(float(square - 1) / 2, rel=CLOSE, abs=0)
    assert are_unit(excess, base, ROUNDOFF).tolist() == [True, True, False]


@pytest.mark.parametrize(("part", "suffices"), [(0.0, True), (0.9, True), (1.1, False)])
def test_first_order_suffices_where_it_neglects_little(part: float, suffices: bool) -> None:
    """It neglects c^2 a/2, at most a sixteenth of what remains in a component; nothing where c is 0."""
    one, zero = np.ones((1, 2)), np.zeros((3, 1, 2))
    course = np.array([[0.0, (2 * part / 16 / 3**0.5) ** 0.5]])
    errors = Errors(zero, zero, one, one, one)
    assert errors.is_first_order(course, one if part else 0 * one, True).tolist() == [suffices]
