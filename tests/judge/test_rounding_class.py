"""A published number may be another draw of the same random walk, and nothing else."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders import reports, verdicts

from taylor_verify.cli import main
from taylor_verify.judge import rounding_class
from taylor_verify.judge.rounding_class import FACTOR, LEVEL, compare
from taylor_verify.records.reason import Cause, stated
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Pairs of runs; that none of n leaves its class says with 95 % that the rate is below 3/n.
PAIRS = 20_000
STEPS = 200


def row(**changed: Any) -> Verdict:
    """A published error of half of what is attainable."""
    return verdicts.row(**{"max": 5e-15, "mean": 2e-15, "final": 1e-15, "ratio": 0.6, **changed})


def departures_between(old: list[Verdict], new: list[Verdict]) -> list[str]:
    return [str(departure) for departure in compare(old, new).departures]


# The rate of false alarms, on walks whose steps are those that attainable counts.


def walk(rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Errors and attainable of a conserved quantity: every step's rounding stays."""
    steps = rng.standard_normal((PAIRS, STEPS))
    return np.abs(np.cumsum(steps, axis=1)), np.sqrt(np.arange(1, STEPS + 1))


def secular(rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Errors of a phase that drifts at the rate of the walk: a rounding at j has grown to k - j at k."""
    steps = rng.standard_normal((PAIRS, STEPS))
    grown = np.arange(1, STEPS + 1)
    return np.abs(np.cumsum(np.cumsum(steps, axis=1), axis=1)), np.sqrt(np.cumsum(grown**2.0))


def unstable(rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Errors of an orbit that magnifies by e in five steps: the first few roundings are all that counts."""
    steps = rng.standard_normal((PAIRS, STEPS))
    growth = np.exp(np.arange(STEPS) / 5)
    errors = np.abs(np.cumsum(steps / growth, axis=1)) * growth
    return errors, np.sqrt(np.cumsum(growth**-2.0)) * growth


def ratios(model: Any, seed: int) -> Floats:
    errors, attainable = model(np.random.default_rng(seed))
    largest: Floats = np.max(errors / attainable, axis=1)
    return largest


def share_out(old: Floats, new: Floats, factor: float, level: float) -> float:
    """The share of pairs that are out of a class of this factor and level."""
    up = new > factor * np.maximum(old, level)
    down = old > factor * np.maximum(new, level)
    return float(np.mean(up | down))


@pytest.mark.parametrize("model", [walk, secular, unstable])
def test_two_draws_of_one_walk_are_in_one_class(model: Any) -> None:
    """None of the pairs leaves the class, whatever carries the roundings on; some would leave a
    class without a level or with a factor of two, so that the walks do spread."""
    old, new = ratios(model, 1), ratios(model, 2)
    assert share_out(old, new, FACTOR, LEVEL) == 0
    assert share_out(old, new, 2.0, LEVEL) > 1e-3


def test_no_factor_is_a_class_without_a_level() -> None:
    """The maximum of a walk in one unstable direction is a single Gaussian: the ratio of two such
    exceeds any factor f with probability (4/pi) arctan(1/f), one way or the other."""
    rng = np.random.default_rng(3)
    old, new = np.abs(rng.standard_normal((2, PAIRS)))
    expected = 4 / math.pi * math.atan(1 / FACTOR)
    # Five standard deviations of a count of PAIRS: a fixed seed leaves no room for luck.
    allowed = 5 * math.sqrt(expected / PAIRS)
    assert abs(share_out(old, new, FACTOR, 0.0) - expected) <= allowed


@pytest.mark.parametrize("model", [walk, secular, unstable])
def test_the_stated_rate_of_false_alarms(model: Any) -> None:
    """Alarms ask for one error beyond FACTOR LEVEL = 5, and Gaussian tails make that rare: the
    tail that the simulation can see, beyond 3, is within the same formula at 3."""
    level = 3.0
    tail = math.erfc(level / math.sqrt(2)) / 2
    stated = level**2 * tail * math.log(STEPS) + 4 * tail
    beyond = float(np.mean(ratios(model, 4) > level))
    assert beyond <= stated
    assert FACTOR * LEVEL == 5


def test_a_maximum_over_all_samples_is_seldom_small() -> None:
    """Less than one in twenty walks that are asked at every sample stays below LEVEL."""
    assert float(np.mean(ratios(walk, 5) < LEVEL)) < 1 / 20


# What is compared.


def test_the_same_verdicts_depart_by_nothing() -> None:
    """Every row is in its own class, and every row is compared."""
    published = [
        row(rung=rung, quantity=name) for rung in ("f32", "f64") for name in ("omega", "T")
    ]
    comparison = compare(published, published)
    assert comparison.departures == ()
    assert comparison.compared == len(published) > 0


@pytest.mark.parametrize("name", ["max", "mean", "final", "ratio"])
def test_an_error_thirty_times_as_large_or_as_small_is_named(name: str) -> None:
    """A single number above what is attainable by chance is a departure with its place."""
    old = row(max=2e-14, mean=2e-14, final=2e-14, ratio=2.0)
    large = replace(old, **{name: 30 * getattr(old, name)})
    (there,) = departures_between([old], [large])
    assert f"@ euler/generic f64 omega {name}" in there
    (back,) = departures_between([large], [old])
    assert f"@ euler/generic f64 omega {name}" in back


def test_errors_below_the_level_are_alike() -> None:
    """An exact zero may become five attainable, and no more; a tiny error may become zero."""
    zero = {"max": 0.0, "mean": 0.0, "final": 0.0, "ratio": 0.0}
    assert departures_between([row(**zero)], [row(max=4.9e-14, ratio=4.9)]) == []
    assert departures_between([row()], [row(**zero)]) == []
    assert len(departures_between([row(**zero)], [row(max=5.1e-14, ratio=5.1)])) == 2


@pytest.mark.parametrize("lost", [None, math.nan, math.inf])
def test_what_is_no_number_is_in_no_class_of_numbers(lost: float | None) -> None:
    """An error that became NaN, infinite or nothing departs; one that stayed so does not."""
    new = row(max=lost, mean=lost, final=lost, ratio=lost)
    assert len(departures_between([row()], [new])) == 4
    assert departures_between([row(max=None, mean=None, final=None, ratio=None)], [new]) == []


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"verdict": Status.FAIL}, "expected pass, got fail @ euler/generic f64 omega verdict"),
        ({"outcome": "stopped"}, "got stopped @ euler/generic f64 omega outcome"),
        ({"unit": "rad"}, "got rad @ euler/generic f64 omega unit"),
        ({"roundoff": 2.0**-52}, "omega roundoff"),
        ({"steps": 112, "evaluations": 2240}, "expected 100 within 10%, got 112 @"),
        ({"evaluations": 2300}, "expected 20 within 10%, got 23 @"),
        ({"attainable": 1.2e-14}, "omega attainable"),
        ({"bound": 2e-13}, "omega bound"),
        ({"bound": None}, "got no finite number @ euler/generic f64 omega bound"),
        ({"bound": math.nan}, "omega bound"),
        ({"provenance": {"scene": "another"}}, "make reports"),
    ],
)
def test_every_other_number_has_its_class(changed: dict[str, Any], words: str) -> None:
    """A change of any one of them is told, with what was expected, what came and where."""
    (only,) = departures_between([row()], [row(**changed)])
    assert words in only


