"""Weber's curve of genus two: its points, its periods and its theta functions, exactly or by two ways."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from types import SimpleNamespace
from typing import cast

import pytest
from builders.webers import BODIES, built, case, curve_of, second
from flint import acb, acb_mat, arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.balls import ball, midpoint
from taylor_verify.exact.kirchhoff.weber import surd as surds
from taylor_verify.exact.kirchhoff.weber.characteristics import (
    HALF_PERIODS,
    at_branches,
    is_odd,
    of_pair,
)
from taylor_verify.exact.kirchhoff.weber.curve import Curve, curve
from taylor_verify.exact.kirchhoff.weber.integrals import branch_points, jacobian
from taylor_verify.exact.kirchhoff.weber.quadrature import narrowness, real_jacobian
from taylor_verify.exact.kirchhoff.weber.riemann import Thetas
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.scenes import tensors
from taylor_verify.scenes.tensors import Vector

# The curve.


rationals = st.fractions(min_value=-2, max_value=2, max_denominator=8)
positive = st.fractions(min_value=Fraction(1, 4), max_value=2, max_denominator=8)


@settings(max_examples=25, deadline=None)
@given(
    x=st.tuples(rationals, rationals, rationals),
    v=st.tuples(rationals, rationals, rationals),
    r=st.tuples(positive, positive, positive),
    theta=rationals,
    alike=st.booleans(),
)
def test_the_start_is_on_the_curve_and_on_its_ovals(
    x: Vector, v: Vector, r: Vector, theta: Fraction, alike: bool
) -> None:
    """U'^2 + 4 A B is divisible by U, the F_i add to 1, and e2 <= u1 <= e3, e4 <= u2 <= e5: exactly."""
    p = tuple(abs(entry) + 3 for entry in v) if alike else second(r, theta, Fraction(20))
    scene = built(x, tensors.cross(x, v), (r[0],) * 3 if alike else r, p)
    try:
        spectral_curve = curve(scene)
    except NoClosedForm:
        return
    if spectral_curve is None:
        return
    e = spectral_curve.branches
    assert sum(spectral_curve.uhlenbeck) == 1
    assert all(surds.compare(a, b) < 0 for a, b in pairwise(e))
    for k, point in enumerate(spectral_curve.points):
        assert (point.sheet == 0) == (point.branch is not None)
        if point.branch is not None:
            assert point.branch in (2 * k + 1, 2 * k + 2)
    with ctx.workprec(200):
        points = branch_points(spectral_curve)
        for k, point in enumerate(spectral_curve.points):
            u = point.u.form(ball, arb.sqrt)
            assert not u < points[2 * k + 1]
            assert not u > points[2 * k + 2]
            w = ball(spectral_curve.U_rate[1]) * u + ball(spectral_curve.U_rate[2])
            product = arb(-4)
            for entry in points:
                product *= u - entry
            assert ((w / ball(spectral_curve.sigma)) ** 2).overlaps(product)


@given(
    h=rationals,
    d=st.fractions(min_value=0, max_value=4, max_denominator=9),
    slope=rationals,
    c=rationals,
)
def test_a_sign_of_a_surd_is_that_of_its_ball(
    h: Fraction, d: Fraction, slope: Fraction, c: Fraction
) -> None:
    """The roots of z^2 - 2 h z + h^2 - d, and a linear form of them."""
    low, high = surds.roots(Fraction(1), -2 * h, h**2 - d)
    assert surds.compare(low, high) == (-1 if d else 0)
    with ctx.workprec(300):
        for root in (low, high):
            value = ball(slope) * root.form(ball, arb.sqrt) + ball(c)
            sign = root.sign(slope, c)
            # At 300 bits no such form of small rationals is zero to the last bit but zero itself.
            assert (value > 0, value < 0) == (sign > 0, sign < 0)


# The theta functions.


def test_the_sums_of_theta_are_flints() -> None:
    """All sixteen characteristics at two places, and their rates, beside the balls of FLINT."""
    Y = (Fraction(7, 10), Fraction(1, 3), Fraction(3, 2))
    along = (Fraction(2), Fraction(-3, 7))
    with mp.workdps(60), ctx.workprec(240):
        thetas = Thetas(tuple(mp.convert(entry) for entry in Y), range(16))
        upper = [[acb(0, ball(Y[m + n])) for n in range(2)] for m in range(2)]
        for Z in ((Fraction(0), Fraction(0)), (Fraction(5, 7), Fraction(-11, 3))):
            place = acb_mat([[acb(ball(z))] for z in Z])
            jets = acb_mat(upper).theta_jets(place, 1)
            numbers = [mp.convert(z) for z in Z]
            values = thetas.values(numbers)
            slopes = thetas.slopes(numbers, [mp.convert(g) for g in along])
            for which in range(16):
                slope = ball(along[0]) * jets[which, 1] + ball(along[1]) * jets[which, 2]
                assert abs(values[which] - midpoint(jets[which, 0].real)) <= mpf(10) ** -55
                assert abs(slopes[which] - midpoint(slope.real)) <= mpf(10) ** -54


def test_six_characteristics_are_odd_and_stand_for_the_six_branch_points() -> None:
    """Riemann's constant and each half period added to it; the ten of two finite points are even."""
    odd = {at_branches(), *(at_branches(j) for j in range(5))}
    assert odd == {which for which in range(16) if is_odd(which)}
    pairs = {at_branches(p, q) for p in range(5) for q in range(p)}
    assert pairs == set(range(16)) - odd
    assert [HALF_PERIODS[p] ^ HALF_PERIODS[q] for p, q in ((0, 1), (3, 4))] == [
        of_pair(0, 1),
        of_pair(3, 4),
    ]


@pytest.mark.parametrize("body", BODIES)
def test_the_periods_of_both_routes_are_one_matrix(body: str) -> None:
    """Riemann's relations hold, tau is the same by both integrations, and so are the rates."""
    spectral_curve = curve_of(case("plain", body))
    with mp.workdps(50), ctx.workprec(240):
        one, other = jacobian(spectral_curve), real_jacobian(spectral_curve)
        balls = [one.tau[0, 0], one.tau[0, 1], one.tau[1, 1]]
        for tau, Y in zip(balls, other.Y, strict=True):
            assert abs(midpoint(tau.imag) - Y) <= mpf(10) ** -45
        assert other.Y[0] > 0
        assert other.Y[0] * other.Y[2] > other.Y[1] ** 2
        for a, b in zip(one.rate + one.neumann, other.rate + other.neumann, strict=True):
            assert abs(midpoint(a) - b) <= mpf(10) ** -45


@given(st.integers(1, 60))
def test_the_digits_that_two_branch_points_share_are_counted(shared: int) -> None:
    """As many are lost by a difference, and one more: the gap is a share of 2/10^n of all."""
    points = [Fraction(1), 1 + Fraction(6, 10**shared), *map(Fraction, (2, 3, 4))]
    branches = SimpleNamespace(branches=[surds.Surd(e) for e in points])
    assert narrowness(cast(Curve, branches)) == shared + 1
