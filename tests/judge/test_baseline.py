"""A regression from a baseline is what rounding does not explain, and nothing that shrank."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from itertools import product
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from builders import reports
from builders.verdicts import ATTAINABLE, row
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.cli import main
from taylor_verify.judge.baseline import decided_alone, hold, load
from taylor_verify.judge.rounding_class import FACTOR, LEVEL, compare
from taylor_verify.records.status import Status
from taylor_verify.records.store import load as load_report
from taylor_verify.records.store import write
from taylor_verify.records.verdict import Verdict, exit_status

Captured = pytest.CaptureFixture[str]


def regressions(old: Iterable[Verdict], new: Iterable[Verdict]) -> list[str]:
    return [str(departure) for departure in hold(old, new).regressions]


def test_a_quaternion_that_loses_its_length_is_a_regression() -> None:
    """The row of a lost unit quaternion is new where it appears, and held as no other new row is."""
    lost = row(errors=50.0, verdict=Status.FAIL, quantity="unit quaternion")
    (regression,) = regressions([row()], [row(), lost])
    assert "expected no such row, got one that fails" in regression
    assert hold([row()], [row(), row(quantity="T")]).regressions == ()


def test_a_quaternion_that_has_its_length_again_is_no_regression() -> None:
    """The row is there only where it fails: that it is gone is told, and fails nothing."""
    lost = row(errors=50.0, verdict=Status.FAIL, quantity="unit quaternion")
    comparison = hold([row(), lost], [row()])
    assert (comparison.regressions, comparison.status) == ((), 0)
    (change,) = comparison.changes
    assert "got none: it is mended" in str(change)


def test_a_row_that_is_named_already_is_not_named_again() -> None:
    """Without the gates a row is lost once, or shows nothing; a row that passes is neither."""
    failed = row(errors=50.0, verdict=Status.FAIL)
    lost = row(verdict=Status.FAIL, max=math.nan)
    empty = row(verdict=Status.VACUOUS)
    for was, now, lost_more, undecided_more in (
        (row(), row(), 0, 0),
        (row(), failed, 0, 0),
        (failed, failed, 0, 0),
        (lost, lost, 1, 0),
        (empty, empty, 0, 1),
    ):
        gated = hold([was], [now])
        alone = decided_alone(gated, [was], [now])
        assert len(alone.regressions) - len(gated.regressions) == lost_more
        assert len(alone.undecided) - len(gated.undecided) == undecided_more


# Errors.


def test_a_run_is_no_regression_from_itself() -> None:
    """Every row is compared, and nothing at all is to be said of it."""
    rows = [row(), row(rung="f80"), row(quantity="T", verdict=Status.FAIL, max=math.nan)]
    comparison = hold(rows, rows)
    assert comparison.compared == len(rows)
    assert (
        comparison.regressions,
        comparison.undecided,
        comparison.changes,
        comparison.status,
    ) == ((), (), (), 0)


SIZES = st.floats(0, 1e6)


@given(SIZES, SIZES)
def test_an_error_regresses_where_it_leaves_its_class_upwards(was: float, now: float) -> None:
    """The limit is ten times the larger of the former error and half of what is attainable; an error
    that regressed is out of the two-sided class of published numbers too."""
    before, after = row(was), row(now)
    limit = FACTOR * max(was, LEVEL)
    if abs(now - limit) > 1e-12 * limit:  # errors are rounded products of these
        assert bool(regressions([before], [after])) == (now > limit)
    if regressions([before], [after]):
        assert compare([before], [after]).departures


@pytest.mark.parametrize("name", ["max", "mean", "final", "ratio"])
@pytest.mark.parametrize("lost", [None, math.nan, math.inf])
def test_an_error_that_is_no_number_any_more_is_a_regression(name: str, lost: Any) -> None:
    """NaN, infinite or nothing in place of a number regresses by its name; the reverse does not."""
    (departures,) = regressions([row()], [row(**{name: lost})])
    assert departures.endswith(f"got no finite number @ euler/generic f64 omega {name}")
    assert regressions([row(**{name: lost})], [row()]) == []


def test_a_baseline_more_than_ten_times_as_good_is_a_regression() -> None:
    """A row that still passes, at 8 attainable, fails against a baseline of an eleventh of it; the
    message has the number, the limit and the reason."""
    departures = regressions([row(8 / 11)], [row(8)])
    assert departures == [
        "expected at most 7.27e-14 (10 x the larger of the baseline's 7.27e-15 and 0.5 attainable, "
        "5e-15: rounding explains no more), got 8e-14 "
        "@ euler/generic f64 omega max (and mean, final, ratio)"
    ]
    assert hold([row(8 / 11)], [row(8)]).status == 1


@pytest.mark.parametrize("was", [0.0, 1e-9, 0.01, 0.5])
def test_below_five_attainable_a_former_error_was_small_by_chance(was: float) -> None:
    """No error of at most 5 attainable regresses, and every larger one does."""
    assert regressions([row(was)], [row(4.99)]) == []
    assert len(regressions([row(was)], [row(5.01)])) == 1


def test_more_steps_excuse_no_error() -> None:
    """A hundred times the steps make ten times as much attainable, and still an error of 40 times the
    former attainable is a regression, though the two-sided class lets it be."""
    costly = {"steps": 10_000, "evaluations": 200_000, "attainable": 10 * ATTAINABLE, "ratio": 4.0}
    new = row(40, **costly, bound=100 * ATTAINABLE)
    assert all(
        departure.what not in ("max", "mean", "final")
        for departure in compare([row()], [new]).departures
    )
    (departures,) = regressions([row()], [new])
    assert departures.endswith("omega max (and mean, final)")


def test_another_time_of_the_maximum_is_allowed_for() -> None:
    """A later maximum is compared with what is attainable at its own time."""
    later = row(40, at=99.0, attainable=10 * ATTAINABLE, bound=100 * ATTAINABLE, ratio=4.0)
    assert regressions([row()], [later]) == []


# Verdicts and rows.

JUDGED = [status for status in Status if status is not Status.UNAVAILABLE]


@pytest.mark.parametrize(("was", "now"), [*product(JUDGED, JUDGED)])
def test_a_verdict_regresses_by_the_grades_of_the_exit_status(was: Status, now: Status) -> None:
    """A change from pass to nothing shown, or from either to fail, is worse; no other is."""
    grades = {0: "pass", 3: "nothing shown", 1: "fail"}
    order = list(grades)
    before, after = row(verdict=was), row(verdict=now)
    worse = order.index(exit_status([after])) > order.index(exit_status([before]))
    departures = regressions([before], [after])
    expected = f"expected {was}, got {now} @ euler/generic f64 omega verdict"
    assert departures == ([expected] if worse else [])


def test_a_row_that_vanished_is_a_regression() -> None:
    """A quantity that is no longer compared is named; a new one is told and fails nothing."""
    both = [row(), row(quantity="T")]
    comparison = hold(both, [row()])
    assert [str(d) for d in comparison.regressions] == [
        "expected this row, got none @ euler/generic f64 T"
    ]
    comparison = hold([row()], both)
    assert (comparison.regressions, comparison.status) == ((), 0)
    assert [str(d) for d in comparison.changes] == [
        "expected a row of the baseline, got a new one @ euler/generic f64 T"
    ]


def test_a_run_that_did_not_finish_regresses_in_every_row() -> None:
    """Its one row is worse, and the others are gone."""
    broken = row(verdict=Status.FAIL, outcome="crashed", unit="", roundoff=None)
    both = [row(), row(quantity="T"), row(quantity="H2")]
    departures = regressions(both, [broken])
    assert [line.rpartition("f64 ")[2] for line in departures] == ["T", "H2", "omega verdict"]


def test_what_shrank_is_told_and_fails_nothing() -> None:
    """A smaller error, a better verdict and another cost are changes."""
    old = row(1000, verdict=Status.FAIL)
    comparison = hold([old], [row(0.1, steps=50, evaluations=1000)])
    assert (comparison.regressions, comparison.undecided, comparison.status) == ((), (), 0)
    assert {d.what for d in comparison.changes} == {
        "verdict",
        "steps",
        "max",
        "mean",
        "final",
        "ratio",
    }


@pytest.mark.parametrize(
    "changed",
    [{"provenance": {"scene": "another"}}, {"unit": "rad"}, {"roundoff": 2.0**-24}],
)
def test_another_question_is_undecided(changed: dict[str, Any]) -> None:
    """Another text of the scene, unit or roundoff: no regression is claimed, and it is not green."""
    comparison = hold([row()], [row(1000, **changed)])
    assert (comparison.regressions, len(comparison.undecided), comparison.status) == ((), 1, 3)


def test_a_rung_that_one_machine_lacks_is_told_and_not_compared() -> None:
    """It fails nothing, as it changes no exit status; but if nothing else is left, nothing is shown."""
    rows = [row(rung="f80"), row(rung="f80", quantity="T")]
    absent = row(rung="f80", verdict=Status.UNAVAILABLE, max=None, ratio=None)
    comparison = hold([*rows, row()], [absent, row()])
    assert (comparison.compared, comparison.regressions, comparison.status) == (1, (), 0)
    assert len(comparison.changes) == 1
    assert hold(rows, [absent]).status == 3


# Files.


def test_both_documents_are_read(tmp_path: Path) -> None:
    """verdicts.json of --out, and the document of --json, give the rows that were written."""
    made = [row(), row(quantity="T"), row(quantity="H2", verdict=Status.FAIL, max=math.nan)]
    write(tmp_path, made, [])
    report = [(v.scene, v.rung, v.quantity, v.max, v.ratio) for v in load_report(tmp_path)]
    stored = load(tmp_path / "data" / "verdicts.json")
    assert [(v.scene, v.rung, v.quantity, v.max, v.ratio) for v in stored] == report
    file = tmp_path / "printed.json"
    document = {"verdicts": [{**v.row(), "of_later_versions": 1} for v in made], "summary": {}}
    file.write_text(json.dumps(document), encoding="utf-8")
    assert hold(load(file), made).regressions == ()
    assert hold(load(file), made).compared == 3


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"max": math.nan}, "expected a JSON document, got a fault"),
        ({"max": -1e-15}, "not negative, got -1e-15 @ verdicts[1].max"),
        ({"max": "5e-15"}, "expected a number or null, got '5e-15' @ verdicts[1].max"),
        ({"ratio": True}, "got True @ verdicts[1].ratio"),
        ({"max": None}, "expected a number of a row that passed, got null @ verdicts[1].max"),
        ({"verdict": "passed"}, "got 'passed' @ verdicts[1].verdict"),
        ({"verdict": ["pass"]}, "got a list @ verdicts[1].verdict"),
        ({"steps": 1.5}, "expected a whole number, got 1.5 @ verdicts[1].steps"),
        ({"scene": None}, "expected a text, got None @ verdicts[1].scene"),
        ({"provenance": {}}, "got none @ verdicts[1].provenance.scene"),
        ({"provenance": None}, "expected an object, got None @ verdicts[1].provenance"),
        ({"quantity": "omega"}, "every row once, got more of euler/generic taylor f64 omega"),
    ],
)
def test_a_row_that_is_none_is_refused_by_its_place(
    tmp_path: Path, changed: dict[str, Any], message: str
) -> None:
    """A baseline that is half understood would let all pass: it is refused whole."""
    rows = [row().row(), {**row(quantity="T").row(), **changed}]
    file = tmp_path / "spoiled.json"
    file.write_text(json.dumps({"verdicts": rows}), encoding="utf-8")
    with pytest.raises(ValueError, match="expected") as refused:
        load(file)
    assert message in str(refused.value)
    assert str(file) in str(refused.value)


@pytest.mark.parametrize("text", ["{", "[]", "1", "{}", '{"verdicts": {}}', '{"verdicts": [1]}'])
def test_a_document_of_something_else_is_refused(tmp_path: Path, text: str) -> None:
    """A document without verdicts is refused as a baseline."""
    file = tmp_path / "other.json"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"other\.json"):
        load(file)


# The command.


@pytest.fixture
def baseline(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A baseline of two scenes, and a run that makes just these rows again."""
    reports.write_remade(tmp_path, monkeypatch, {"errors": 6.0})
    return tmp_path / "data" / "verdicts.json"


