"""A report holds what the verdicts say, can be remade from its data, and is never half written."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterable
from dataclasses import replace
from math import nan
from operator import attrgetter
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest
from builders.processes import printed_by
from builders.verdicts import MIXED, NAN, PROVENANCE, RECORD, STOPPED, VERSIONS, passed, unscored
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from taylor_verify.records import store
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.reason import Cause, stated
from taylor_verify.records.status import GRAVITY, Status
from taylor_verify.records.store import load, write
from taylor_verify.records.verdict import Verdict
from taylor_verify.report import index_page
from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.page_parts import MADE_BY
from taylor_verify_reports.studies.published_report import publish


@pytest.fixture
def report(tmp_path: Path) -> Path:
    write(tmp_path, MIXED, [RECORD])
    publish(tmp_path)
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in folder.rglob("*")
        if file.is_file()
    }


def lines(report: Path, table: str, *words: str) -> list[str]:
    """The lines of a published table's rows in which all the words occur."""
    text = (report / "tables" / table).read_text(encoding="utf-8")
    return [
        line for line in text.splitlines() if line.startswith("|") and all(w in line for w in words)
    ]


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split(" | ")]


def rows(report: Path, sheet: str) -> list[dict[str, str]]:
    with (report / "tables" / sheet).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


# What is written is what is read.


def finite(verdict: Verdict) -> Verdict:
    """The verdict with None for what JSON cannot hold."""
    row = verdict.row()
    return replace(verdict, **{name: row[name] for name in (*NAN, "at", "bound", "seconds")})


FLOATS = st.none() | st.floats()
SIZES = st.none() | st.floats(min_value=0) | st.just(nan)
FINITE = st.floats(min_value=0, allow_infinity=False)
TEXT = st.text(st.characters(codec="utf-8"), max_size=12)


@st.composite
def one_run(draw: st.DrawFn) -> list[Verdict]:
    """A run of any names and numbers, its seconds and machine the same in all its verdicts."""
    provenance: dict[str, Any] = draw(
        st.fixed_dictionaries({"scene": TEXT, "processor": TEXT, "command": TEXT})
        | st.fixed_dictionaries({"scene": TEXT})
    )
    if "processor" in provenance:
        provenance["versions"] = {**VERSIONS, "python": draw(st.sampled_from(["3.11", "3.12"]))}
    scene, solver, setting = draw(TEXT), draw(TEXT), draw(TEXT)
    rung = draw(st.sampled_from(LADDER))
    seconds = draw(SIZES)
    quantities = draw(
        st.lists(st.sampled_from(["omega", "impulse", "T", "y3"]), min_size=1, unique=True)
    )
    verdicts = []
    for quantity in quantities:
        numbers: dict[str, Any] = {name: draw(SIZES) for name in (*NAN, "at", "bound")}
        numbers |= {name: draw(FLOATS) for name in ("at", "time_shift") if name in numbers}
        status, outcome = draw(st.sampled_from(Status)), draw(TEXT)
        if status is Status.PASS:
            sizes = sorted(draw(FINITE) for _ in range(4))
            numbers |= zip(("mean", "final", "max", "bound"), sizes, strict=True)
            numbers |= {name: draw(FINITE) for name in ("ratio", "attainable", "roundoff")}
        elif numbers["max"] is not None:
            numbers |= dict.fromkeys(("mean", "final"), numbers["max"])
        verdict = Verdict(scene, solver, rung, setting, quantity, status, outcome, **numbers)
        rest: dict[str, Any] = {
            "reason": stated(Cause.NOT_POSED, draw(TEXT)),
            "seconds": seconds,
            "provenance": provenance,
        }
        verdicts.append(replace(verdict, **rest))
    return verdicts


