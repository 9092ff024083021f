"""The templates of docs/bring-your-engine.md: each runs a stand-in engine, and its answer is judged."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from builders.engine import ENGINE
from builders.scenes import acted
from builders.turns import by_turns
from builders.worked import DOCS

from taylor_verify.judge.judgement import Judgement
from taylor_verify.models.problem import pose
from taylor_verify.models.registry import natural_units
from taylor_verify.numbers.precision import rung
from taylor_verify.records.json_text import converted
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load, read
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.engine import SCRIPTS as OUTSIDE
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify_reports.studies.engines.entry import EntryList, entry_list

PAGE = (DOCS / "bring-your-engine.md").read_text(encoding="utf-8")
SCENES = [
    name
    for name in names()
    if name.split("/")[0] in ("euler", "engines", "loads") and load(name).model == "euler"
]
TOLERANCE = 1e-3

# The engine of builders.engine in two other languages.
JAVASCRIPT = """
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export class Engine {
  constructor(inertia, omega, attitude) {
    const [a, b, c] = this.I = inertia;
    const minors = [cross(b, c), cross(c, a), cross(a, b)], volume = dot(a, minors[0]);
    this.K = [0, 1, 2].map((i) => minors.map((minor) => minor[i] / volume));
    this.s = [...omega, ...attitude];
  }
  rates(t, s, moment) {
    const w = s.slice(0, 3), [p, x, y, z] = s.slice(3), [a, b, c] = w.map((entry) => entry / 2);
    const outer = moment(t, s), inner = cross(this.I.map((row) => dot(row, w)), w);
    const turned = inner.map((entry, i) => entry + outer[i]);
    return [...this.K.map((row) => dot(row, turned)), -x * a - y * b - z * c, p * a + y * c - z * b,
      p * b + z * a - x * c, p * c + x * b - y * a];
  }
  step(t, h, moment) {
    const moved = (part, k) => this.s.map((entry, i) => entry + part * h * k[i]);
    const k1 = this.rates(t, this.s, moment), k2 = this.rates(t + h / 2, moved(0.5, k1), moment);
    const k3 = this.rates(t + h / 2, moved(0.5, k2), moment), k4 = this.rates(t + h, moved(1, k3), moment);
    this.s = this.s.map((entry, i) => entry + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]));
  }
  state() { return this.s; }
}
"""
CPP = """
#pragma once
#include <functional>
#include <vector>
struct Engine {
  using Vector = std::vector<double>;
  using Moment = std::function<Vector(double, const Vector &)>;
  Vector I, K, s;
  static Vector cross(const Vector &a, const Vector &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static double dot(const double *a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  Engine(Vector inertia, Vector omega, const Vector &attitude) : I(inertia), K(9), s(omega) {
    const Vector a(I.begin(), I.begin() + 3), b(I.begin() + 3, I.begin() + 6), c(I.begin() + 6, I.end());
    const Vector minors[] = {cross(b, c), cross(c, a), cross(a, b)};
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) K[3 * i + j] = minors[j][i] / dot(&I[0], minors[0]);
    s.insert(s.end(), attitude.begin(), attitude.end());
  }
  Vector rates(double t, const Vector &s, const Moment &moment) const {
    const Vector w(s.begin(), s.begin() + 3);
    Vector turned = cross({dot(&I[0], w), dot(&I[3], w), dot(&I[6], w)}, w);
    const Vector outer = moment(t, s);
    for (int i = 0; i < 3; i++) turned[i] += outer[i];
    const double a = w[0] / 2, b = w[1] / 2, c = w[2] / 2, p = s[3], x = s[4], y = s[5], z = s[6];
    return {dot(&K[0], turned), dot(&K[3], turned), dot(&K[6], turned), -x * a - y * b - z * c,
            p * a + y * c - z * b, p * b + z * a - x * c, p * c + x * b - y * a};
  }
  Vector moved(double h, const Vector &k) const {
    Vector made = s;
    for (std::size_t i = 0; i < s.size(); i++) made[i] += h * k[i];
    return made;
  }
  void step(double t, double h, const Moment &moment) {
    const Vector k1 = rates(t, s, moment), k2 = rates(t + h / 2, moved(h / 2, k1), moment);
    const Vector k3 = rates(t + h / 2, moved(h / 2, k2), moment), k4 = rates(t + h, moved(h, k3), moment);
    for (std::size_t i = 0; i < s.size(); i++) s[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  Vector state() const { return s; }
};
"""


LOADED = """
title = "All that acts"
model = "euler"
track = ["attitude"]
[body]
inertia = [[2, 0.1, 0], [0.1, 1.5, 0], [0, 0, 1]]
rotor = [0.05, 0, 0.1]
damping = "1/50"
moment = ["clip(-q1 - w1/2, -0.2, M)", "profile*sin(t)^2 + w3^3/8", "r13/9 - abs(w3)*w3/50 - atan2(w1, 2)"]
[define]
M = "0.3 if t < 3.3 else 0.1"
[tables]
profile = { times = [1, 2, 7.5], values = [0, 0.3, 0.1], kind = "cubic" }
[initial]
omega = [0.3, -0.5, 0.4]
attitude = [0.5, 0.6, -0.4, 0.45]
[time]
start = 1
end = END
samples = 14
"""


def template(language: str) -> str:
    """Return the template of a language as the page has it."""
    (text,) = re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)
    return str(text)


def program(*names: str) -> str:
    """Return the first of these programs that is there; skip the test where none is."""
    path = next(filter(None, map(shutil.which, names)), None)
    if path is None:
        pytest.skip(f"needs {names[0]}")
    return path


def written(folder: Path, suffix: str, template: str, engine: str, header: str = "") -> None:
    """Write a template, its engine, and the file that the page says to copy."""
    (folder / f"my_engine.{suffix}").write_text(template, encoding="utf-8")
    header = header or suffix
    (folder / f"engine.{header}").write_text(engine, encoding="utf-8")
    shutil.copy(OUTSIDE / f"acting.{header}", folder)


def in_python(folder: Path) -> str:
    written(folder, "py", template("python"), ENGINE)
    return f"{sys.executable} -S {folder / 'my_engine.py'}"


def in_javascript(folder: Path) -> str:
    node = program("node")
    written(folder, "mjs", template("javascript"), JAVASCRIPT)
    return f"{node} {folder / 'my_engine.mjs'}"


def in_cpp(folder: Path) -> str:
    compiler = program("c++", "g++")
    written(folder, "cpp", template("cpp"), CPP, "hpp")
    words = [compiler, "-std=c++17", "-Wall", "-Werror", "-o"]
    subprocess.run([*words, "my_engine", "my_engine.cpp"], cwd=folder, check=True)
    return str(folder / "my_engine")


LANGUAGES = [in_python, in_javascript, in_cpp]


@pytest.fixture(scope="module", params=LANGUAGES, ids=lambda language: language.__name__)
def command(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The words that start a template with the engine above."""
    language: Callable[[Path], str] = request.param
    return language(tmp_path_factory.mktemp("engine"))


def judged(scene: Scene | str, command: str, parts: int = 10) -> Judgement:
    """Return the judgement of a template on a scene, in steps of a part of the scene's unit of time."""
    asked = load(scene) if isinstance(scene, str) else scene
    step = float(natural_units(asked).time) / parts
    return run(asked, f"process:{command} {step!r}", tolerance=TOLERANCE, causes=False)


# A constant moment, a start other than 0, a motion backwards in time; all else is in LOADED.
KINDS = ("constant-moment", "later-start", "moment-backward")


def test_a_template_answers_each_kind_of_scene(command: str) -> None:
    """It reads all that may act on a body; what it cannot have is unsuited."""
    for name in KINDS:
        verdicts = judged(f"euler/{name}", command).verdicts
        assert {verdict.verdict for verdict in verdicts} == {Status.PASS}, name
    (verdict,) = {v.verdict for v in judged("engines/ellipsoid", command).verdicts}
    assert verdict is Status.UNAVAILABLE


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_a_template_answers_every_scene(command: str, name: str) -> None:
    """Its answer to each shipped scene of a rigid body passes, or the scene is unsuited."""
    right = {Status.PASS}, {Status.UNAVAILABLE}
    assert {v.verdict for v in judged(name, command, 50).verdicts} in right


@pytest.mark.parametrize("end", by_turns([8, -5]))
def test_a_template_evaluates_loads(command: str, end: int) -> None:
    """Texts, a table, a switch, damping and wheels reach the engine, forwards and backwards in time."""
    scene = read(LOADED.replace("END", str(end)), "all")
    assert {v.verdict for v in judged(scene, command).verdicts} == {Status.PASS}


def test_a_template_has_states_of_ones_own(command: str) -> None:
    """Wheels that a text drives, and a sampled controller, beside the engine and in its answer."""
    assert largest_error(acted(), command, "1/16") < 1e-4
    # Of order four, as the engine is: half a step leaves a sixteenth of the error.
    coarse, fine = (
        largest_error(acted(is_smooth=True), command, step) for step in ("1/16", "1/32")
    )
    assert coarse > 12 * fine


def largest_error(scene: Scene, command: str, step: str) -> float:
    """The largest difference of a template's answer from heyoka's, of body and states of one's own."""
    problem = pose(scene, rung("f64"))
    answered = solver_named(f"process:{command} {float(Fraction(step))}").solve(problem)
    exact = solver_named("taylor").solve(problem)
    assert answered.outcome is Outcome.FINISHED, answered.detail
    names = ("omega", "quaternion", "m", "h")
    return max(float(np.abs(answered.quantities[n] - exact.quantities[n]).max()) for n in names)


@pytest.mark.parametrize("left_out", ["self._damping * H", "_cross(self._wheels, omega)"])
def test_what_a_template_leaves_out_is_caught(left_out: str, tmp_path: Path) -> None:
    """The broken twin: without damping, or without wheels, the judgement fails."""
    command = in_python(tmp_path)
    text = (tmp_path / "acting.py").read_text(encoding="utf-8")
    assert left_out in text
    zero = "[0.0] * 3" if "cross" in left_out else "0.0"
    (tmp_path / "acting.py").write_text(text.replace(left_out, zero), encoding="utf-8")
    scene = read(LOADED.replace("END", "8"), "all")
    assert Status.FAIL in {v.verdict for v in judged(scene, command).verdicts}


def test_the_row_for_the_board_is_one() -> None:
    """The entry on the page is read by the list of the board, and asks for each version on some scene."""
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    row = converted({"scene": [], **tomllib.loads(text)}, EntryList).entry[0]
    runs = list(row.runs(entry_list().scene))
    assert {run.version for run in runs} == {"1.0.0", "1.1.0"}
    assert runs[0].solver == "outside:mine?version=1.1.0&integrator=euler&step=0.02"
