"""Jacobi's functions from (m, m'): against theta functions, and by identities where those fail."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.elliptic import Landen, Triple

DIGITS = 50
# jacobi() works with ten bits more than asked for, against some sixty roundings on the way; what is
# left is the rounding of each result and a few more in the identity itself.
FEW_ULP = 8


def jacobi(u: mpf, m: mpf, m_prime: mpf) -> Triple:
    """(sn, cn, dn)(u | m) to the working precision; the smaller parameter is the exact one."""
    u, m, m_prime = map(mp.convert, (u, m, m_prime))
    # u = 1e12 is some 1e12/4K periods: what is lost in reducing it is its magnitude.
    with mp.extraprec(10 + mp.mag(1 + abs(u))):
        pair = (m, 1 - m) if m <= m_prime else (1 - m_prime, m_prime)
        sn, cn, dn = Landen(*pair).jacobi(u)
    return +sn, +cn, +dn


def complete_k(m_prime: mpf) -> mpf:
    with mp.extraprec(10):
        return Landen(1 - m_prime, m_prime).quarter_period


@pytest.fixture(autouse=True)
def fifty_digits():
    with mp.workdps(DIGITS):
        yield


def ulps(value: mpf, expected: mpf, scale: mpf | int = 1) -> mpf:
    """The difference in units of the working precision's epsilon, relative to the scale."""
    return abs(value - expected) / (scale * mp.eps)


def theta_route(u: mpf, m: mpf) -> list[mpf]:
    """The same three numbers from mpmath's theta functions, at a precision that covers u."""
    with mp.workdps(2 * DIGITS):
        return [mp.ellipfun(name, u, m=m) for name in ("sn", "cn", "dn")]


PARAMETERS = st.integers(1, 10**6 - 1).map(lambda n: mp.mpf(n) / 10**6)
ARGUMENTS = st.integers(-(10**9), 10**9).map(lambda n: mp.mpf(n) / 10**7)


@given(PARAMETERS, ARGUMENTS)
@settings(max_examples=60, deadline=None)
def test_the_landen_chain_agrees_with_theta_functions(m, u):
    """For moderate m, (sn, cn, dn) from the arithmetic-geometric mean are mpmath's ellipfun."""
    for value, expected in zip(jacobi(u, m, 1 - m), theta_route(u, m), strict=True):
        # The three are at most 1, so that an absolute difference is the honest one.
        assert ulps(value, expected) <= FEW_ULP


@pytest.mark.parametrize("u", ["1e6", "-3e9", "1e12", "123456789012.25"])
@pytest.mark.parametrize("m", ["0.51", "1e-12", "0.999999"])
def test_no_digit_is_lost_over_many_periods(u, m):
    """At |u| up to 1e12 the functions are as accurate as at 0, for the parameter as given."""
    u, m = mpf(u), mpf(m)
    for value, expected in zip(jacobi(u, m, 1 - m), theta_route(u, m), strict=True):
        assert ulps(value, expected) <= FEW_ULP


NEAR_SEPARATRIX = ["1e-12", "1e-24", "1e-60", "1e-100"]
WIDE = ["0.3", "1", "20", "69.7", "-71", "1e3", "1e6", "-1e9", "1e12"]


@pytest.mark.parametrize("u", WIDE)
@pytest.mark.parametrize("m_prime", NEAR_SEPARATRIX)
def test_squares_add_up_however_small_m_prime(m_prime, u):
    """sn^2 + cn^2 = 1 and dn^2 = cn^2 + m' sn^2, the latter relatively, although m rounds to 1."""
    m_prime = mpf(m_prime)
    sn, cn, dn = jacobi(mpf(u), 1 - m_prime, m_prime)
    assert ulps(sn**2 + cn**2, mpf(1)) <= FEW_ULP
    assert ulps(cn**2 + m_prime * sn**2, dn**2, dn**2) <= FEW_ULP
    assert dn >= mp.sqrt(m_prime) * (1 - mp.eps)


@pytest.mark.parametrize("u", WIDE)
@pytest.mark.parametrize("m_prime", [*NEAR_SEPARATRIX, "0.49", "0.999999999999"])
def test_doubling_the_argument(m_prime, u):
    """sn 2u, cn 2u and dn 2u follow from those at u (DLMF 22.6.5-7, denominators made positive)."""
    u, m_prime = mpf(u), mpf(m_prime)
    m = 1 - m_prime
    sn, cn, dn = jacobi(u, m, m_prime)
    denominator = cn**2 + (sn * dn) ** 2  # = 1 - m sn^4
    doubled = (
        2 * sn * cn * dn / denominator,
        (cn**2 - (sn * dn) ** 2) / denominator,
        (dn**2 * cn**2 + m_prime * sn**2) / denominator,
    )
    for value, expected in zip(jacobi(2 * u, m, m_prime), doubled, strict=True):
        # Cubes triple the relative error of their parts; numerators are below denominators.
        assert ulps(value, expected) <= 3 * FEW_ULP


@pytest.mark.parametrize("m_prime", ["0.49", "1e-12", "1e-60"])
def test_quarter_periods_shift_the_functions(m_prime):
    """sn(u + 2K) = -sn u, cn(u + 2K) = -cn u, dn(u + 2K) = dn u, and sn K = 1, dn K = k'."""
    m_prime = mpf(m_prime)
    chain = Landen(1 - m_prime, m_prime)
    K, u = chain.quarter_period, mpf("0.7")
    here, there = chain.jacobi(u), chain.jacobi(u + 2 * K)
    # The chain is used without guard digits: up to 14 steps of half a dozen roundings each, and the
    # rounding of u + 2K, which is below 150.
    roundings = 14 * 6 + 150
    for sign, value, expected in zip((-1, -1, 1), here, there, strict=True):
        assert ulps(sign * value, expected) <= roundings
    sn, _, dn = chain.jacobi(K)
    assert ulps(sn, mpf(1)) <= roundings
    assert ulps(dn, mp.sqrt(m_prime), mp.sqrt(m_prime)) <= roundings


