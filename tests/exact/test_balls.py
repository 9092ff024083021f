"""Motions in balls: the precision rises until they are narrow, and what they claim is never too little."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, final

import numpy as np
import pytest
from flint import arb, ctx, fmpq
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact import balls as module
from taylor_verify.exact.balls import Enclosed, Enclosure, Undecidable, midpoint, sign, upper
from taylor_verify.exact.solution import Unsettled
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value, held_exactly
from taylor_verify.scenes.motion import Motion

DIGITS = 20
NOT_A_NUMBER, INFINITE, WIDE = arb("nan"), arb("inf"), arb(0, 1)


@final
class Told(Enclosed):
    """A solution that says what it is told to, and counts how often it is asked."""

    regime = "told"

    def __init__(self, enclose: Callable[[Sequence[Fraction], int], Enclosure]) -> None:
        self._enclose = enclose
        self.asked: list[int] = []

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        self.asked.append(bits)
        return self._enclose(elapsed, bits)


def always(*row: arb) -> Told:
    return Told(lambda elapsed, bits: {"omega": [list(row) for _ in elapsed]})


def open_branch(elapsed: Sequence[Fraction], bits: int) -> Enclosure:
    raise Undecidable


def nothing_to_divide_by(elapsed: Sequence[Fraction], bits: int) -> Enclosure:
    raise ZeroDivisionError


NOW = [Fraction(0)]


# How the precision rises.


@pytest.mark.parametrize("lost", [0, 100, 3000])
def test_the_precision_rises_until_the_balls_are_narrow(lost: int) -> None:
    """However many bits an evaluation loses, the radius ends below 10^-digits, and is right."""

    def losing(elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        big = arb(2) ** lost
        return {"omega": [[ball(t) + big - big, arb(1)] for t in elapsed]}

    third = Fraction(1, 3)
    motion = Told(losing).motion([third], DIGITS)
    assert motion.radius[0] <= mpf(10) ** -DIGITS
    assert encloses(motion, {"omega": [[third, Fraction(1)]]})


@pytest.mark.parametrize(
    "solution",
    [
        Told(open_branch),
        Told(nothing_to_divide_by),
        always(WIDE),
        always(arb(1, 1e-6)),
        always(NOT_A_NUMBER),
        always(arb(1), NOT_A_NUMBER),
        always(INFINITE),
        always(arb(1), -INFINITE),
        always(arb(0, INFINITE)),
    ],
    ids=["branch", "division", "zero", "coarse", "nan", "one nan", "inf", "one inf", "no bound"],
)
def test_what_never_narrows_is_unsettled(solution: Told) -> None:
    """A number that is wide, infinite or none, and a branch that stays open: a dozen steps, no more."""
    with pytest.raises(Unsettled, match="do not shrink to 20 digits"):
        solution.motion(NOW, DIGITS)
    assert 2 <= len(solution.asked) <= 12
    assert solution.asked == sorted(set(solution.asked))


@pytest.mark.parametrize("bad", [NOT_A_NUMBER, INFINITE, arb(0, INFINITE), WIDE])
@pytest.mark.parametrize("row", [0, 1, 2])
@pytest.mark.parametrize("quantity", ["omega", "attitude"])
def test_one_bad_number_is_enough(quantity: str, row: int, bad: arb) -> None:
    """A number that is none, in whichever row and quantity, sends the whole motion back."""

    def bad_at_first(elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        rows_of: dict[str, Any] = {
            "omega": [[ball(t + 1)] * 3 for t in elapsed],
            "attitude": [[[ball(t + 2)] * 3] * 3 for t in elapsed],
        }
        if len(solution.asked) == 1:
            rows_of[quantity][row] = [bad] * 3 if quantity == "omega" else [[bad] * 3] * 3
        return rows_of

    solution = Told(bad_at_first)
    times = [Fraction(t, 3) for t in range(3)]
    motion = solution.motion(times, DIGITS)
    assert len(solution.asked) == 2
    assert all(radius <= mpf(10) ** -DIGITS for radius in motion.radius)
    assert encloses(
        motion,
        {"omega": [[t + 1] * 3 for t in times], "attitude": [[[t + 2] * 3] * 3 for t in times]},
    )


# What a radius says. Balls are made whose true value lies in a corner: no radius may be smaller.


dyadic = st.builds(
    lambda n, e: Fraction(n) * Fraction(2) ** e,
    st.integers(-(2**30), 2**30).filter(bool),
    st.integers(-60, 60),
)
shapes = st.sampled_from([(1,), (3,), (3, 3)])


@st.composite
def cornered(draw: st.DrawFn) -> tuple[Enclosure, dict[str, Any]]:
    """Balls, and a truth in one of their corners; an entry may be zero, and its ball too."""
    shape = draw(shapes)
    number = int(np.prod(shape))
    values = draw(st.lists(dyadic, min_size=number, max_size=number))
    radii = [
        Fraction(draw(st.integers(0, 2**20))) * Fraction(2) ** draw(st.integers(-90, -40))
        for _ in values
    ]
    signs = draw(st.lists(st.sampled_from([-1, 1]), min_size=number, max_size=number))
    with ctx.workprec(300):
        balls = [arb(ball(v), ball(r)) for v, r in zip(values, radii, strict=True)]
    truth = [v + s * r for v, s, r in zip(values, signs, radii, strict=True)]
    return {"omega": [_shaped(balls, shape)]}, {"omega": [_shaped(truth, shape)]}


def _shaped(entries: Sequence[Any], shape: tuple[int, ...]) -> Any:
    array = np.empty(len(entries), dtype=object)
    array[:] = entries
    return array.reshape(shape).tolist()


def encloses(motion: Motion, truth: Any) -> bool:
    """Whether every row's error is within its radius, exactly: both are compared as rationals."""
    for name, rows in truth.items():
        for values, true, radius in zip(motion[name], rows, motion.radius, strict=True):
            exact = [Fraction(t) for t in np.array(true, dtype=object).flat]
            error = [exact_value(f) - t for f, t in zip(np.array(values).flat, exact, strict=True)]
            size = sum(t * t for t in exact) or 1
            if not sum(e * e for e in error) <= exact_value(radius) ** 2 * size:
                return False
    return True


