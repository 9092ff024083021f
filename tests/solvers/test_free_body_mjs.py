"""The reader of a free rigid body that the scripts in JavaScript share, under an engine of our own."""

from __future__ import annotations

import shutil
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from builders.scenes import BACKWARDS, FULL, oblique
from builders.turns import by_turns

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.engines.engine import SCRIPTS
from taylor_verify.solvers.process import process
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.tradeoff.accuracy import Truth

pytestmark = pytest.mark.skipif(not shutil.which("node"), reason="node is not installed")

# Two equal moments, and 45 degrees to the principal axes.
EQUAL = "[[2, 0.5, 0], [0.5, 2, 0], [0, 0, 1.5]]"
DIAGONAL = "[2.7, 1.2, 2.1]"
# Without the start.
LISTED = "at = [0.5, 1, 4]"

# An engine by RK4, in principal axes, which hands on omega in space axes as physics engines do. What it
# prints would spoil an answer on the same stream.
ENGINE = """\
import { answer, stepped } from "./free_body.mjs";
console.log("an engine may say what it likes");
const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
const times = ([px, py, pz, pw], [qx, qy, qz]) => [
  pw * qx + py * qz - pz * qy, pw * qy + pz * qx - px * qz, pw * qz + px * qy - py * qx,
  -px * qx - py * qy - pz * qz];
const add = (u, h, v) => u.map((entry, i) => entry + h * v[i]);
answer((body, settings) => stepped(body, settings.step, () => {
  const I = body.moments, h = settings.step;
  const rates = (s) => {
    const omega = s.slice(0, 3);
    const turning = cross(omega.map((w, i) => I[i] * w), omega).map((m, i) => m / I[i]);
    return [...turning, ...times(s.slice(3), omega.map((w) => w / 2))];
  };
  let s = [...body.omega, ...body.attitude];
  const toSpace = (q, v) => {
    const twice = cross(q, v).map((c) => 2 * c);
    return add(add(v, q[3], twice), 1, cross(q, twice));
  };
  return {
    advance() {
      const k1 = rates(s), k2 = rates(add(s, h / 2, k1)), k3 = rates(add(s, h / 2, k2));
      const k4 = rates(add(s, h, k3));
      s = [[1, k1], [2, k2], [2, k3], [1, k4]].reduce((sum, [b, k]) => add(sum, (b * h) / 6, k), s);
    },
    row: () => body.rowFromSpace(toSpace(s.slice(3), s.slice(0, 3)), s.slice(3)),
  };
}));
"""


@pytest.fixture
def engine(tmp_path: Path) -> list[str]:
    """The command of the engine, which stands beside the shared file."""
    shutil.copy(SCRIPTS / "free_body.mjs", tmp_path)
    (tmp_path / "engine.mjs").write_text(ENGINE)
    return [shutil.which("node") or "", str(tmp_path / "engine.mjs")]


def posed(inertia: str = FULL, time: str = BACKWARDS, on: str = "f64") -> Problem:
    return pose(oblique(inertia, time), rung(on))


def solved(engine: list[str], problem: Problem, step: float) -> Trajectory:
    return process.program([*engine, f"step={step}"], 60).solve(problem)


@pytest.mark.parametrize(
    ("inertia", "time"), by_turns(product([FULL, EQUAL, DIAGONAL], [BACKWARDS, LISTED]), 5)
)
def test_an_engine_with_the_right_equations_converges_to_the_exact_motion(
    inertia: str, time: str, engine: list[str]
) -> None:
    """The error falls with the fourth power of the step, whatever the tensor and the instants."""
    problem = posed(inertia, time)
    truth = Truth(problem)
    remark = "" if inertia == DIAGONAL else "solved in principal axes, and turned back"
    errors = []
    for step in (0.1, 0.05):
        trajectory = solved(engine, problem, step)
        assert (trajectory.outcome, trajectory.detail) == (Outcome.FINISHED, remark)
        assert trajectory.steps == round(4 / step)
        assert trajectory.seconds > 0
        errors.append(truth.accuracy(trajectory).worst)
    assert errors[1] <= errors[0] / 8


@pytest.mark.parametrize("inertia", [FULL, EQUAL, DIAGONAL])
def test_what_an_engine_was_given_is_read_back(inertia: str, tmp_path: Path) -> None:
    """Four turns, to principal axes, to space and back, round each component once in each."""
    shutil.copy(SCRIPTS / "free_body.mjs", tmp_path)
    (tmp_path / "engine.mjs").write_text(
        'import { answer, stepped } from "./free_body.mjs";\n'
        "answer((body, settings) => stepped(body, settings.step, () => ({\n"
        "  advance() {}, row: () => body.rowFromSpace(body.omegaInSpace, body.attitude),\n"
        "})));\n"
    )
    problem = posed(inertia)
    resting = [shutil.which("node") or "", str(tmp_path / "engine.mjs")]
    omega = np.array(problem.given.initial.omega, dtype=float)
    first = np.array(solved(resting, problem, 0.5).quantities["omega"][0], dtype=float)
    assert np.linalg.norm(first - omega) <= 4 * 2**-53 * np.linalg.norm(omega)


def test_instants_of_float32_are_multiples_of_a_decimal_step(engine: list[str]) -> None:
    """Instants that are rounded to the rung are multiples of a decimal step all the same."""
    problem = posed(time="at = [0, 0.1, 0.7]", on="f32")
    assert solved(engine, problem, 0.1).outcome is Outcome.FINISHED


@pytest.mark.parametrize("scene", ["euler/constant-moment", "euler/gyrostat", "kirchhoff/screw"])
def test_a_body_that_is_not_free_is_refused(scene: str, engine: list[str]) -> None:
    """A moment, wheels and a fluid are none for a physics engine, which has not failed."""
    trajectory = solved(engine, pose(load(scene), rung("f64")), 0.1)
    assert trajectory.outcome is Outcome.UNSUITED
    assert "expected a free rigid body" in trajectory.detail


def test_one_process_answers_many_questions(engine: list[str]) -> None:
    """As each of them alone, also behind one that is none for it; what follows an error is left open."""
    asked = [("step=0.1", posed()), ("step=0.3", posed()), ("step=0.05", posed(EQUAL))]
    trajectories = process.together(engine, [([words], problem) for words, problem in asked], 60)
    assert trajectories[1] is None
    for k in (0, 2):
        words, problem = asked[k]
        alone, together = process.program([*engine, words], 60).solve(problem), trajectories[k]
        for name, rows in alone.quantities.items():
            assert np.all(rows == together.quantities[name])
