"""`check`: anybody's trajectory, read exactly, judged in the scene's own terms, or refused in words."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.scenes import scene_text
from builders.trajectories import (
    MATRIX,
    VECTORS,
    Columns,
    columns_at,
    exact_columns,
    file_judgement,
    write_csv,
)
from builders.verdicts import by_quantity
from mpmath import mp

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.exact.route import solution
from taylor_verify.judge.files.judgement import FileJudgement
from taylor_verify.models.problem import adopt, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.records.faults import Refused
from taylor_verify.records.quantities import COLUMNS, COMPLETE, INITIAL
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.values import exact

pytestmark = pytest.mark.usefixtures("without_causes")
F64 = rung("f64")
SCENE = "euler/with-attitude"
OMEGA = VECTORS["omega"]


def checked(path: Path, scene: str, columns: Mapping[str, Sequence[Any]]) -> FileJudgement:
    return file_judgement(write_csv(path / "mine.csv", columns), scene)


def all_pass(judgement: FileJudgement) -> bool:
    """Return True if all that was compared passes; whether the file is complete is another row."""
    return {v.verdict for v in judgement.verdicts if v.quantity != COMPLETE} == {Status.PASS}


def without(columns: Mapping[str, Sequence[float]], *names: str) -> Columns:
    return {name: list(values) for name, values in columns.items() if name not in names}


# Sound files.


@pytest.mark.parametrize(
    ("scene", "quantities"),
    [
        ("euler/with-attitude", {"omega", "attitude", "T", "H2", "H_space"}),
        ("euler/backward", {"omega", "T", "H2"}),
        ("euler/later-start", {"omega", "T", "H2"}),
        ("euler/constant-moment", {"omega", "T", "H2"}),
        (
            "kirchhoff/whole-motion",
            {"impulse", "attitude", "centre", "T", "F2", "FG", "y3", "x_space", "y_space", "omega"},
        ),
    ],
)
def test_exact_motion_rounded_to_float64_passes(
    scene: str, quantities: set[str], tmp_path: Path
) -> None:
    """Every quantity that the columns determine has its row, and every row passes."""
    judgement = checked(tmp_path, scene, exact_columns(scene))
    assert all_pass(judgement)
    assert set(by_quantity(judgement)) - {INITIAL} == quantities
    assert judgement.conventions == ()


def test_matrices_are_judged_as_they_are(tmp_path: Path) -> None:
    """A matrix scaled by 1 + 1e-9 is off by that much: it is not made a rotation before."""
    sound = exact_columns(SCENE, matrix=True)
    assert all_pass(checked(tmp_path, SCENE, sound))
    scaled = {n: [v * (1 + 1e-9 * (n in MATRIX)) for v in vs] for n, vs in sound.items()}
    attitude = by_quantity(checked(tmp_path, SCENE, scaled))["attitude"]
    assert attitude.verdict is Status.FAIL
    # |R (1 + e) - R| = e sqrt 3, and an angle is |difference| / sqrt 2.
    assert attitude.max == pytest.approx(1e-9 * math.sqrt(3 / 2), rel=1e-3)


def test_times_are_the_files_own(tmp_path: Path) -> None:
    """Rows between the scene's samples, beyond its end and before its start are judged."""
    scene = load(SCENE)
    times = [Fraction(k, 7) * 3 for k in range(-20, 200, 21)]
    judgement = checked(tmp_path, SCENE, columns_at(scene, times))
    assert max(times) > scene.clock.instants[-1]
    assert all_pass(judgement)
    spoiled = columns_at(scene, times)
    spoiled["w1"][0] += 1e-6
    omega = by_quantity(checked(tmp_path, SCENE, spoiled))["omega"]
    assert (omega.verdict, omega.at) == (Status.FAIL, float(times[0]))


def test_rows_may_run_backwards(tmp_path: Path) -> None:
    """A file whose times decrease is the same file, and that they do is said."""
    turned = {name: list(values)[::-1] for name, values in exact_columns(SCENE).items()}
    judgement = checked(tmp_path, SCENE, turned)
    assert all_pass(judgement)
    assert any(note.startswith("the rows are reversed: ") for note in judgement.notes)


