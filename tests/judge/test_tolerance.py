"""A tolerance that is asked for takes the place of every bound, in each way to ask for a judgement."""

from __future__ import annotations

import json
import math
import sys
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.scenes import THREE_INSTANTS, scene_file
from builders.trajectories import exact_columns, write_csv
from builders.turns import by_turns
from builders.verdicts import by_quantity

import taylor_verify
from taylor_verify.batch.expectations import compare_with_expectations
from taylor_verify.cli import main
from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.gates import GATE_FACTOR, judge
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.records.reason import Carried, Cause, Reason, RoundoffFloor
from taylor_verify.records.status import Status
from taylor_verify.testing.plugin import SolverGate

pytestmark = pytest.mark.usefixtures("without_causes")
Captured = pytest.CaptureFixture[str]
COARSE = "scipy:RK45?rtol=1e-6"
SCENE = "euler/with-attitude"
SCENES = (SCENE, "kirchhoff/whole-motion")
GATES = {
    SCENE: ("omega", "attitude", "T", "H2", "H_space"),
    "kirchhoff/whole-motion": ("impulse", "attitude", "centre", "T", "F2", "FG", "y3"),
}


@lru_cache
def coarse_file(scene: str) -> tuple[tuple[str, tuple[float, ...]], ...]:
    """The columns of a coarse answer to a scene."""
    answer = taylor_verify.solve(scene, COARSE)
    columns = {"t": [float(t) for t in taylor_verify.load(scene).clock.instants]}
    for group, rows in answer.quantities.items():
        for i, name in enumerate(COLUMNS[group]):
            columns[name] = [float(row[i]) for row in rows]
    if "y3" in columns:  # which a solver of the reduced equations keeps to the last bit
        columns["y3"][-1] *= 1 + 1e-6
    return tuple((name, tuple(values)) for name, values in columns.items())


@pytest.fixture
def coarse(tmp_path: Path) -> str:
    """A coarse answer to euler/with-attitude, as a file."""
    return write_csv(tmp_path / "mine.csv", dict(coarse_file(SCENE)))


# Every gate, at the border.


@pytest.mark.parametrize("is_file", [False, True])
@pytest.mark.parametrize("scene", by_turns(SCENES, 2))
def test_a_gate_passes_at_its_tolerance_and_fails_just_above(
    scene: str, is_file: bool, tmp_path: Path
) -> None:
    """An error that is the tolerance passes, for every quantity of a solver's answer and of a file."""
    columns = dict(coarse_file(scene))
    states = np.array([columns[name] for name in columns if name != "t"]).T
    file = write_csv(tmp_path / "mine.csv", columns)
    solve_or_file: Any = file if is_file else lambda problem: states
    verdicts = by_quantity(taylor_verify.check(scene, solve_or_file, tolerance=0.5))
    errors = {name: verdicts[name].max for name in GATES[scene]}
    below = {name: math.nextafter(error or 0, 0) for name, error in errors.items()}
    for asked, status in ((errors, Status.PASS), (below, Status.FAIL)):
        judged = by_quantity(taylor_verify.check(scene, solve_or_file, tolerance=asked))
        assert {name: judged[name].verdict for name in errors} == dict.fromkeys(errors, status)
        assert {name: judged[name].max for name in errors} == errors
        for name, tolerance in asked.items():
            assert judged[name].bound == judged[name].tolerance == tolerance


def test_the_start_may_be_off_by_the_tolerance_of_its_state(tmp_path: Path) -> None:
    """A first row that is off by 3e-9 fails a tolerance of 1e-9 and passes one of 1e-8, which says so."""
    columns = {name: list(values) for name, values in exact_columns("euler/generic").items()}
    columns["w1"][0] *= 1 + 3e-9
    file = write_csv(tmp_path / "mine.csv", columns)
    for tolerance, status in ((1e-9, Status.FAIL), (1e-8, Status.PASS)):
        verdicts = by_quantity(taylor_verify.check("euler/generic", file, tolerance=tolerance))
        start = verdicts["initial state"]
        assert (start.verdict, start.bound) == (status, tolerance)
        assert verdicts["omega"].verdict is status
    assert (
        "is the scene's initial state to within the tolerance: its omega is off by" in start.because
    )


