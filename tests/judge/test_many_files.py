"""Several files of one solver at several steps: `check` judges each, and says the order of them all."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from builders.integrators import explicit_euler, fixed_step, rk4
from builders.scenes import THREE_INSTANTS, scene_file
from builders.turns import by_turns
from jsonschema import Draft202012Validator

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.judge.series.files import FilesJudgement
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.answers import Order
from taylor_verify.records.faults import Refused
from taylor_verify.records.passing import NotPassed
from taylor_verify.records.schema import schema
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.stated_step import (
    FileStep,
    Source,
    knob_of,
    step_in_name,
    step_of_rows,
)

pytestmark = pytest.mark.usefixtures("without_causes")
Floats = np.ndarray[Any, Any]
Method = Callable[..., tuple[Floats, Floats]]
Captured = pytest.CaptureFixture[str]

SCENE = THREE_INSTANTS.replace("end = 2\nsamples = 3", "end = 4\nsamples = 5").replace(
    "[body]", 'track = ["attitude"]\n[body]'
)
STEPS = (0.25, 0.125, 0.0625, 0.03125)
# All that is within it passes, so that no reason is searched for.
AMPLE = 1e-2
NAMES = ("w1", "w2", "w3", "q0", "q1", "q2", "q3")


def midpoint(f: Callable[[Floats], Floats], w: Floats, h: Any) -> tuple[Floats, Floats]:
    """The explicit midpoint rule; the attitude turns with the angular velocity of the middle."""
    middle = w + h / 2 * f(w)
    return w + h * f(middle), middle


def with_euler_attitude(f: Callable[[Floats], Floats], w: Floats, h: Any) -> tuple[Floats, Floats]:
    """The classical method for omega; the attitude turns with the angular velocity of the beginning."""
    return rk4(f, w, h)[0], w


def rows_of(scene: Path, method: Method, step: float) -> Floats:
    problem = pose(load(str(scene)), rung("f64"))
    return fixed_step(method)(problem, step)


def write(file: Path, rows: Floats, head: str = "", spacing: int = 1) -> str:
    lines = [*head.splitlines(), ",".join(("t", *NAMES[: rows.shape[1]]))]
    for k, row in enumerate(rows):
        lines.append(",".join([str(k * spacing), *(repr(float(value)) for value in row)]))
    file.parent.mkdir(exist_ok=True)
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(file)


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return scene_file(tmp_path_factory.mktemp("scene"), SCENE)


@pytest.fixture(scope="module")
def files(scene: Path) -> list[str]:
    """Runge-Kutta's answers, the step in the name of each."""
    return [
        write(scene.with_name(f"run_h{step}.csv"), rows_of(scene, rk4, step)[:, :3])
        for step in STEPS
    ]


@pytest.fixture(scope="module")
def judged(scene: Path, files: list[str]) -> FilesJudgement:
    return taylor_verify.check(scene, files, partial=True)


def ample(
    scene: Path, files: Sequence[str], steps: Sequence[Fraction | float] | None = None
) -> FilesJudgement:
    """The judgement of files that are far from failing."""
    return taylor_verify.check(scene, files, partial=True, steps=steps, tolerance=AMPLE)


def order_of(judged: FilesJudgement, quantity: str) -> Order:
    return next(order for order in judged.order if order.quantity == quantity)


# The order.


@pytest.mark.parametrize(
    ("method", "expected"), by_turns([(midpoint, 2), (explicit_euler, 1), (rk4, 4)], 2)
)
def test_the_order_of_a_method_is_found(
    method: Method, expected: int, scene: Path, tmp_path: Path
) -> None:
    """Euler's method, the midpoint rule and the classical Runge-Kutta method, from their files alone."""
    steps = [step / (8 if expected == 1 else 1) for step in STEPS]
    made = [
        write(tmp_path / f"dt={step}.csv", rows_of(scene, method, step)[:, :3]) for step in steps
    ]
    omega = order_of(ample(scene, made), "omega")
    assert omega.order == pytest.approx(expected, abs=0.2)
    assert omega.best_step == steps[-1]
    assert [point.step for point in omega.points] == steps


