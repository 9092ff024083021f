"""The page of the extremes: verdicts, expected verdicts, and every mismatch."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from builders.studies.extremes import ALL, DRIFT, FORESEEN, MISMATCH, VACUOUS, WHY, study
from builders.studies.stored import publish_document
from builders.verdicts import passed

from taylor_verify.cli import main
from taylor_verify.records import store
from taylor_verify.records.status import Status
from taylor_verify.records.store import write
from taylor_verify.words.page import MADE_BY
from taylor_verify_reports.studies.extremes import page as extremes
from taylor_verify_reports.studies.extremes.study import STUDY
from taylor_verify_reports.studies.report import publish


def lines(text: str, *words: str) -> list[str]:
    return [
        line for line in text.splitlines() if line.startswith("|") and all(w in line for w in words)
    ]


@pytest.fixture
def page(tmp_path: Path) -> str:
    publish_document(tmp_path, STUDY, extremes.EXTREMES, study())
    return (tmp_path / STUDY.path).read_text(encoding="utf-8")


def test_what_is_stored_reads_back(tmp_path: Path) -> None:
    """Verdicts without their seconds, expectations, titles and what made them are the same again."""
    publish_document(tmp_path, STUDY, extremes.EXTREMES, study())
    loaded = extremes.EXTREMES.load(tmp_path)
    stored = [
        replace(v, seconds=None, provenance={"scene": f"digest of {v.scene}"})
        for v in study().verdicts
    ]
    assert loaded == replace(study(), verdicts=tuple(stored))
    assert [verdict.expected for verdict in loaded.verdicts] == list(FORESEEN.values())
    assert [verdict.is_met for verdict in loaded.verdicts] == [True, True, True, False]
    assert loaded.titles["extremes/long"] == "Title of extremes/long"


def test_a_row_that_was_compared_with_nothing_is_no_mismatch(tmp_path: Path) -> None:
    """A rung that the machine lacks is no mismatch, in the file and on the page."""
    absent = passed("extremes/near", "f32", "omega", verdict=Status.UNAVAILABLE)
    publish_document(tmp_path, STUDY, extremes.EXTREMES, study((absent,), ()))
    (row,) = store.read_document(tmp_path / extremes.EXTREMES.name)["verdicts"]
    assert row["expected"] is None
    (verdict,) = extremes.EXTREMES.load(tmp_path).verdicts
    assert verdict.expected is None
    assert verdict.is_met


def test_a_row_of_an_earlier_version_has_its_reason(tmp_path: Path) -> None:
    """A row whose reason is a sentence alone keeps it on the page and in the file."""
    odd = passed("extremes/odd", "f64", "omega", verdict=Status.UNDECIDED)
    publish_document(tmp_path, STUDY, extremes.EXTREMES, study((odd,), ()))
    file = tmp_path / extremes.EXTREMES.name
    document = store.read_document(file)
    (row,) = document["verdicts"]
    row["because"] = "the truth is wider than the bound"
    del row["reason"]
    file.write_text(json.dumps(document), encoding="utf-8")
    assert "the truth is wider than the bound" in STUDY.pages(tmp_path)[STUDY.path]
    publish_document(tmp_path, STUDY, extremes.EXTREMES, extremes.EXTREMES.load(tmp_path))
    (again,) = store.read_document(file)["verdicts"]
    assert again["reason"]["remarks"][0]["text"] == row["because"] == again["because"]


def test_a_scene_is_a_line_with_its_worst(page: str) -> None:
    """The line has title, max and mean with the time, the largest ratio, and the count of expected rows."""
    (line,) = lines(page, "`near`")
    for part in ("Title of extremes/near", "3.00, 2.00 @ 7", "0.750 (`T`)", "| pass", "2 of 2"):
        assert part in line


def test_an_answer_that_is_no_pass_has_its_reason(page: str) -> None:
    """The verdict is bold in its cell, and listed below with the expected verdict and the reason."""
    row, reason = lines(page, "`long`")
    assert "3.00, 2.00 @ 7 **vacuous**" in row
    assert "1 of 1" in row
    assert "| **vacuous** | vacuous" in reason
    assert WHY in reason
    assert "3.00" in reason


def test_a_mismatch_stands_out(page: str) -> None:
    """The cell has the failure, its count is bold, and the page begins with the sentence."""
    row, reason = lines(page, "`vast`")
    assert "**fail**" in row
    assert "**0 of 1**" in row
    assert "**refused**" in reason
    assert "1 of 2 verdicts other than pass were expected. **1 mismatches**:" in page
    assert MISMATCH in page


def test_a_pass_that_was_not_expected_is_told_too(tmp_path: Path) -> None:
    """A row that was foreseen to be vacuous and passed is a mismatch, with its reason."""
    lucky = replace(VACUOUS, verdict=Status.PASS)
    publish_document(tmp_path, STUDY, extremes.EXTREMES, study((lucky,), ("a mismatch",)))
    (_, reason) = lines((tmp_path / STUDY.path).read_text(encoding="utf-8"), "`long`")
    assert "| pass" in reason
    assert "**vacuous**" in reason


def test_what_was_not_run_and_what_made_it_are_told(page: str) -> None:
    """A run that is left out has its reason; versions, processor and command end the page."""
    assert "`extremes/endless`, mp237: it takes a week" in page
    end = page.rpartition("## ")[2]
    for part in ("heyoka 7.13.0", "Machine: A chip", "By `taylor-verify run`", "extremes"):
        assert part in end
    assert page.splitlines()[0] == MADE_BY


def test_the_sheet_has_every_quantity(tmp_path: Path) -> None:
    """A row for each verdict with every digit, what was expected and whether it came."""
    publish_document(tmp_path, STUDY, extremes.EXTREMES, study())
    text = (tmp_path / "tables/extremes.csv").read_text(encoding="utf-8")
    cells = {(r["scene"], r["quantity"]): r for r in csv.DictReader(text.splitlines())}
    assert set(cells) == {(v.scene, v.quantity) for v in ALL}
    assert float(cells["extremes/near", "T"]["max"]) == DRIFT.max
    impulse = cells["extremes/vast", "impulse"]
    assert (impulse["max"], impulse["expected"], impulse["as_expected"]) == (
        "fail",
        "refused",
        "no",
    )
    assert cells["extremes/long", "omega"]["why_expected"] == WHY


def test_publish_remakes_it_from_the_data_alone(tmp_path: Path) -> None:
    """The page is remade with the tables of a run, and linked from both; without data there is none."""
    write(tmp_path, [passed("euler/a", "f64", "omega")], [])
    publish(tmp_path)
    assert not (tmp_path / STUDY.path).exists()
    paths = publish_document(tmp_path, STUDY, extremes.EXTREMES, study())
    before = {path: path.read_bytes() for path in paths}
    for path in paths[1:]:
        path.unlink()
    publish(tmp_path)
    assert {path: path.read_bytes() for path in paths} == before
    assert "](tables/extremes.md)" in (tmp_path / "README.md").read_text(encoding="utf-8")
    index = (tmp_path / "tables" / "README.md").read_text(encoding="utf-8")
    assert "[extremes.md](extremes.md)" in index
    assert "[csv](extremes.csv)" in index


def test_rows_that_are_none_are_refused(tmp_path: Path) -> None:
    """A file with something else in it is a ValueError that names the file."""
    file = tmp_path / extremes.EXTREMES.name
    file.parent.mkdir()
    file.write_text('{"verdicts": [{"scene": "a"}], "versions": {}}', encoding="utf-8")
    fault = r"expected a key solver, got none @ verdicts\[0\] @ .*extremes\.json"
    with pytest.raises(ValueError, match=fault):
        STUDY.pages(tmp_path)


@pytest.mark.parametrize(
    ("verdict", "status"), [(Status.PASS, 0), (Status.VACUOUS, 1), (Status.FAIL, 1)]
)
def test_the_command_fails_at_a_mismatch(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    verdict: Status,
    status: int,
) -> None:
    """All extremes of float64 are asked for; what was not foreseen is written too, and is status 1."""
    scene = "extremes/euler-needle"
    asked: list[str] = []

    def answered(jobs: list[Any], *_: Any) -> list[Any]:
        asked.extend(job.name for job in jobs)
        row = passed(scene, "f64", "omega", verdict=verdict)
        return [SimpleNamespace(verdicts=(row,))]

    monkeypatch.setattr("taylor_verify_reports.studies.extremes.measure.judge_all", answered)
    call = ["publish", "extremes", "--from", str(tmp_path), "--json"]
    assert main(call) == status
    captured = capsys.readouterr()
    assert len(json.loads(captured.out)["written"]) == 3
    assert {scene, "extremes/worst/euler-gaps"} < set(asked)
    stored = store.read_document(tmp_path / extremes.EXTREMES.name)
    assert len(stored["mismatches"]) == status
    assert (f"got {verdict.value} @ {scene} f64 omega" in captured.err) == bool(status)