def measured(enclosure: Enclosure) -> Motion:
    with ctx.workprec(300):
        return module._measured(enclosure, 1)[0]


@given(cornered())
def test_a_radius_is_never_below_the_true_error(
    case: tuple[Enclosure, dict[str, Any]],
) -> None:
    """Wherever in its ball the truth lies, a vector's or a matrix's relative error is in the radius."""
    enclosure, truth = case
    motion = measured(enclosure)
    assert not mp.isfinite(motion.radius[0]) or encloses(motion, truth)


@pytest.mark.parametrize("shape", [(1,), (3,), (3, 3)])
def test_a_radius_too_small_by_half_a_digit_is_noticed(
    shape: tuple[int, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A width divided by sqrt(10) no longer holds a truth that lies in the corner of its ball."""
    number = int(np.prod(shape))
    values, radius = [Fraction(k + 1, 4) for k in range(number)], Fraction(1, 2**40)
    enclosure = {"omega": [_shaped([arb(ball(v), ball(radius)) for v in values], shape)]}
    truth = {"omega": [_shaped([v + radius for v in values], shape)]}
    assert encloses(measured(enclosure), truth)
    honest = module.widths

    def short(balls: Sequence[arb], count: int) -> tuple[Any, Any]:
        radii, doubles = honest(balls, count)
        return radii / mp.sqrt(10), doubles

    monkeypatch.setattr(module, "widths", short)
    assert not encloses(measured(enclosure), truth)


@settings(max_examples=40)
@given(st.lists(cornered(), min_size=1, max_size=4), st.integers(-900, 900))
def test_widths_of_rows_are_those_of_each(
    cases: list[tuple[Enclosure, dict[str, Any]]], exponent: int
) -> None:
    """A width, by doubles or in balls, in the range of doubles or not, is at least the true ratio."""
    with ctx.workprec(300):
        rows = [[b * arb(2) ** exponent for b in np.array(case["omega"]).flat] for case, _ in cases]
        size = min(map(len, rows))
        rows = [row[:size] for row in rows]
        radii, doubles = module.widths([b for row in rows for b in row], len(rows))
    for row, radius in zip(rows, radii, strict=True):
        alone = module.width(row)
        assert radius == alone or abs(radius - alone) <= alone * mpf(2) ** -9
        errors, middles = (
            [exact_value(midpoint(b)) for b in part]
            for part in ([b.rad() for b in row], [b.mid() for b in row])
        )
        if mp.isfinite(radius):
            least = sum(m * m for m in middles)
            assert sum(e * e for e in errors) <= exact_value(radius) ** 2 * least
    for radius, double in zip(radii, doubles.tolist(), strict=True):
        assert double == radius or double != double


# Between rationals, balls and mpmath.


@given(st.fractions(), st.integers(2, 200))
def test_a_ball_contains_its_rational(value: Fraction, bits: int) -> None:
    """At any precision, and its relative radius is at most 2^(1 - bits)."""
    with ctx.workprec(bits):
        enclosure = ball(value)
        assert enclosure.contains(fmpq(value.numerator, value.denominator))
    assert exact_value(midpoint(enclosure.rad())) <= abs(value) * Fraction(2) ** (1 - bits)


def test_what_is_not_finite_is_not_taken_for_a_number() -> None:
    """NaN stays NaN; the larger of NaN and anything is NaN."""
    assert mp.isnan(upper(NOT_A_NUMBER))
    assert mp.isinf(upper(INFINITE))
    one = held_exactly(Fraction(1))
    assert mp.isnan(module.max_or_nan(one, mp.nan))
    assert mp.isnan(module.max_or_nan(mp.nan, one))
    assert module.max_or_nan(one, mp.inf) == mp.inf


def test_a_sign_is_proven_or_left_open() -> None:
    """A ball that touches zero has no sign."""
    assert sign(arb(1, 0.5)) == 1
    assert sign(arb(-1, 0.5)) == -1
    for undecided in (arb(0), arb(1, 1.5), arb(1, 1), NOT_A_NUMBER):
        with pytest.raises(Undecidable):
            sign(undecided)
