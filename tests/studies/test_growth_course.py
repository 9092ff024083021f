"""An ensemble over many periods: its course, its signed errors, and what is published of it."""

from __future__ import annotations

import csv
import json
from fractions import Fraction
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpmath import mp

from taylor_verify.cli import main
from taylor_verify.exact.route import solution
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import exact_value, rung
from taylor_verify.records.json_text import complete, converted
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.growth import experiment as experiments
from taylor_verify_reports.studies.growth import growth_page as pages
from taylor_verify_reports.studies.growth.errors import PHASE, Measured, certain_shifts, lane_errors
from taylor_verify_reports.studies.growth.experiment import course, ensemble_errors, experiment
from taylor_verify_reports.studies.growth.fit import BIAS, Law
from taylor_verify_reports.studies.growth.grown import Ensemble, GrowthOfQuantity
from taylor_verify_reports.studies.growth.growth_page import STUDY
from taylor_verify_reports.studies.growth.question import Question

SHORT = 10**3.5


def question(name: str = "euler/about-max-axis", on: str = "f64", **changed: Any) -> Question:
    return Question(load(name), rung(on), **{"periods": SHORT, "lanes": 4, **changed})


def several_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("taylor_verify_reports.studies.growth.question.PIECE_PERIODS", 400)


# The question


def test_instants_are_half_decades_of_periods() -> None:
    """Instants begin at 100 periods, have a ratio of the root of ten, and are numbers of the rung."""
    asked = question(periods=1e5)
    assert asked.counts == pytest.approx([10 ** (k / 2) for k in range(4, 11)], rel=1e-12)
    for problem in asked.problems:
        ratio = np.array([float(t) for t in problem.given.clock.elapsed]) / asked.period
        assert ratio == pytest.approx(asked.counts, rel=2**-50)
        assert all(problem.rung.holds(t) for t in problem.times)


def test_pieces_lead_to_every_instant(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces go forward, none is longer than is stated, and the instants are among them in order."""
    several_pieces(monkeypatch)
    asked = question(on="f32")
    at = [stops for stops, is_instant in asked.pieces if is_instant]
    assert at == list(zip(*(problem.times for problem in asked.problems), strict=True))
    for i, problem in enumerate(asked.problems):
        times = [Fraction(0), *(stops[i] for stops, _ in asked.pieces)]
        lengths = np.diff([float(t * problem.units.time) for t in times])
        assert np.all(lengths > 0)
        assert np.all(lengths <= 400 * asked.period * (1 + 2**-20))


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"periods": 1000}, "expected at least 3162 periods, got 1000"),
        ({"periods": float("nan")}, "expected at least 3162 periods, got nan"),
    ],
)
def test_what_cannot_be_followed_is_refused(changed: dict[str, Any], message: str) -> None:
    """Too few periods for the gate are named."""
    with pytest.raises(ValueError, match=message):
        question(**changed)


# Errors


def by_name(problem: Problem, states: list[Any], period: float) -> dict[str, np.ndarray]:
    return {one.quantity: one.values for one in lane_errors(problem, states, period)}


@pytest.mark.parametrize("late", [1e-9, -1e-9, 1e-3, -0.2])
def test_the_phase_is_the_shift_of_time(late: float) -> None:
    """States of the exact motion at t - c have the phase 2 pi c over the period, with its sign."""
    asked = question("euler/generic", on="f80", lanes=2)
    problem = asked.problems[1]
    shift = Fraction(late)
    elapsed = [t - shift for t in problem.given.clock.elapsed]
    with mp.workdps(40):
        omega = solution(problem.given).motion(elapsed, 30)["omega"]
        inertia = [mp.convert(problem.given.body.inertia[i][i]) for i in range(3)]  # type: ignore[union-attr]
        states = [
            tuple(
                problem.rung.round(exact_value(inertia[i] * row[i]) / problem.units.momentum)
                for i in range(3)
            )
            for row in omega
        ]
    phase = by_name(problem, states, asked.period)[PHASE]
    # The states are rounded: u over the slowest rate, of which this orbit has a tenth per unit of time.
    rounding = 2 * pi / asked.period * 10 * float(problem.rung.unit_roundoff) * 10
    assert phase == pytest.approx(2 * pi * late / asked.period, rel=2e-6, abs=rounding)


def test_what_a_lane_did_not_reach_is_no_number() -> None:
    """A lane that is lost after its first instant has errors there and none later."""
    asked = question(lanes=2)
    (first,) = asked.problems[:1]
    followed = course(asked)
    states = [followed.samples[0][0][0], None, None, None]  # type: ignore[index]
    for name, values in by_name(first, states, asked.period).items():
        assert np.isfinite(values).tolist() == [True, False, False, False], name


def test_without_a_closed_form_the_drifts_are_measured() -> None:
    """A body without a closed form has no phase, and all of its conserved quantities."""
    result = experiment(question("kirchhoff/general-body", lanes=2))
    assert {one.quantity for one in result.quantities} == {"T", "F2", "FG"}
    assert all(one.gate is not None for one in result.quantities)


def test_a_phase_that_may_be_off_by_a_period_is_not_told() -> None:
    """No phase is given beyond a quarter of a period, or if t^2 could have led there unseen."""
    times = [Fraction(10) ** k for k in range(4)]
    sure = certain_shifts(times, np.array([1e-6, -1e-4, 1e-3, 0.1]), 1.0)
    assert sure.tolist() == [1e-6, -1e-4, 1e-3, 0.1]
    # 0.01 could have become 1, which looks like 0.001 if 1 is a period.
    lost = certain_shifts(times, np.array([1e-6, 1e-2, 1e-3, 1e-3]), 1.0)
    assert np.isnan(lost).tolist() == [False, False, True, True]
    assert np.isnan(certain_shifts(times, np.array([1e-6, 0.3, 0, 0]), 1.0)).tolist() == [
        False,
        True,
        True,
        True,
    ]


# Measured end to end


def asked_of(name: str, periods: float = SHORT, lanes: int = 8, **changed: Any) -> Question:
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
    result = experiment(asked_of(name))
    assert result.lost == 0
    assert {one.gate.verdict for one in result.quantities if one.gate} == {Status.PASS}
    # A step rounds its end once, to half a unit in the last place at most, and each of its sums
    # once more, much smaller: a walk of steps of about u. Ten of them would be another integrator.
    assert 0.01 <= of(result, "T").in_walks <= 10


def test_a_coarse_tolerance_is_a_bias() -> None:
    """Truncation dominates at 1e-12: energy and momentum grow as t, the phase as t^2, and gates fail."""
    asked = asked_of("euler/about-max-axis", 1e4, solver="taylor?tol=1e-12")
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
    asked = asked_of("euler/about-max-axis", lanes=2)
    nothing = Measured("T", Law.WALK, np.full((2, len(asked.counts)), np.nan))
    whole = experiment(asked)
    monkeypatch.setattr(experiments, "ensemble_errors", lambda asked, end: [nothing])
    lost = experiment(asked)
    for one in (whole, lost):
        assert converted(complete(one), Ensemble) == one
    (row,) = lost.quantities
    assert row.rms == (None,) * len(asked.counts)
    assert row.exponent is row.in_walks is row.gate.chance is None
