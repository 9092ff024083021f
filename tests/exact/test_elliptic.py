"""Jacobi's functions from (m, m'): they are mpmath's theta functions at a lavish precision."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.elliptic import Landen, Triple

DIGITS = 50
# 1 - m' keeps m' = 1e-100 with as many digits as it has itself.
LAVISH = 220
# jacobi() works with ten bits more than asked for, against some sixty roundings on the way; what is
# left is the rounding of each result.
FEW_ULP = 8


@pytest.fixture(autouse=True)
def fifty_digits() -> Iterator[None]:
    with mp.workdps(DIGITS):
        yield


def jacobi(u: mpf, small: mpf, near_one: bool) -> Triple:
    """(sn, cn, dn)(u) to the working precision, with ``small`` for m, or for m' where m is near one."""
    # u = 1e12 is some 1e12/4K periods: what is lost in reducing it is its magnitude.
    with mp.extraprec(10 + mp.mag(1 + abs(u))):
        pair = (1 - small, small) if near_one else (small, 1 - small)
        sn, cn, dn = Landen(*pair).jacobi(u)
    return +sn, +cn, +dn


def theta_route(u: mpf, small: mpf, near_one: bool) -> list[mpf]:
    """Return the same three numbers by theta functions."""
    with mp.workdps(LAVISH):
        m = 1 - small if near_one else small
        return [mp.ellipfun(name, u, m=m) for name in ("sn", "cn", "dn")]


def ulps(value: mpf, expected: mpf) -> mpf:
    """The difference in units of the working precision's epsilon, relative to the number."""
    return abs(value - expected) / (abs(expected) * mp.eps)


@given(
    st.integers(1, 10**6 - 1).map(lambda n: mpf(n) / 10**6),
    st.integers(-(10**9), 10**9).map(lambda n: mpf(n) / 10**7),
)
@settings(max_examples=60, deadline=None)
def test_the_landen_chain_agrees_with_theta_functions(m: mpf, u: mpf) -> None:
    """For moderate m, (sn, cn, dn) from the arithmetic-geometric mean are mpmath's ellipfun."""
    for value, expected in zip(jacobi(u, m, False), theta_route(u, m, False), strict=True):
        # The three are at most 1, so that an absolute difference is the honest one.
        assert abs(value - expected) <= FEW_ULP * mp.eps


@pytest.mark.parametrize("u", ["0.3", "20", "-71", "1e6", "-3e9", "123456789012.25"])
@pytest.mark.parametrize("near_one", [False, True])
@pytest.mark.parametrize("small", ["0.49", "1e-12", "1e-60", "1e-100"])
def test_no_digit_is_lost_at_either_end_or_over_many_periods(
    small: str, near_one: bool, u: str
) -> None:
    """The digits last for m or m' to 1e-100 and |u| to 1e11; dn relatively, which is k' at its least."""
    given_one = mpf(u), mpf(small), near_one
    (sn, cn, dn), (s, c, d) = jacobi(*given_one), theta_route(*given_one)
    assert max(abs(sn - s), abs(cn - c)) <= FEW_ULP * mp.eps
    assert ulps(dn, d) <= FEW_ULP
