"""Growth measured end to end, of a sound and of a biased integrator; and the published growth."""

from __future__ import annotations

import json
import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from taylor_verify.cli import main
from taylor_verify.records.json_text import complete, converted
from taylor_verify.records.status import Status
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.growth import page as pages
from taylor_verify_reports.studies.growth import published
from taylor_verify_reports.studies.growth.document import Ensemble
from taylor_verify_reports.studies.growth.errors import PHASE
from taylor_verify_reports.studies.growth.experiment import Experiment, QuantityGrowth, experiment
from taylor_verify_reports.studies.growth.fit import BIAS, Law, growth
from taylor_verify_reports.studies.growth.question import Question
from taylor_verify_reports.studies.growth.study import STUDY

SHORT = 10**3.5


def followed(name: str, periods: float = SHORT, lanes: int = 8, **changed: Any) -> Experiment:
    return experiment(Question(load(name), rung("f64"), periods, lanes, **changed))


def of(result: Experiment, quantity: str) -> QuantityGrowth:
    (one,) = [one for one in result.quantities if one.quantity == quantity]
    return one


def verdict(result: Experiment, quantity: str) -> Status:
    judged = of(result, quantity).growth.gate
    assert judged is not None
    return judged.verdict


# The chain


@pytest.mark.parametrize("name", ["euler/about-max-axis", "kirchhoff/two-real-roots"])
def test_the_integrator_walks(name: str) -> None:
    """No quantity grows faster than a walk at the integrator's own tolerance, and every lane ends."""
    result = followed(name)
    assert result.lost == 0
    assert {verdict(result, one.quantity) for one in result.quantities if one.growth.gate} == {
        Status.PASS
    }
    walks = {row.quantity: row.in_walks for row in result.ensemble().quantities}
    # A step rounds its end once, to half a unit in the last place at most, and each of its sums
    # once more, much smaller: a walk of steps of about u. Ten of them would be another integrator.
    assert 0.01 <= walks["T"] <= 10


def test_a_coarse_tolerance_is_a_bias() -> None:
    """Truncation dominates at 1e-12: energy and momentum grow as t, the phase as t^2, and gates fail."""
    result = followed("euler/about-max-axis", 1e4, solver="taylor?tol=1e-12")
    for name in ("T", "H2", PHASE):
        assert verdict(result, name) is Status.FAIL
        assert of(result, name).growth.exponent.word == BIAS
    # What always has one sign has it in every lane.
    drift = of(result, "T").errors[:, -1]
    assert np.all(np.sign(drift) == np.sign(drift[0]))


def test_one_lane_alone_is_the_same_lane() -> None:
    """The errors of a lane do not change with the ensemble around it."""
    few, many = followed("euler/about-max-axis", lanes=2), followed("euler/about-max-axis", lanes=5)
    for one in few.quantities:
        assert np.array_equal(one.errors, of(many, one.quantity).errors[:2])


@pytest.mark.slow
def test_brouwers_law_to_a_hundred_thousand_periods() -> None:
    """Three decades of f64: drifts grow as the root of time, the phase as its three halves."""
    result = followed("euler/about-max-axis", 1e5, 16)
    for name, power in (("T", 0.5), ("H2", 0.5), (PHASE, 1.5)):
        assert verdict(result, name) is Status.PASS
        # Half way to the next word. The slopes of sixteen lanes have a mean that scatters by 0.04, and
        # another processor draws other roundings.
        assert abs(of(result, name).growth.exponent.value - power) <= 0.25


def mean_rounding(coefficient: float, part: int) -> float:
    """Return the mean rounding of products with random 53-bit numbers of one quarter of their range."""
    whole, draw = coefficient.as_integer_ratio()[0], random.Random(part)
    quarter, errors = 2**50, []
    for _ in range(20_000):
        exact = whole * draw.randrange(2**52 + part * quarter, 2**52 + (part + 1) * quarter)
        unit = 1 << (exact.bit_length() - 53)
        quotient, rest = divmod(exact, unit)
        is_up = rest > unit // 2 or (rest == unit // 2 and quotient % 2)
        errors.append(((unit - rest) if is_up else -rest) / unit)
    return sum(errors) / len(errors)