def spoil(file: Path, index: int, **changed: Any) -> None:
    stored = json.loads(file.read_text(encoding="utf-8"))
    stored["verdicts"][index] |= changed
    file.write_text(json.dumps(stored), encoding="utf-8")


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"max": 6e-14 / 11}, "got 6e-14 @ euler/full-tensor f64 omega max"),
        ({"quantity": "H_space"}, "expected this row, got none @ euler/full-tensor f64 H_space"),
    ],
)
def test_run_against_a_broken_twin_exits_1_by_name(
    baseline: Path, capsys: Captured, changed: dict[str, Any], message: str
) -> None:
    """Exit 0 against the same rows; 1, and the reason in message and document, against the twin."""
    call = ["run", "euler/generic", "euler/full-tensor", "--baseline", str(baseline), "--json"]
    assert main(call) == 0
    assert json.loads(capsys.readouterr().out)["baseline"]["compared"] == 6
    spoil(baseline, 0, **changed)
    assert main(call) == 1
    out, error = capsys.readouterr()
    assert "regression: expected " in error
    assert message in error
    assert any(message in line for line in json.loads(out)["baseline"]["regressions"])


def test_only_what_was_run_again_is_compared(baseline: Path) -> None:
    """A scene that was not named may have gone; run without names, every scene must be there."""
    spoil(baseline, 0, scene="euler/gone")
    call = ["run", "--rung", "f64", "--baseline", str(baseline)]
    assert main([*call, "euler/generic"]) == 0
    assert main(call) == 1


