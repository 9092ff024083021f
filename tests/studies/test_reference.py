"""The reference trajectories: right, complete, and readable without Python."""

from __future__ import annotations

import csv
import json
import re
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from builders.reports import SOME_REFERENCES, every_reference, some_references
from builders.scenes import read_scene

from taylor_verify.batch.failure import Failed
from taylor_verify.cli import main
from taylor_verify.exact.printed import document
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.words.page_parts import MADE_BY
from taylor_verify_reports.studies.reference import reference_page as reference_files
from taylor_verify_reports.studies.reference.exact_table import DIGITS, reference
from taylor_verify_reports.studies.stored import document as document_of

# A second or less each; with attitude, centre and a full tensor among them.
CHEAP = (
    "euler/generic",
    "euler/nesc-brick",
    "kirchhoff/steady-precession",
    "kirchhoff/steady-spin",
)
VECTORS = {
    "omega": ("w1", "w2", "w3"),
    "linear_impulse": ("x1", "x2", "x3"),
    "angular_impulse": ("y1", "y2", "y3"),
    "attitude": ("r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"),
    "centre": ("c1", "c2", "c3"),
}

Rows = list[dict[str, str]]
Vector = Sequence[Fraction]


def by_scene(scenes: Iterable[str]) -> pytest.MarkDecorator:
    """The scenes as parameters of a test: the others than some are slow."""
    slow = pytest.mark.slow
    parameters = [pytest.param(n, marks=() if n in SOME_REFERENCES else slow) for n in scenes]
    return pytest.mark.parametrize("scene", parameters)


# Sets of scenes whose files stand in one folder.
by_set = pytest.mark.parametrize(
    "scenes",
    [SOME_REFERENCES, pytest.param(names(), marks=pytest.mark.slow)],
    ids=["some", "every"],
)


def folder(scenes: Iterable[str] = SOME_REFERENCES) -> Path:
    """The folder that has the files of these scenes."""
    made = some_references if set(scenes) <= set(SOME_REFERENCES) else every_reference
    return made() / reference_files.FOLDER


def file(scene: str, suffix: str) -> Path:
    name = "loads" if suffix == "csv" and is_shared(scene) else scene.replace("/", "-")
    return folder([scene]) / f"{name}.{suffix}"


def is_shared(scene: str) -> bool:
    return scene.startswith("loads/")


def sheet(scene: str) -> Rows:
    """The rows of a scene, with the columns that it has."""
    with file(scene, "csv").open(encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines))
    if not is_shared(scene):
        return rows
    return [
        {name: cell for name, cell in row.items() if cell and name != "scene"}
        for row in rows
        if row["scene"] == scene
    ]


def question(scene: str) -> dict[str, Any]:
    published: dict[str, Any] = json.loads(file(scene, "json").read_text(encoding="utf-8"))
    return published


def vector(row: dict[str, str], quantity: str) -> list[Fraction]:
    return [Fraction(row[name]) for name in VECTORS[quantity]]


def rational(value: Any) -> Any:
    """The exact values of the texts of a JSON file."""
    return Fraction(value) if isinstance(value, str) else [rational(entry) for entry in value]


def flat(value: Any) -> list[Fraction]:
    return [value] if isinstance(value, Fraction) else [x for part in value for x in flat(part)]


def dot(a: Vector, b: Vector) -> Fraction:
    return sum((p * q for p, q in zip(a, b, strict=True)), Fraction(0))


# Complete.


@by_scene(names())
def test_every_shipped_scene_has_its_files(scene: str) -> None:
    """CSV and JSON hold the same columns, a row for every instant, of the scene as it is now."""
    published, asked = question(scene), load(scene)
    assert published["sha256"] == asked.digest
    rows = sheet(scene)
    assert len(rows) == len(asked.clock.instants)
    for name in rows[0]:
        assert published[name] == [row[name] for row in rows]
    tracked = {"omega"} if asked.model == "euler" else {"linear_impulse", "angular_impulse"}
    expected = [n for q in VECTORS if q in tracked | asked.track for n in VECTORS[q]]
    expected += [n for group in asked.groups if group.name in asked.states for n in group.columns]
    assert list(rows[0]) == ["t", *expected, "radius"]


