"""`--baseline` and `--against` compare with earlier verdicts, and decide the exit status by name."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from builders import reports

from taylor_verify.cli import main
from taylor_verify.records.sums import line

Captured = pytest.CaptureFixture[str]
TWO = ["run", "euler/generic", "euler/full-tensor"]
# The option, what it names in the folder of a report, and its list in the document of --json.
BASELINE = ("--baseline", "data/verdicts.json", "regressions")
LESS = dict.fromkeys(("max", "mean", "final"), 6e-14 / 11)
AGAINST = ("--against", "", "departures")
GREW = "got 6e-14 @ euler/full-tensor f64 omega max"


@pytest.fixture
def report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the rows of two scenes, and a run that makes just these rows again."""
    reports.write_remade(tmp_path, monkeypatch, {"errors": 6.0})
    return tmp_path


def spoil(folder: Path, index: int, **changed: Any) -> None:
    """Change one stored row, its time and the sum; with nothing to change, take the row out."""
    file = folder / "data" / "verdicts.json"
    stored = json.loads(file.read_text(encoding="utf-8"))
    if changed:
        digest = stored["scenes"][stored["verdicts"][index]["scene"]]
        stored["verdicts"][index] |= changed
        stored["scenes"].setdefault(stored["verdicts"][index]["scene"], digest)
    else:
        del stored["verdicts"][index]
    text = json.dumps(stored)
    file.write_text(text, encoding="utf-8")
    file.with_name("verdicts.sha256").write_text(line(text.encode(), file.name))
    file.with_name("timings.json").unlink(missing_ok=True)


def option(report: Path, how: tuple[str, str, str]) -> list[str]:
    return [how[0], str(report / how[1])]


@pytest.mark.parametrize(
    ("how", "changed", "words"),
    [
        (BASELINE, LESS, GREW),
        (AGAINST, LESS, GREW),
        (AGAINST, {"max": 30 * 6e-14, "bound": 1e-9}, GREW),
        (AGAINST, {}, "expected no such row, got a new one @ euler/full-tensor f64 omega"),
        (AGAINST, {"verdict": "fail"}, "expected fail, got pass @ euler/full-tensor f64 omega"),
        (BASELINE, {"quantity": "H_space"}, "this row, got none @ euler/full-tensor f64 H_space"),
        (AGAINST, {"quantity": "H_space"}, "this row, got none @ euler/full-tensor f64 H_space"),
    ],
)
def test_run_against_a_broken_twin_exits_1_by_name(
    report: Path, capsys: Captured, how: tuple[str, str, str], changed: dict[str, Any], words: str
) -> None:
    """Exit 0 against the same rows; 1, and the reason in message and document, against the twin."""
    name, _, listed = how
    call = [*TWO, *option(report, how), "--json"]
    assert main(call) == 0
    key = name.removeprefix("--")
    assert json.loads(capsys.readouterr().out)[key]["compared"] == 6
    spoil(report, 0, **changed)
    assert main(call) == 1
    out, error = capsys.readouterr()
    assert words in error
    assert any(words in line for line in json.loads(out)[key][listed])


def test_what_is_better_fails_no_baseline(report: Path, capsys: Captured) -> None:
    """It is named as a change, and the exit status is 0."""
    spoil(report, 0, max=30 * 6e-14, bound=1e-9)
    assert main([*TWO, *option(report, BASELINE)]) == 0
    assert "changed, no regression: expected at least 1.8e-13" in capsys.readouterr().err


@pytest.mark.parametrize("how", [BASELINE, AGAINST])
def test_only_what_was_run_again_is_compared(report: Path, how: tuple[str, str, str]) -> None:
    """A scene that was not named may have gone; run without names, every scene must be there."""
    spoil(report, 0, scene="euler/gone")
    call = ["run", "--rung", "f64", *option(report, how)]
    assert main([*call, "euler/generic"]) == 0
    assert main(call) == 1


def test_a_comparison_of_nothing_is_undecided(
    report: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """Exit 3 where no row was compared, for another solver's rows say nothing of this one."""
    for index in range(6):
        spoil(report, index, solver="process:./other")
    assert main(["run", "euler/generic", *option(report, BASELINE)]) == 3
    error = capsys.readouterr().err
    assert "nothing of the baseline was run again" in error
    assert "its solver is `process:./other`, and this run's is `taylor`" in error
    monkeypatch.setattr("taylor_verify.batch.judging.judge_all", lambda *_: [])
    assert main(["run", "euler/generic", "--rung", "f32", *option(report, AGAINST)]) == 3


@pytest.mark.parametrize(
    ("how", "spoiled"),
    [
        *((how, spoiled) for how in (BASELINE, AGAINST) for spoiled in ("missing", "{", "{}")),
        (BASELINE, "folder"),
    ],
)
def test_what_holds_no_verdicts_is_a_wrong_call(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
    how: tuple[str, str, str],
    spoiled: str,
) -> None:
    """Exit 2 with a message that names the option, before any work."""
    monkeypatch.setattr(
        "taylor_verify.batch.judging.judge_all", lambda *_: pytest.fail("the work was begun")
    )
    file = tmp_path / "data" / "verdicts.json"
    file.parent.mkdir()
    if spoiled == "folder":
        file.mkdir()
    if spoiled.startswith("{"):
        file.write_text(spoiled, encoding="utf-8")
    assert main(["run", "euler/generic", *option(tmp_path, how)]) == 2
    assert how[0] in capsys.readouterr().err
