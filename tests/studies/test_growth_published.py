"""Growth measured end to end, of a sound and of a biased integrator; and the published growth."""

from __future__ import annotations

import json
import random
from dataclasses import replace
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from taylor_verify.cli import main
from taylor_verify.plotting.picture import plotting
from taylor_verify.plotting.style import PAGE_WIDTH
from taylor_verify.records.json_text import complete, converted
from taylor_verify.records.provenance import Provenance
from taylor_verify.records.status import Status
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.growth import page as pages
from taylor_verify_reports.studies.growth import picture as diagram
from taylor_verify_reports.studies.growth import published
from taylor_verify_reports.studies.growth.document import Ensemble, GrowthOfQuantity, GrowthStudy
from taylor_verify_reports.studies.growth.errors import PHASE
from taylor_verify_reports.studies.growth.experiment import Experiment, QuantityGrowth, experiment
from taylor_verify_reports.studies.growth.fit import BIAS, Law, growth
from taylor_verify_reports.studies.growth.published import Entry
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


ONE = Entry("euler/about-max-axis", "f64", 1e5, 4, "a test")


@pytest.fixture
def one_short_entry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(published, "PUBLISHED", (ONE,))
    monkeypatch.setattr(published, "LONG", (Entry("euler/generic", "f64", 1e8, 3, "long"),))


@pytest.mark.usefixtures("one_short_entry")
def test_publish_writes_data_picture_and_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The page is made of the stored data alone, and no checkpoint is left behind."""
    call = ["publish", "growth", "--periods", "3163", "--from", str(tmp_path), "--json"]
    assert main(call) == 0
    written = [Path(name) for name in json.loads(capsys.readouterr().out)["written"]]
    assert {file.name for file in written} >= {"growth.json", "growth.md"}
    assert all(file.stat().st_size for file in written)
    assert not list((tmp_path / "local" / "growth").glob("*.json"))
    page = (tmp_path / STUDY.path).read_text(encoding="utf-8")
    sheet = (tmp_path / "tables/growth.csv").read_text(encoding="utf-8")
    assert STUDY.pages(tmp_path) == {STUDY.path: page, "tables/growth.csv": sheet}
    assert "euler/about-max-axis on f64, taylor" in page
    assert "](../figures/" in page
    # The long ensemble stands beside the others, and leaves them as they are.
    before = (tmp_path / pages.GROWTH.name).read_bytes()
    assert main([*call, "--long"]) == 0
    assert (tmp_path / pages.GROWTH.name).read_bytes() == before
    assert "euler/generic on f64, taylor" in (tmp_path / STUDY.path).read_text(encoding="utf-8")


@pytest.mark.usefixtures("one_short_entry")
def test_an_interrupted_run_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Stopped between two pieces, the same command ends with the same numbers as one that was not."""
    monkeypatch.setattr("taylor_verify_reports.studies.growth.question.PIECE_PERIODS", 500)
    call = ["publish", "growth", "--periods", "3163", "--from"]
    assert main([*call, str(tmp_path / "whole")]) == 0
    say = "taylor_verify_reports.studies.growth.study.Pieces.__call__"

    def stopped(_progress: object, _label: str, done: int, _of: int) -> None:
        if done == 5:
            raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(say, stopped)
        with pytest.raises((KeyboardInterrupt, SystemExit)):
            raise SystemExit(main([*call, str(tmp_path / "left")]))
    (file,) = (tmp_path / "left" / "local" / "growth").glob("*.json")
    assert json.loads(file.read_text(encoding="utf-8"))["pieces"] == 5
    assert main([*call, str(tmp_path / "left")]) == 0
    runs = [
        json.loads((tmp_path / place / pages.GROWTH.name).read_text(encoding="utf-8"))["runs"]
        for place in ("whole", "left")
    ]
    assert runs[0] == runs[1]


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


