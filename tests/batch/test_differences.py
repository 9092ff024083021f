"""Rows differ where rounding does not explain it, and a difference says whether it is for the worse."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
from builders.verdicts import ATTAINABLE, row
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.batch.differences import FACTOR, LEVEL, Direction, compare
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.solvers.trajectory import Outcome

Floats = np.ndarray[Any, np.dtype[np.float64]]
WORSE, BETTER, CHANGED, OTHER_QUESTION, UNAVAILABLE = Direction

# Pairs of runs; that none of n leaves its class says with 95 % that the rate is below 3/n.
PAIRS = 20_000
STEPS = 200


def differing(before: Verdict, now: Verdict) -> list[tuple[Direction, str]]:
    """The direction and the name of every difference of a row."""
    return [(each.direction, each.what) for each in compare([before], [now]).all]


# The rate of false alarms, on walks whose steps are those that attainable counts.


def walk(rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Errors and attainable of a conserved quantity: every step's rounding stays."""
    steps = rng.standard_normal((PAIRS, STEPS))
    return np.abs(np.cumsum(steps, axis=1)), np.sqrt(np.arange(1, STEPS + 1))


def ratios(seed: int) -> Floats:
    errors, attainable = walk(np.random.default_rng(seed))
    largest: Floats = np.max(errors / attainable, axis=1)
    return largest


def share_out(old: Floats, new: Floats, factor: float, level: float) -> float:
    """The share of pairs that are out of a class of this factor and level."""
    up = new > factor * np.maximum(old, level)
    down = old > factor * np.maximum(new, level)
    return float(np.mean(up | down))


def test_two_draws_of_one_walk_are_in_one_class() -> None:
    """None of the pairs leaves it; some would leave one with a factor of two, so the walks do spread."""
    old, new = ratios(1), ratios(2)
    assert share_out(old, new, FACTOR, LEVEL) == 0
    assert share_out(old, new, 2.0, LEVEL) > 1e-3


# Errors.

SIZES = st.floats(0, 1e6)


@given(SIZES, SIZES)
def test_an_error_leaves_its_class_upwards_or_downwards(was: float, now: float) -> None:
    """The limit is ten times the larger of the one error and half of what is attainable."""
    for direction, low, high in ((WORSE, was, now), (BETTER, now, was)):
        limit = FACTOR * max(low, LEVEL)
        if abs(high - limit) > 1e-12 * limit:  # errors are rounded products of these
            expected = [(direction, "max (and mean, final, ratio)")] if high > limit else []
            assert [
                each for each in differing(row(was), row(now)) if each[0] is direction
            ] == expected


@pytest.mark.parametrize("name", ["max", "mean", "final", "ratio"])
@pytest.mark.parametrize("lost", [None, math.nan, math.inf])
def test_an_error_that_is_no_number_is_beyond_every_number(name: str, lost: Any) -> None:
    """NaN, infinite or nothing in place of a number is worse by its name, the reverse is better."""
    broken = row(**{name: lost})
    assert differing(row(), broken) == [(WORSE, name)]
    assert differing(broken, row()) == [(BETTER, name)]
    assert differing(broken, broken) == []


def test_the_figures_of_a_difference_are_its_limit_and_its_reason() -> None:
    """A row that still passes, at 8 attainable, is worse than an eleventh of it, and better in reverse."""
    (worse,) = compare([row(8 / 11)], [row(8)]).all
    assert str(worse) == (
        "expected at most 7.27e-14 (10 x the larger of the earlier error 7.27e-15 and "
        "0.5 roundoff floors, 5e-15), got 8e-14 "
        "@ euler/generic f64 omega max (and mean, final, ratio)"
    )
    (better,) = compare([row(8)], [row(8 / 11)]).all
    assert str(better).startswith("expected at least 8e-15 (the earlier error 8e-14 over 10)")


def test_more_steps_excuse_no_error() -> None:
    """A hundred times the steps make ten times as much attainable, and still an error of 40 times the
    former attainable is worse."""
    costly = {"steps": 10_000, "evaluations": 200_000, "attainable": 10 * ATTAINABLE, "ratio": 4.0}
    new = row(40, **costly, bound=100 * ATTAINABLE)
    assert differing(row(), new) == [(WORSE, "max (and mean, final)")]


# The other columns of a row.


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({"outcome": "stopped"}, (CHANGED, "outcome")),
        ({"unit": "rad"}, (OTHER_QUESTION, "unit")),
        ({"roundoff": 2.0**-24}, (OTHER_QUESTION, "roundoff")),
        ({"unit": ""}, (CHANGED, "unit")),
        ({"provenance": {"scene": "another"}}, (OTHER_QUESTION, "scene")),
        ({"steps": 112, "evaluations": 2240}, (CHANGED, "steps")),
        ({"evaluations": 2300}, (CHANGED, "evaluations a step")),
        ({"attainable": 1.2e-14}, (CHANGED, "attainable")),
        ({"bound": 2e-13}, (CHANGED, "bound")),
        ({"bound": None}, (CHANGED, "bound")),
        ({"bound": math.nan}, (CHANGED, "bound")),
    ],
)
def test_every_other_number_has_its_class(
    changed: dict[str, Any], expected: tuple[Direction, str]
) -> None:
    """A change of any one of them is named, whichever of the two rows is the former one."""
    assert differing(row(), row(**changed)) == [expected]
    assert differing(row(**changed), row()) == [expected]


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"steps": 109, "evaluations": 2180},
        {"at": 99.0, "attainable": 5e-14, "bound": 5e-13},
        {"max": 40 * ATTAINABLE, "at": 99.0, "attainable": 10 * ATTAINABLE},
        {"ratio_at": 3.0, "seconds": 9.0},
    ],
)
def test_what_is_drawn_anew_makes_no_difference(changed: dict[str, Any]) -> None:
    """A few steps more, another time of the maximum and the floor there, are within the class."""
    assert differing(row(), row(**changed)) == []


