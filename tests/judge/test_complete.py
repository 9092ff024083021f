"""Rows beside those of quantities: the start, and what a file does not answer, is never a pass."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from builders.trajectories import columns_at, write_csv
from builders.turns import by_turns
from builders.verdicts import by_quantity

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.models.problem import Problem
from taylor_verify.records.quantities import COMPLETE, GATE_FACTOR, INITIAL
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.taylor.driver import Taylor

SCENE = "euler/with-attitude"
OMEGA = ("t", "w1", "w2", "w3")
pytestmark = pytest.mark.usefixtures("without_causes")
Captured = pytest.CaptureFixture[str]


def file_of(path: Path, rows: Sequence[int], names: Sequence[str] = (), scene: str = SCENE) -> str:
    """A file with these of the scene's own samples, and these of its columns."""
    instants = load(scene).clock.instants
    columns = columns_at(load(scene), [instants[k] for k in rows])
    written = {name: values for name, values in columns.items() if not names or name in names}
    return str(write_csv(path / "mine.csv", written))


def complete(file: str, scene: str = SCENE, partial: bool = False) -> Verdict | None:
    judgement = taylor_verify.check(scene, file, partial=partial)
    rows = by_quantity(judgement)
    assert {v.verdict for name, v in rows.items() if name != COMPLETE} == {Status.PASS}
    return rows.get(COMPLETE)


LACKING = [
    ([0], (), "one row within it is no trajectory"),
    (range(5), (), "the last 18 of the scene's span of 20"),
    (range(20, 41), (), "the first 10 of the scene's span of 20"),
    ([20, 40], (), "the first 10 of the scene's span of 20"),
    (range(41), OMEGA, "the attitude"),
    (range(41), ("t", "q0", "q1", "q2", "q3"), "the angular velocity"),
    (range(5), OMEGA, "the attitude, the last 18"),
    # The last row is left out, as numpy.arange does.
    (range(40), (), "the last 0.5 of the scene's span of 20"),
]


@pytest.mark.parametrize(("rows", "names", "lack"), by_turns(LACKING, 2))
def test_what_a_file_lacks_is_undecided(
    rows: Sequence[int], names: Sequence[str], lack: str, tmp_path: Path
) -> None:
    """A single row says all that was not judged, and names both ways out; --partial makes it vacuous."""
    file = file_of(tmp_path, rows, names)
    verdict, part = complete(file), complete(file, partial=True)
    assert part.verdict is Status.VACUOUS
    assert lack in part.because
    assert verdict.verdict is Status.UNDECIDED
    assert verdict.because.startswith("not judged: ")
    assert lack in verdict.because
    assert "--partial" in verdict.because
    assert f"`taylor-verify question {SCENE} --csv`" in verdict.because


@pytest.mark.parametrize(
    "rows",
    by_turns(
        [range(41), [0, 40], [0, 3, 40], range(1, 41), [40, 17, 0], range(5, 41, 5)],
        2,
    ),
)
def test_sample_times_are_the_files_own_affair(rows: Sequence[int], tmp_path: Path) -> None:
    """A file that reaches the end from within one of its own intervals of the start is complete."""
    assert complete(file_of(tmp_path, sorted(rows))) is None