def test_a_baseline_of_nothing_that_was_run_is_undecided(baseline: Path, capsys: Captured) -> None:
    """Exit 3 where no row was compared, for another solver's rows say nothing of this one."""
    for index in range(6):
        spoil(baseline, index, solver="process:./other")
    assert main(["run", "euler/generic", "--baseline", str(baseline)]) == 3
    departures = capsys.readouterr().err
    assert "nothing of the baseline was run again" in departures
    assert "its solver is `process:./other`, and this run's is `taylor`" in departures


def test_a_baseline_excuses_no_failure(
    baseline: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """A row that failed before and fails again is no regression, and the exit status is 1."""
    failed = row(60.0, verdict=Status.FAIL)
    monkeypatch.setattr(
        "taylor_verify.batch.judging.judge_all",
        lambda *_: [
            SimpleNamespace(verdicts=(failed,), record=None, costs={}, causes=(), notes=())
        ],
    )
    baseline.write_text(json.dumps({"verdicts": [failed.row()]}), encoding="utf-8")
    assert main(["run", "euler/generic", "--baseline", str(baseline), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["baseline"]["regressions"] == []


@pytest.mark.parametrize("spoiled", ["missing", "folder", "no verdicts"])
def test_a_file_that_is_no_baseline_is_a_wrong_call(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured, spoiled: str
) -> None:
    """Exit 2 with a message that names --baseline, before any work."""
    monkeypatch.setattr(
        "taylor_verify.batch.judging.judge_all", lambda *_: pytest.fail("the work was begun")
    )
    file = tmp_path / "baseline.json"
    if spoiled == "folder":
        file.mkdir()
    if spoiled == "no verdicts":
        file.write_text("{}", encoding="utf-8")
    assert main(["run", "euler/generic", "--baseline", str(file)]) == 2
    assert "--baseline" in capsys.readouterr().err
