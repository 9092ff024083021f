"""Numbers of Q(pi, gamma, ...): exact arithmetic, and comparisons that are proven or refused."""

from __future__ import annotations

import operator
import pickle
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import pytest
from flint import arb
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.numbers.irrational import (
    PI,
    Constant,
    Irrational,
    Pi,
    Undecided,
    ball,
    generator,
)
from taylor_verify.numbers.precision import exact_value, floor_log2

DIGITS: Final = 60


@dataclass(frozen=True)
class Gamma(Constant):
    """Euler's constant, of which it is unknown whether it is rational."""

    def evaluated(self) -> arb:
        return arb.const_euler()


@dataclass(frozen=True)
class Twin(Constant):
    """The number pi under another name, so that no ball shows whether a number is it."""

    def __str__(self) -> str:
        return "twin"

    def evaluated(self) -> arb:
        return arb.pi()


GAMMA: Final = generator((Pi(), Gamma()), 1)
TWIN: Final = generator((Pi(), Twin()), 1)

COEFFICIENT = st.fractions(-9, 9, max_denominator=9)


def polynomial(coefficients: list[Fraction]) -> Any:
    """a + b pi + c gamma + d pi^2 gamma, a Fraction if only a is left."""
    a, b, c, d = coefficients
    return a + b * PI + c * GAMMA + d * PI**2 * GAMMA


POLYNOMIAL = st.lists(COEFFICIENT, min_size=4, max_size=4).map(polynomial)
NUMBER = st.builds(operator.truediv, POLYNOMIAL, POLYNOMIAL.filter(bool))


def value(number: Any) -> mpf:
    """The number at the ambient precision, by mpmath alone."""
    if isinstance(number, Fraction):
        return mpf(number.numerator) / number.denominator
    above, below = (
        sum(
            int(c) * mp.pi ** int(i) * mp.euler ** int(j)
            for (i, j, *_), c in part.to_dict().items()
        )
        for part in (number.numerator_polynomial, number.denominator_polynomial)
    )
    return above / below


OPERATIONS = (operator.add, operator.sub, operator.mul, operator.truediv)


@pytest.mark.parametrize("operation", OPERATIONS)
@settings(max_examples=6)
@given(NUMBER, NUMBER | COEFFICIENT | st.integers(-9, 9))
def test_arithmetic_is_that_of_mpmath(operation: Callable[..., Any], a: Any, b: Any) -> None:
    """Results agree to 60 digits of the larger operand, with rationals on either side too."""
    assume(a and b)
    with mp.workdps(2 * DIGITS):
        x, y = value(a), value(Fraction(b) if isinstance(b, int) else b)
        for result, expected in (
            (operation(a, b), operation(x, y)),
            (operation(b, a), operation(y, x)),
        ):
            room = max(abs(x), abs(y), abs(expected)) * mpf(10) ** -DIGITS
            assert abs(value(result) - expected) <= room


@settings(max_examples=10)
@given(NUMBER, NUMBER)
def test_the_order_is_that_of_mpmath(a: Any, b: Any) -> None:
    """Two different numbers compare as their values do, either way round; equal ones are equal."""
    assume(isinstance(a, Irrational))
    with mp.workdps(2 * DIGITS):
        x, y = value(a), value(b)
        # Numbers of such small coefficients are not as near as the digits of this comparison.
        assert (x == y) or abs(x - y) > mpf(10) ** -DIGITS
        if a == b:
            assert abs(x - y) <= mpf(10) ** -DIGITS
            assert a <= b <= a
            return
    for compare in (operator.lt, operator.le, operator.gt, operator.ge, operator.ne):
        assert compare(a, b) == compare(x, y)
        assert compare(b, a) == compare(y, x)
    assert abs(a) == (a if x > 0 else -a)
    assert a.sign == mp.sign(x)


def test_equality_is_structural() -> None:
    """A constant that cancels is gone: then the number is a Fraction, and equal to it."""
    assert +PI == 0 + PI == PI == 1 / (1 / PI)
    assert PI**-2 == 1 / (PI * PI)
    assert PI / PI == 1
    assert type(PI - PI) is type(PI / PI) is type(PI**0) is type(0 * PI) is Fraction
    assert (PI**2 - GAMMA**2) / (PI - GAMMA) - GAMMA == PI
    assert (2 * PI) / (4 * PI * GAMMA) == Fraction(1, 2) / GAMMA
    assert (-PI) / (-GAMMA) == PI / GAMMA
    assert PI != Fraction(22, 7)
    assert PI != GAMMA
    with pytest.raises(ZeroDivisionError):
        1 / (PI - PI)


