"""Growth of errors: intervals that cover exponents, right words, a gate with a known rate."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan, sqrt

import numpy as np
import pytest
from scipy import stats

from taylor_verify.records.status import Status
from taylor_verify.records.student import student
from taylor_verify_reports.studies.growth.fit import (
    BIAS,
    BOUNDED,
    LEVEL,
    NO_WORD,
    RANDOM_WALK,
    Law,
    chi_square_tail,
    covariance_of,
    exponent,
    gate,
    growth,
    word,
)
from taylor_verify_reports.studies.growth.grown import EXACT

Draw = Callable[[np.random.Generator, int], np.ndarray]

# Half-decades from 10^2 to 10^6.
TIMES = 10 ** np.arange(2, 6.01, 0.5)
# A count of independent events leaves so many standard deviations once in 10^5; the seeds are fixed,
# so that a change, and nothing else, can make it happen.
SIGMAS = 4.5


def of_law(law: Law, draw: np.random.Generator, lanes: int) -> np.ndarray:
    """Lanes that follow one law exactly, with sizes spread over a factor of ten."""
    root = np.linalg.cholesky(covariance_of(law, TIMES))
    sizes = np.exp(draw.normal(0, 0.6, (lanes, 1)))
    errors: np.ndarray = sizes * (draw.standard_normal((lanes, len(TIMES))) @ root.T)
    return errors


def walk(draw: np.random.Generator, lanes: int) -> np.ndarray:
    return of_law(Law.WALK, draw, lanes)


def integrated_walk(draw: np.random.Generator, lanes: int) -> np.ndarray:
    return of_law(Law.INTEGRATED, draw, lanes)


def bounded(draw: np.random.Generator, lanes: int) -> np.ndarray:
    return draw.uniform(-1, 1, (lanes, len(TIMES)))


def biased(power: float) -> Draw:
    """Errors that all have the sign of their lane's bias, and swing about the power by a fifth."""

    def drawn(draw: np.random.Generator, lanes: int) -> np.ndarray:
        size = np.exp(draw.normal(0, 0.6, (lanes, 1)))
        swing = 1 + 0.2 * draw.uniform(-1, 1, (lanes, len(TIMES)))
        errors: np.ndarray = size * swing * (TIMES / TIMES[-1]) ** power
        return errors

    return drawn


KINDS = [
    (Law.WALK, bounded, 0.0, BOUNDED),
    (Law.WALK, walk, 0.5, RANDOM_WALK),
    (Law.WALK, biased(1), 1.0, BIAS),
    (Law.INTEGRATED, biased(1), 1.0, "constant rate"),
    (Law.INTEGRATED, integrated_walk, 1.5, RANDOM_WALK),
    (Law.INTEGRATED, biased(2), 2.0, BIAS),
]


# Distributions


@pytest.mark.parametrize("freedom", [1, 2, 3, 4, 7, 15, 31, 200])
def test_students_quantile_is_scipys(freedom: int) -> None:
    """The interval of Student's variable is that of another implementation to nine digits."""
    for level in (0.5, 0.9, 0.99, 0.9999):
        expected = stats.t.ppf((1 + level) / 2, freedom)
        assert student(freedom, level) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("freedom", [2, 4, 16, 32, 1000, 4000])
def test_the_tail_of_chi_square_is_scipys(freedom: int) -> None:
    """The probability of a larger value is that of another implementation, far out too."""
    for value in (0.0, 0.1, freedom / 2, freedom, 2.0 * freedom, 5.0 * freedom):
        expected = stats.chi2.sf(value, freedom)
        assert chi_square_tail(value, freedom) == pytest.approx(expected, rel=1e-8)
    assert chi_square_tail(inf, freedom) == 0
    assert chi_square_tail(nan, freedom) != chi_square_tail(nan, freedom)


def test_the_covariances_are_those_of_sums() -> None:
    """A sum of many independent numbers, and the sum of such sums, have the laws' covariances."""
    steps, samples = 400, 4000
    draw = np.random.default_rng(3)
    single = np.cumsum(draw.standard_normal((samples, steps)), axis=1)
    double = np.cumsum(single, axis=1)
    at = np.array([99, 199, 399])
    for law, sums in ((Law.WALK, single), (Law.INTEGRATED, double)):
        sampled = np.cov(sums[:, at].T)
        expected = covariance_of(law, at + 1.0)
        ratio = (sampled / sampled[-1, -1]) / (expected / expected[-1, -1])
        # Each entry is known to some sqrt(2/samples) of itself, sums of 100 steps to one part in 100.
        assert np.all(np.abs(ratio - 1) <= SIGMAS * sqrt(2 / samples) + 0.02)


# Exponents and words


@pytest.mark.parametrize("lanes", [4, 16])
@pytest.mark.parametrize(("law", "drawn", "power", "_word"), KINDS)
def test_the_interval_covers_as_often_as_it_says(
    law: Law, drawn: Draw, power: float, _word: str, lanes: int
) -> None:
    """The interval misses the true exponent once in a hundred, whatever the kind of growth."""
    draw, count = np.random.default_rng(lanes), 800
    exponents = [exponent(TIMES, drawn(draw, lanes), law, 1e-9) for _ in range(count)]
    missed = sum(not one.low <= power <= one.high for one in exponents)
    expected = (1 - LEVEL) * count
    assert abs(missed - expected) <= SIGMAS * sqrt(expected)