def test_only_omega_of_a_solid_in_a_fluid(tmp_path: Path) -> None:
    """w1 w2 w3 alone are compared with Omega = B^T x + C y, and an error of them is seen."""
    scene = "kirchhoff/screw"
    sound = exact_columns(scene)
    columns = {name: list(sound[name]) for name in ("t", *OMEGA)}
    assert set(by_quantity(checked(tmp_path, scene, columns))) == {INITIAL, "omega", COMPLETE}
    columns["w2"][3] *= 1 + 1e-10
    omega = by_quantity(checked(tmp_path, scene, columns))["omega"]
    assert (omega.verdict, omega.at) == (Status.FAIL, columns["t"][3])


def test_the_floor_of_a_velocity_has_that_of_the_states(tmp_path: Path) -> None:
    """Omega = B^T x + C y carries the roundings of x and y on the way, not its own alone."""
    columns = exact_columns("kirchhoff/screw")
    both = by_quantity(checked(tmp_path, "kirchhoff/screw", columns))["impulse"]
    alone = {name: columns[name] for name in ("t", *OMEGA)}
    omega = by_quantity(checked(tmp_path, "kirchhoff/screw", alone))["omega"]
    assert omega.attainable > both.attainable > 4 * 2**-53


def test_columns_that_the_scene_does_not_track_are_not_compared(tmp_path: Path) -> None:
    """Quaternions beside a scene of omega alone are left out, and that is said."""
    columns = {**exact_columns("euler/generic")}
    rest = {name: [0.5] * len(columns["t"]) for name in COLUMNS["quaternion"]}
    judgement = checked(tmp_path, "euler/generic", {**columns, **rest})
    assert all_pass(judgement)
    assert any("does not track the attitude" in note for note in judgement.notes)


def test_matrices_of_a_loaded_body(tmp_path: Path) -> None:
    """States are compared under a moment, and the balances that need no matrix."""
    scene = replace(load("euler/constant-moment"), track=frozenset({"attitude"}))
    columns = columns_at(scene, scene.clock.instants[::2], matrix=True)
    judgement = taylor_verify.check(scene, write_csv(tmp_path / "mine.csv", columns))
    assert {v.quantity for v in judgement.verdicts} == {INITIAL, "omega", "attitude", "T", "H2"}
    assert {v.verdict for v in judgement.verdicts} == {Status.PASS}


# What is wrong in a file that can be read.


def test_initial_state_that_is_not_the_scenes_is_said_first(tmp_path: Path) -> None:
    """The first row is its own, fails and says by how much."""
    scene = load(SCENE)
    w1, w2, w3 = scene.initial.omega
    other = replace(scene, initial=replace(scene.initial, omega=(w1 + Fraction(1, 10**6), w2, w3)))
    first, *others = checked(tmp_path, SCENE, columns_at(other, scene.clock.instants[::4])).verdicts
    assert (first.quantity, first.verdict, first.at) == (INITIAL, Status.FAIL, 0.0)
    assert "is not the scene's initial state" in first.because
    assert any(verdict.verdict is Status.FAIL for verdict in others)


def test_one_unit_in_the_last_place_of_the_start_passes(tmp_path: Path) -> None:
    """Whoever rounded the input once otherwise has an answer as good: its response is attainable."""
    scene = load(SCENE)
    ulp = 1 + Fraction(1, 2**53)
    I = scene.body.inertia
    body = RigidBody(tensors.diagonal((I[0][0] * ulp, I[1][1], I[2][2] / ulp)))
    initial = replace(scene.initial, omega=tensors.scaled(ulp, scene.initial.omega))
    other = replace(scene, body=body, initial=initial)
    # Its exact motion, so that no rounding but that of the input is left.
    motion = solution(other).evaluate([Fraction(60)], 40)["omega"][0]
    truth = solution(adopt(scene, F64, (Fraction(60),)).given).evaluate([Fraction(60)], 40)["omega"]
    error = float(mp.norm(list(motion - truth[0])))
    columns = {"t": [60.0], **{n: [mp.nstr(v, 30)] for n, v in zip(OMEGA, motion, strict=True)}}
    judgement = file_judgement(write_csv(tmp_path / "mine.csv", columns, str), SCENE)
    assert error > 1e-15
    assert by_quantity(judgement)["omega"].verdict is Status.PASS
    assert "moved by u" in by_quantity(judgement)["omega"].because


