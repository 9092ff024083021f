"""The length of an answer's quaternions: where it is not 1 a row fails, and loads act by it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders import written_loads
from builders.integrators import step
from builders.trajectories import MATRIX, QUATERNION, columns_at, exact_columns, write_csv
from builders.turns import by_turns
from builders.written_loads import Evaluated, euler, kirchhoff, rotation, value
from mpmath import mp

import taylor_verify
from taylor_verify.exact.conditioning.condition import path_of_run
from taylor_verify.exact.conditioning.linearised import products
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.judge.floor.loads import Along
from taylor_verify.judge.floor.quaternion_length import LENGTH, with_length
from taylor_verify.judge.judgement import Judgement
from taylor_verify.models.problem import Problem
from taylor_verify.records.quantities import ROTATION_MATRIX, UNIT_QUATERNION
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

pytestmark = pytest.mark.usefixtures("without_causes")
SCENE = "euler/with-attitude"
SOUND = exact_columns(SCENE)
ROWS = len(SOUND["t"])


def stretched(factors: Sequence[float]) -> dict[str, list[float]]:
    """The sound file with the quaternion of every row longer by a factor."""
    return {
        name: [v * f if name in QUATERNION else v for v, f in zip(values, factors, strict=True)]
        for name, values in SOUND.items()
    }


def row(judgement: Judgement) -> Verdict | None:
    return next((v for v in judgement.verdicts if v.quantity == UNIT_QUATERNION), None)


def checked(path: Path, columns: Mapping[str, Sequence[Any]], **options: Any) -> Judgement:
    return taylor_verify.check(SCENE, write_csv(path / "mine.csv", columns), **options)


@pytest.mark.parametrize(
    ("factors", "size", "words"),
    [
        ([0.5] * ROWS, 0.5, "the length of q0 q1 q2 q3 is 0.5"),
        (np.linspace(1, 100, ROWS).tolist(), 99.0, "the length of q0 q1 q2 q3 is 1 to 100"),
        ([1.0] * (ROWS - 1) + [1 + 1e-12], 1e-12, "is 1 to 1+1e-12"),
    ],
)
def test_another_length_fails_with_its_size(
    factors: list[float], size: float, words: str, tmp_path: Path
) -> None:
    """The attitude is read from any length and passes; the row of the length alone fails."""
    judgement = checked(tmp_path, stretched(factors))
    (failed,) = [v for v in judgement.verdicts if v.verdict is Status.FAIL]
    assert failed.quantity == UNIT_QUATERNION
    assert failed.max == pytest.approx(size, rel=1e-3)
    assert words in failed.because
    assert "attainable = u N" in failed.because


@pytest.mark.parametrize(
    ("entry", "change"),
    by_turns(
        [("all", 1e-9), ("r12", 1e-6), ("r33", 0.1), (None, 0.0)],
        4,
        lambda entry, change: entry is None,
    ),
)
def test_a_matrix_that_is_no_rotation_has_a_row_of_its_own(
    entry: str | None, change: float, tmp_path: Path
) -> None:
    """A matrix with longer axes or one wrong entry fails as such, whatever its attitude is."""
    sound = exact_columns(SCENE, matrix=True)
    wrong = {
        name: [v * (1 + change) if entry in ("all", name) and name in MATRIX else v for v in values]
        for name, values in sound.items()
    }
    judged = checked(tmp_path, wrong)
    failed = next((v for v in judged.verdicts if v.quantity == ROTATION_MATRIX), None)
    assert (failed is None) is (entry is None)
    if failed is not None:
        assert "r11 ... r33 are no rotation" in failed.because
        assert 0 < failed.max <= change
        assert entry != "all" or failed.max == pytest.approx(change, rel=1e-3)


def test_roundings_in_every_step_are_no_failure(tmp_path: Path) -> None:
    """A length that grows by u a row is within roundoff times steps, and has no row."""
    factors = [1 + 2.0**-53 * k for k in range(ROWS)]
    assert row(checked(tmp_path, stretched(factors))) is None
    assert row(checked(tmp_path, SOUND)) is None


def test_the_order_of_the_quaternion_does_not_hide_its_length(tmp_path: Path) -> None:
    """A quaternion that is corrected from scalar last is still half as long as it should be."""
    half = stretched([0.5] * ROWS)
    last = {f"q{i}": half[f"q{(i + 1) % 4}"] for i in range(4)}
    failed = row(checked(tmp_path, half | last, accept_conventions=True))
    assert failed.max == pytest.approx(0.5)


def test_both_directions_of_time_are_looked_at(tmp_path: Path) -> None:
    """A row before the start with a long quaternion fails as one after it."""
    columns = columns_at(load(SCENE), [-2, -1, 0, 1, 2])  # type: ignore[list-item]
    for name in QUATERNION:
        columns[name][0] *= 1.5
    failed = row(checked(tmp_path, columns))
    assert (failed.at, failed.max) == (-2.0, pytest.approx(0.5))


def test_a_quaternion_without_a_number_is_the_attitudes_failure(tmp_path: Path) -> None:
    """NaN has no length: the attitude fails, and no second row says so."""
    columns = stretched([1.0] * ROWS)
    columns["q2"][3] = float("nan")
    assert row(checked(tmp_path, columns)) is None


def test_an_answer_of_a_callable_is_asked_too() -> None:
    """The scene's own quaternion, which is not of unit length, does not pass as an attitude's."""

    def solve(problem: Problem) -> Any:
        motion = solution(problem.given).evaluate(problem.given.clock.elapsed, 30)
        columns = columns_at(problem.given, problem.given.clock.instants)
        start = problem.scene.initial
        length = float(sum(q * q for q in start.attitude)) ** 0.5
        q = length * np.array([columns[name] for name in QUATERNION]).T
        return np.concatenate([motion["omega"].astype(float), q], axis=1)

    failed = row(taylor_verify.check(SCENE, solve))
    assert failed.max == pytest.approx(15**0.5 - 1)


# What the length does through loads

TOP = euler(["r33/4 - r32/3", "r31/3 - r33/4", "(r32 - r31)/4"])
SOLID = kirchhoff(
    ["-0.1*c1*r11 - norm(u1, u2, u3)*u1/4", "0.3*c2*r31", "-0.2*r33"],
    ["-w1/5", "0.1*sin(t)*r21", "-w3/10"],
)
LONGER = 1e-5
STEPS = 30
# The errors of the path between its times, and of the second order.
NEAR = 0.02


def end(scene: Scene, length: float) -> np.ndarray[Any, Any]:
    """Momenta and centre at the end, from a quaternion of this length."""
    evaluated = Evaluated(scene)
    y, at = evaluated.start(), 3 if scene.model == "euler" else 6
    y[at : at + 4] = [length * e for e in y[at : at + 4]]
    begin, last = value(scene.clock.start), value(scene.clock.instants[-1])
    h = (last - begin) / STEPS
    for k in range(STEPS):
        y = list(step(evaluated.rates, begin + k * h, y, h))
    momentum = kind_of(scene.body).momentum_matrix(scene.body).astype(float)
    return np.array([*momentum @ np.array(y[:at], dtype=float), *map(float, y[at + 4 :])])


def unscaled(q: list[Any]) -> list[list[Any]]:
    """R(q) as solvers have it that do not normalise: with the square of the length."""
    size = sum(e * e for e in q)
    return [[size * entry for entry in row] for row in rotation(q)]


@pytest.mark.parametrize("scene", [TOP, SOLID])
def test_a_longer_quaternion_moves_the_motion_as_the_path_says(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two motions by Runge and Kutta, from quaternions of two lengths, differ by the derivative."""
    monkeypatch.setattr(written_loads, "rotation", unscaled)
    path = with_length(path_of_run(scene))
    sizes, d = Along(path_of_run(scene)).sizes_of_state, len(path.flow.components)
    whole = products(path.carried.steps)[-1][:-1, -1] * sizes
    with mp.workdps(20):
        moved = (end(scene, 1 + LONGER) - end(scene, 1.0)) / LONGER
    derived = np.concatenate([whole[:d], whole[d + 3 : d + 6][: len(moved) - d]])
    for part in (slice(0, d), slice(d, None)):
        error = np.linalg.norm(derived[part] - moved[part])
        assert error <= NEAR * np.linalg.norm(moved[part])


def test_without_loads_that_read_the_frame_no_length_matters() -> None:
    """A path under loads of the rates alone has no such state."""
    scene = euler(["-0.1*w1", "0.2*sin(t)", "0"])
    assert LENGTH not in with_length(path_of_run(scene)).blocks