@by_scene(names())
def test_the_question_is_that_of_the_scene(scene: str) -> None:
    """Body and initial state read back exactly, and every time is the instant to 32 digits."""
    published, asked = question(scene), load(scene)
    for name, value in published["body"].items():
        assert flat(rational(value)) == flat(getattr(asked.body, name))
    initial = {name: rational(value) for name, value in published["initial"].items()}
    state = asked.initial
    assert initial.pop("t") == asked.clock.start
    short = {"linear_impulse": "linear", "angular_impulse": "angular"}
    for name, value in initial.items():
        assert flat(value) == list(getattr(state, short.get(name, name)))
    for text, instant in zip(published["t"], asked.clock.instants, strict=True):
        # Half a unit of the last of 32 digits.
        assert abs(Fraction(text) - instant) <= abs(instant) * Fraction(1, 2 * 10**31)


@by_scene(names())
def test_at_least_thirty_digits(scene: str) -> None:
    """Every number but zero shows 32 significant digits, and no row is off by more than 10^-30."""
    for row in sheet(scene):
        assert Fraction(row["radius"]) <= Fraction(1, 10**30)
        for name in set(row) - {"t", "radius"}:
            shown = re.sub(r"e.*|[-.]", "", row[name]).lstrip("0")
            assert len(shown) == DIGITS or row[name] == "0"


# Right.