def test_another_question_and_a_growth_leave_out_their_consequences() -> None:
    """A row with another question is told as that alone, and a worse one by what is worse alone."""
    before = row(until=40.0)
    assert differing(before, row(1e5, verdict=Status.FAIL, until=9.0)) == [
        (OTHER_QUESTION, "last time")
    ]
    worse = row(1e5, verdict=Status.FAIL, steps=900, outcome="stopped")
    errors = "max (and mean, final, ratio)"
    assert differing(row(), worse) == [(WORSE, "verdict"), (WORSE, errors)]
    names = ["verdict", "outcome", "steps", "evaluations a step", errors]
    assert [what for _, what in differing(worse, row())] == names


JUDGED = [status for status in Status if status is not Status.UNAVAILABLE]


@pytest.mark.parametrize(("was", "now"), [*product(JUDGED, JUDGED)])
def test_a_verdict_is_worse_by_the_grades_of_the_exit_status(was: Status, now: Status) -> None:
    """A change from pass to nothing shown, or from either to fail, is worse; the reverse is better."""
    order = (0, 3, 1)
    before, after = row(verdict=was), row(verdict=now)
    grades = [order.index(exit_status([each])) for each in (before, after)]
    direction = CHANGED if grades[0] == grades[1] else WORSE if grades[0] < grades[1] else BETTER
    assert differing(before, after) == ([] if was is now else [(direction, "verdict")])


def test_a_verdict_by_another_tolerance_is_neither_worse_nor_better() -> None:
    """Errors are compared all the same, and so is the verdict of a run that came to no comparison."""
    by_tolerance = row(1e5, tolerance=1e-6)
    failed = replace(by_tolerance, tolerance=None, verdict=Status.FAIL)
    assert differing(by_tolerance, failed) == [(CHANGED, "verdict")]
    assert differing(by_tolerance, replace(failed, max=1e9))[0] == (WORSE, "max")
    assert differing(by_tolerance, replace(failed, tolerance=1e-6)) == [(WORSE, "verdict")]
    assert (WORSE, "verdict") in differing(by_tolerance, replace(failed, at=None))


# Rows of one side alone.


def test_a_row_that_is_gone_is_worse_and_a_new_one_is_a_change() -> None:
    """Either is named, and is not counted as compared."""
    both = [row(), row(quantity="T")]
    (missing,) = compare(both, [row()]).all
    assert str(missing) == "expected this row, got none @ euler/generic f64 T"
    (new,) = compare([row()], both).all
    assert str(new) == "expected no such row, got a new one @ euler/generic f64 T"
    assert (missing.direction, new.direction) == (WORSE, CHANGED)
    assert compare(both, [row()]).compared == compare(both[:1], both).compared == 1


def test_a_quaternion_has_a_row_only_where_its_length_is_lost() -> None:
    """Such a row is worse where it appears, and better where it is gone."""
    lost = row(errors=50.0, verdict=Status.FAIL, quantity="unit quaternion")
    (worse,) = compare([row()], [row(), lost]).all
    assert "expected no such row, got one that fails" in str(worse)
    (better,) = compare([row(), lost], [row()]).all
    assert "got none: it is mended" in str(better)
    assert (worse.direction, better.direction) == (WORSE, BETTER)


def test_a_run_that_did_not_finish_is_worse_in_every_row() -> None:
    """Its one row is worse, and the others are gone."""
    broken = row(verdict=Status.FAIL, outcome="crashed", unit="", roundoff=None)
    both = [row(), row(quantity="T"), row(quantity="H2")]
    worse = [str(each) for each in compare(both, [broken]).towards(WORSE)]
    assert [line.rpartition("f64 ")[2] for line in worse] == ["T", "H2", "omega verdict"]


def test_a_rung_that_one_machine_lacks_is_named_and_not_compared() -> None:
    """A run unavailable on either side is left out with all its quantities, and its rung alone."""
    rows = [row(rung="f80"), row(rung="f80", quantity="T")]
    lacks = {"verdict": Status.UNAVAILABLE, "outcome": Outcome.NO_FORMAT.value}
    absent = [row(rung="f80", **lacks, max=None, ratio=None)]
    for old, new in ((rows, absent), (absent, rows)):
        compared = compare([*old, row()], [*new, row()])
        assert compared.compared == 1
        assert [each.direction for each in compared.all] == [UNAVAILABLE]


@pytest.mark.parametrize("outcome", [Outcome.UNSUITED, Outcome.NO_PACKAGE])
def test_a_run_that_a_solver_no_longer_makes_is_worse(outcome: Outcome) -> None:
    """Its verdict, and each row that is gone, are regressions; a machine's number formats are none."""
    rows = [row(), row(quantity="T")]
    absent = [row(verdict=Status.UNAVAILABLE, outcome=outcome.value, max=None, ratio=None)]
    worse, back = compare(rows, absent), compare(absent, rows)
    assert [each.quantity for each in worse.towards(WORSE)] == ["T", "omega"]
    assert not back.towards(WORSE)
    assert not compare(absent, absent).all