@pytest.mark.parametrize(
    "changed",
    [
        {"steps": 109, "evaluations": 2180},
        {"at": 99.0, "attainable": 5e-14, "bound": 5e-13},
        {
            "ratio_at": 3.0,
            "seconds": 9.0,
            "reason": stated(Cause.STATED, "10 x attainable, of 101 steps"),
        },
    ],
)
def test_what_is_drawn_anew_departs_by_nothing(changed: dict[str, Any]) -> None:
    """A few steps more, another time of the maximum and the floor there, are within the class."""
    assert departures_between([row()], [row(**changed)]) == []


def test_a_short_run_may_take_two_steps_more() -> None:
    """A tenth of a few steps is less than a step."""
    assert (
        departures_between([row(steps=5, evaluations=100)], [row(steps=7, evaluations=140)]) == []
    )
    assert (
        len(departures_between([row(steps=5, evaluations=100)], [row(steps=8, evaluations=160)]))
        == 1
    )


def test_missing_and_new_rows_are_named() -> None:
    """A row of one side alone is a departure, and is not counted as compared."""
    other = row(quantity="T")
    comparison = compare([row(), other], [row()])
    assert [str(d) for d in comparison.departures] == [
        "expected this row, got none @ euler/generic f64 T"
    ]
    assert comparison.compared == 1
    assert departures_between([row()], [row(), other]) == [
        "expected no such row, got one @ euler/generic f64 T"
    ]


