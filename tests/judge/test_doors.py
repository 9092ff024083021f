"""Every door through which a verdict leaves has the same words: status, worst row, likely cause."""

from __future__ import annotations

from contextlib import redirect_stderr, redirect_stdout
from html import unescape
from io import StringIO
from pathlib import Path
from typing import Final
from urllib.parse import unquote
from xml.etree import ElementTree

import numpy as np
import pytest
from builders.trajectories import write_csv

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.judge.judgement import Judgement
from taylor_verify.testing.demand import report
from taylor_verify.words.account import cause_line
from taylor_verify.words.markdown import plain
from taylor_verify.words.opening import opening, worst

SCENE: Final = "euler/generic"
CAUSE: Final = "no gyroscopic term"


@pytest.fixture(scope="module")
def trajectory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A CSV of a simulator without the gyroscopic term."""
    scene = taylor_verify.load(SCENE)
    file = tmp_path_factory.mktemp("doors") / "mine.csv"
    times = [float(t) for t in scene.clock.instants]
    (start,) = {tuple(map(float, scene.initial.moving))}
    still = {name: [w] * len(times) for name, w in zip(("w1", "w2", "w3"), start, strict=True)}
    return Path(write_csv(file, {"t": times, **still}))


@pytest.fixture(scope="module")
def judgement(trajectory: Path) -> Judgement:
    return taylor_verify.check(SCENE, trajectory)


@pytest.fixture(scope="module")
def doors(
    trajectory: Path, judgement: Judgement, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, str]:
    """The text that leaves by each door, without what its format adds."""
    folder = tmp_path_factory.mktemp("written")
    junit, summary = folder / "results.xml", folder / "summary.md"
    call = ["check", str(trajectory), "--scene", SCENE, "--junit", str(junit), "--github"]
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(StringIO()) as out:
        patch.setenv("GITHUB_STEP_SUMMARY", str(summary))
        with redirect_stderr(StringIO()) as err:
            assert main(call) == 1
    with pytest.raises(AssertionError) as raised:
        judgement.raise_for_failure()
    failures = ElementTree.parse(junit).iter("failure")
    return {
        "terminal": out.getvalue(),
        "step summary": plain(summary.read_text(encoding="utf-8")),
        "JUnit": "\n".join(f"{failure.get('type')}\n{failure.text}" for failure in failures),
        "annotations": unquote(err.getvalue()),
        "print": str(judgement),
        "notebook": unescape(judgement._repr_html_()),
        "exception": str(raised.value),
        "pytest": report(judgement, judgement.verdicts),
    }


DOORS: Final = (
    "terminal",
    "step summary",
    "JUnit",
    "annotations",
    "print",
    "notebook",
    "exception",
    "pytest",
)
# These show a row at its own place, and no report that could begin with a sentence.
ROWS_ALONE: Final = ("JUnit", "annotations")


@pytest.mark.parametrize("door", DOORS)
def test_every_door_has_the_status_the_worst_row_and_the_cause(
    door: str, doors: dict[str, str], judgement: Judgement
) -> None:
    """The sentence of the worst row and the line of the cause are equal at all of them."""
    (cause,) = judgement.causes
    assert cause.name == CAUSE
    assert "fail" in doors[door]
    assert worst(judgement.verdicts).sentence in doors[door]
    assert cause_line(cause.sentence) in doors[door]


@pytest.mark.parametrize("door", [door for door in DOORS if door not in ROWS_ALONE])
def test_every_report_begins_with_one_sentence(
    door: str, doors: dict[str, str], judgement: Judgement
) -> None:
    """Status, cause and worst row come before every other row."""
    beginning = opening(judgement.verdicts, judgement.causes)
    assert beginning.startswith(f"fail, likely cause: {CAUSE}; worst: omega: ")
    assert doors[door].index(beginning) < doors[door].index("likely cause: no gyroscopic term; ")


def test_the_terminal_begins_a_line_with_the_cause(doors: dict[str, str]) -> None:
    """Programs find it by `likely cause:` at the beginning of a line."""
    assert any(line.startswith("likely cause: ") for line in doors["terminal"].splitlines())


def test_a_convention_is_a_note_at_every_door_of_python() -> None:
    """Findings about a file are said by print, the notebook, the exception and the terminal."""
    times = np.linspace(0, 10, 11)
    states = np.array(taylor_verify.exact(SCENE, times)["omega"], dtype=float)
    columns = zip(("w1", "w2", "w3"), np.degrees(states).T, strict=True)
    judgement = taylor_verify.check(SCENE, {"t": times, **dict(columns)})
    (note,) = (finding.sentence for finding in judgement.conventions)
    assert f"note: {note}" in str(judgement)
    assert f"note: {note}" in unescape(judgement._repr_html_())


def test_the_row_of_one_of_several_runs_has_its_place() -> None:
    """In a report on many runs the opening, the rows and the causes name scene and rung."""
    results = taylor_verify.run_many(
        ["euler/generic", "euler/spherical"], "geometric:splitting?step=1", rungs=["f64"], jobs=1
    )
    with pytest.raises(AssertionError) as raised:
        results.raise_for_failure()
    first, *lines = str(raised.value).splitlines()
    assert "; worst: euler/" in first
    rows = [line for line in lines if line.startswith("fail  ")]
    assert rows
    assert all(line.startswith("fail  euler/") for line in rows)
