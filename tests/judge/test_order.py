"""The order of convergence over files: read where it shows, and said where it does not."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.judge.series.order import Sample, orders
from taylor_verify.records.answers import Order, Stall
from taylor_verify.records.observed_order import SAME
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

HALVED = [0.1 * 2.0**-k for k in range(8)]
FLOOR = 1e-15


def read(
    errors: Sequence[float | None],
    steps: Sequence[float] = HALVED,
    floor: float = FLOOR,
    digits: int | None = None,
    unit: str = "max|omega|",
) -> Order:
    """The order of one quantity with these errors, in files of as many rows as steps."""
    samples = [
        Sample(made(f"{step:.4g}.csv", step, error, floor, digits, unit), step)
        for step, error in zip(steps, errors, strict=False)
    ]
    (order,) = orders(samples)
    return order


def made(
    name: str, step: float, error: float | None, floor: float, digits: int | None, unit: str
) -> Any:
    row = Verdict(
        scene="euler/generic",
        solver="file",
        rung="f64",
        setting=name,
        quantity="omega",
        verdict=Status.FAIL,
        outcome="finished",
        max=error,
        at=1.0,
        unit=unit,
        attainable=floor,
    )
    # As many rows as steps: the floor is that of the verdict.
    file = SimpleNamespace(name=name, times=(Fraction(0), Fraction(step)), digits=digits)
    return SimpleNamespace(file=file, verdicts=(row,))


def power(order: float, constant: float = 0.1) -> list[float]:
    return [constant * h**order for h in HALVED]


@given(st.sampled_from([1, 2, 3, 4, 6]), st.floats(0.01, 10))
def test_a_power_of_the_step_has_its_order(order: int, constant: float) -> None:
    """Errors C h^p have order p, from the largest step to the last that is clear of roundoff."""
    measured = read(power(order, constant), floor=1e-30)
    assert measured.order == pytest.approx(order, abs=1e-6)
    assert measured.low <= measured.order <= measured.high
    assert (measured.largest, measured.smallest) == (HALVED[0], HALVED[-1])
    assert measured.sentence.startswith(f"omega: order {order}.0 from h = 0.1 to ")
    assert measured.sentence.endswith("the smallest: the error still falls")


def test_roundoff_takes_over_below_the_best_step() -> None:
    """Errors that rise again as the step falls: the best step is not the smallest, and it is said."""
    steps = [0.1 * 2.0**-k for k in range(11)]
    measured = read([h**4 + 1e-14 / h**0.5 for h in steps], steps, floor=1e-14)
    assert measured.order == pytest.approx(4, abs=0.1)
    assert steps[-1] < measured.best_step < steps[0]
    assert measured.stall is Stall.ROUNDOFF
    assert measured.stalls_at >= measured.best_step
    assert "roundoff takes over" in measured.sentence
    assert "digits" in measured.sentence


def test_a_wrong_step_is_named_and_no_order_is_stated() -> None:
    """One file whose step is not what its name says: no one order fits, and its error tells which."""
    errors = power(4, 1.0)
    errors[3] = (1.3 * HALVED[3]) ** 4
    measured = read(errors, floor=1e-30)
    assert measured.order is None
    assert measured.suspect == f"{HALVED[3]:.4g}.csv"
    assert measured.suspect_step == pytest.approx(1.3 * HALVED[3], rel=0.01)
    words = f"the others agree without {measured.suspect}, whose error is that of h = "
    assert f"{words}{measured.suspect_step:g} and not of {HALVED[3]:g}" in measured.sentence
    assert measured.sentence.startswith(
        "omega: no one order fits: from step to step it is 4.0, 4.0, 2.5"
    )


@pytest.mark.parametrize("place", range(1, 7))
def test_a_wrong_step_at_any_inner_place_is_found(place: int) -> None:
    """However many files agree on either side of it."""
    errors = power(2)
    errors[place] *= 2
    assert read(errors, floor=1e-30).suspect == f"{HALVED[place]:.4g}.csv"


@pytest.mark.parametrize("ratios", [(2, 64), (64, 2)], ids=["below", "above"])
def test_a_wrong_step_departs_clearly_to_both_sides(ratios: tuple[int, int]) -> None:
    """Where one of the two local orders is too near to the others, no file is named."""
    steps = [1.0]
    for ratio in (2, 2, *ratios, 2, 2):
        steps.append(steps[-1] / ratio)
    errors = [h**2 for h in steps]
    errors[3] *= 2 ** (2 * SAME)
    measured = read(errors, steps, floor=1e-30)
    assert measured.suspect is None


def test_steps_that_are_not_asymptotic_are_no_wrong_steps() -> None:
    """Large steps that depart to one side are left out and listed; the order is that of the others."""
    measured = read([h**2 * (1 + 30 * h) for h in HALVED], floor=1e-30)
    assert measured.suspect is None
    assert measured.order == pytest.approx(2, abs=0.2)
    assert measured.largest < HALVED[0]
    assert " at larger steps)" in measured.sentence


def test_disagreement_without_one_culprit_has_no_order() -> None:
    """Errors that zigzag from file to file: all local orders are listed, and none is the order."""
    errors = [e * (5 if k % 2 else 1) for k, e in enumerate(power(4))]
    measured = read(errors, floor=1e-30)
    assert (measured.order, measured.suspect) == (None, None)
    assert "no one order fits" in measured.sentence


def test_two_steps_confirm_no_order() -> None:
    """One ratio of errors agrees with itself: it is said, and no order is stated."""
    measured = read(power(4)[:2])
    assert measured.order is None
    assert measured.points[1].local == pytest.approx(4)
    assert "order 4.0 between h = 0.1 and 0.05, which no third step confirms" in measured.sentence


def test_errors_that_stall_at_the_printed_digits_are_of_the_file() -> None:
    """The error of files with seven digits stalls near 1e-7: neither roundoff nor the method."""
    measured = read([max(e, 6e-8) for e in power(4)], digits=7)
    assert measured.stall is Stall.DIGITS
    assert "the error is that of the printed digits" in measured.sentence


def test_errors_that_stall_far_above_roundoff_have_another_reason() -> None:
    """An error that no step removes is told with its multiple of the floor, and not called roundoff."""
    measured = read([e + 1e-7 for e in power(4)])
    assert measured.stall is Stall.OTHER
    assert "roundoff takes over" not in measured.sentence
    assert "1e+08 times what roundoff leaves" in measured.sentence


@pytest.mark.parametrize("error", [None, float("nan"), float("inf")])
def test_a_file_without_an_error_spoils_no_order(error: float | None) -> None:
    """A file whose error is no number has no part in the slope."""
    errors: list[float | None] = [*power(2)]
    errors[0] = error
    measured = read(errors, floor=1e-30)
    assert measured.order == pytest.approx(2)
    assert measured.largest == HALVED[1]


def test_an_answer_without_any_error_has_no_order() -> None:
    """Errors of zero, and errors of roundoff at every step, show none: it is said, and no best step."""
    for errors in ([0.0] * 4, [7e-16] * 4):
        measured = read(errors)
        assert measured.order is None
        assert measured.sentence.endswith("because the error is near roundoff at every step")


def test_more_steps_than_rows_raise_the_floor() -> None:
    """A file keeps few of its steps: the floor of roundoff is that of all of them."""
    judged = made("a.csv", 0.1, 1e-3, FLOOR, None, "rad")
    judged.file.times = (Fraction(0), Fraction(10), Fraction(20))
    judged.file.times += tuple(Fraction(k) for k in range(21, 121))
    (order,) = orders([Sample(judged, 0.012)])
    assert order.points[0].attainable == pytest.approx(FLOOR * (10_000 / 103) ** 0.5)
