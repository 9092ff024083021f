"""The data that an engine takes: the truth starts from the numbers that it was given."""

from __future__ import annotations

import shutil
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from builders.engine import ENGINE
from builders.scenes import acted, read_scene

from taylor_verify.judge.judgement import Judgement
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.run import run
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines import python
from taylor_verify.solvers.engines.engine import SCRIPTS, Engine, Outside, solve_together
from taylor_verify.solvers.engines.script import read_script
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.trajectory import Outcome

# RK4 in doubles, on I and omega as the question has them: its own error is beyond float32.
TWIN = """\
# /// script
# dependencies = []
# [tool.taylor-verify]
# title = "RK4 on I and omega"
# rungs = ["f32"]
# loads = false
# {data}
# ///
from engine import Engine
from free_body import answer, pushed_body, stepped

STEP = 0.0625 / 8


def solve(body, settings):
    def moment(t, s):
        is_pushed = getattr(body, "is_pushed", False)
        return body.moment(s[:3], s[3:], t) if is_pushed else [0, 0, 0]

    def start():
        engine, done = Engine(body.inertia, body.omega, body.attitude), 0

        def advance(steps):
            nonlocal done
            for done in range(done + 1, done + steps + 1):
                engine.step((done - 1) * STEP, STEP, moment)

        return advance, lambda: body.row(engine.s[:3], engine.s[3:])

    return stepped(body, STEP, start)


answer(solve)
"""
# The same with all that acts on the body, asked for in each stage.
PUSHED = (
    TWIN.replace("loads = false", 'loads = "written"')
    .replace('["f32"]', '["f64"]')
    .replace("answer(solve)", "answer(solve, pushed_body)")
)
FLOAT32 = 2.0**-24


# An engine that remembers what it was asked before, in its process, and dies of a negative omega.
MORTAL = """\
# /// script
# dependencies = []
# [tool.taylor-verify]
# title = "counts"
# loads = false
# [tool.taylor-verify.settings]
# step = 0.5
# ///
import os

from free_body import answer, stepped

asked = []


def solve(body, settings):
    asked.append(1)
    if body.omega[0] < 0:
        os._exit(3)
    solved = stepped(body, settings.step, lambda: (lambda steps: None, lambda: [*body.omega]))
    return type(solved)(solved.states, solved.steps, 0, 0.0, 0.0, f"question {len(asked)}")


answer(solve)
"""
# An engine as strict as some are: it leaves a log where it runs, and takes no tensor that no solid has.
STRICT = """\
# /// script
# dependencies = []
# [tool.taylor-verify]
# title = "refuses"
# loads = false
# ///
from pathlib import Path

from free_body import answer


def solve(body, settings):
    Path("ENGINE_LOG.TXT").write_text("hello")
    raise ValueError("A + B >= C is required")


answer(solve)
"""


def body(largest: int = 3, first: int = 1) -> Scene:
    """A rigid body that is no solid where its largest moment is beyond the sum of the others."""
    return read_scene(f"inertia = [1, 2, {largest}]", f"omega = [{first}, 1, 1]")


def twin(folder: Path, data: str, monkeypatch: pytest.MonkeyPatch, text: str = TWIN) -> Outside:
    """The script as an engine that runs in this interpreter."""
    monkeypatch.setattr(python, "interpreter", lambda *_: sys.executable)
    for module in ("acting.py", "axes.py", "equations.py", "free_body.py", "question.py"):
        shutil.copy(SCRIPTS / module, folder)
    (folder / "engine.py").write_text(ENGINE)
    path = folder / "with_twin.py"
    path.write_text(text.replace("{data}", data), encoding="utf-8")
    script = read_script(path)
    return Outside(Engine(script), f"outside:twin-{script.about.data}", script.block, ())


def judged(folder: Path, data: str, monkeypatch: pytest.MonkeyPatch) -> Judgement:
    return run(scene(), twin(folder, data, monkeypatch), "f32", causes=False)


def scene() -> Scene:
    return load("euler/with-attitude")


def errors(judgement: Judgement) -> dict[str, float]:
    return {v.quantity: v.max for v in judgement.verdicts if v.max is not None}


def test_an_engine_that_takes_the_tensor_is_judged_on_the_tensor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The truth has float32's rounding of I and omega, and no error of the engine remains of it."""
    sizes = errors(judged(tmp_path, 'data = "tensor"', monkeypatch))
    # Doubles throughout, and twenty units of time: far below one rounding of float32.
    assert sizes["omega"] <= FLOAT32 / 10
    assert sizes["attitude"] <= FLOAT32