@pytest.mark.parametrize("value", ["nan", "inf", "-Infinity"])
def test_what_is_not_finite_fails_its_own_rows(value: str, tmp_path: Path) -> None:
    """The row says where the first such value stands; what does not rest on it still passes."""
    sound = exact_columns(SCENE)
    spoiled = {name: [repr(v) for v in values] for name, values in sound.items()}
    spoiled["q2"][3] = spoiled["q2"][9] = value
    verdicts = by_quantity(file_judgement(write_csv(tmp_path / "mine.csv", spoiled, str), SCENE))
    for quantity in ("attitude", "H_space"):
        assert verdicts[quantity].verdict is Status.FAIL
    assert verdicts["attitude"].at == sound["t"][3]
    assert f"q2 is {float(value)} in row 4" in verdicts["attitude"].because
    assert all(verdicts[q].verdict is Status.PASS for q in ("omega", "T", "H2"))
    assert json.dumps(verdicts["attitude"].row(), allow_nan=False)


def test_numbers_cut_off_in_printing_are_told(tmp_path: Path) -> None:
    """Six digits are no float64, and the note says so."""
    file = write_csv(tmp_path / "mine.csv", exact_columns(SCENE), lambda v: f"{v:.5e}")
    judgement = file_judgement(file, SCENE)
    assert by_quantity(judgement)["omega"].verdict is Status.FAIL
    assert any("6 significant digits, where f64 has 17" in note for note in judgement.notes)
    sound = file_judgement(write_csv(tmp_path / "mine.csv", exact_columns(SCENE)), SCENE)
    assert not any("digits" in note for note in sound.notes)


def test_a_file_that_stops_early_is_told(tmp_path: Path) -> None:
    """The rows there are judged, and the note says where the rest begins, also of a motion backwards."""
    for scene in (SCENE, "euler/backward"):
        whole = exact_columns(scene)
        half = {name: values[: len(values) // 2] for name, values in whole.items()}
        judgement = checked(tmp_path, scene, half)
        assert all_pass(judgement)
        expected = f"the last row is at t = {half['t'][-1]:g}, and the scene ends at t = "
        assert any(expected in note for note in judgement.notes)
        assert not any("last row" in note for note in checked(tmp_path, scene, whole).notes)


# The problem that others solve.


def test_others_round_the_inertia_and_we_its_inverse() -> None:
    """adopt stores I and omega0 on the rung, exactly inverted; pose stores I^-1."""
    scene = load("euler/full-tensor")
    given, posed = adopt(scene, F64, scene.clock.instants).given, pose(scene, F64).given
    for body, entries in ((given.body, "inertia"), (posed.body, "inverse_inertia")):
        assert all(F64.holds(v) for row in getattr(body, entries) for v in row)
    assert all(F64.holds(v) for v in given.initial.omega)
    assert given.clock.instants == scene.clock.instants


# Numbers.


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.1", Fraction(1, 10)),
        ("1/3", Fraction(1, 3)),
        ("0x1.8p-3", Fraction(3, 16)),
        ("-0X.8P+4", Fraction(-8)),
        ("0x1p-16000", Fraction(1, 2**16000)),
        ("0x10", Fraction(16)),
        ("1e-400", Fraction(1, 10**400)),
        ("123456789012345678901234567890.5", Fraction(246913578024691357802469135781, 2)),
    ],
)
def test_text_becomes_exact(text: str, value: Fraction) -> None:
    """Decimals, fractions and hexadecimal floats of any length lose nothing."""
    assert exact(text) == value
    assert exact(np.longdouble(1) / 3) == Fraction(*(np.longdouble(1) / 3).as_integer_ratio())


# Formats.


@pytest.mark.parametrize("document", ["{}", '{"title": "mine", "columns": {}}'])
def test_json_numbers_are_read_as_text(document: str, tmp_path: Path) -> None:
    """0.1 in JSON is a tenth, and no double; columns are the document, or below its key `columns`."""
    columns = '{"t": [0.1, 1], "w1": [0.1, "0x1.8p-3"], "w2": [0, 0], "w3": [1e-30, 1]}'
    file = tmp_path / "mine.json"
    file.write_text(document.replace("{}", columns))
    trajectory = read(file)
    assert trajectory.times == (Fraction(1, 10), Fraction(1))
    assert trajectory.groups["omega"] == (
        (Fraction(1, 10), Fraction(0), Fraction(1, 10**30)),
        (Fraction(3, 16), Fraction(0), Fraction(1)),
    )


# Faults.


