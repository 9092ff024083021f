"""Every door through which a verdict leaves names the same likely cause."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.testing.demand import report

pytest_plugins = ["pytester"]

SCENE = "euler/generic"
CAUSE = "no gyroscopic term"


def without_gyroscopic_term(problem: Any) -> Any:
    """Return omega as it started: I omega' = 0."""
    start = [float(w) for w in problem.given.initial.omega]
    return np.array([start] * len(problem.given.clock.elapsed))


@pytest.fixture(scope="module")
def trajectory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A CSV of a simulator without the gyroscopic term."""
    scene = taylor_verify.load(SCENE)
    file = tmp_path_factory.mktemp("doors") / "mine.csv"
    times = [float(t) for t in scene.clock.instants]
    (start,) = {tuple(map(float, scene.initial.moving))}
    rows = [",".join(map(repr, (t, *start))) for t in times]
    file.write_text("\n".join(["t,w1,w2,w3", *rows]) + "\n", encoding="utf-8")
    return file


def test_the_terminal_begins_with_the_verdict_and_has_a_line_for_the_cause(
    trajectory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The first sentence has verdict, cause and worst row; a line begins `likely cause:`."""
    assert main(["check", str(trajectory), "--scene", SCENE]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith(f"fail, likely cause: {CAUSE}; worst:") for line in lines[:4])
    assert any(line.startswith("likely cause:") and CAUSE in line for line in lines)


def test_junit_and_github_name_the_cause(
    trajectory: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """JUnit, the annotations and the step summary have it beside the row that it explains."""
    junit, summary = tmp_path / "results.xml", tmp_path / "summary.md"
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(summary))
    call = ["check", str(trajectory), "--scene", SCENE, "--junit", str(junit), "--github"]
    assert main(call) == 1
    shown = capsys.readouterr()
    annotations = [line for line in f"{shown.out}\n{shown.err}".splitlines() if "::error" in line]
    texts = [junit.read_text(encoding="utf-8"), summary.read_text(encoding="utf-8"), *annotations]
    assert all(CAUSE in text for text in texts[:2])
    assert any(CAUSE in line for line in annotations)


def test_python_prints_the_cause(trajectory: Path) -> None:
    """print, a notebook and the exception have it."""
    judgement = taylor_verify.check(SCENE, trajectory)
    with pytest.raises(AssertionError) as raised:
        judgement.raise_for_failure()
    texts = (str(judgement), judgement._repr_html_(), str(raised.value))
    assert all(CAUSE in text for text in texts)


def test_pytest_names_the_cause_and_gives_no_false_lead() -> None:
    """The report of the plugin has the cause in place of the advice that the pattern of fails gives."""
    judgement = taylor_verify.check(SCENE, without_gyroscopic_term)
    text = report(judgement, list(judgement.verdicts))
    assert f"likely cause: {CAUSE}" in text.splitlines()[0]
    assert "Look at the time" not in text
