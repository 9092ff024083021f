"""What is expected of the extremes: the file, how it is read, and what comes of it in `run`."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from typing import Any

import pytest

import taylor_verify
from taylor_verify.batch.chosen_scenes import select
from taylor_verify.batch.expectations import Agreement, compare_with_expectations
from taylor_verify.cli import main
from taylor_verify.records.faults import Refused
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.scenes import library
from taylor_verify.scenes.expected import Expectation, Expectations, left_out, read, shipped
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.trajectory import Outcome

Captured = pytest.CaptureFixture[str]
SCENE = "extremes/euler-a"
SCENES = (SCENE, "extremes/kirchhoff-b")
LONG = "extremes/euler-separatrix-long"


def row(status: Status = Status.PASS, **changed: Any) -> Verdict:
    given = {"scene": SCENE, "solver": "taylor", "rung": "f64", "setting": "", "quantity": "omega"}
    outcome = Outcome.NO_FORMAT.value if status is Status.UNAVAILABLE else ""
    return Verdict(**{**given, "verdict": status, "outcome": outcome, **changed})


def expecting(verdict: str, quantity: str = "omega") -> Expectations:
    return Expectations({(SCENE, "f64", quantity): Expectation(verdict, "so it is")})


# The file


def test_every_row_that_is_listed_can_come() -> None:
    """A listed quantity is one that its scene is judged by: what it tracks, or what it conserves."""
    always = {"euler": {"omega", "T", "H2"}, "kirchhoff": {"impulse", "T", "F2", "FG", "y3"}}
    in_space = {"attitude": {"H_space", "x_space"}, "centre": {"y_space"}}
    assert shipped().rows
    for scene, rung, quantity in shipped().rows:
        asked = load(scene)
        known = always[asked.model].union(asked.track, *(in_space[t] for t in asked.track))
        assert quantity in known, (scene, rung, quantity)


def test_no_extreme_is_left_out_on_double_precision() -> None:
    """`make verify` runs every extreme: what is left out is left out on other rungs."""
    assert shipped().left_out
    assert {rung for _, rung in shipped().left_out} <= set(LADDER) - {"f64"}


def test_every_reason_is_a_sentence() -> None:
    """A reason says more than the verdict does, and ends without a full stop, as it is quoted."""
    reasons = {e.why for e in shipped().rows.values()} | set(shipped().left_out.values())
    assert all(len(why.split()) >= 5 and not why.endswith(".") for why in reasons)


# The reader


ENTRY = '[[expected]]\nscene = "euler-a"\nrung = "f64"\nquantity = "omega"\n'
GOOD = ENTRY + 'verdict = "vacuous"\nwhy = "w"\n'


def test_words_lists_and_wildcards() -> None:
    """A scene, a rung or a quantity is a word or an array; "*" stands for all scenes or rungs."""
    text = GOOD.replace('"f64"', '"*"').replace('"omega"', '["omega", "T"]')
    expectations = read(text.replace('"euler-a"', '"*"'), SCENES)
    assert set(expectations.rows) == {
        (s, r, q) for s in SCENES for r in LADDER for q in ("omega", "T")
    }
    assert expectations.rows[SCENE, "f80", "T"] == Expectation("vacuous", "w")
    assert set(expectations.of_run(SCENE, "f32")) == {"omega", "T"}


FAULTS = {
    "an expected fail": (GOOD.replace('"vacuous"', '"fail"'), "got 'fail' @ expected[0].verdict"),
    "a second entry": (GOOD + GOOD, "a second one @ extremes/euler-a f64 omega"),
    "an unknown scene": (GOOD.replace("euler-a", "euler-c"), "scenes of the extremes, got euler-c"),
    "an unknown rung": (GOOD.replace("f64", "f65"), "'f65'"),
    "an unknown key": (GOOD + "note = 1\n", "unknown field note"),
    "an unknown table": (GOOD.replace("[[expected]]", "[[expect]]"), "unknown field expect"),
    "no reason": (ENTRY + 'verdict = "vacuous"\n', "expected a key why, got none @ expected[0]"),
    "a number": (GOOD.replace('"omega"', "3"), "got 3 @ expected[0].quantity"),
}


@pytest.mark.parametrize(("text", "fragment"), FAULTS.values(), ids=FAULTS)
def test_a_fault_of_the_file_is_refused_with_its_place(text: str, fragment: str) -> None:
    """Nothing is guessed, and nothing is left out."""
    with pytest.raises((ValueError, Refused), match=re.escape(fragment)):
        read(text, SCENES)


# Holding verdicts to it


@pytest.mark.parametrize("wanted", ["vacuous", "refused", "undecided", "unavailable"])
@pytest.mark.parametrize("came", list(Status))
def test_only_what_was_expected_is_met(wanted: str, came: Status) -> None:
    """For every expectation and every verdict: equal is green, anything else fails, a pass too."""
    verdict = row(came)
    comparison = compare_with_expectations([verdict], expecting(wanted))
    agrees = came.value == wanted
    assert (comparison.met(verdict) is not None) is agrees
    assert comparison.exit_status == (0 if agrees else 1)
    assert comparison.row(verdict)["expected"] == {
        "verdict": wanted,
        "why": "so it is",
        "met": agrees,
    }
    assert comparison.row(verdict)["verdict"] == came.value


@pytest.mark.parametrize("came", list(Status))
def test_a_row_that_is_not_listed_must_pass(came: Status) -> None:
    """Without an entry every verdict but `pass` is a mismatch, unless the machine has no such rung."""
    status = compare_with_expectations([row(came)], Expectations()).exit_status
    assert status == (0 if came in (Status.PASS, Status.UNAVAILABLE) else 1)


def test_a_row_that_is_listed_must_come() -> None:
    """An entry for a quantity that the run has no row for is a mismatch that names it."""
    comparison = compare_with_expectations([row()], expecting("vacuous", "attitude"))
    (mismatch,) = comparison.mismatches
    text = "expected vacuous (so it is), got no row @ extremes/euler-a f64 attitude"
    assert str(mismatch) == text
    assert comparison.exit_status == 1


def test_an_entry_waits_for_its_own_rung() -> None:
    """An entry of a rung that was not run says nothing."""
    assert compare_with_expectations([row(rung="f32")], expecting("vacuous")).mismatches == ()


@pytest.mark.parametrize(
    "changed",
    [{"scene": "euler/generic"}, {"solver": "scipy:RK45"}, {"setting": "tol=1e-9"}],
    ids=["another scene", "another solver", "another setting"],
)
@pytest.mark.parametrize("came", list(Status))
def test_nothing_else_is_held_to_it(came: Status, changed: dict[str, str]) -> None:
    """For all other scenes and solvers the exit status is that of the verdicts, and rows are as ever."""
    verdict = row(came, **changed)
    comparison = compare_with_expectations([verdict], expecting("vacuous"))
    assert comparison == Agreement([verdict])
    assert comparison.exit_status == exit_status([verdict])
    assert "expected" not in comparison.row(verdict)


# In the command


@pytest.fixture(scope="module")
def long_separatrix() -> Any:
    """The judgement of a scene whose omega is rightly vacuous on f64."""
    return taylor_verify.run(LONG)


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch, long_separatrix: Any) -> Any:
    """`run` finds that judgement made."""
    monkeypatch.setattr("taylor_verify.batch.judging.judge_all", lambda *_: [long_separatrix])
    return long_separatrix


@pytest.mark.usefixtures("solved")
def test_an_expected_verdict_is_shown_as_such(capsys: Captured) -> None:
    """The row stays vacuous, with its reason; the exit status is 0; the counts say how many."""
    assert main(["run", LONG]) == 0
    text = capsys.readouterr().out
    why = shipped().rows[LONG, "f64", "omega"]
    assert f"omega: as expected: {why.why}" in text
    assert "1 vacuous; 1 of them as expected" in text
    assert main(["run", LONG, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["summary"]["vacuous"] == 1
    assert document["expected"] == {"met": 1, "mismatches": []}
    rows = {v["quantity"]: v["expected"] for v in document["verdicts"]}
    assert rows["omega"] == {"verdict": "vacuous", "why": why.why, "met": True}
    assert rows["T"] == {"verdict": "pass", "why": "", "met": True}


def test_an_unexpected_pass_fails(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured, solved: Any
) -> None:
    """A pass that was expected to be vacuous is a mismatch: exit status 1, and a line says so."""
    start, omega, *others = solved.verdicts
    passed = replace(omega, verdict=Status.PASS)
    marred = replace(solved, verdicts=(start, passed, *others))
    monkeypatch.setattr("taylor_verify.batch.judging.judge_all", lambda *_: [marred])
    assert main(["run", LONG]) == 1
    text = capsys.readouterr().out
    assert "not as expected  expected vacuous" in text
    assert f"got pass @ {LONG} f64 omega" in text
    assert "1 not as expected" in text


@pytest.mark.usefixtures("solved")
def test_what_came_as_expected_leaves_a_junit_file_green(
    tmp_path: Any, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file is green where the exit status is 0; a mismatch is a failure in it."""
    file = tmp_path / "junit.xml"
    assert main(["run", LONG, "--junit", str(file)]) == 0
    assert 'failures="0"' in file.read_text()
    assert "<error" not in file.read_text()
    monkeypatch.setattr("taylor_verify.batch.expectations.shipped", Expectations)
    assert main(["run", LONG, "--junit", str(file)]) == 1
    assert "expected pass, got vacuous" in file.read_text()
    capsys.readouterr()