def test_the_length_of_a_quaternion_has_the_tolerance_of_the_attitude(tmp_path: Path) -> None:
    """A quaternion of length 1 + 1e-6 fails by its length against 1e-7, and against 1e-5 it passes."""
    columns = {name: list(values) for name, values in exact_columns(SCENE).items()}
    for name in COLUMNS["quaternion"]:
        columns[name] = [value * (1 + 1e-6) for value in columns[name]]
    file = write_csv(tmp_path / "mine.csv", columns)
    (failed,) = [
        v for v in taylor_verify.check(SCENE, file, tolerance=1e-7).verdicts if v.verdict != "pass"
    ]
    assert (failed.quantity, failed.bound) == ("unit quaternion", 1e-7)
    assert taylor_verify.check(SCENE, file, tolerance=1e-5).passed
    assert "unit quaternion" in by_quantity(
        taylor_verify.check(SCENE, file, tolerance={"omega": 1e-5})
    )


def test_the_direction_of_time_with_the_larger_error_decides(tmp_path: Path) -> None:
    """The larger error of a file that goes both ways from the start counts, and not the larger ratio."""
    scene = taylor_verify.load("euler/generic")
    text = "t,w1,w2,w3\n"
    motion = taylor_verify.exact(scene, ["-1", "0", "1", "50", "100"], 30)["omega"]
    for t, omega, spoil in zip((-1, 0, 1, 50, 100), motion, (2e-9, 0, 0, 0, 9e-9), strict=True):
        text += ",".join(map(repr, (t, *(float(w) * (1 + spoil) for w in omega)))) + "\n"
    (tmp_path / "mine.csv").write_text(text)
    verdicts = by_quantity(
        taylor_verify.check(scene, tmp_path / "mine.csv", partial=True, tolerance=5e-9)
    )
    assert (verdicts["omega"].verdict, verdicts["omega"].at) == (Status.FAIL, 100.0)


# Rules of the gate.

FLOOR = Reason(floor=RoundoffFloor(Carried.ORBIT, 1e-15, 53, 100, 1.0))


def gate(
    errors: Any, width: float = 0.0, attainable: float = 1e-15, tolerance: float = 1e-8
) -> Any:
    return judge(*plain(errors, width, attainable), tolerance)


def test_a_truth_wider_than_a_sixteenth_of_the_tolerance_is_undecided() -> None:
    """The row is undecided, whether the error is within the tolerance or not."""
    assert gate([0.0], width=1e-8 / 16).status is Status.PASS
    for error in (0.0, 1.0):
        assert gate([error], width=1.01e-8 / 16).status is Status.UNDECIDED
    # A truth too wide for the bound of the arithmetic may do for the tolerance.
    assert judge(*plain([0.0], width=1e-10)).status is Status.UNDECIDED
    assert gate([0.0], width=1e-10).status is Status.PASS


def plain(errors: Any, width: float, attainable: float = 1e-15) -> Any:
    values, widths = np.array(errors, dtype=float), np.full(len(errors), width)
    column = Errors("omega", "max|omega|", values, widths, {}, is_state=True)
    return column, np.full(len(errors), attainable), FLOOR


@pytest.mark.parametrize(("error", "status"), [(1e-9, Status.PASS), (1e-7, Status.FAIL)])
def test_a_tolerance_decides_where_rounding_alone_reaches_the_motion(
    error: float, status: Status
) -> None:
    """No gate with a tolerance is vacuous; of a failure the roundings are named as the likely reason."""
    finding = gate([0.0, error], attainable=0.5)
    assert finding.status is status
    causes = {remark.cause for remark in finding.reason.remarks}
    assert causes == ({Cause.FINE_TOLERANCE} if status is Status.FAIL else set())