def test_a_rung_that_a_machine_does_not_have_is_not_compared() -> None:
    """A run unavailable on either side is left out with all its quantities, and its rung alone."""
    rows = [row(rung="f80"), row(rung="f80", quantity="T")]
    absent = [row(rung="f80", verdict=Status.UNAVAILABLE, max=None, ratio=None)]
    for old, new in ((rows, absent), (absent, rows)):
        comparison = compare([*old, row()], [*new, row()])
        assert (comparison.compared, comparison.departures) == (1, ())


# The command.


@pytest.fixture
def published(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the rows of two scenes, and a run that makes just these rows again."""
    errors = {"max": 2e-14, "mean": 2e-15, "final": 1e-15, "ratio": 2.0}
    reports.write_remade(tmp_path, monkeypatch, errors)
    return tmp_path


def spoil(folder: Path, index: int, **changed: Any) -> None:
    """Change one stored row; with nothing to change, take it out."""
    file = folder / "data" / "verdicts.json"
    stored = json.loads(file.read_text(encoding="utf-8"))
    if changed:
        stored["verdicts"][index] |= changed
    else:
        del stored["verdicts"][index]
    file.write_text(json.dumps(stored), encoding="utf-8")


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"max": 30 * 2e-14}, "omega max"),
        ({}, "expected no such row, got one @ euler/full-tensor f64 omega"),
        ({"verdict": "fail"}, "expected fail, got pass @ euler/full-tensor f64 omega verdict"),
        ({"quantity": "H_space"}, "expected this row, got none @ euler/full-tensor f64 H_space"),
    ],
)
def test_run_against_a_broken_twin_fails_by_name(
    published: Path, capsys: pytest.CaptureFixture[str], changed: dict[str, Any], words: str
) -> None:
    """Exit 0 against the same rows; 1 and a message that names the row once one is spoiled."""
    call = ["run", "euler/generic", "euler/full-tensor", "--against", str(published), "--json"]
    assert main(call) == 0
    assert json.loads(capsys.readouterr().out)["against"]["compared"] == 6
    spoil(published, 0, **changed)
    assert main(call) == 1
    out, error = capsys.readouterr()
    assert words in error
    assert any(words in line for line in json.loads(out)["against"]["departures"])


def test_only_what_was_run_is_compared(published: Path) -> None:
    """A scene that was not asked for may be spoiled; run without names, every row must be there."""
    spoil(published, 0, max=1.0)
    assert main(["run", "euler/generic", "--against", str(published)]) == 0
    assert main(["run", "euler/full-tensor", "--against", str(published)]) == 1
    spoil(published, 0, max=2e-14, scene="euler/gone")
    assert main(["run", "--rung", "f64", "--against", str(published)]) == 1


def test_a_comparison_of_nothing_is_undecided(
    published: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exit 3 where no published row was compared: nothing was shown."""
    monkeypatch.setattr("taylor_verify.batch.judging.judge_all", lambda *_: [])
    call = ["run", "euler/generic", "--rung", "f32", "--against", str(published)]
    assert main(call) == 3


def test_a_folder_without_verdicts_is_a_wrong_call(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Exit 2 with a message that names --against, before any work."""
    monkeypatch.setattr(
        "taylor_verify.batch.judging.judge_all", lambda *_: pytest.fail("the work was begun")
    )
    assert main(["run", "euler/generic", "--against", str(tmp_path)]) == 2
    assert "--against" in capsys.readouterr().err
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "verdicts.json").write_text("{", encoding="utf-8")
    assert main(["run", "euler/generic", "--against", str(tmp_path)]) == 2
    assert "--against" in capsys.readouterr().err


def test_the_class_is_the_one_that_is_stated() -> None:
    """The numbers of the docstring are those of the constants."""
    text = rounding_class.__doc__ or ""
    assert f"FACTOR LEVEL = {FACTOR * LEVEL:g}" in text