def test_the_same_engine_on_the_other_data_has_their_rounding_for_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Posed on I^-1 and I omega, omega0 is rounded on its way, and the error shows it."""
    assert errors(judged(tmp_path, "", monkeypatch))["omega"] >= FLOAT32 / 4


@pytest.mark.parametrize("name", ["euler/constant-moment", "euler/gyrostat", "euler/damped"])
def test_an_engine_for_free_bodies_is_not_asked_for_others(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a moment, wheels or damping an engine of `loads = false` is unavailable: it has not failed."""
    judgement = run(name, twin(tmp_path, 'data = "tensor"', monkeypatch), "f32", causes=False)
    assert {str(v.verdict) for v in judgement.verdicts} == {"unavailable"}
    assert "is made for a body without" in str(judgement.verdicts[0].reason)


@pytest.mark.parametrize(
    "name", ["euler/constant-moment", "euler/gyrostat", "euler/damped", "euler/moment-backward"]
)
def test_an_engine_that_takes_a_moment_is_given_all_that_acts(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A moment, wheels and damping, forwards and backwards in time."""
    engine = twin(tmp_path, 'data = "tensor"', monkeypatch, PUSHED)
    judgement = run(name, engine, tolerance=1e-6)
    assert {str(v.verdict) for v in judgement.verdicts} == {"pass"}


def test_an_engine_is_given_loads_and_states(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its state and the scene's own go on side by side, and its answer has the tracked ones."""
    engine = twin(tmp_path, 'data = "tensor"', monkeypatch, PUSHED)
    asked = acted()
    answered = engine.solve(engine.problem(asked, rung("f64")))
    exact = solver_named("taylor").solve(pose(asked, rung("f64")))
    assert answered.outcome is Outcome.FINISHED, answered.detail
    for name in ("omega", "quaternion", "m", "h"):
        # One's own states go by a method of order two.
        assert np.abs(answered.quantities[name] - exact.quantities[name]).max() < 1e-5


@pytest.mark.parametrize(
    ("largest", "verdict", "words"),
    [
        (5, "unavailable", "expected principal moments of a solid, got 1.0, 2.0, 5.0 @ inertia"),
        (3, "fail", "A + B >= C is required"),
    ],
)
def test_an_engine_that_ends_on_moments_of_no_solid_has_not_failed(
    largest: int, verdict: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It cannot represent the body; the same end on moments that a solid has is a failure."""
    engine = twin(tmp_path, "", monkeypatch, STRICT)
    judgement = run(body(largest), engine, "f64")
    assert {str(v.verdict) for v in judgement.verdicts} == {verdict}
    assert words in str(judgement.verdicts[0].reason)


def test_an_engine_leaves_nothing_in_the_folder_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A log that it writes where it is run is gone with that folder."""
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    run(body(), twin(tmp_path, "", monkeypatch, STRICT), "f64")
    assert list(here.iterdir()) == []


def test_one_process_answers_many_questions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A question that ends it has failed by itself, and the others are answered as if alone."""
    engine = twin(tmp_path, "", monkeypatch, MORTAL)
    asked = []
    for first, step in ((1, "0.5"), (2, "0.3"), (3, "1.0"), (-4, "0.5"), (5, "0.5"), (6, "0.5")):
        solver = replace(engine, settings=(("step", step),))
        asked.append((solver, solver.problem(body(first=first), rung("f64"))))
    trajectories = solve_together(asked)
    assert [answer.outcome for answer in trajectories] == [
        *(Outcome.FINISHED, Outcome.UNSUITED, Outcome.FINISHED),
        *(Outcome.CRASHED, Outcome.FINISHED, Outcome.FINISHED),
    ]
    alone = [solver.solve(problem) for solver, problem in asked]
    for one, other in zip(trajectories, alone, strict=True):
        assert one.outcome is other.outcome
        assert one.quantities.keys() == other.quantities.keys()
        assert all(np.all(one.quantities[k] == other.quantities[k]) for k in one.quantities)
    # The first process has come to the third question; all from the fourth on are asked alone.
    details = ["question 1", "question 3", "question 1", "question 1"]
    assert [a.detail for a in trajectories if a.outcome is Outcome.FINISHED] == details
    assert trajectories[3].detail.startswith("exit status 3")
