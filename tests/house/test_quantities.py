"""A new state quantity is named in five files, and every door then knows it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Final

import pytest

import taylor_verify

PACKAGE: Final = Path(taylor_verify.__file__).parent
ROOT: Final = PACKAGE.parent.parent
NAME: Final = "spin_energy"
# By file a line of it, and what is written before that line; page and list are the fifth and last.
TOLD: Final = {
    "records/quantities.py": (
        (
            '        Group("centre", (',
            f'        Group("{NAME}", ("es",), "{NAME}", "energy", "number", moves_with=""),\n',
        ),
        (
            '        Quantity("velocity", ',
            f'        Quantity("{NAME}", "max|{NAME}|", ("{NAME}",), "", ("euler",), is_function=True),\n',
        ),
    ),
    "solvers/trajectory.py": (
        (
            '    "centre": _centres,',
            f'    "{NAME}": lambda problem, columns, motion: [\n'
            "        (sum(i * w * w for i, w in zip((1, 2, 3), row)) / 2,)\n"
            '        for row in motion["omega"]\n    ],\n',
        ),
    ),
    "exact/functions.py": (
        (
            "def functions(scene",
            "def _energy(scene):\n"
            "    from dataclasses import replace\n"
            "    from taylor_verify.exact.euler.invariants import energy\n"
            f'    return replace(energy(scene.body), name="{NAME}")\n\n\n'
            f'FUNCTIONS["{NAME}"] = _energy\n\n\n',
        ),
    ),
    "solvers/files/columns/names.py": (
        (
            '    yield Spelling("centre", _P,',
            f'    yield Spelling("{NAME}", ("e_spin",), is_whole=True)\n',
        ),
    ),
}
SCENE: Final = """title = "A spin and its energy"
model = "euler"
track = ["spin_energy"]
[body]
inertia = [1, 2, 3]
[initial]
omega = [1, 0.4, 0.3]
[time]
end = 5
samples = 11
"""
SOLVER: Final = """import numpy as np
I, h = np.array([1, 2, 3]), 1 / 64
def rate(w):
    return np.cross(I * w, w) / I
def solve(problem=None, factor=1):
    w, rows = np.array([1, 0.4, 0.3]), []
    for n in range(321):
        rows.append([*w, factor * (I * w) @ w / 2])
        a = rate(w); b = rate(w + h / 2 * a); c = rate(w + h / 2 * b); d = rate(w + h * c)
        w = w + h / 6 * (a + 2 * b + 2 * c + d)
    return np.array(rows[::32])
def wrong(problem=None):
    return solve(factor=1.001)
if __name__ == "__main__":
    for name in (solve, wrong):
        table = np.c_[np.arange(11) / 2, name()]
        np.savetxt(name.__name__ + ".csv", table, header="t w1 w2 w3 e_spin", comments="")
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package that was told of one more quantity, a scene that tracks it, and answers."""
    folder = tmp_path_factory.mktemp("told")
    shutil.copytree(
        PACKAGE,
        folder / "verify" / "taylor_verify",
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    (folder / "cases").symlink_to(ROOT / "cases")
    for name, insertions in TOLD.items():
        file = folder / "verify" / "taylor_verify" / name
        text = file.read_text("utf-8")
        for line, added in insertions:
            assert text.count(f"\n{line}") == 1, f"{name} has no line {line!r}"
            text = text.replace(f"\n{line}", f"\n{added}{line}")
        file.write_text(text, "utf-8")
    (folder / "spin.toml").write_text(SCENE, "utf-8")
    (folder / "simulator.py").write_text(SOLVER, "utf-8")
    subprocess.run([sys.executable, "simulator.py"], cwd=folder, check=True)
    return folder


Call = Callable[..., tuple[int, str]]


@pytest.fixture(scope="module")
def call(folder: Path) -> Call:
    def call(*words: str) -> tuple[int, str]:
        environment = {**os.environ, "PYTHONPATH": str(folder / "verify")}
        done = subprocess.run(
            [sys.executable, "-m", *words],
            cwd=folder,
            env=environment,
            capture_output=True,
            encoding="utf-8",
        )
        return done.returncode, done.stdout + done.stderr

    return call


def test_five_files_are_told() -> None:
    """Four files of the package and the page of columns are all that a new quantity needs."""
    assert len(TOLD) + 1 <= 5


@pytest.mark.parametrize(
    "answer",
    [
        ("check", "{}.csv", "--scene", "spin.toml"),
        ("run", "spin.toml", "--solver", "python:simulator:{}"),
    ],
)
def test_an_answer_is_judged(call: Call, answer: tuple[str, ...]) -> None:
    """A right energy passes and one that is 1e-3 too large fails, from a file and from a function."""
    for name, verdict, status in (("solve", "pass", 0), ("wrong", "fail", 1)):
        words = [word.format(name) for word in answer]
        code, text = call("taylor_verify", *words, "--json", "--tolerance", "1e-6")
        assert code == status, text
        rows = {row["quantity"]: row for row in json.loads(text)["verdicts"]}
        assert rows[NAME]["verdict"] == verdict
        assert rows["omega"]["verdict"] == "pass"
    assert abs(rows[NAME]["max"] - 1e-3) <= 1e-6


@pytest.mark.parametrize(
    "words",
    [
        "explain spin.toml",
        "question spin.toml --csv",
        "question spin.toml",
        "exact spin.toml --at 1,2",
        "exact spin.toml --at 1,2 --json",
        "check wrong.csv --scene spin.toml",
        "check wrong.csv --scene spin.toml --explain",
        "check wrong.csv --scene spin.toml --github",
        "run spin.toml --solver scipy:DOP853",
        "run spin.toml --solver taylor",
    ],
)
def test_a_door_names_it(call: Call, words: str) -> None:
    """Each door names the quantity, or its column."""
    code, text = call("taylor_verify", *words.split())
    assert code in (0, 1), text
    assert "Traceback" not in text
    assert NAME in text or ",es" in text or " es" in text