@given(PARAMETERS)
@settings(max_examples=30, deadline=None)
def test_complete_integral_is_the_hypergeometric_one(m):
    """K = pi/2 F(1/2, 1/2; 1; m), summed by a route that knows no mean."""
    with mp.workdps(DIGITS + 10):
        series = mp.pi / 2 * mp.hyp2f1(mpf(1) / 2, mpf(1) / 2, 1, m)
    # 1 - m is rounded, which moves K ~ log(4/k') by at most half an ulp.
    assert ulps(+complete_k(1 - m), series, series) <= FEW_ULP


@pytest.mark.parametrize("m_prime", ["1e-12", "1e-24", "1e-60"])
def test_complete_integral_near_the_separatrix(m_prime):
    """K = L + (L - 1) m'/4 + O(m'^2 L) with L = log(4/k') (DLMF 19.12.1)."""
    m_prime = mpf(m_prime)
    L = mp.log(4 / mp.sqrt(m_prime))
    K = Landen(1 - m_prime, m_prime).quarter_period
    # The next term of the series is (9/64)(L - 7/6) m'^2.
    assert abs(K - (L + (L - 1) * m_prime / 4)) <= L * m_prime**2 + 200 * mp.eps


@pytest.mark.parametrize("m", ["1e-8", "1e-30", "1e-60"])
def test_small_parameter_is_nearly_trigonometric(m):
    """sn u = sin u - (m/4)(u - sin u cos u) cos u + O(m^2) (DLMF 22.10.7)."""
    m, u = mpf(m), mpf(2)
    sn, _, _ = jacobi(u, m, 1 - m)
    first = mp.sin(u) - m / 4 * (u - mp.sin(u) * mp.cos(u)) * mp.cos(u)
    # The coefficient of m^2 is a cubic in u with coefficients below 1.
    assert abs(sn - first) <= 8 * m**2 + FEW_ULP * mp.eps


@pytest.mark.parametrize("m_prime", ["1e-8", "1e-30", "1e-60"])
def test_parameter_near_one_is_nearly_hyperbolic(m_prime):
    """sn u = tanh u - (m'/4)(u - sinh u cosh u) sech^2 u + O(m'^2) (DLMF 22.10.10)."""
    m_prime, u = mpf(m_prime), mpf(2)
    sn, _, _ = jacobi(u, 1 - m_prime, m_prime)
    first = mp.tanh(u) - m_prime / 4 * (u - mp.sinh(u) * mp.cosh(u)) * mp.sech(u) ** 2
    # Corrections grow as (m' e^{2u})^n.
    assert abs(sn - first) <= m_prime**2 * mp.exp(4 * u) + FEW_ULP * mp.eps


def test_zero_parameter_is_trigonometric():
    """At m = 0 the functions are sin u, cos u and 1."""
    u = mpf("17.3")
    expected = (mp.sin(u), mp.cos(u), mpf(1))
    for value, right in zip(jacobi(u, mpf(0), mpf(1)), expected, strict=True):
        assert ulps(value, right) <= FEW_ULP


def test_detest_b5_is_solved_by_the_three_functions():
    """y = (sn, cn, dn)(t | 0.51) solves DETEST B5: y1' = y2 y3, y2' = -y1 y3, y3' = -0.51 y1 y2."""
    t, m, h = mpf(20), mpf("0.51"), mpf("1e-12")
    y1, y2, y3 = jacobi(t, m, 1 - m)
    samples = [jacobi(t + k * h, m, 1 - m) for k in (-2, -1, 1, 2)]
    derivatives = [
        (far_back - 8 * back + 8 * ahead - far_ahead) / (12 * h)
        for far_back, back, ahead, far_ahead in zip(*samples, strict=True)
    ]
    # The rule's error is h^4/30 |y^(5)| <= 4e-48 (|y^(n)| <= n!), its rounding 2 eps/h ~ 1e-38.
    for value, expected in zip(derivatives, (y2 * y3, -y1 * y3, -m * y1 * y2), strict=True):
        assert abs(value - expected) <= mpf("1e-37")


def test_detest_b5_reference_digits():
    """The digits in circulation for B5 at t = 20 are the three functions to double precision."""
    published = ("-0.9396570798729192", "-0.3421177754000779", "0.7414126596199957")
    m = mpf("0.51")
    # An integrator in doubles over 20 units of time, with |y'| <= 1, rounds each component 20 times
    # even if it takes steps as long as 1; it took shorter ones.
    bound = 20 * 2 * mpf(2) ** -52
    for value, digits in zip(jacobi(mpf(20), m, 1 - m), published, strict=True):
        assert abs(value - mpf(digits)) <= bound


@pytest.mark.parametrize(
    ("m", "m_prime"), [("1", "0"), ("1.1", "-0.1"), ("-0.1", "1.1"), ("nan", "nan")]
)
def test_parameters_outside_the_range_are_refused(m, m_prime):
    """m = 1 (hyperbolic), m > 1, m < 0 and NaN are refused with the range that is expected."""
    with pytest.raises(ValueError, match="expected 0 <= m and 0 < m'"):
        Landen(mpf(m), mpf(m_prime))
