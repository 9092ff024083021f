"""Weber's curve of genus two: its points, its periods and the zeros of its theta functions, exactly."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from builders.webers import built, second
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st

from taylor_verify.exact.kirchhoff.weber import surd as surds
from taylor_verify.exact.kirchhoff.weber.characteristics import (
    at_branches,
    is_odd,
)
from taylor_verify.exact.kirchhoff.weber.curve import curve
from taylor_verify.exact.kirchhoff.weber.integrals import branch_points
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.tensors import Vector

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


def test_six_characteristics_are_odd_and_stand_for_the_six_branch_points() -> None:
    """Riemann's constant and each half period added to it; the ten of two finite points are even."""
    odd = {at_branches(), *(at_branches(j) for j in range(5))}
    assert odd == {which for which in range(16) if is_odd(which)}
    pairs = {at_branches(p, q) for p in range(5) for q in range(p)}
    assert pairs == set(range(16)) - odd