def test_an_attitude_of_a_lower_order_is_seen(scene: Path, tmp_path: Path) -> None:
    """omega of order 4 beside an attitude of order 1: a line for each, and a sentence on the difference."""
    made = [
        write(tmp_path / f"h{step}.csv", rows_of(scene, with_euler_attitude, step))
        for step in STEPS
    ]
    judgement = taylor_verify.check(scene, made)
    assert order_of(judgement, "omega").order == pytest.approx(4, abs=0.2)
    assert order_of(judgement, "attitude").order == pytest.approx(1, abs=0.2)
    assert any(
        "attitude has a lower order (1.0) than omega (4.0)" in note for note in judgement.notes
    )


# The steps.


@pytest.mark.parametrize(
    ("name", "knob", "number"),
    [
        ("run_rtol1e-6.csv", "rtol", 1e-6),
        ("run-rtol=1e-06.csv", "rtol", 1e-6),
        ("RTOL_1e-6/run.csv", "rtol", 1e-6),
        ("h0.1_substeps16.csv", "substeps", 16.0),
        ("run_n4.csv", "n", 4.0),
        ("run4.csv", "n", None),
        ("run_atol1e-6.csv", "tol", None),
        ("run_rtol.csv", "rtol", None),
    ],
)
def test_a_name_states_the_number_of_a_knob(
    name: str, knob: str, number: float | None, tmp_path: Path
) -> None:
    """Any word before a number in the name of a file, or of its folder; not the end of another word."""
    file = tmp_path / name
    file.parent.mkdir(exist_ok=True)
    file.write_text("t,w1,w2,w3\n")
    stated = knob_of(str(file), knob)
    assert (stated.value if stated else None) == number


def test_a_knob_orders_files_in_place_of_the_step(
    scene: Path, files: list[str], tmp_path: Path
) -> None:
    """Substeps are as good as steps, in 1/substeps; a knob that no name states gives no order."""
    named = [tmp_path / f"run_substeps{round(1 / step)}.csv" for step in STEPS]
    for file, copy in zip(files, named, strict=True):
        copy.write_text(Path(file).read_text())
    judgement = taylor_verify.check(scene, named, partial=True, knob="substeps")
    omega = order_of(judgement, "omega")
    assert omega.order == pytest.approx(4, abs=0.2)
    assert "from 1/substeps = 0.25 to 0.03125" in omega.sentence
    assert "substeps is from the names of the files; --steps says others" in judgement.notes
    other = taylor_verify.check(scene, named[:2], partial=True, knob="rtol")
    assert other.order == ()
    assert any("rtol of the files is not known" in note for note in other.notes)
    with pytest.raises(ValueError, match="a list of files with knob, got one answer @ knob"):
        taylor_verify.check(scene, named[0], knob="rtol")


@pytest.mark.parametrize(
    ("name", "step"),
    [
        ("run_h0.01.csv", 0.01),
        ("dt=0.01.csv", 0.01),
        ("rk4-dt1e-3.csv", 1e-3),
        ("rk4h0.5.csv", 0.5),
        ("run_h0p05.csv", 0.05),
        ("step_0.5s.csv", None),
        ("time-step=0.5.npz", 0.5),
        ("h0.1/run.csv", 0.1),
        ("step3.csv", None),
        ("ch0.1.csv", None),
        ("dt10ms.csv", None),
        ("h0.csv", None),
        ("h0.1_dt0.2.csv", None),
        ("h1e999999999.csv", None),
        ("run.csv", None),
    ],
)
def test_a_name_states_a_step_or_none(name: str, step: float | None) -> None:
    """h, dt or step before a number; an index, a unit, a zero and two steps that differ state none."""
    stated = step_in_name(name)
    assert (stated.value if stated else None) == step


@pytest.mark.parametrize(
    ("ending", "content", "step"),
    [
        (".csv", "# h = 0.25\nt,w1,w2,w3\n0,1,0,0\n1,1,0,0\n", 0.25),
        (".csv", "# rk4, time step: 2.5e-1 s\nt,w1,w2,w3\n0,1,0,0\n1,1,0,0\n", 0.25),
        (".csv", "t,w1,w2,w3,dt\n0,1,0,0,0.25\n1,1,0,0,0.25\n", 0.25),
        (".csv", "t,w1,w2,w3,dt\n0,1,0,0,0.25\n1,1,0,0,0.5\n", None),
        (".csv", "t,w1,w2,w3\n0,1,0,0\n1,1,0,0\n", None),
        (".json", '{"dt": 0.25, "t": [0, 1], "w1": [1, 1], "w2": [0, 0], "w3": [0, 0]}', 0.25),
    ],
)
def test_a_file_states_a_step_or_none(
    ending: str, content: str, step: float | None, tmp_path: Path
) -> None:
    """A comment, a column of one value, a key of the JSON object; a column that changes states none."""
    file = tmp_path / f"run_h9{ending}"
    file.write_text(content, encoding="utf-8")
    assert read(file).step == (FileStep(step, Source.FILE) if step else None)