@given(st.lists(one_run(), min_size=1, unique_by=lambda run: run[0].scene))
@settings(max_examples=12, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_verdicts_read_back_as_they_were(tmp_path: Path, runs: list[list[Verdict]]) -> None:
    """Every field of every verdict reads back to the last bit, what is not finite as None."""
    same = [run for run in runs if run[0].provenance.keys() == runs[0][0].provenance.keys()]
    given = [verdict for run in same for verdict in run]
    write(tmp_path, given, [])
    read = load(tmp_path)
    by_run = attrgetter("run")
    assert sorted(read, key=by_run) == sorted((finite(v) for v in given), key=by_run)
    publish(tmp_path)
    assert len(rows(tmp_path, "gates.csv")) == len(given)


def test_a_record_reads_back_with_null_for_what_is_not_finite(report: Path) -> None:
    """A run's record is one JSON file with all that the record holds, to the last bit."""
    file = report / "data" / "records" / "euler-generic.taylor.f64.json"
    stored = json.loads(file.read_text(encoding="utf-8"), parse_constant=pytest.fail)
    del stored["made_by"]
    expected = json.loads(json.dumps(RECORD.document()))
    expected["gates"][0] |= {"errors": [0.0, None], "attainable": [1e-300, None]}
    assert stored == expected


def test_what_differs_between_machines_is_in_timings_alone(tmp_path: Path) -> None:
    """Another time, machine and order of the runs change timings.json and no other file."""
    write(tmp_path, MIXED, [RECORD])
    publish(tmp_path)
    before = contents(tmp_path)
    elsewhere = {
        "versions": {**VERSIONS, "python": "3.11.2"},
        "processor": "Another chip",
        "command": "taylor-verify run --out elsewhere",
    }
    later = [
        replace(verdict, seconds=9.0, provenance={**verdict.provenance, **elsewhere})
        for verdict in [*MIXED[4:], *MIXED[:4]]
    ]
    write(tmp_path, later, [RECORD])
    publish(tmp_path)
    after = contents(tmp_path)
    assert {name for name in after if after[name] != before.get(name)} == {"data/timings.json"}
    assert set(after) == set(before)


def test_verdicts_of_unlike_versions_make_no_report(tmp_path: Path) -> None:
    """A report states one set of versions; those of two are refused before writing."""
    other = {**PROVENANCE, "versions": {**VERSIONS, "heyoka": "6.0.0"}}
    with pytest.raises(ValueError, match=r"one set of versions.*6\.0\.0"):
        write(tmp_path, [*MIXED, passed("euler/old", "f64", "omega", provenance=other)], [])
    assert contents(tmp_path) == {}


def test_two_unlike_records_of_one_run_are_refused(tmp_path: Path) -> None:
    """No record silently takes the place of another one of the same run."""
    with pytest.raises(ValueError, match=r"one record a run.*euler-generic\.taylor\.f64"):
        write(tmp_path, MIXED, [RECORD, replace(RECORD, steps=42)])


# Files.


@pytest.mark.parametrize("broken", ["taylor_verify.records.store._encoded", "pathlib.Path.open"])
def test_a_failure_half_way_leaves_the_old_files(report: Path, broken: str) -> None:
    """A disk that is full in the middle of writing leaves every old byte and nothing new."""
    before = contents(report)
    is_text = broken.endswith("_encoded")
    whole, calls = store._encoded if is_text else Path.open, 0

    def full(*arguments: Any, **named: Any) -> Any:
        nonlocal calls
        calls += is_text or "w" in arguments
        if calls == 3:
            raise OSError(28, "No space left on device")
        return whole(*arguments, **named)

    with patch(broken, full), pytest.raises(OSError, match="No space left"):
        write(report, [passed("euler/new", "f64", "omega")], [replace(RECORD, scene="euler/new")])
    assert calls == 3
    assert contents(report) == before
    assert list(report.rglob(".unfinished*")) == []


def test_what_is_no_longer_made_goes_and_what_is_not_ours_stays(report: Path) -> None:
    """Old tables and records that name us as maker are removed; other people's files are kept."""
    tables, records = report / "tables", report / "data" / "records"
    (tables / "old.md").write_text(f"{MADE_BY}\n# Old\n", encoding="utf-8")
    (tables / "old.csv").write_text("a\n", encoding="utf-8")
    (tables / "mine.md").write_text("# Mine\n", encoding="utf-8")
    (tables / "mine.csv").write_text("a\n", encoding="utf-8")
    (records / "mine.json").write_text("{}\n", encoding="utf-8")
    write(report, MIXED, [replace(RECORD, rung="f32")])
    written = publish(report)
    mine = {tables / "mine.md", tables / "mine.csv"}
    assert {*tables.iterdir(), report / "README.md"} == {*written, *mine}
    assert {file.name for file in records.iterdir()} == {
        "mine.json",
        "euler-generic.taylor.f32.json",
        "verdicts.sha256",
    }


def test_publishing_imports_no_physics(report: Path) -> None:
    """Publishing, in a process of its own, loads no integrator and no arithmetic; of claims, its document.

    The light modules of the package itself are imported before: tests/house/test_public_api.py names them.
    """
    program = (
        "import sys, taylor_verify; light = set(sys.modules);"
        "from taylor_verify_reports.studies.published_report import publish; publish(sys.argv[1]);"
        "print(*set(sys.modules) - light)"
    )
    loaded = set(printed_by(program, str(report)).split())
    assert "taylor_verify.report.published_tables" in loaded
    assert loaded.isdisjoint({"heyoka", "mpmath", "flint", "numpy", "gmpy2"})
    own = {name for name in loaded if name.startswith("taylor_verify")}
    below = {tuple(name.split(".")[:2]) for name in own if "." in name}
    first = {room for package, room in below if package == "taylor_verify"}
    assert first == {"plotting", "records", "report", "scenes", "tradeoff", "words"}
    # The names of the shipped scenes, and none of them.
    of_scenes = {name for name in own if name.startswith("taylor_verify.scenes.")}
    assert of_scenes == {"taylor_verify.scenes.library"}
    assert "taylor_verify_reports.claims.claim_row" in own
    assert not [
        name
        for name in own
        if name.endswith(
            (".extremes", ".broken_runs", ".measured_causes", ".measure", ".measurement")
        )
    ]


# The front page.


def front_page(report: Path) -> str:
    return (report / "README.md").read_text(encoding="utf-8")


def test_the_front_page_hides_no_failure(report: Path) -> None:
    """A scene that did not pass has its verdict in its line, and its rung does not count as all."""
    by_scene = {cells(line)[0]: cells(line) for line in front_page(report).splitlines()}
    assert by_scene["`euler/broken`"][1:] == [NOTHING, "**fail**", NOTHING, NOTHING]
    assert by_scene["`euler/lost`"][2] == "**fail**"
    assert by_scene["`euler/long`"][2].endswith("**fail**")
    assert by_scene["`euler/vast`"][1] == "**refused**"
    assert by_scene["f64"][2:4] == ["5", "**2**"]
    assert by_scene["f64"][5] == "**no number**"


def test_a_front_page_of_somebody_else_is_left_alone(report: Path) -> None:
    """A README.md that does not name us as its maker is neither replaced nor reported as written."""
    (report / "README.md").write_text("# Mine\n", encoding="utf-8")
    assert report / "README.md" not in publish(report)
    assert front_page(report) == "# Mine\n"


# Cells.


def test_a_failed_run_shows_how_it_ended_and_no_number(report: Path) -> None:
    """The only cell of its errors that is not empty holds the outcome; its verdict is fail."""
    (line,) = lines(report, "accuracy.md", "euler/broken")
    assert cells(line) == ["`euler/broken`", "f64", "`omega`", STOPPED, *[NOTHING] * 7, "**fail**"]
    (row,) = (
        row
        for row in rows(report, "gates.csv")
        if (row["scene"], row["quantity"]) == ("euler/broken", "omega")
    )
    assert (row["max"], row["mean"], row["ratio"]) == (STOPPED, "", "")


def test_an_error_that_is_no_number_is_shown_as_fail(report: Path) -> None:
    """A NaN is neither zero nor blank in any table, it is counted, and the reason says so."""
    (line,) = lines(report, "accuracy.md", "euler/lost")
    assert cells(line)[3] == "fail"
    assert cells(line)[8] == "fail"
    (line,) = lines(report, "conserved.md", "euler/lost")
    assert "**fail**" in cells(line)
    for line in lines(report, "gates.md", "euler/lost"):
        assert cells(line)[-1].startswith("the error is not a finite number; 10 x attainable")
    assert "2 of 15 without a finite error" in (report / "tables/gates.md").read_text(
        encoding="utf-8"
    )
    assert [row["max"] for row in rows(report, "gates.csv") if row["scene"] == "euler/lost"] == [
        "fail",
        "fail",
    ]


@pytest.mark.parametrize(
    ("scene", "rung", "word"),
    [("euler/generic", "f80", "unavailable"), ("euler/vast", "f32", "refused")],
)
def test_a_run_that_never_began_is_shown(report: Path, scene: str, rung: str, word: str) -> None:
    """It has its row on every page, a word in place of each error, and its reason."""
    (line,) = lines(report, "accuracy.md", scene, f" {rung} ")
    assert cells(line)[3] == word
    assert cells(line)[-1] == f"**{word}**"
    (line,) = lines(report, "conserved.md", scene, f" {rung} ")
    assert cells(line)[2] == f"**{word}**"
    (line,) = lines(report, "gates.md", scene, f" {rung} ")
    assert cells(line)[-1] == f"the reason why {scene} has no number"
    text = (report / "tables" / "accuracy.md").read_text(encoding="utf-8")
    assert f"- `{scene}`, {rung}: **{word}**, the reason why {scene} has no number" in text


def test_the_sheet_holds_a_row_for_every_verdict(report: Path) -> None:
    """The sheet of the gates has a row a verdict with every digit."""
    gates = rows(report, "gates.csv")
    assert len(gates) == len(MIXED)
    assert {row["verdict"] for row in gates} <= set(Status)
    by_place = {(row["scene"], row["rung"], row["quantity"]): row for row in gates}
    for verdict in MIXED:
        row = by_place[verdict.scene, verdict.rung, verdict.quantity]
        if verdict.bound is not None:
            assert float(row["bound"]) == verdict.bound


def pages(report: Path) -> Iterable[str]:
    files = [report / "README.md", *(report / "tables").glob("*.md")]
    return [file.read_text(encoding="utf-8") for file in files]


def test_every_page_names_its_maker_and_says_how_to_remake_it(report: Path) -> None:
    """The first line is the maker's; the last section has the commands and the versions."""
    assert len(list(pages(report))) == 4
    for text in pages(report):
        assert text.splitlines()[0] == MADE_BY
        end = text.partition("## To remake this")[2]
        for needed in ("`make verify`", "`reports/local", "`make reports`", "heyoka 7.13.0"):
            assert needed in end


def test_every_line_of_a_table_has_as_many_cells_as_its_heading(report: Path) -> None:
    """No text of a scene, unit, outcome or reason breaks a table, whatever is in it."""
    nasty = "a|b\n`c` <img> *d* _e_ \\| [f](g) $h$"
    hostile = [
        passed(nasty, "f64", "omega", unit=nasty, reason=stated(Cause.NOT_POSED, nasty)),
        replace(
            unscored(nasty, "f32", "omega", Status.FAIL, nasty),
            reason=stated(Cause.NOT_POSED, nasty),
        ),
    ]
    write(report, [*MIXED, *hostile], [])
    publish(report)
    for text in pages(report):
        for block in text.split("\n\n"):
            table = [line for line in block.splitlines() if line.startswith("|")]
            # A bar ends a cell unless a backslash escapes it that is not escaped itself.
            bars = {len(re.findall(r"\|", re.sub(r"\\.", "", line))) for line in table}
            assert len(bars) <= 1
        assert "<img>" not in text.replace(r"\<", "")


def test_every_status_has_its_meaning_and_its_gravity() -> None:
    """A verdict of any kind can be explained and compared with another one."""
    assert set(index_page._MEANINGS) == set(Status) == set(GRAVITY)


@given(st.floats(min_value=1e-300, max_value=1e300))
@example(9.996)
@example(999.6)
def test_a_figure_has_three_significant_digits(value: float) -> None:
    """It is off by at most half a unit of its third digit, and shows exactly three digits."""
    text = figure(value)
    shown = text.partition("e")[0].replace(".", "").lstrip("0")
    assert len(shown) == 3
    # Half a unit of the third digit is at most 1/200 of the number; the rest is this test's own
    # rounding.
    assert abs(float(text) - value) <= value * (0.005 + 1e-12)
    assert [figure(0.0), figure(None)] == ["0", NOTHING]
