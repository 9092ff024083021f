"""MPFR's numbers in place of mpmath's: the same to the last bit, and nothing left changed."""

from __future__ import annotations

import operator

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.scenes.mpfr import precision, sqrt, to_mpf, to_mpfr

OPERATIONS = (operator.add, operator.sub, operator.mul, operator.truediv)


def exactly(count: int, exponent: int) -> mpf:
    with mp.workprec(10_000):
        return mp.ldexp(mpf(count), exponent)


def column(*values: mpf) -> np.ndarray:
    return np.array(values, dtype=object)


# Far longer than what they are computed with.
numbers = st.builds(exactly, st.integers(-(2**600), 2**600), st.integers(-2000, 2000))


@given(numbers, st.integers(2, 400))
def test_the_way_there_and_back_is_exact_at_any_precision(value: mpf, bits: int) -> None:
    """No bit of a number is lost, however low the ambient precision is."""
    with mp.workprec(bits):
        (there_and_back,) = to_mpf(to_mpfr(column(value)))
    assert there_and_back._mpf_ == value._mpf_


@given(numbers, numbers, st.integers(2, 400))
def test_every_operation_rounds_as_mpmath_does(a: mpf, b: mpf, bits: int) -> None:
    """Sums, differences, products, quotients and roots are mpmath's to the last bit."""
    with mp.workprec(bits):
        p, q = to_mpfr(column(a)), to_mpfr(column(b))
        for operation in OPERATIONS:
            if operation is operator.truediv and b == 0:
                continue
            with precision():
                result = operation(p, q)
            assert to_mpf(result)[0]._mpf_ == operation(a, b)._mpf_
        with precision():
            root = sqrt(abs(p))
        assert to_mpf(root)[0]._mpf_ == mp.sqrt(abs(a))._mpf_


def test_what_is_not_finite_stays_so() -> None:
    """NaN and both infinities keep what they are, there and back."""
    nan, up, down = to_mpf(to_mpfr(column(mp.nan, mp.inf, -mp.inf)))
    assert mp.isnan(nan)
    assert (up, down) == (mp.inf, -mp.inf)