@pytest.mark.parametrize(
    ("value", "reach", "law", "expected"),
    [
        (0.5, 0.1, Law.WALK, "random walk"),
        (0.75, 0.3, Law.WALK, "unclear: random walk or bias"),
        (0.75, 0.1, Law.WALK, "between random walk and bias"),
        (1.5, 0.1, Law.WALK, "faster than bias"),
        (-1, 0.1, Law.WALK, "shrinking"),
        (1.5, 0.1, Law.INTEGRATED, "random walk"),
        (0.5, 0.1, Law.INTEGRATED, "jitter"),
        (nan, nan, Law.INTEGRATED, NO_WORD),
    ],
)
def test_words_follow_from_the_interval(
    value: float, reach: float, law: Law, expected: str
) -> None:
    """One exponent inside is its word; several are unclear; none is between its neighbours."""
    assert word(value, reach, law) == expected


def test_no_error_at_all_is_exact() -> None:
    """A quantity that no lane ever loses has no exponent and passes; one zero is one rounding."""
    nothing = growth(TIMES, np.zeros((8, len(TIMES))), Law.WALK, 1e-16)
    assert nothing.exponent.word == EXACT
    assert nothing.gate is not None
    assert nothing.gate.verdict is Status.PASS
    errors = 1e-16 * walk(np.random.default_rng(1), 8) / 1e-3
    errors[3, 2] = 0
    one = exponent(TIMES, errors, Law.WALK, 1e-16)
    errors[3, 2] = 1e-16
    assert one == exponent(TIMES, errors, Law.WALK, 1e-16)


def test_a_lane_that_is_lost_has_no_slope() -> None:
    """The others' exponent is that of the others alone; of one lane nothing can be told."""
    errors = walk(np.random.default_rng(1), 8)
    errors[2, 5:] = nan
    others = np.delete(errors, 2, axis=0)
    assert exponent(TIMES, errors, Law.WALK, 1e-9) == exponent(TIMES, others, Law.WALK, 1e-9)
    errors[1:] = inf
    assert exponent(TIMES, errors, Law.WALK, 1e-9).word == NO_WORD


# The gate


@pytest.mark.parametrize("law", Law)
def test_the_law_itself_fails_as_often_as_is_stated(law: Law) -> None:
    """The chance of the law's own samples is below any threshold that often, lanes of all sizes."""
    draw, count = np.random.default_rng(11), 2500
    chances = np.array([gate(TIMES, of_law(law, draw, 8), law, 0).chance for _ in range(count)])
    for rate in (0.5, 0.1, 0.01):
        failures = np.sum(chances < rate)
        assert abs(failures - rate * count) <= SIGMAS * sqrt(rate * (1 - rate) * count)


@pytest.mark.parametrize(("law", "power"), [(Law.WALK, 1), (Law.INTEGRATED, 2)])
def test_a_bias_beneath_a_walk_fails(law: Law, power: int) -> None:
    """A bias that is ten times the walk at the end, and still hidden in it early, is always seen."""
    draw = np.random.default_rng(19)
    spread = sqrt(covariance_of(law, TIMES)[-1, -1])
    bias = 10 * spread * (TIMES / TIMES[-1]) ** power
    root = np.linalg.cholesky(covariance_of(law, TIMES))
    for _ in range(200):
        hidden = draw.standard_normal((8, len(TIMES))) @ root.T
        assert gate(TIMES, hidden, law, 0).verdict is Status.PASS
        assert gate(TIMES, hidden + bias, law, 0).verdict is Status.FAIL


@pytest.mark.parametrize("lost", [nan, inf, -inf])
def test_an_error_that_is_no_number_fails(lost: float) -> None:
    """One lane that is lost at the end fails the gate, which says what it expected."""
    errors = walk(np.random.default_rng(1), 8)
    errors[2, -1] = lost
    judgement = gate(TIMES, errors, Law.WALK, 0)
    assert judgement.verdict is Status.FAIL
    assert "finite errors" in judgement.because


@pytest.mark.parametrize(
    ("times", "errors", "message"),
    [
        (TIMES, np.ones((8, 3)), r"expected errors of shape \(lanes, 9\), got \(8, 3\)"),
        (TIMES, np.ones((1, 9)), "at least 2 lanes and 4 instants, got 1 and 9"),
        (TIMES[:3], np.ones((8, 3)), "at least 2 lanes and 4 instants, got 8 and 3"),
        (TIMES[::-1], np.ones((8, 9)), "instants after the start that increase"),
        (TIMES - TIMES[0], np.ones((8, 9)), "instants after the start that increase"),
    ],
)
def test_too_little_is_refused(times: np.ndarray, errors: np.ndarray, message: str) -> None:
    """An array of another shape, too few lanes or instants, instants out of order: each is named."""
    with pytest.raises(ValueError, match=message):
        growth(times, errors, Law.WALK, 1e-16)