# Which runs a folder stands for


def test_a_folder_stands_for_its_scenes(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    """`run extremes` is all of them on f64; what is left out elsewhere is told, and run by name.

    The judge of this test judges nothing, and that is no pass.
    """
    asked: list[Any] = []
    monkeypatch.setattr(
        "taylor_verify.batch.judging.judge_all",
        lambda jobs, *_: asked.append([(job.name, job.rungs) for job in jobs]) or [],
    )
    assert main(["run", "extremes"]) == 3
    names = library.named("extremes")
    assert asked.pop() == [(name, ("f64",)) for name in names]
    (scene, rung), why = next(iter(shipped().left_out.items()))
    assert main(["run", "extremes", "--rung", rung]) == 3
    assert scene not in dict(asked.pop())
    assert f"not run: {scene} on {rung}: {why}" in capsys.readouterr().err
    assert main(["run", scene, "--rung", rung]) == 3
    assert asked.pop() == [(scene, (rung,))]
    assert main(["run", "extremes", scene, "--rung", rung]) == 3
    assert dict(asked.pop())[scene] == (rung,)


def test_what_is_left_out_is_not_run() -> None:
    """No job holds a run that is left out, and a scene with no rung left has no job."""
    without = {("euler/rest", "mp237"): "why", ("euler/generic", "f64"): "why"}
    both = select(["euler/rest", "euler/generic"], ["f64", "mp237"])
    made = replace(both, left_out=without).jobs("taylor")
    assert [(job.name, job.rungs) for job in made] == [
        ("euler/rest", ("f64",)),
        ("euler/generic", ("mp237",)),
    ]
    alone = replace(select(["euler/rest"], ["mp237"]), left_out=without)
    assert alone.jobs("taylor") == alone.scenes_run == []


def test_other_folders_leave_nothing_out() -> None:
    """Only the extremes have runs that take hours."""
    assert left_out(["euler", "kirchhoff/screw"], LADDER) == {}
    assert left_out([], LADDER) == {}
