"""The page of the hard scenes: verdicts and mismatches, the worst of each family, the reach."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from math import nan
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from builders.studies.hard import ALL, DRIFT, MISMATCH, REACH, WHY, row, study, worst_of
from builders.studies.stored import publish_document
from builders.verdicts import passed
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.cli import main
from taylor_verify.records.status import Status
from taylor_verify.scenes import library
from taylor_verify.words.cells import NOTHING
from taylor_verify_reports.studies.hard import extremes as measure
from taylor_verify_reports.studies.hard import hard_page as pages
from taylor_verify_reports.studies.hard import reach, search
from taylor_verify_reports.studies.hard.hard_page import STUDY, store_scenes
from taylor_verify_reports.studies.hard.hard_scenes import HARD, last_value


def lines(text: str, *words: str) -> list[str]:
    return [
        line for line in text.splitlines() if line.startswith("|") and all(w in line for w in words)
    ]


@pytest.fixture(scope="module")
def published(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("published")
    publish_document(place, STUDY, HARD, study())
    return place


@pytest.fixture
def page(published: Path) -> str:
    return (published / STUDY.path).read_text(encoding="utf-8")


# Verdicts


def test_a_mismatch_stands_out(page: str) -> None:
    """The cell has the failure, its count is bold, and the page begins with the sentence."""
    line, reason = lines(page, "`vast`")
    assert "**fail**" in line
    assert "**0 of 1**" in line
    assert "**refused**" in reason
    assert "1 of 2 verdicts other than pass were expected. **1 mismatches**:" in page
    assert MISMATCH in page


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
    """All extremes of float64 are run; a mismatch is written too, and is status 1; the search stays."""
    scene = "extremes/euler-needle"
    asked: list[str] = []

    def answered(jobs: list[Any], *_: Any) -> list[Any]:
        asked.extend(job.name for job in jobs)
        return [SimpleNamespace(verdicts=(passed(scene, "f64", "omega", verdict=verdict),))]

    def followed(finished: Callable[[str], None]) -> Any:
        finished("axis 1e-1")
        return REACH

    monkeypatch.setattr("taylor_verify_reports.studies.hard.extremes.judge_all", answered)
    monkeypatch.setattr(reach, "measure", followed)
    HARD.write(tmp_path, study())
    call = ["publish", "hard", "--from", str(tmp_path), "--json"]
    assert main(call) == status
    captured = capsys.readouterr()
    assert str(tmp_path / STUDY.path) in json.loads(captured.out)["written"]
    assert {scene, "extremes/worst/euler-gaps"} < set(asked)
    stored = HARD.load(tmp_path)
    assert len(stored.mismatches) == status
    assert (stored.reach, stored.search, stored.worst) == (REACH, study().search, study().worst)
    assert (f"got {verdict.value} @ {scene} f64 omega" in captured.err) == bool(status)
    assert "axis 1e-1" in captured.err


# The worst


def test_a_search_replaces_the_stored_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`publish hard --runs` stores the new worst rows, and its scenes in place of the shipped ones."""
    shipped, asked = tmp_path / "cases" / library.WORST, []

    def searched(runs: int, seed: int, finished: Callable[[str], None]) -> list[Any]:
        asked.append((runs, seed))
        return [worst_of("euler-c", 4.5)]

    store_scenes(shipped, {"euler-old": "1\n"})
    monkeypatch.setattr(search, "search_all", searched)
    monkeypatch.setattr(library, "cases_directory", lambda: tmp_path / "cases")
    monkeypatch.setattr(measure, "extremes", lambda progress: SimpleNamespace(exit_status=0))
    monkeypatch.setattr(measure, "study", lambda results, rows: study(mismatches=()))
    monkeypatch.setattr(reach, "measure", lambda finished: ())
    assert main(["publish", "hard", "--runs", "40", "--seed", "2", "--from", str(tmp_path)]) == 0
    stored = HARD.load(tmp_path)
    assert stored.search is not None
    assert asked == [(40, 2)] == [(stored.search.runs, stored.search.seed)]
    assert [one.name for one in stored.worst] == ["euler-c"]
    texts = {file.name: file.read_text(encoding="utf-8") for file in shipped.iterdir()}
    assert texts == {"euler-c.toml": worst_of("euler-c", 4.5).scene_text}


# The reach


ERRORS = st.lists(st.floats(0, 10) | st.sampled_from([None, nan, 1e-3, 1e-6, 1e-12]), min_size=3)


@given(st.lists(ERRORS.map(lambda errors: errors[:3]), min_size=1, max_size=6), st.integers(1, 15))
def test_a_reach_is_of_all_that_is_easier(table: list[list[float]], digits: int) -> None:
    """Every error up to the returned value is small enough, and the next one is not."""
    rows = [replace(row(str(k), "f64"), errors=tuple(e)) for k, e in enumerate(table)]
    last = last_value(rows, 10, digits)
    count = 0 if last is None else int(last) + 1
    good = [errors[1] is not None and errors[1] <= 10.0**-digits for errors in table]
    assert all(good[:count])
    assert not any(good[count : count + 1])


def test_each_rung_has_its_reach(page: str) -> None:
    """The cells have the last values with a mark at the end of the tried ones, and the ended run a line."""
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in page.splitlines()]
    assert ["a body beside something", "d", "f32", "1e-2", "1e-1", NOTHING, "1e-1"] in cells
    last = "1e-3 \N{RIGHTWARDS ARROW}"
    assert ["a body beside something", "d", "f64", last, last, last, last] in cells
    assert "figures/hard-reach.svg" in page
    assert "axis 1e-2, f32: the run stopped: too many steps. It counts as lost." in page
    assert "6 runs. In 1 of them the rung could not represent the motion" in page


def test_the_sheet_has_every_quantity() -> None:
    """A row for each verdict with every digit, what was expected and whether it came."""
    rows = csv.DictReader(pages.sheet(study()).splitlines())
    cells = {(r["scene"], r["quantity"]): r for r in rows}
    assert set(cells) == {(v.scene, v.quantity) for v in ALL}
    assert float(cells["extremes/near", "T"]["max"]) == DRIFT.max
    impulse = cells["extremes/vast", "impulse"]
    assert (impulse["max"], impulse["expected"], impulse["as_expected"]) == (
        "fail",
        "refused",
        "no",
    )
    assert cells["extremes/long", "omega"]["why_expected"] == WHY