@pytest.mark.parametrize(
    ("names", "ignored"),
    [
        ("x1", "`x1`"),
        ("u1 c2 y3", "`u1` `c2` `y3`"),
        ("x1[kg] x2[kg] x3[kg]", "`x1[kg]` `x2[kg]` `x3[kg]`"),
        ("px py pz x y z", "`px` `py` `pz` `x` `y` `z`"),
    ],
)
def test_what_means_nothing_in_a_scene_is_ignored_and_named(
    names: str, ignored: str, tmp_path: Path
) -> None:
    """A part of an impulse, or one that is not clear, is no fault in a file of a rigid body."""
    file = tmp_path / "mine.csv"
    others = names.split()
    numbers = ",".join(map(str, range(4 + len(others))))
    file.write_text(",".join(["t,w1,w2,w3", *others]) + f"\n{numbers}\n")
    assert f"ignored: {ignored}" in read(file, scene=load("euler/generic")).notes
    with pytest.raises(Refused):
        read(file, scene=load("kirchhoff/whole-motion"))


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("w1,w2,w3\n1,2,3\n", "expected a column `t` of times, got none"),
        ("t,w1,w2\n0,1,2\n", "expected all of w1 w2 w3, got no w3"),
        ("t,t,w1,w2,w3\n0,0,1,2,3\n", "expected every column once, got `t` again"),
        ("t,w1,w2,w3\n", "expected at least one row, got none"),
        ("", "got an empty file"),
        ("1,2,3,4\n2,3,4,5\n", "expected a header line that names the columns"),
        ("t,w1,w2,w3\n0,1,2,3\n1,1,x,3\n", "got 'x' @ .* row 2, column w2"),
        ("t,w1,w2,w3\n0,1,2,3\n2,1,2,3\n1,1,2,3\n", "keep increasing, got 1 after 2 @ .* row 3"),
        ("t,w1,w2,w3\n5,1,2,3\n1,1,2,3\n2,1,2,3\n", "keep decreasing, got 2 after 1 @ .* row 3"),
        ("t,w1,w2,w3\nnan,1,2,3\n", "expected a finite time, got nan @ .* row 1"),
    ],
)
def test_each_fault_has_its_own_message(text: str, fault: str, tmp_path: Path) -> None:
    """Expectation, value and place of what is wrong with a CSV file."""
    file = tmp_path / "mine.csv"
    file.write_text(text)
    with pytest.raises(Refused, match=fault):
        read(file)


@pytest.mark.parametrize(
    ("name", "content", "fault"),
    [
        ("mine.json", b"{", "expected a JSON document"),
        ("mine.json", b"[1, 2]", "expected an object of column arrays"),
        ("mine.json", b'{"t": 1, "w1": [1]}', "expected an array of numbers, got '1'"),
        (
            "mine.json",
            b'{"t": [0], "w1": [1, 2], "w2": [1], "w3": [1]}',
            "expected 1 values as in t",
        ),
        ("mine.json", b'{"t": [0], "w1": [true], "w2": [null], "w3": [[1]]}', "column w2"),
        ("mine.csv", b"\xff\xfe\x00", "expected text in UTF-8"),
        ("mine.npz", b"PK no zip", "expected an NPZ archive"),
        ("mine.parquet", b"no parquet", "expected a Parquet file, got a fault"),
    ],
)
def test_what_is_no_such_file_is_refused(
    name: str, content: bytes, fault: str, tmp_path: Path
) -> None:
    """A fault of the format is told in words, whatever the library made of it."""
    (tmp_path / name).write_bytes(content)
    with pytest.raises(Refused, match=fault):
        read(tmp_path / name)


def test_missing_file_and_folder(tmp_path: Path) -> None:
    """A missing file and a folder are refused as trajectory files."""
    (tmp_path / "folder.csv").mkdir()
    for name, got in (("none.csv", "no such file"), ("folder.csv", "a folder")):
        with pytest.raises(Refused, match=f"expected a trajectory file, got {got}"):
            read(tmp_path / name)


def test_truth_of_a_path_that_begins_at_the_origin_is_narrow_enough(tmp_path: Path) -> None:
    """No row is undecided for a centre that begins at zero, whose first floor is zero."""
    scene = load("kirchhoff/planar-turn")
    assert all_pass(checked(tmp_path, scene.name, columns_at(scene, scene.clock.instants[::20])))


def test_all_faults_at_once(tmp_path: Path) -> None:
    """A file with three faults is refused with all of them, and many of one kind are counted."""
    file = tmp_path / "mine.csv"
    file.write_text("w1,w2,speed\n" + "a,1,2\n" * 10)
    with pytest.raises(Refused) as refused:
        read(file)
    assert len([line for line in refused.value.faults if line.startswith("expected")]) == 5
    assert any(line.startswith("and 7 more of this kind") for line in refused.value.faults)