def test_a_step_inside_a_file_comes_before_that_of_its_name(scene: Path, tmp_path: Path) -> None:
    """The step inside a file comes before that of its name, and one that the caller states before both."""
    rows = rows_of(scene, rk4, 0.25)[:, :3]
    one = write(tmp_path / "h9.csv", rows, head="# h = 0.25")
    other = write(tmp_path / "h0.5.csv", rows_of(scene, rk4, 0.5)[:, :3])
    judgement = ample(scene, [one, other])
    assert [step and step.value for step in judgement.steps] == [0.25, 0.5]
    assert (
        "the steps are from the files themselves and the names of the files" in judgement.notes[0]
    )
    stated = ample(scene, [one, other], [1, Fraction(1, 2)])
    assert [step and (step.value, step.source) for step in stated.steps] == [
        (1.0, Source.CALL),
        (0.5, Source.CALL),
    ]


def test_rows_are_taken_for_steps_only_where_they_differ(scene: Path, tmp_path: Path) -> None:
    """The spacing of the rows is an assumption, said as such; equal spacings are no steps."""
    rows = {step: rows_of(scene, rk4, 0.25)[:: round(step), :3] for step in (1, 2)}
    made = [write(tmp_path / f"{k}.csv", rows[k], spacing=k) for k in (1, 2)]
    judgement = ample(scene, made)
    assert [step and step.value for step in judgement.steps] == [1.0, 2.0]
    assert judgement.notes[0].startswith("assumed: the spacing of the rows is the step")
    alike = [write(tmp_path / f"{k}.csv", rows[1]) for k in ("a", "b")]
    judgement = ample(scene, alike)
    assert judgement.order == ()
    assert (
        "the steps of the files are not known; say them with --steps 0.1,0.05" in judgement.notes[0]
    )
    assert step_of_rows([Fraction(0), Fraction(1), Fraction(3)]) is None


def test_a_file_of_unknown_step_is_judged_alone(
    scene: Path, files: list[str], tmp_path: Path
) -> None:
    """The others show their order, and it is said that this one has no part in it."""
    other = write(tmp_path / "other.csv", rows_of(scene, rk4, 0.5)[:, :3])
    judgement = ample(scene, [*files, other])
    assert len(judgement.files) == 5
    assert len(order_of(judgement, "omega").points) == 4
    assert f"the step of {other} is not known: it has no part in the order" in judgement.notes


def test_two_files_of_one_step_have_no_order(scene: Path, files: list[str], tmp_path: Path) -> None:
    """Their names are in the sentence; steps that the caller repeats are refused."""
    again = write(tmp_path / "again_h0.25.csv", rows_of(scene, midpoint, 0.25)[:, :3])
    judgement = ample(scene, [*files, again])
    assert judgement.order == ()
    assert any(f"{files[0]} and {again} have the same step, h = 0.25" in n for n in judgement.notes)
    with pytest.raises(ValueError, match=r"no two of which are the same, got 0.1 again @ steps"):
        taylor_verify.check(scene, files[:2], steps=[0.1, 0.1])


def test_a_file_that_ends_early_has_no_part_in_the_order(
    scene: Path, files: list[str], tmp_path: Path
) -> None:
    """Its error is that of a shorter time."""
    cut = write(tmp_path / "cut_h0.5.csv", rows_of(scene, rk4, 0.5)[:3, :3])
    judgement = ample(scene, [cut, *files])
    assert f"{cut} ends before the others do, and has no part in the order" in judgement.notes
    assert order_of(judgement, "omega").order == pytest.approx(4, abs=0.2)


# The Python call.


def test_a_list_of_files_has_one_judgement(judged: FilesJudgement, files: list[str]) -> None:
    """Verdicts of all files, told apart by their setting; each file's own judgement; a table of pandas."""
    assert isinstance(judged, FilesJudgement)
    assert [one.file.name for one in judged.files] == files
    assert judged.verdicts == tuple(v for one in judged.files for v in one.verdicts)
    assert {verdict.setting for verdict in judged.verdicts} == {*files}
    assert not judged.passed
    assert not judged
    with pytest.raises(NotPassed, match="f64 omega: 5 digits are right"):
        judged.raise_for_failure()
    assert len(judged.to_dataframe()) == len(judged.verdicts)
    assert repr(judged).startswith("<FilesJudgement of 4 files on ")
    assert "omega: order 4.0" in judged._repr_html_()