@pytest.mark.usefixtures("one_short_entry")
def test_somebody_elses_checkpoint_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A checkpoint that is not this ensemble's stops the command before it computes, and stays."""
    file = tmp_path / "local" / "growth" / ONE.file
    file.parent.mkdir(parents=True)
    file.write_text("{}", encoding="utf-8")
    assert main(["publish", "growth", "--periods", "3163", "--from", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert "expected a checkpoint" in error
    assert str(file) in error
    assert file.read_text(encoding="utf-8") == "{}"


def test_checkpoints_have_names_of_their_own() -> None:
    """No two ensembles keep their checkpoints in one file."""
    entries = (*published.PUBLISHED, *published.LONG)
    assert len({entry.file for entry in entries}) == len(entries)


def test_a_number_that_is_not_finite_is_stored_as_none() -> None:
    """An ensemble is the same when it is read again; one without a finite error has no numbers."""
    result = followed("euler/about-max-axis", lanes=2)
    errors = np.full((2, len(result.steps)), np.nan)
    nothing = growth(np.array(result.question.counts), errors, Law.WALK, 1e-16)
    lost = replace(result, quantities=(QuantityGrowth("T", errors, nothing),))
    for one in (result.ensemble("a test"), lost.ensemble()):
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


# The picture


def run(scene: str, solver: str = "taylor", factor: float = 1.0) -> Ensemble:
    counts = tuple(10 ** (k / 2) for k in range(4, 13))
    rows = {
        "T": tuple(factor * 1e-16 * n**0.5 for n in counts),
        "phase": (None, *(factor * 1e-15 * n**1.5 for n in counts[1:])),
    }
    quantities = tuple(
        GrowthOfQuantity(name, rms, 1.0, 0.5, 0.4, 0.6, 0.99, 8, "", (0.5, 0.4, 0.6), "")
        for name, rms in rows.items()
    )
    steps = tuple(20 * n for n in counts)
    return Ensemble(scene, "", solver, "f64", counts[-1], 8, 1, 6.0, 0, counts, steps, quantities)


def study_of(runs: list[Ensemble]) -> GrowthStudy:
    return GrowthStudy(tuple(runs), (), Provenance())


RUNS = [
    run("euler/about-max-axis"),
    run("euler/about-max-axis", "taylor?tol=1e-12", 1e3),
    run("euler/generic", factor=1.5),
    run("kirchhoff/two-real-roots", factor=1e-3),
    run("kirchhoff/generic", factor=2),
    run("euler/full-tensor", factor=3),
]


def test_each_ensemble_is_a_line_of_its_own() -> None:
    """Left and right, every ensemble is drawn once with its numbers; what is no number is left out."""
    (picture,) = pages.pictures(study_of(RUNS))
    with plotting():
        left, right = picture.figure().axes
    for axes, quantity in ((left, 0), (right, 1)):
        for label, one in zip(diagram.labels_of(RUNS), RUNS, strict=True):
            (line,) = [line for line in axes.get_lines() if line.get_gid() == label]
            expected = [e for e in one.quantities[quantity].rms if e is not None]
            assert line.get_ydata().tolist() == expected
            assert all(map(isfinite, line.get_xdata()))


def test_thin_lines_rise_as_they_are_named() -> None:
    """From the first point of a line on, each is a pure power of time, and stays in its panel."""
    (picture,) = pages.pictures(study_of(RUNS))
    with plotting():
        axes = picture.figure().axes
    for panel, powers in zip(axes, ({0.5, 1.0}, {1.5, 2.0}), strict=True):
        drawn = [line for line in panel.get_lines() if str(line.get_gid()).startswith("power")]
        assert {float(line.get_gid().split()[1]) for line in drawn} == powers
        for line in drawn:
            (x0, x1), (y0, y1) = line.get_xdata(), line.get_ydata()
            power = np.log(y1 / y0) / np.log(x1 / x0)
            assert power == pytest.approx(float(line.get_gid().split()[1]), rel=1e-9)
            assert x1 <= panel.get_xlim()[1] * (1 + 1e-9)
            assert y1 <= panel.get_ylim()[1] * (1 + 1e-9)


def test_powers_are_told_by_their_dashes() -> None:
    """No text stands in a panel, where names of powers would meet: the note says what is dashed."""
    (picture,) = pages.pictures(study_of(RUNS))
    with plotting():
        figure = picture.figure()
    for panel, bias in zip(figure.axes, (1.0, 2.0), strict=True):
        assert not panel.texts
        for line in panel.get_lines():
            if str(line.get_gid()).startswith("power"):
                assert line.is_dashed() == (float(str(line.get_gid()).split()[1]) == bias)
    assert any("dashed" in text.get_text() for text in figure.texts)


def test_nothing_of_the_picture_is_cut_off() -> None:
    """Names of scenes that are long, and six of them, are on the page."""
    (picture,) = pages.pictures(study_of(RUNS))
    with plotting():
        figure = picture.figure()
        everything = figure.get_tightbbox(FigureCanvasAgg(figure).get_renderer())
    assert everything.x0 >= 0
    assert everything.y0 >= 0
    assert everything.x1 <= PAGE_WIDTH


def test_scenes_with_one_ending_keep_their_whole_names() -> None:
    """Two scenes that end alike are told apart; a setting is part of the name."""
    assert diagram.labels_of(RUNS) == [
        "about-max-axis f64",
        "about-max-axis f64 tol=1e-12",
        "euler/generic f64",
        "two-real-roots f64",
        "kirchhoff/generic f64",
        "full-tensor f64",
    ]


def test_without_errors_there_is_no_picture() -> None:
    """Ensembles that are exact have nothing that a logarithmic axis can show."""
    assert pages.pictures(study_of([run("euler/rest", factor=0)])) == []
