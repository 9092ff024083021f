"""Weber's curve of genus two: its points, its periods and the zeros of its theta functions, exactly."""

from __future__ import annotations

from fractions import Fraction

from builders.webers import built, second
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st

from taylor_verify.exact.kirchhoff.weber.characteristics import (
    at_branches,
    is_odd,
)
from taylor_verify.exact.kirchhoff.weber.curve import curve
from taylor_verify.exact.kirchhoff.weber.periods import branch_points, points
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
    assert sum(spectral_curve.uhlenbeck) == 1
    with ctx.workprec(200):
        e = branch_points(spectral_curve)
        assert all(
            e[k].overlaps(ball(a))
            for k, a in zip(spectral_curve.places, spectral_curve.a, strict=True)
        )
        for k, (u, sheet) in enumerate(points(spectral_curve)):
            ends = e[2 * k + 1], e[2 * k + 2]
            assert (sheet == 0) == any(map(u.overlaps, ends))
            assert not u < ends[0]
            assert not u > ends[1]
            w = ball(spectral_curve.U_rate[1]) * u + ball(spectral_curve.U_rate[2])
            product = arb(-4)
            for entry in e:
                product *= u - entry
            assert ((w / ball(spectral_curve.sigma)) ** 2).overlaps(product)


# The theta functions.


def test_six_characteristics_are_odd_and_stand_for_the_six_branch_points() -> None:
    """Riemann's constant and each half period added to it; the ten of two finite points are even."""
    odd = {at_branches(), *(at_branches(j) for j in range(5))}
    assert odd == {which for which in range(16) if is_odd(which)}
    pairs = {at_branches(p, q) for p in range(5) for q in range(p)}
    assert pairs == set(range(16)) - odd
