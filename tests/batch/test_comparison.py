"""A result compared with earlier verdicts, and written for a CI, without the command line."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

import taylor_verify
from taylor_verify.batch.chosen_scenes import select
from taylor_verify.batch.comparison import shown_verdicts
from taylor_verify.batch.earlier_file import read_baseline
from taylor_verify.batch.judgements import Judgements
from taylor_verify.batch.report import (
    remarks,
    write_junit,
)
from taylor_verify.records.status import Status

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
    write_junit(file, worse, read_baseline(baseline).compare_as_baseline(worse))
    assert colour(file) == "red"
    expected = taylor_verify.run_many([LONG])
    write_junit(file, expected)
    assert colour(file) == "green"
    assert remarks(expected) == []
    assert len(shown_verdicts(expected)) == len(expected.verdicts) - 1
    write_junit(file, expected[0])
    assert colour(file) == "red"
