"""`--baseline` and `--against` compare with earlier verdicts, and decide the exit status by name."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from builders import reports
from builders.scenes import scene_file
from builders.verdicts import row

from taylor_verify.batch.comparison import Earlier
from taylor_verify.batch.earlier_file import read_baseline
from taylor_verify.check import check
from taylor_verify.cli import main
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.status import Status
from taylor_verify.records.sums import line
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.words.annotations import annotation_lines
from taylor_verify.words.case import Remark
from taylor_verify.words.junit import junit

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


# With `--gate baseline` the baseline alone decides, and what shows nothing is never green.


def status_alone(before: Sequence[Verdict], now: Sequence[Verdict]) -> int:
    earlier = Earlier("before.json", tuple(before))
    return earlier.compare_as_baseline(Judgement(tuple(now), None), decides=True).exit_status


def ordinary(errors: float = 1e5, **changed: Any) -> Verdict:
    """The row of an ordinary integrator, whose error is far beyond its bound."""
    return row(errors, verdict=Status.FAIL, **changed)


# Which rows decide.


def test_what_fails_its_bound_as_before_is_green() -> None:
    """The twin whose error has grown beyond ten times is not, nor is one that passed before."""
    assert status_alone([ordinary()], [ordinary(9e5)]) == 0
    assert status_alone([ordinary()], [ordinary(11e5)]) == 1
    assert status_alone([row()], [ordinary()]) == 1
    assert status_alone([ordinary()], [row()]) == 0


@pytest.mark.parametrize("lost", [None, math.nan, math.inf])
def test_a_row_without_a_finite_error_is_a_regression_from_any_baseline(lost: Any) -> None:
    """Also from one that has none either."""
    numbers = dict.fromkeys(("max", "mean", "final", "ratio"), lost)
    broken = ordinary(**numbers)
    for before in (ordinary(), broken):
        assert status_alone([before], [broken]) == 1
    unfinished = replace(broken, at=None, outcome="stopped before the last sample")
    assert status_alone([unfinished], [unfinished]) == 1


@pytest.mark.parametrize("status", [s for s in Status if exit_status([row(verdict=s)]) == 3])
def test_a_row_that_shows_nothing_is_never_green(status: Status) -> None:
    """Undecided, vacuous and refused are not comparable, though they were so before."""
    nothing = row(verdict=status)
    assert status_alone([nothing], [nothing]) == 3
    extra = row(quantity="complete", verdict=Status.UNDECIDED, at=None)
    assert status_alone([row()], [row(), extra]) == 3


def test_a_part_that_the_caller_accepts_and_a_missing_format_count_for_nothing() -> None:
    """The row `complete` of --partial, and a rung that this machine lacks beside one that it has."""
    waived = row(quantity="complete", verdict=Status.VACUOUS, at=None)
    lacks = {"verdict": Status.UNAVAILABLE, "outcome": Outcome.NO_FORMAT.value}
    absent = row(rung="f80", **lacks, at=None)
    assert status_alone([row()], [row(), waived]) == 0
    assert status_alone([row(), row(rung="f80")], [row(), absent]) == 0
    assert status_alone([row(rung="f80")], [absent]) == 3


def test_a_new_row_counts_if_it_fails() -> None:
    """A new row that fails is a regression; one that passes needs no baseline."""
    assert status_alone([ordinary()], [ordinary(), row(quantity="T")]) == 0
    assert status_alone([ordinary()], [ordinary(), ordinary(quantity="T")]) == 3


def test_a_row_that_is_named_already_is_not_named_again() -> None:
    """Without the gates a row is lost once, or shows nothing; a row that passes is neither."""
    failed = row(50.0, verdict=Status.FAIL)
    lost = row(verdict=Status.FAIL, max=math.nan)
    empty = row(verdict=Status.VACUOUS)
    for was, now, failures, undecided in (
        (row(), row(), 0, 0),
        (row(), failed, 2, 0),
        (row(), lost, 2, 0),
        (failed, failed, 0, 0),
        (lost, lost, 1, 0),
        (empty, empty, 0, 1),
    ):
        comparison = Earlier("before.json", (was,)).compare_as_baseline(
            Judgement((now,), None), decides=True
        )
        assert (len(comparison.failures), len(comparison.undecided)) == (failures, undecided)


# What a CI is shown.


def elements(text: str) -> list[str]:
    cases = ElementTree.fromstring(text).iter("testcase")
    return [",".join(child.tag for child in case) for case in cases]


def test_a_row_beyond_its_bound_is_green_for_a_ci_and_a_regression_is_red() -> None:
    """JUnit and annotations are green for the row and red for the regression; a skip stays one."""
    rows = [ordinary(), ordinary(quantity="T"), row(rung="f80", verdict=Status.UNAVAILABLE)]
    grew = Remark("euler/generic", "taylor", "", "f64", "T", Status.FAIL, "regression: grew")
    doubt = grew._replace(status=Status.UNDECIDED, text="not comparable: another text")
    assert elements(junit(rows, [], by_remarks=True)) == ["", "", "skipped"]
    assert elements(junit(rows, [grew], by_remarks=True)) == ["", "failure", "skipped"]
    assert elements(junit(rows, [doubt], by_remarks=True)) == ["", "error", "skipped"]
    assert elements(junit(rows, [grew])) == ["failure", "failure", "skipped"]
    (line, _) = annotation_lines(rows, [grew], by_remarks=True)
    assert line.startswith("::error title=euler/generic on f64%3A T fail::")
    assert len(annotation_lines(rows, [], by_remarks=True)) == 1


# The command.

COARSE = "scipy:RK45?rtol={}"


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    return str(scene_file(Path()))


def test_run_is_decided_by_the_baseline_in_both_directions(scene: str, capsys: Captured) -> None:
    """A coarse solver is green as it was, a coarser one red; text, JSON and JUnit say by what."""
    assert main(["run", scene, "--solver", COARSE.format("1e-6"), "--json"]) == 1
    document = json.loads(capsys.readouterr().out)
    gate = ["--baseline", "base.json", "--gate", "baseline", "--junit", "r.xml"]
    for name, status, words in (("1e-6", 0, "no regression"), ("1e-2", 1, "regressions")):
        # The name of the solver holds its tolerance: the baseline is that of another setting.
        rows = [{**each, "solver": COARSE.format(name)} for each in document["verdicts"]]
        Path("base.json").write_text(json.dumps({"verdicts": rows}), encoding="utf-8")
        call = ["run", scene, "--solver", COARSE.format(name), *gate]
        assert main(call) == status
        out, error = capsys.readouterr()
        assert out.splitlines()[-1].startswith("decided by the baseline base.json alone: ")
        assert words in out.splitlines()[-1]
        assert ("regression: expected at most" in error) is bool(status)
        text = Path("r.xml").read_text(encoding="utf-8")
        assert ("failure" in elements(text)) is bool(status)
        assert main([*call, "--json"]) == status
        printed = json.loads(capsys.readouterr().out)
        assert printed["baseline"]["gate"] == "baseline"
        assert {each["verdict"] for each in printed["verdicts"]} == {"pass", "fail"}
        assert main([*call[:-4], "--baseline", "base.json"]) == 1


def test_nothing_compared_is_undecided_and_red_for_a_ci(scene: str, capsys: Captured) -> None:
    """A baseline of another solver decides nothing."""
    assert main(["run", scene, "--solver", COARSE.format("1e-6"), "--json"]) == 1
    Path("base.json").write_text(capsys.readouterr().out, encoding="utf-8")
    call = ["run", scene, "--solver", "scipy:DOP853", "--baseline", "base.json", "--junit", "r.xml"]
    assert main([*call, "--gate", "baseline"]) == 3
    assert "alone: no row was compared" in capsys.readouterr().out.splitlines()[-1]
    assert set(elements(Path("r.xml").read_text(encoding="utf-8"))) == {"error"}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "expected --baseline FILE beside --gate baseline, got none @ --gate"),
        (
            ["--baseline", "base.json", "--against", "reports"],
            "expected one comparison to decide, got --against too @ --gate baseline",
        ),
    ],
)
def test_a_gate_without_its_one_baseline_is_a_wrong_call(
    options: list[str], message: str, scene: str, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exit status 2 before anything runs."""
    monkeypatch.setattr("taylor_verify.cli.run._published", lambda folder: None)
    assert main(["run", scene, "--gate", "baseline", *options]) == 2
    assert message in capsys.readouterr().err