@pytest.mark.parametrize(
    ("asked", "options", "sentence"),
    [
        ([], {}, "expected at least one trajectory file, got an empty list"),
        (
            ["a.csv", "b.csv"],
            {"steps": [0.1]},
            "expected a step for each of 2 files, got 1 @ steps",
        ),
        (["a.csv", "b.csv"], {"steps": "0.1,0.2"}, "expected a step for each of 2 files"),
        (["a.csv", "b.csv"], {"steps": [0.1, 0]}, r"a positive number, got 0 @ steps\[1\]"),
        ("a.csv", {"steps": [0.1]}, "expected a list of files with steps, got one answer @ steps"),
        (
            [lambda problem: [[0, 0, 0, 1, 0, 0, 0]]],
            {},
            "expected trajectory files alone in a list",
        ),
        ([3], {}, "expected a callable solve.problem., a trajectory file, .*, got int: 3"),
    ],
)
def test_a_wrong_call_is_refused(
    asked: Any,
    options: Mapping[str, Any],
    sentence: str,
    scene: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each in one sentence."""
    monkeypatch.chdir(tmp_path)
    for name in ("a.csv", "b.csv"):
        write(Path(name), rows_of(scene, rk4, 1.0))
    with pytest.raises(ValueError, match=sentence):
        taylor_verify.check(scene, asked, **options)


def test_the_faults_of_all_files_are_told(scene: Path, files: list[str], tmp_path: Path) -> None:
    """A missing file and one of the other model are both named, and none is judged halfway."""
    foreign = tmp_path / "foreign.csv"
    foreign.write_text("t,x1,x2,x3,y1,y2,y3\n0,1,0,0,1,0,0\n1,1,0,0,1,0,0\n")
    with pytest.raises(Refused) as refused:
        taylor_verify.check(scene, [files[0], str(foreign), "none.csv"])
    assert "@ none.csv" in str(refused.value)
    assert f"@ {foreign}" in str(refused.value)


# The command.


def called(capsys: Captured, *words: Any) -> tuple[int, str, str]:
    status = main([str(word) for word in ("check", *words)])
    return status, *capsys.readouterr()


def within(capsys: Captured, *words: Any) -> tuple[int, str, str]:
    return called(capsys, *words, "--partial", "--tolerance", AMPLE)


def exact_file(file: Path, scene: Path, rows: int = 5) -> str:
    times = list(range(rows))
    motion = taylor_verify.exact(scene, times, 20)
    return write(file, np.array(motion["omega"], dtype=float))


def test_the_command_says_the_order_first(scene: Path, files: list[str], capsys: Captured) -> None:
    """The orders stand above the table of files, which goes from the largest step to the smallest."""
    status, out, _ = within(capsys, *reversed(files), "--scene", scene)
    assert status == 0
    assert out.index("omega: order 4.0 from h = 0.25 to 0.03125") < out.index(files[0])
    places = [out.index(file) for file in files]
    assert places == sorted(places)
    assert "the steps are from the names of the files; --steps says others" in out


def test_the_worst_file_decides_the_exit_status(
    scene: Path, files: list[str], tmp_path: Path, capsys: Captured
) -> None:
    """Two that pass: 0; one of them cut short: 3; one that fails: 1; one that cannot be read: 2."""
    exact = [exact_file(tmp_path / f"h0.{k}.csv", scene) for k in (1, 2)]
    cut = exact_file(tmp_path / "h0.3.csv", scene, rows=3)
    assert called(capsys, *exact, "--scene", scene, "--partial")[0] == 0
    assert called(capsys, exact[0], cut, "--scene", scene)[0] == 3
    assert called(capsys, *exact, files[0], "--scene", scene, "--partial")[0] == 1
    assert called(capsys, *exact, "none.csv", "--scene", scene)[0] == 2


def test_the_document_is_of_the_published_schema(
    scene: Path, files: list[str], judged: FilesJudgement, capsys: Captured
) -> None:
    """A document for each file, as `check` prints it of the file alone, and the order of all."""
    _, out, _ = called(capsys, *files, "--scene", scene, "--partial", "--json")
    document = json.loads(out)
    errors = [error.message for error in Draft202012Validator(schema()).iter_errors(document)]
    assert errors == []
    assert set(document) == {"files", "order", "notes", "summary", "sha256"}
    assert document["order"] == json.loads(json.dumps(judged.document()["order"]))
    assert [one["step"] for one in document["files"]] == list(STEPS)
    _, out, _ = called(capsys, files[1], "--scene", scene, "--partial", "--json")
    alone = json.loads(out)
    alone.pop("sha256")
    assert {name: document["files"][1][name] for name in alone} == alone
    broken = {**document, "order": [{**document["order"][0], "points": None}]}
    assert not Draft202012Validator(schema()).is_valid(broken)
    del broken["order"]
    assert not Draft202012Validator(schema()).is_valid(broken)


def test_a_ci_tells_the_files_apart(
    scene: Path, files: list[str], tmp_path: Path, capsys: Captured
) -> None:
    """Their own document is a baseline; a row that grew names its file, in words and in JUnit."""
    call = [*files[:2], "--scene", scene]
    _, out, _ = within(capsys, *call, "--json")
    base, results = tmp_path / "base.json", tmp_path / "r.xml"
    base.write_text(out, encoding="utf-8")
    _, _, errors = within(capsys, *call, "--baseline", base)
    assert "0 regressions" in errors
    document = json.loads(out)
    row = next(v for v in document["files"][1]["verdicts"] if v["quantity"] == "omega")
    for error in ("max", "mean", "final"):
        row[error] /= 1e3
    base.write_text(json.dumps(document), encoding="utf-8")
    status, _, errors = within(capsys, *call, "--baseline", base, "--junit", results, "--github")
    assert status == 1
    (regression,) = [
        line for line in errors.splitlines() if "regression: " in line and "::" not in line
    ]
    assert regression.endswith(f"omega max (and mean, final) ({files[1]})")
    suites = ElementTree.parse(results).getroot()
    assert [suite.get("name", "").rpartition(" ")[2] for suite in suites] == files[:2]
    cases = [(case.get("classname"), case.get("name")) for case in suites.iter("testcase")]
    assert len(cases) == len(set(cases))
    regressions = [text for text in suites[1].itertext() if "regression: " in text]
    assert len(regressions) == 1
    assert not any("regression: " in text for text in suites[0].itertext())


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--steps", "0.1,x"], "expected a number such as 10, 1e9 or 1/3, got 'x' @ --steps"),
        (["--steps", "0.1,-1"], "expected a positive step, got '-1' @ --steps"),
        (
            ["none.csv", "none.json"],
            "got no such file @ none.csv\nexpected a trajectory file, got no",
        ),
        (["--scene", "euler/none"], "got euler/none"),
    ],
)
def test_a_wrong_command_is_refused(
    words: Sequence[str], sentence: str, scene: Path, files: list[str], capsys: Captured
) -> None:
    """Exit status 2 and a sentence; nothing on stdout, and nothing is judged."""
    status, out, errors = called(capsys, *files[:2], "--scene", scene, *words)
    assert (status, out) == (2, "")
    assert sentence in errors


def test_a_file_given_twice_is_refused(
    scene: Path, files: list[str], tmp_path: Path, capsys: Captured
) -> None:
    """A file given twice, by one path or by two, is refused; the fault of another file is told with it."""
    link = tmp_path / "link.csv"
    link.symlink_to(files[0])
    status, _, errors = called(capsys, files[0], link, files[0], "none.csv", "--scene", scene)
    assert status == 2
    assert f"expected every file once, got {link} again" in errors
    assert f"expected every file once, got {files[0]} again" in errors
    assert "@ none.csv" in errors


def test_files_of_another_start_are_named(scene: Path, files: list[str], tmp_path: Path) -> None:
    """A file that does not begin as the scene does is named: it may be of another scene."""
    rows = rows_of(scene, rk4, 0.5)[:, :3] * math.sqrt(2)
    other = write(tmp_path / "other_h0.5.csv", rows)
    judgement = ample(scene, [*files, other])
    assert (
        judgement.notes[-1]
        == f"{other} does not start as the scene does: is it a file of another scene?"
    )
    assert any(v.verdict is Status.FAIL for v in judgement.files[-1].verdicts)