def test_the_reason_has_both_bounds() -> None:
    """The tolerance, and what arithmetic alone would have allowed; as values and as a sentence."""
    finding = gate([3e-9], attainable=2.6e-14)
    asked = finding.reason.tolerance
    assert (asked.asked, asked.allowed) == (1e-8, pytest.approx(GATE_FACTOR * 2.6e-14))
    assert str(finding.reason).startswith(
        "a tolerance of 1e-8 was asked for; arithmetic alone would have allowed 2.6e-13 = "
        "10 x attainable; attainable = u sqrt(N) x growth"
    )
    assert finding.bound == finding.tolerance == 1e-8
    assert finding.ratio == pytest.approx(3e-9 / 2.6e-14)


def test_an_error_within_a_tolerance_keeps_its_shift_of_time() -> None:
    """A row that passes by the tolerance alone still says what kind of error it has."""
    row = by_quantity(taylor_verify.run("euler/generic", COARSE, tolerance=1e-2))["omega"]
    assert row.verdict is Status.PASS
    assert row.reason.shift is not None
    sound = by_quantity(taylor_verify.run("euler/generic", "taylor", tolerance=1e-2))["omega"]
    assert sound.reason.shift is None


# What is refused.


@pytest.mark.parametrize(
    "number", ["nan", "0", "-1", "1e999", "text", "1", "2.5", "1e-400", "inf", ""]
)
def test_what_is_no_tolerance_is_refused_in_one_sentence(
    number: str, coarse: str, capsys: Captured
) -> None:
    """Exit status 2 before anything runs, for check and run alike; the text given is repeated."""
    for call in (["check", coarse, "--scene", SCENE], ["run", SCENE, "--solver", COARSE]):
        for text in (number, f"omega={number}"):
            assert main([*call, f"--tolerance={text}"]) == 2
            (line,) = capsys.readouterr().err.splitlines()
            assert "expected a positive number below 1 (the error of the answer zero), got " in line
            assert "@ --tolerance" in line


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("omga=1e-8", "expected some of omega, attitude, T, H2, H_space, got omga @ --tolerance"),
        ("omga=1e-8,T=7", "got omga @ --tolerance\nexpected a positive number below 1 "),
        ("T=1e-8,T=1e-9", "expected NAME=E,NAME=E with each name once, got T twice @ --tolerance"),
        ("T=1e-8,1e-9", "expected NAME=E,NAME=E with each name once, got '1e-9' @ --tolerance"),
    ],
)
def test_a_name_that_is_no_quantity_is_refused_with_those_there_are(
    text: str, words: str, coarse: str, capsys: Captured
) -> None:
    """All faults at once."""
    assert main(["check", coarse, "--scene", SCENE, "--tolerance", text]) == 2
    assert words in capsys.readouterr().err


# All ways agree.

PROGRAM = """
import json, sys
question = json.load(sys.stdin)
rows = [line.split(",") for line in open({file!r}).read().split()]
columns = dict(zip(rows[0], zip(*rows[1:])))
print(json.dumps({{name: list(map(float, values)) for name, values in columns.items()}}))
"""