def test_products_with_a_small_fraction_lean_to_one_side() -> None:
    """The mean rounding of products with 1/6 is a tenth of a last place; of other numbers it is zero."""
    # One rounding is uniform within half a unit: the mean of 20000 is known to 0.29/sqrt(20000).
    noise = 4.5 * 0.29 / 20_000**0.5
    for coefficient in (0.1683725917, np.pi / 20, 2**0.5 / 8):
        assert max(abs(mean_rounding(coefficient, part)) for part in range(4)) <= noise
    # 1/6 as f64 has it, and as the difference of its 1/3 and 1/2, which lies on the other side.
    for sixth in (1 / 6, 1 / 2 - 1 / 3):
        leans = [abs(mean_rounding(sixth, part)) for part in range(4)]
        assert max(leans) >= 0.1
        # Three equal remainders have a mean that is off by half their distance at most.
        assert max(leans) <= 1 / 6 + noise


# What is published


@pytest.fixture
def one_short_ensemble(monkeypatch: pytest.MonkeyPatch) -> None:
    axis, generic = load("euler/about-max-axis"), load("euler/generic")
    monkeypatch.setattr(published, "published", lambda: [Question(axis, rung("f64"), 1e5, 4)])
    monkeypatch.setattr(published, "long", lambda: [Question(generic, rung("f64"), 1e8, 3)])


@pytest.mark.usefixtures("one_short_ensemble")
def test_publish_writes_data_and_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The page is made of the stored data alone, and the long ensemble stands beside the others."""
    call = ["publish", "growth", "--periods", "3163", "--from", str(tmp_path), "--json"]
    assert main(call) == 0
    written = [Path(name) for name in json.loads(capsys.readouterr().out)["written"]]
    assert {file.name for file in written} >= {"growth.json", "growth.md"}
    assert all(file.stat().st_size for file in written)
    page = (tmp_path / STUDY.path).read_text(encoding="utf-8")
    sheet = (tmp_path / "tables/growth.csv").read_text(encoding="utf-8")
    assert STUDY.pages(tmp_path) == {STUDY.path: page, "tables/growth.csv": sheet}
    assert "euler/about-max-axis on f64, taylor" in page
    before = (tmp_path / pages.GROWTH.name).read_bytes()
    assert main([*call, "--long"]) == 0
    assert (tmp_path / pages.GROWTH.name).read_bytes() == before
    assert "euler/generic on f64, taylor" in (tmp_path / STUDY.path).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["growth", "--periods", "10"], "expected at least 3162 periods, got 10"),
        (["growth", "--periods", "many"], "expected a number of periods, got 'many'"),
        (["--periods", "1e4"], "expected --periods with `publish growth`, got it with no study"),
        (["prices", "--long"], "expected --long with `publish growth`, got it with prices"),
        (["growth", "--period", "3"], "expected an option, got --period; did you mean --periods?"),
        (["growth", "--period=3"], "expected an option, got --period; did you mean --periods?"),
        (["--lon", "growth"], "expected an option, got --lon; did you mean --long?"),
    ],
)
def test_a_wrong_call_is_refused(
    options: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Too few periods, no number, options misspelt or without their study: exit status 2, one line."""
    assert main(["publish", *options, "--from", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert "expected a study" not in error


def test_a_number_that_is_not_finite_is_stored_as_none() -> None:
    """An ensemble is the same when it is read again; one without a finite error has no numbers."""
    result = followed("euler/about-max-axis", lanes=2)
    errors = np.full((2, len(result.steps)), np.nan)
    nothing = growth(np.array(result.question.counts), errors, Law.WALK, 1e-16)
    lost = replace(result, quantities=(QuantityGrowth("T", errors, nothing),))
    for one in (result.ensemble(), lost.ensemble()):
        assert converted(complete(one), Ensemble) == one
    (row,) = lost.ensemble().quantities
    assert row.rms == (None,) * len(result.steps)
    assert row.exponent is row.in_walks is row.gate.chance is None


def test_a_file_of_something_else_is_named(tmp_path: Path) -> None:
    """Stored ensembles without their runs are a ValueError that names file and key."""
    file = tmp_path / pages.GROWTH.name
    file.parent.mkdir()
    file.write_text('{"runs": [{"scene": "euler/generic"}], "left_out": []}', encoding="utf-8")
    message = r"expected a key digest, got none @ runs\[0\] @ .*growth\.json"
    with pytest.raises(ValueError, match=message):
        STUDY.pages(tmp_path)
