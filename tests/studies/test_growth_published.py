"""Growth measured end to end, of a sound and of a biased integrator; and the published growth."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from taylor_verify.cli import main
from taylor_verify.numbers.precision import rung
from taylor_verify.records.json_text import complete, converted
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.growth import experiment as experiments
from taylor_verify_reports.studies.growth import growth_page as pages
from taylor_verify_reports.studies.growth.errors import PHASE, Measured
from taylor_verify_reports.studies.growth.experiment import course, ensemble_errors, experiment
from taylor_verify_reports.studies.growth.fit import BIAS, Law
from taylor_verify_reports.studies.growth.grown import Ensemble, GrowthOfQuantity
from taylor_verify_reports.studies.growth.growth_page import STUDY
from taylor_verify_reports.studies.growth.question import Question

SHORT = 10**3.5


def question(name: str, periods: float = SHORT, lanes: int = 8, **changed: Any) -> Question:
    return Question(load(name), rung("f64"), periods, lanes, **changed)


def of(ensemble: Ensemble, quantity: str) -> GrowthOfQuantity:
    (one,) = [one for one in ensemble.quantities if one.quantity == quantity]
    return one


def verdict(ensemble: Ensemble, quantity: str) -> Status:
    judged = of(ensemble, quantity).gate
    assert judged is not None
    return judged.verdict


def errors(asked: Question) -> dict[str, np.ndarray]:
    return {one.quantity: one.values for one in ensemble_errors(asked, course(asked))}


# The chain


@pytest.mark.parametrize("name", ["euler/about-max-axis", "kirchhoff/two-real-roots"])
def test_the_integrator_walks(name: str) -> None:
    """No quantity grows faster than a walk at the integrator's own tolerance, and every lane ends."""
    result = experiment(question(name))
    assert result.lost == 0
    assert {one.gate.verdict for one in result.quantities if one.gate} == {Status.PASS}
    # A step rounds its end once, to half a unit in the last place at most, and each of its sums
    # once more, much smaller: a walk of steps of about u. Ten of them would be another integrator.
    assert 0.01 <= of(result, "T").in_walks <= 10


def test_a_coarse_tolerance_is_a_bias() -> None:
    """Truncation dominates at 1e-12: energy and momentum grow as t, the phase as t^2, and gates fail."""
    asked = question("euler/about-max-axis", 1e4, solver="taylor?tol=1e-12")
    result = experiment(asked)
    for name in ("T", "H2", PHASE):
        assert verdict(result, name) is Status.FAIL
        assert of(result, name).word == BIAS
    # What always has one sign has it in every lane.
    drift = errors(asked)["T"][:, -1]
    assert np.all(np.sign(drift) == np.sign(drift[0]))


# What is published


@pytest.fixture
def one_short_ensemble(monkeypatch: pytest.MonkeyPatch) -> None:
    axis, generic = load("euler/about-max-axis"), load("euler/generic")
    monkeypatch.setattr(experiments, "published", lambda: [Question(axis, rung("f64"), 1e5, 4)])
    monkeypatch.setattr(experiments, "long", lambda: [Question(generic, rung("f64"), 1e8, 3)])


@pytest.mark.usefixtures("one_short_ensemble")
def test_publish_writes_data_and_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The page is made of the stored data alone, and the long ensemble stands beside the others.

    The sheet has each quantity of each ensemble, with its interval and its gate, to the last bit.
    """
    call = ["publish", "growth", "--periods", "3163", "--from", str(tmp_path), "--json"]
    assert main(call) == 0
    written = [Path(name) for name in json.loads(capsys.readouterr().out)["written"]]
    assert {file.name for file in written} >= {"growth.json", "growth.md"}
    assert all(file.stat().st_size for file in written)
    page = (tmp_path / STUDY.path).read_text(encoding="utf-8")
    sheet = (tmp_path / "tables/growth.csv").read_text(encoding="utf-8")
    assert STUDY.pages(tmp_path) == {STUDY.path: page, "tables/growth.csv": sheet}
    assert "euler/about-max-axis on f64, taylor" in page
    asked = [(run, row) for run in pages.GROWTH.load(tmp_path).runs for row in run.quantities]
    for cells, (run, row) in zip(csv.DictReader(sheet.splitlines()), asked, strict=True):
        names = (cells["scene"], cells["rung"], cells["quantity"])
        assert names == (run.scene, run.rung, row.quantity)
        ends = ("exponent", "low", "high", "rms_last", "late", "late_low", "late_high")
        numbers = [float(cells[name]) if cells[name] else None for name in ends]
        assert numbers == [row.exponent, row.low, row.high, row.rms[-1], *row.late]
        assert cells["gate"] == (row.gate.verdict.value if row.gate else "")
    before = (tmp_path / pages.GROWTH.name).read_bytes()
    assert main([*call, "--long"]) == 0
    assert (tmp_path / pages.GROWTH.name).read_bytes() == before
    assert "euler/generic on f64, taylor" in (tmp_path / STUDY.path).read_text(encoding="utf-8")


def test_a_number_that_is_not_finite_is_stored_as_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """An ensemble is the same when it is read again; one without a finite error has no numbers."""
    asked = question("euler/about-max-axis", lanes=2)
    nothing = Measured("T", Law.WALK, np.full((2, len(asked.counts)), np.nan))
    whole = experiment(asked)
    monkeypatch.setattr(experiments, "ensemble_errors", lambda asked, end: [nothing])
    lost = experiment(asked)
    for one in (whole, lost):
        assert converted(complete(one), Ensemble) == one
    (row,) = lost.quantities
    assert row.rms == (None,) * len(asked.counts)
    assert row.exponent is row.in_walks is row.gate.chance is None