def test_a_motion_backwards_has_an_end_too(tmp_path: Path) -> None:
    """The span of a scene that ends before it starts is counted in its own direction."""
    last = len(load("euler/backward").clock.instants) - 1
    assert complete(file_of(tmp_path, [0, last], scene="euler/backward"), "euler/backward") is None
    verdict = complete(file_of(tmp_path, [0, last // 2], scene="euler/backward"), "euler/backward")
    assert "the last " in verdict.because


def summed(step: float, end: float) -> float:
    """A clock that adds up its step until it is as near to the end as it comes."""
    t = 0.0
    while t < end - step / 2:
        t += step
    return t


@pytest.mark.parametrize("end", by_turns([summed(1e-3, 20.0), summed(1e-4, 20.0), 19.99999999999]))
def test_a_summed_clock_is_at_the_end(end: float, tmp_path: Path) -> None:
    """A last row that misses the end by roundings of the clock leaves nothing unjudged."""
    assert end != 20.0
    scene = load(SCENE)
    columns = columns_at(scene, [*scene.clock.instants[:-1], Fraction(end)])
    judgement = taylor_verify.check(SCENE, write_csv(tmp_path / "mine.csv", columns))
    assert {verdict.verdict for verdict in judgement.verdicts} == {Status.PASS}
    assert not any("not judged" in note for note in judgement.notes)


def test_nothing_of_it_is_green(tmp_path: Path, capsys: Captured) -> None:
    """Text, JUnit and annotations say what was not judged; asked for a part, none of them is red."""
    file, report = file_of(tmp_path, range(5), OMEGA), tmp_path / "junit.xml"
    call = ["check", file, "--scene", SCENE, "--junit", str(report), "--github"]
    assert main(call) == 3
    output = capsys.readouterr()
    assert re.search(r"complete +undecided", output.out)
    assert "complete: not judged: " in output.out
    assert "not judged" in output.out
    assert "::warning title=euler/with-attitude on f64%3A complete undecided::" in output.err
    suites = ElementTree.parse(report).getroot()
    assert (suites.get("errors"), suites.get("failures")) == ("1", "0")
    assert main([*call, "--partial"]) == 0
    output = capsys.readouterr()
    assert "not judged" in output.out
    assert "::notice title=euler/with-attitude on f64%3A complete vacuous::" in output.err
    suites = ElementTree.parse(report).getroot()
    assert (suites.get("errors"), suites.get("failures")) == ("0", "0")


def test_a_call_that_comes_to_nothing_leaves_no_verdicts_of_an_earlier_one(
    tmp_path: Path, capsys: Captured
) -> None:
    """A step of a CI that publishes the report in any case would show them as its own."""
    file, report = file_of(tmp_path, range(41), OMEGA), tmp_path / "junit.xml"
    assert main(["check", file, "--scene", SCENE, "--partial", "--junit", str(report)]) == 0
    assert report.exists()
    assert main(["check", file, "--scene", "euler/no-such", "--junit", str(report)]) == 2
    assert not report.exists()
    assert "no-such" in capsys.readouterr().err


def test_a_baseline_of_a_part_is_no_regression_of_the_whole(
    tmp_path: Path, capsys: Captured
) -> None:
    """The completeness of a file is judged by each call alone, and not compared with a baseline."""
    file = file_of(tmp_path, range(41), OMEGA)
    assert main(["check", file, "--scene", SCENE, "--json", "--partial"]) == 0
    before = tmp_path / "before.json"
    before.write_text(capsys.readouterr().out)
    call = ["check", file, "--scene", SCENE, "--json", "--baseline", str(before)]
    assert main([*call, "--partial"]) == 0
    assert main(call) == 3
    assert json.loads(before.read_text())["verdicts"][-1]["quantity"] == COMPLETE


# The file to fill in.


@pytest.mark.parametrize("on", ["f32", "f64", "f128", "mp237"])
def test_question_is_what_a_program_gets(on: str, capsys: Captured) -> None:
    """The question is the document of the protocol on that precision, with and without --json."""
    assert main(["question", "kirchhoff/screw", "--rung", on]) == 0
    text = json.loads(capsys.readouterr().out)
    assert main(["question", "kirchhoff/screw", "--rung", on, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == text
    assert (text["rung"], text["scene"]) == (on, "kirchhoff/screw")
    assert {"columns", "body", "initial", "time"} <= set(text)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (["question", SCENE, "--csv", "--json"], "expected one of --csv and --json, got both"),
        (["question", "nobody"], "got nobody"),
        (["question", SCENE, "--rung", "f65"], "@ --rung"),
    ],
)
def test_a_wrong_question_is_refused(call: list[str], message: str, capsys: Captured) -> None:
    """A wrong question ends with a single message on stderr, in --json on stdout too, and status 2."""
    assert main(call) == 2
    shown = capsys.readouterr()
    assert message in shown.err
    assert (message in shown.out) == ("--json" in call)
    assert shown.out.strip()[:1] in ("", "{")


# The row of the start

SCENES = ["euler/generic", "euler/later-start", "euler/full-tensor", "kirchhoff/whole-motion"]
Rows = np.ndarray[Any, Any]


def answered(change: Callable[[Rows], Rows]) -> Callable[[Problem], Any]:
    """A sound solver of free bodies whose rows are changed."""

    def solve(problem: Problem) -> Any:
        trajectory = Taylor().solve(problem)
        return change(trajectory.quantities["omega"].astype(float))

    return solve


def first_moved(rows: Rows) -> Rows:
    """The first row is wrong by a millionth, and no other."""
    moved = rows.copy()
    moved[0] *= 1 + 1e-6
    return moved


def last_moved(rows: Rows) -> Rows:
    moved = rows.copy()
    moved[-1] *= 1 + 1e-6
    return moved


@pytest.mark.parametrize(("scene", "on"), by_turns(product(SCENES, ["f32", "f64", "mp237"]), 5))
def test_a_sound_run_starts_where_it_was_told(scene: str, on: str) -> None:
    """The first row of every run is that of the start, and passes."""
    first, *others = run(scene, "taylor", on).verdicts
    assert (first.quantity, first.verdict) == (INITIAL, Status.PASS)
    assert first.at == float(load(scene).clock.start)
    assert first.bound == GATE_FACTOR * first.attainable
    assert "is the scene's initial state" in first.because
    assert "one rounding of each component of the start on the rung" in first.because
    assert all(verdict.quantity != INITIAL for verdict in others)


def test_a_wrong_start_is_said_first() -> None:
    """The row fails with the size of the error, and so does the state at that sample."""
    first, omega, *_ = taylor_verify.check("euler/generic", answered(first_moved)).verdicts
    assert (first.quantity, first.verdict) == (INITIAL, Status.FAIL)
    assert first.max == pytest.approx(1e-6, rel=0.05)
    assert "is not the scene's initial state: its omega is off by 9.79e-07" in first.because
    assert (omega.verdict, omega.at) == (Status.FAIL, 0.0)


def test_a_wrong_end_is_no_wrong_start() -> None:
    """Rows that are wrong later only fail later."""
    first, omega, *_ = taylor_verify.check("euler/generic", answered(last_moved)).verdicts
    assert (first.verdict, omega.verdict) == (Status.PASS, Status.FAIL)


def test_a_start_of_nan_fails() -> None:
    """No comparison with a number that is none is a pass."""

    def spoil(rows: Rows) -> Rows:
        return np.where(np.arange(len(rows))[:, None] == 0, np.nan, rows)

    first, *_ = taylor_verify.check("euler/generic", answered(spoil)).verdicts
    assert (first.quantity, first.verdict) == (INITIAL, Status.FAIL)


def test_a_run_that_is_not_asked_at_its_start_has_no_such_row() -> None:
    """Without a sample at the start there is nothing to compare there."""
    scene = load("euler/generic")
    late = replace(scene, clock=Clock(scene.clock.start, scene.clock.instants[1:]))
    assert INITIAL not in {verdict.quantity for verdict in run(late).verdicts}


def test_a_callback_of_the_exact_start_passes_with_no_error() -> None:
    """The rung's own numbers of the start leave no more than their rounding."""

    def still(problem: Problem) -> Any:
        return [[float(w) for w in problem.given.initial.omega]] * len(problem.times)

    first, omega, *_ = run("euler/generic", Callback(still)).verdicts
    assert first.max is not None
    assert first.attainable is not None
    assert first.max <= first.attainable
    assert (first.verdict, omega.verdict) == (Status.PASS, Status.FAIL)
