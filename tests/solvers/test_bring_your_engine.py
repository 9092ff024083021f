"""The templates of docs/bring-your-engine.md: each runs a stand-in engine, and its answer is judged."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from builders.worked import DOCS

from taylor_verify.records.json_text import converted
from taylor_verify.records.quantities import INITIAL
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify_reports.studies.engines.entry import EntryList, entry_list

PAGE = (DOCS / "bring-your-engine.md").read_text(encoding="utf-8")

# One engine three times: Euler's step of the gyroscopic term in principal axes, then a turn about omega.
PYTHON = """
import math

class Engine:
    def __init__(self, inertia, omega, attitude):
        self.I, self.w, self.q = [inertia[i][i] for i in range(3)], omega, attitude

    def step(self, h):
        (a, b, c), (x, y, z) = self.I, self.w
        x, y, z = x + h * (b - c) / a * y * z, y + h * (c - a) / b * z * x, z + h * (a - b) / c * x * y
        size = math.sqrt(x * x + y * y + z * z)
        s, (p, q, r, t) = math.sin(size * h / 2) / size, self.q
        u, x1, y1, z1 = math.cos(size * h / 2), s * x, s * y, s * z
        self.w = [x, y, z]
        self.q = [
            p * u - q * x1 - r * y1 - t * z1, p * x1 + q * u + r * z1 - t * y1,
            p * y1 + r * u + t * x1 - q * z1, p * z1 + t * u + q * y1 - r * x1,
        ]

    def state(self):
        return [*self.w, *self.q]
"""
JAVASCRIPT = """
export class Engine {
  constructor(inertia, omega, attitude) {
    this.I = [0, 1, 2].map((i) => inertia[i][i]);
    this.w = omega;
    this.q = attitude;
  }
  step(h) {
    const [a, b, c] = this.I, [x0, y0, z0] = this.w, [p, q, r, t] = this.q;
    const x = x0 + h * (b - c) / a * y0 * z0, y = y0 + h * (c - a) / b * z0 * x0;
    const z = z0 + h * (a - b) / c * x0 * y0, size = Math.sqrt(x * x + y * y + z * z);
    const s = Math.sin(size * h / 2) / size, u = Math.cos(size * h / 2);
    const x1 = s * x, y1 = s * y, z1 = s * z;
    this.w = [x, y, z];
    this.q = [p * u - q * x1 - r * y1 - t * z1, p * x1 + q * u + r * z1 - t * y1,
      p * y1 + r * u + t * x1 - q * z1, p * z1 + t * u + q * y1 - r * x1];
  }
  state() { return [...this.w, ...this.q]; }
}
"""
CPP = """
#include <cmath>
#include <vector>
struct Engine {
  double a, b, c;
  std::vector<double> w, q;
  Engine(std::vector<double> i, std::vector<double> omega, std::vector<double> attitude)
      : a(i[0]), b(i[4]), c(i[8]), w(omega), q(attitude) {}
  void step(double h) {
    double x = w[0] + h * (b - c) / a * w[1] * w[2], y = w[1] + h * (c - a) / b * w[2] * w[0];
    double z = w[2] + h * (a - b) / c * w[0] * w[1], size = std::sqrt(x * x + y * y + z * z);
    double s = std::sin(size * h / 2) / size, u = std::cos(size * h / 2);
    double x1 = s * x, y1 = s * y, z1 = s * z;
    w = {x, y, z};
    q = {q[0] * u - q[1] * x1 - q[2] * y1 - q[3] * z1, q[0] * x1 + q[1] * u + q[2] * z1 - q[3] * y1,
         q[0] * y1 + q[2] * u + q[3] * x1 - q[1] * z1, q[0] * z1 + q[3] * u + q[1] * y1 - q[2] * x1};
  }
  std::vector<double> state() { return {w[0], w[1], w[2], q[0], q[1], q[2], q[3]}; }
};
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


def in_python(folder: Path) -> str:
    (folder / "my_engine.py").write_text(template("python"), encoding="utf-8")
    (folder / "engine.py").write_text(PYTHON, encoding="utf-8")
    return f"{sys.executable} {folder / 'my_engine.py'}"


def in_javascript(folder: Path) -> str:
    node = program("node")
    (folder / "my_engine.mjs").write_text(template("javascript"), encoding="utf-8")
    (folder / "engine.mjs").write_text(JAVASCRIPT, encoding="utf-8")
    return f"{node} {folder / 'my_engine.mjs'}"


def in_cpp(folder: Path) -> str:
    compiler = program("c++", "g++")
    (folder / "my_engine.cpp").write_text(template("cpp"), encoding="utf-8")
    (folder / "engine.hpp").write_text(CPP, encoding="utf-8")
    # As it is printed: neither the processor nor the compiler may fuse a product with a sum.
    words = [compiler, "-Wall", "-Werror", "-O1", "-ffp-contract=off", "-o", "my_engine"]
    subprocess.run([*words, "my_engine.cpp"], cwd=folder, check=True)
    return str(folder / "my_engine")


@pytest.mark.parametrize("language", [in_python, in_javascript, in_cpp])
def test_a_template_answers(language: Callable[[Path], str], tmp_path: Path) -> None:
    """Its start is the scene's, and the judge names the step that the stand-in engine takes."""
    judged = run("engines/oblique", f"process:{language(tmp_path)} 0.01")
    verdicts = {verdict.quantity: verdict for verdict in judged.verdicts}
    assert verdicts[INITIAL].verdict is Status.PASS
    assert verdicts["omega"].steps == 2000
    assert verdicts["omega"].verdict is Status.FAIL
    assert {"explicit gyroscopic step"} <= {cause.name for cause in judged.causes}
    in_a_fluid = run("engines/ellipsoid", f"process:{language(tmp_path)} 0.01")
    assert {verdict.verdict for verdict in in_a_fluid.verdicts} == {Status.UNAVAILABLE}


def test_the_row_for_the_board_is_one() -> None:
    """The entry on the page is read by the list of the board, and asks for each version on some scene."""
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    row = converted({"scene": [], **tomllib.loads(text)}, EntryList).entry[0]
    runs = list(row.runs(entry_list().scene))
    assert {run.version for run in runs} == {"1.0.0", "1.1.0"}
    assert runs[0].solver == "outside:mine?version=1.1.0&integrator=euler&step=0.02"