@settings(max_examples=10)
@given(NUMBER, NUMBER)
def test_equal_numbers_have_equal_hashes(a: Any, b: Any) -> None:
    """A number that is formed in two ways is one key of a dictionary."""
    assume(a and b)
    assert hash(a * b / b) == hash(a)
    assert {a + b - b: "same"}[a] == "same"
    # The same polynomial in a larger field.
    assert hash(PI) == hash(generator((Pi(), Gamma()), 0))


@pytest.mark.parametrize(
    "question",
    [
        *(lambda compare=compare: compare(PI, TWIN) for compare in (operator.eq, operator.lt)),
        lambda: bool(PI - TWIN),
        lambda: abs(TWIN - PI),
        lambda: (PI * TWIN - PI**2).sign,
        lambda: floor_log2(2 * TWIN / PI),
        lambda: Fraction(1) >= PI / TWIN,
        lambda: mp.convert(PI - TWIN),
        lambda: float(PI / TWIN - 1),
    ],
)
def test_no_relation_of_constants_is_guessed(question: Callable[[], Any]) -> None:
    """Where two constants may be one number, neither equality nor a sign is answered."""
    with pytest.raises(Undecided, match="pi and twin"):
        question()


def test_a_constant_that_cancels_leaves_nothing_undecided() -> None:
    """Equality in polynomials is proven, also among constants that nothing tells apart."""
    assert PI * TWIN / TWIN == PI
    assert (PI + TWIN) ** 2 == PI**2 + 2 * PI * TWIN + TWIN**2
    assert 2 * TWIN > PI


def test_numbers_of_two_fields_lie_in_that_of_all_their_constants() -> None:
    """Their order does not matter, and what cancels is gone."""
    assert (PI + GAMMA).constants == (GAMMA + PI).constants == (Pi(), Gamma())
    alone = generator((Gamma(),), 0)
    assert alone == GAMMA
    assert (alone + PI - alone) == PI
    assert (TWIN * alone).constants == (Pi(), Twin(), Gamma())
    assert (alone * TWIN) / TWIN == GAMMA


@given(st.integers(1, 1000), st.integers(-2000, 2000))
def test_the_power_of_two_below_a_number(factor: int, shift: int) -> None:
    """2^e <= |value| < 2^(e + 1), for either sign and far from one."""
    number = factor * PI * Fraction(2) ** shift * (-1) ** factor
    e = floor_log2(number)
    assert Fraction(2) ** e <= abs(number) < Fraction(2) ** (e + 1)


@pytest.mark.parametrize("bits", [40, 1000, 20000])
def test_numbers_beside_a_power_of_two_lie_on_their_side(bits: int) -> None:
    """However near: as many bits are taken as it needs."""
    little = PI / Fraction(2) ** bits
    assert floor_log2(4 + little) == 2
    assert floor_log2(4 - little) == 1
    assert 4 - little < 4 < 4 + little


@settings(max_examples=10)
@given(NUMBER.filter(lambda number: isinstance(number, Irrational)))
def test_values_are_near_the_number(number: Irrational) -> None:
    """mpmath gets it to the last bit at any precision, and `near` and `float` are as near as they say."""
    for bits in (24, 53, 400):
        with mp.workprec(bits):
            converted = mp.convert(number)
        with mp.workprec(bits + 400):
            expected = value(number)
            assert abs(converted - expected) <= mp.ldexp(abs(expected), 1 - bits)
            assert abs(value(number.near()) - expected) <= mp.ldexp(abs(expected), -128)
            assert abs(float(number) - expected) <= mp.ldexp(abs(expected), -52)


@settings(max_examples=10)
@given(NUMBER.filter(lambda number: isinstance(number, Irrational)), st.sampled_from([10, 300]))
def test_enclosures_contain_the_number(number: Irrational, bits: int) -> None:
    """A ball of the relative width that was asked for, which contains a sharper one."""
    enclosed = number.enclosure(bits)
    assert enclosed.rel_accuracy_bits() >= bits
    finer = (number + 0).enclosure(4 * bits)
    assert enclosed.contains(finer)
    with mp.workprec(5 * bits + 400):
        assert finer.overlaps(ball(exact_value(value(number))))


@settings(max_examples=10)
@given(NUMBER)
def test_numbers_go_to_another_process(number: Any) -> None:
    """A pickled number comes back equal, with its hash, in its field, and computes as before."""
    back = pickle.loads(pickle.dumps(number))
    assert back == number
    assert hash(back) == hash(number)
    assert back + PI == number + PI
    assert getattr(back, "constants", ()) == getattr(number, "constants", ())
