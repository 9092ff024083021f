"""A result compared with earlier verdicts, and written for a CI, without the command line."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

import taylor_verify
from taylor_verify.batch.comparison import compare_with_baseline, shown_verdicts
from taylor_verify.batch.judgements import Judgements
from taylor_verify.batch.report import (
    compare_with_published,
    read_report,
    remarks,
    write_junit,
)
from taylor_verify.batch.selection import select
from taylor_verify.judge.judgement import NotPassed
from taylor_verify.records.status import Status
from taylor_verify.report.folder import write_report

SCENES = ["euler/rest", "euler/generic"]
LONG = "extremes/euler-separatrix-long"


@pytest.fixture(scope="module")
def results() -> Judgements:
    """Two scenes on f64, run one after the other."""
    judgements = [taylor_verify.run(scene) for scene in SCENES]
    return Judgements(tuple(judgements), select(SCENES), "taylor")


def changed(results: Judgements, scene: str, quantity: str, **fields: Any) -> Judgements:
    """Return the result with other fields in one verdict."""
    judgements = []
    for judgement in results:
        verdicts = tuple(
            replace(v, **fields) if (v.scene, v.quantity) == (scene, quantity) else v
            for v in judgement.verdicts
        )
        judgements.append(replace(judgement, verdicts=verdicts))
    assert [v for one in judgements for v in one.verdicts] != list(results.verdicts)
    return replace(results, judgements=tuple(judgements))


@pytest.fixture
def baseline(tmp_path: Path, results: Judgements) -> Path:
    """The document of `run --json` as a file."""
    file = tmp_path / "baseline.json"
    file.write_text(json.dumps(results.document()), encoding="utf-8")
    return file


def test_an_error_that_grew_is_a_regression(baseline: Path, results: Judgements) -> None:
    """It fails by name, also where the gate itself still passes."""
    worse = changed(results, "euler/generic", "omega", max=1e-3)
    comparison = compare_with_baseline(worse, baseline)
    (failure,) = comparison.failures
    assert "euler/generic f64 omega max" in str(failure)
    assert (comparison.exit_status, comparison.passed) == (1, False)
    with pytest.raises(NotPassed, match="euler/generic f64 omega max"):
        comparison.raise_for_failure()


def test_only_what_was_asked_for_again_is_compared(baseline: Path, results: Judgements) -> None:
    """A scene that was not named may be missing; of another solver nothing is compared."""
    (_, second) = results.judgements
    one = Judgements((second,), select(["euler/generic"]), "taylor")
    assert compare_with_baseline(one, baseline).passed
    assert not compare_with_baseline(replace(one, selection=select(SCENES)), baseline).passed
    other = compare_with_baseline(replace(one, solver="scipy:RK45"), baseline)
    assert (other.compared, other.exit_status) == (0, 3)
    with pytest.raises(NotPassed, match="no row was compared"):
        other.raise_for_failure()


def test_a_report_is_compared_both_ways(tmp_path: Path, results: Judgements) -> None:
    """Against the folder it wrote a result passes; an error that shrank departs too."""
    paths = write_report(tmp_path, results)
    assert {tmp_path / "data" / "verdicts.json", tmp_path / "tables" / "accuracy.md"} <= set(paths)
    assert len(read_report(tmp_path).verdicts) == len(results.verdicts)
    comparison = compare_with_published(results, tmp_path)
    assert (comparison.passed, comparison.compared) == (True, len(results.verdicts))
    large = changed(results, "euler/generic", "omega", max=1e-3, bound=1.0)
    write_report(tmp_path, large)
    failures = compare_with_published(results, tmp_path).failures
    assert any("euler/generic f64 omega max" in str(failure) for failure in failures)
    with pytest.raises(FileNotFoundError):
        compare_with_published(results, tmp_path / "none")


def colour(file: Path) -> str:
    root = ElementTree.parse(file).getroot()
    return "green" if (root.get("failures"), root.get("errors")) == ("0", "0") else "red"


def test_a_junit_file_is_as_red_as_the_result(
    tmp_path: Path, baseline: Path, results: Judgements
) -> None:
    """A failure and a regression make it red; what came as expected does not."""
    file = tmp_path / "junit.xml"
    write_junit(file, results)
    assert colour(file) == "green"
    write_junit(file, changed(results, "euler/generic", "omega", verdict=Status.FAIL))
    assert colour(file) == "red"
    worse = changed(results, "euler/generic", "omega", max=1e-3)
    write_junit(file, worse, compare_with_baseline(worse, baseline))
    assert colour(file) == "red"
    expected = taylor_verify.run_many([LONG])
    write_junit(file, expected)
    assert colour(file) == "green"
    assert remarks(expected) == []
    assert len(shown_verdicts(expected)) == len(expected.verdicts) - 1
    write_junit(file, expected[0])
    assert colour(file) == "red"