def test_numbers_beyond_a_double_are_refused(tmp_path: Path) -> None:
    """Errors are told as doubles: 1e400 is refused, 1e-400 is a number like any other."""
    columns = {"t": ["0"], "w1": ["1e400"], "w2": ["1e-400"], "w3": ["0"]}
    with pytest.raises(
        Refused, match=r"below 2\^1000 in size, got '1e400' @ .* column w1"
    ) as refused:
        read(write_csv(tmp_path / "mine.csv", columns, str))
    assert len(refused.value.faults) == 1


def test_a_line_within_a_number_is_refused(tmp_path: Path) -> None:
    """Two lines of digits are no number, also where each of them is one."""
    file = tmp_path / "mine.json"
    columns = {"t": ["0", "1"], "w1": ["0.1", "0\n2"], "w2": ["0", "0"], "w3": ["0", "0"]}
    file.write_text(json.dumps(columns), encoding="utf-8")
    with pytest.raises(Refused, match="row 2, column w1"):
        read(str(file))


def test_far_beyond_a_scene_without_closed_form_is_undecided(tmp_path: Path) -> None:
    """Rows without an exact motion are undecided, and the row says why."""
    columns = {"t": ["0", "1e9"], **{n: ["0", "0"] for n in OMEGA}}
    file = write_csv(tmp_path / "mine.csv", columns, str)
    (verdict,) = file_judgement(file, "euler/constant-moment").verdicts
    assert verdict.verdict is Status.UNDECIDED
    assert "100 times as far as the scene" in verdict.because


def test_columns_of_the_other_model_are_refused(tmp_path: Path) -> None:
    """Impulses are no answer to Euler's equations."""
    columns = {"t": [0.0], **{f"{letter}{i}": [1.0] for letter in "xy" for i in (1, 2, 3)}}
    with pytest.raises(Refused, match="expected columns of a scene of model euler"):
        checked(tmp_path, "euler/generic", columns)


# The command.


def test_command_says_pass_and_fail(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit 0 for a sound file, 1 with the hint for a spoiled one, 0 when it is accepted."""
    sound = exact_columns(SCENE)
    file = write_csv(tmp_path / "mine.csv", sound)
    assert main(["check", file, "--scene", SCENE]) == 0
    assert "6 pass" in capsys.readouterr().out
    scalar_last = {f"q{i}": sound[f"q{(i + 1) % 4}"] for i in range(4)}
    spoiled = {**sound, **scalar_last}
    file = write_csv(tmp_path / "mine.csv", spoiled)
    assert main(["check", file, "--scene", SCENE]) == 1
    printed = capsys.readouterr().out
    assert "scalar last" in printed
    assert "--accept-conventions" in printed
    assert "is not the scene's initial state" in printed
    assert main(["check", file, "--scene", SCENE, "--accept-conventions"]) == 0


def test_command_as_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The rows of `run`: late states say by how much, and conserved quantities see nothing."""
    sound = exact_columns(SCENE)
    late = {**sound, "t": [t + 5e-4 for t in sound["t"]]}
    file = write_csv(tmp_path / "mine.csv", late)
    assert main(["check", file, "--scene", SCENE, "--json"]) == 1
    document = json.loads(capsys.readouterr().out)
    states = [row for row in document["verdicts"] if row["quantity"] in ("omega", "attitude")]
    assert [row["time_shift"] for row in states] == pytest.approx([5e-4] * 2, rel=1e-9)
    assert all(row["residual"] < 1e-12 < row["max"] for row in states)
    assert [row["verdict"] for row in document["verdicts"]] == ["fail"] * 2 + ["pass"] * 3
    (convention,) = document["conventions"]
    assert (convention["found"], convention["corrected"]) == ("t is late by 0.0005", False)
    assert convention["error_with"] < 1e-6 * convention["error_without"]
    assert set(document["verdicts"][0]) == set(Verdict(*[""] * 5, Status.PASS, "").row())
    assert document["file"]["columns"][:4] == ["t", *OMEGA]


def test_scene_that_the_rung_cannot_hold_is_refused(tmp_path: Path) -> None:
    """A body whose numbers overflow float32 is a refused row, as in a run."""
    scene = tmp_path / "huge.toml"
    scene.write_text(scene_text("inertia = [1e60, 2e60, 2.5e60]"))
    file = write_csv(tmp_path / "mine.csv", {"t": [0.0], "w1": [1.0], "w2": [2.0], "w3": [3.0]})
    (verdict,) = file_judgement(file, str(scene), rung="f32").verdicts
    assert verdict.verdict is Status.REFUSED