@pytest.mark.parametrize("factor", by_turns([0.999, 1.001], 2))
def test_four_ways_agree(factor: float, tmp_path: Path, capsys: Captured) -> None:
    """check and run, of the command line and of Python, and the fixture of pytest, on one answer."""
    scene = str(
        scene_file(tmp_path, THREE_INSTANTS.replace("[body]", 'track = ["attitude"]\n[body]'))
    )
    columns = dict(coarse_file(scene))
    coarse = write_csv(tmp_path / "mine.csv", columns)
    states = np.array([columns[c] for c in (*COLUMNS["omega"], *COLUMNS["quaternion"])]).T
    verdicts = taylor_verify.check(scene, coarse).verdicts
    error, worst = max((v.max, v.quantity) for v in verdicts if v.max is not None)
    number = factor * error
    script = tmp_path / "mine.py"
    script.write_text(PROGRAM.format(file=coarse))
    program = f"process:{sys.executable} {script}"
    results = [
        taylor_verify.check(scene, coarse, tolerance=number).verdicts,
        taylor_verify.check(scene, lambda problem: states, tolerance=number).verdicts,
        taylor_verify.run(scene, program, tolerance=number).verdicts,
        taylor_verify.run_many([scene], program, tolerance=number).verdicts,
    ]
    words = {
        tuple((v.quantity, v.verdict.value, v.bound) for v in verdicts) for verdicts in results
    }
    for call in (["check", coarse, "--scene", scene], ["run", scene, "--solver", program]):
        status = main([*call, "--tolerance", repr(number), "--json"])
        document = json.loads(capsys.readouterr().out)["verdicts"]
        words.add(tuple((v["quantity"], v["verdict"], v["tolerance"]) for v in document))
        assert status == (factor < 1)
    (word,) = words
    assert {verdict for name, verdict, _ in word if name == worst} == {
        "fail" if factor < 1 else "pass"
    }
    if factor < 1:
        with pytest.raises(pytest.fail.Exception, match=rf"fail  .* {worst}: "):
            SolverGate()(scene, lambda problem: states, tolerance=number)
    else:
        judged = SolverGate()(scene, lambda problem: states, tolerance=number)
        assert tuple((v.quantity, v.verdict.value, v.bound) for v in judged.verdicts) == word


def test_a_file_that_lacks_a_part_is_no_pass_by_any_tolerance(tmp_path: Path) -> None:
    """The row `complete` is undecided with a tolerance too."""
    columns = {name: values[:5] for name, values in dict(coarse_file(SCENE)).items()}
    judged = taylor_verify.check(SCENE, write_csv(tmp_path / "a.csv", columns), tolerance=0.5)
    assert by_quantity(judged)["complete"].verdict is Status.UNDECIDED
    assert not judged.passed


# Many runs.


def test_the_expected_verdicts_are_those_of_the_ordinary_bounds() -> None:
    """A row that a tolerance has judged is compared with nothing, and counts as it stands."""
    (row, *_) = taylor_verify.run("euler/rest").verdicts
    row = replace(row, scene="extremes/euler-separatrix-long", solver="taylor", setting="")
    vacuous = replace(row, quantity="omega", verdict=Status.VACUOUS)
    failed = replace(vacuous, verdict=Status.FAIL, tolerance=1e-8)
    expected = compare_with_expectations([vacuous])
    assert expected.exit_status == 0
    agreement = compare_with_expectations([failed])
    assert agreement.mismatches == ()
    assert agreement.exit_status == 1


@pytest.mark.parametrize(
    ("scene", "states"),
    [
        ("kirchhoff/falling-away", {"omega", "impulse", "attitude", "centre"}),
        pytest.param(
            "manufactured/kirchhoff-path",
            {"impulse", "attitude", "centre"},
            marks=pytest.mark.slow,
        ),
    ],
)
def test_states_that_are_compared_apart_take_a_tolerance(
    scene: str, states: set[str], tmp_path: Path
) -> None:
    """Omega of a solid in a fluid, and the attitude and centre of a loaded body."""
    columns = {name: list(values) for name, values in exact_columns(scene).items()}
    for name, values in columns.items():
        if name != "t":
            columns[name] = [*values[:-1], values[-1] + 1e-6]
    file = write_csv(tmp_path / "mine.csv", columns)
    for tolerance, status in ((1e-3, Status.PASS), (1e-9, Status.FAIL)):
        verdicts = by_quantity(taylor_verify.check(scene, file, tolerance=tolerance))
        assert states <= set(verdicts)
        assert {verdicts[name].verdict for name in states} == {status}
        assert {row.bound for row in verdicts.values()} == {tolerance}
