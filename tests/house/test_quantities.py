"""A new state quantity is named in five files, and every door then knows it."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
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
            f'    yield Spelling("{NAME}", ("espin",), is_whole=True)\n',
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
    loaded = SCENE.replace("[initial]", 'moment = ["-0.1*w1", 0, "0.1*sin(t)"]\n[initial]')
    (folder / "loaded.toml").write_text(loaded, "utf-8")
    (folder / "doors.py").write_text(SCRIPT, "utf-8")
    (folder / "gate.py").write_text(GATE, "utf-8")
    (folder / "simulator.py").write_text(SOLVER, "utf-8")
    subprocess.run([sys.executable, "simulator.py"], cwd=folder, check=True)
    return folder


# The words of each call; {} is the name of an answer that is right or wrong.
CALLS: Final = {
    "file": "check {}.csv --scene spin.toml --json --tolerance 1e-6",
    "function": "run spin.toml --solver python:simulator:{} --json --tolerance 1e-6",
}
DOORS: Final = (
    "explain spin.toml",
    "question spin.toml --csv",
    "question spin.toml",
    "exact spin.toml --at 1,2",
    "exact spin.toml --at 1,2 --json --route mpmath",
    "check wrong.csv --scene spin.toml",
    "check wrong.csv --scene spin.toml --explain",
    "check wrong.csv --scene spin.toml --github",
    "check wrong.csv --scene spin.toml --junit junit.xml",
    "draw spin.toml wrong.csv --only errors --out drawn.svg",
    "run spin.toml --solver scipy:DOP853",
    "run loaded.toml --solver taylor",
)
SCRIPT: Final = """import contextlib, io, json, sys
import taylor_verify
from taylor_verify.cli import main
import simulator

answers = {}
for words in json.loads(sys.argv[1]):
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()):
        try:
            code = main(words.split())
        except SystemExit as end:
            code = end.code
    answers[words] = code, out.getvalue()
judged = taylor_verify.check("spin.toml", simulator.wrong)
answers["page"] = 1, judged._repr_html_()
answers["table"] = 1, judged.to_dataframe().to_csv()
answers["motion"] = 0, taylor_verify.exact("spin.toml", [1], digits=20).to_dataframe().to_csv()
print(json.dumps(answers))
"""
GATE: Final = """import simulator
def test_spin(verify_solver):
    verify_solver("spin.toml", simulator.wrong)
"""


def told(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run Python with the copy of the package."""
    environment = {**os.environ, "PYTHONPATH": str(folder / "verify")}
    return subprocess.run(
        [sys.executable, *words], cwd=folder, env=environment, capture_output=True, encoding="utf-8"
    )


@pytest.fixture(scope="module")
def answers(folder: Path) -> dict[str, tuple[int, str]]:
    """The exit status and the text of every door."""
    calls = [words.format(name) for words in CALLS.values() for name in ("solve", "wrong")]
    done = told(folder, "doors.py", json.dumps([*calls, *DOORS]))
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_five_files_are_told() -> None:
    """Four files of the package and the page of columns are named in the list for contributors."""
    page = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    steps = page.partition("## To add a state quantity")[2].partition("\n## ")[0]
    named = set(re.findall(r"`((?:verify|docs)/[\w/]+\.\w+)`", steps))
    assert named == {*(f"verify/taylor_verify/{name}" for name in TOLD), "docs/columns.md"}
    assert len(named) <= 5


@pytest.mark.parametrize("words", CALLS.values(), ids=CALLS)
def test_an_answer_is_judged(answers: dict[str, tuple[int, str]], words: str) -> None:
    """A right energy passes and one that is 1e-3 too large fails, from a file and from a function."""
    for name, verdict, status in (("solve", "pass", 0), ("wrong", "fail", 1)):
        code, text = answers[words.format(name)]
        assert code == status, text
        rows = {row["quantity"]: row for row in json.loads(text)["verdicts"]}
        assert rows[NAME]["verdict"] == verdict
        assert rows["omega"]["verdict"] == "pass"
    assert abs(rows[NAME]["max"] - 1e-3) <= 1e-6


@pytest.mark.parametrize("words", [*DOORS, "page", "table", "motion"])
def test_a_door_names_it(folder: Path, answers: dict[str, tuple[int, str]], words: str) -> None:
    """Each door names the quantity, or its column."""
    code, text = answers[words]
    if (out := words.rpartition(" ")[2]) in ("junit.xml", "drawn.svg"):
        text += (folder / out).read_text("utf-8")
    assert code in (0, 1), text
    names = ("es",) if words.startswith("question") else (NAME,)
    assert any(re.search(rf"\b{name}\b", text) for name in names), text


def test_pytest_names_it(folder: Path) -> None:
    """The fixture of pytest fails a wrong energy by its name."""
    done = told(folder, "-m", "pytest", "-q", "-p", "taylor_verify.testing.plugin", "gate.py")
    assert done.returncode == 1
    assert f"{NAME}: " in done.stdout