# Files of other names.


def write_answer(name: str, factor: float) -> None:
    """A file of a body at the same three instants that turns a little too fast."""
    Path(name).write_text(
        "t,w1,w2,w3\n" + "".join(f"{t},{factor},0.4,0.3\n" for t in (0, 1, 2)), encoding="utf-8"
    )


def test_a_file_is_compared_with_the_one_file_of_a_baseline(scene: str, capsys: Captured) -> None:
    """Whatever their names are, and a message says so; the rows keep the name of the new file."""
    write_answer("monday.csv", 1.0)
    write_answer("tuesday.csv", 1.0)
    assert main(["check", "monday.csv", "--scene", scene, "--json"]) == 1
    Path("base.json").write_text(capsys.readouterr().out, encoding="utf-8")
    call = ["check", "tuesday.csv", "--scene", scene, "--baseline", "base.json"]
    assert main([*call, "--gate", "baseline"]) == 0
    message = "the baseline is of the file monday.csv, and this is tuesday.csv"
    assert message in capsys.readouterr().err
    judged = check(scene, "tuesday.csv")
    comparison = read_baseline("base.json").compare_as_baseline(judged, decides=True)
    assert comparison.passed
    assert {verdict.setting for verdict in comparison.before} == {"tuesday.csv"}


def test_of_several_files_the_one_with_the_same_name_counts(scene: str, capsys: Captured) -> None:
    """A file that is not among the baselines is compared with none, and the names are said."""
    rows = []
    for name in ("monday.csv", "tuesday.csv"):
        write_answer(name, 1.0)
        main(["check", name, "--scene", scene, "--json"])
        rows += json.loads(capsys.readouterr().out)["verdicts"]
    Path("base.json").write_text(json.dumps({"verdicts": rows}), encoding="utf-8")
    write_answer("sunday.csv", 1.0)
    for name, status in (("monday.csv", 0), ("sunday.csv", 3)):
        call = ["check", name, "--scene", scene, "--baseline", "base.json", "--gate", "baseline"]
        assert main(call) == status
    error = capsys.readouterr().err
    assert "its file is monday.csv, tuesday.csv, and this one sunday.csv" in error


def test_another_span_is_not_comparable() -> None:
    """An answer that ends early has smaller errors than the whole one: no row of it shows anything."""
    assert status_alone([ordinary(until=40.0)], [ordinary(until=9.0)]) == 3
    assert status_alone([ordinary(until=40.0)], [ordinary(until=40.0)]) == 0


def test_none_of_several_files_may_be_left_out() -> None:
    """The finest file of a series is gone: a regression, as long as the others have their names."""

    def rows(*names: str) -> tuple[Verdict, ...]:
        return tuple(row(solver="file", setting=name) for name in names)

    before = Earlier("before.json", rows("a.csv", "b.csv", "c.csv"))
    compared = before.compare_as_baseline(Judgement(rows("a.csv", "b.csv"), None))
    assert [departure.setting for departure in compared.failures] == ["c.csv"]
    assert before.compare_as_baseline(Judgement(rows("a.csv"), None)).exit_status == 0