def agrees(scene: str, route: str | None, rows: Rows | None = None) -> None:
    """Five rows of the files are within their radius of the motion computed anew to 45 digits."""
    asked, rows = load(scene), rows or sheet(scene)
    chosen = [rows[k * (len(rows) - 1) // 4] for k in range(5)] if len(rows) > 4 else rows
    times = [(row["t"], Fraction(row["t"])) for row in chosen]
    sharper = document(asked, solution(asked, route), times, 45)["rows"]
    for row, exact in zip(chosen, sharper, strict=True):
        for quantity in VECTORS.keys() & exact.keys():
            v, w = vector(row, quantity), flat(rational(exact[quantity]))
            error = dot(d := [p - q for p, q in zip(v, w, strict=True)], d)
            # The radius of the 45 digits is added: a comparison has two ends.
            radius = Fraction(row["radius"]) + Fraction(exact["radius"])
            assert error <= radius**2 * (dot(v, v) or 1)


@pytest.mark.parametrize("scene", CHEAP)
def test_the_digits_are_those_of_the_taylor_route(scene: str) -> None:
    """The recursion, asked for 45 digits, is within the radius, whatever route made the file."""
    agrees(scene, "taylor")


@pytest.mark.parametrize("column", ["w2", "r12"])
def test_one_wrong_digit_does_not_agree(column: str) -> None:
    """A change in the 29th digit of one number of one row is outside its radius."""
    rows = sheet("euler/nesc-brick")
    middle = rows[(len(rows) - 1) // 2]
    middle[column] = str(Fraction(middle[column]) * (1 + Fraction(1, 10**28)))
    with pytest.raises(AssertionError):
        agrees("euler/nesc-brick", None, rows)


# Remade.


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_a_time_without_a_finite_decimal_is_the_decimal_that_is_printed() -> None:
    """The row of t = 1/3 is the motion at 0.33...3, 32 digits: time and motion go together."""
    asked = read_scene(initial='omega = ["1e9", "2e9", "1/3"]', time='at = ["1/3"]')
    published = reference(asked)
    assert published["columns"]["t"] == ["0." + "3" * 32]
    assert published["initial"]["omega"] == ["1000000000", "2000000000", "1/3"]
    time = ("", Fraction(published["columns"]["t"][0]))
    (row,) = document(asked, solution(asked), [time], DIGITS)["rows"]
    assert [published["columns"][name][0] for name in VECTORS["omega"]] == row["omega"]


def test_the_verb_writes_the_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """`publish reference` names each scene on stderr, prints what it wrote, and drops old scenes."""
    scenes = ("euler/rest", "euler/generic")
    reference_files.write(tmp_path, [reference(load("euler/generic")) | {"scene": "euler/gone"}])
    mine = tmp_path / "reference" / "mine.json"
    mine.write_text("{}\n", encoding="utf-8")
    monkeypatch.setattr("taylor_verify.scenes.library.names", lambda: scenes)
    assert main(["publish", "reference", "--from", str(tmp_path), "--json"]) == 0
    out, err = capsys.readouterr()
    assert all(f"/2 {scene}\n" in err for scene in scenes)
    folder = tmp_path / "reference"
    assert {*json.loads(out)["written"], str(mine)} == {str(path) for path in folder.iterdir()}
    assert "euler-gone.csv" not in contents(folder)
    assert contents(folder)["euler-generic.csv"] == file("euler/generic", "csv").read_bytes()


@pytest.mark.parametrize(
    ("error", "text"),
    [(Unsettled("two evaluations do not agree"), r"euler/rest: two evaluations do not agree$"),
     (ZeroDivisionError("by zero"), r"euler/rest: ZeroDivisionError: by zero.*please report it")],
)  # fmt: skip
def test_a_scene_that_cannot_be_solved_is_named(error: Exception, text: str) -> None:
    """Whatever a worker meets comes back as one line with the scene in it."""

    def broken(scene: object) -> dict[str, Any]:
        raise error

    with pytest.raises(Failed, match=text):
        document_of(broken, "euler/rest")


# Read.


def test_the_page_names_every_file() -> None:
    """Each link of the page leads to a file; it links to all but the JSON; its maker is line 1."""
    text = (folder() / "README.md").read_text(encoding="utf-8")
    assert text.splitlines()[0] == MADE_BY
    assert "{{" not in text
    links = set(re.findall(r"\]\(([^)]+)\)", text))
    committed = {path.name for path in folder().iterdir() if path.suffix != ".json"}
    assert links == committed - {"README.md"} | {"../tables/accuracy.md"}
    for name in reference_files.EXAMPLES:
        assert (folder() / name).read_text(encoding="utf-8") in text.replace("\n```", "\n")


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program of the page, compiled as the page says, with warnings as errors."""
    compiler = shutil.which("g++")
    if compiler is None:
        pytest.skip("there is no g++ on this machine")
    program = tmp_path_factory.mktemp("example") / "example"
    options = ["-std=c++17", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    source = str(folder() / "example.cpp")
    subprocess.run([compiler, *options, source, "-o", str(program)], check=True)
    return program


def compared(example: Path, reference: Path, mine: Path, tolerance: str) -> int:
    command = [str(example), str(reference), str(mine), tolerance]
    return subprocess.run(command, capture_output=True, check=False).returncode


@pytest.mark.parametrize(
    ("cell", "status"),
    [("0.5000000001", 0), ("0.500001", 1), ("nan", 1), ("-nan", 1), ("inf", 1), ("-0.5", 1)],
)
def test_the_example_sees_a_wrong_number(
    example: Path, tmp_path: Path, cell: str, status: int
) -> None:
    """An error above the tolerance, a NaN or an infinity in one cell is status 1, else it is 0."""
    exact, mine = tmp_path / "exact.csv", tmp_path / "mine.csv"
    exact.write_text("t,w1,w2,w3,radius\n0,1,0,0,5e-32\n1,0.5,0,0,5e-32\n", encoding="utf-8")
    mine.write_text(f"w3,w2,w1,t\n0,0,1,0\n0,0,{cell},1\n", encoding="utf-8")
    assert compared(example, exact, mine, "1e-8") == status


def test_the_example_names_a_column_that_is_missing(example: Path, tmp_path: Path) -> None:
    """A file without w3 ends with status 2 and the name of the column."""
    exact, mine = tmp_path / "exact.csv", tmp_path / "mine.csv"
    exact.write_text("t,w1,w2,w3,radius\n0,1,0,0,5e-32\n", encoding="utf-8")
    mine.write_text("t,w1,w2\n0,1,0\n", encoding="utf-8")
    command = [str(example), str(exact), str(mine), "1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (2, f"expected a column w3, got none in {mine}\n")


@by_set
def test_the_example_accepts_every_reference(scenes: Sequence[str], example: Path) -> None:
    """Each file read twice agrees with itself exactly, and no other scene passes for it."""
    for scene in (scene for scene in scenes if not is_shared(scene)):
        assert compared(example, file(scene, "csv"), file(scene, "csv"), "0") == 0
    others = (file("euler/tennis-racket", "csv"), file("euler/generic", "csv"))
    assert compared(example, *others, "1e-3") == 1
