"""The squared speed on the washboard: derivatives, quotients and wide balls are of one function."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from builders.scenes import vector
from builders.washboards import axial, board
from flint import acb, arb, ctx

from taylor_verify.exact.balls import ball
from taylor_verify.exact.euler.moments.washboard.speed import speed
from taylor_verify.exact.euler.moments.washboard.turnings import turnings
from taylor_verify.scenes.scene import Scene

BITS = 400
# The third derivatives are some tens: a difference errs by some tens of STEP^2.
STEP, CLOSE = arb(2) ** -120, arb(2) ** -220
SWINGING = axial(2, "1/20", vector("1/2", "3/5", "-1/5"))
GROWING = axial(1, "-1/3", vector("1/2", "-1/4", "2/3"))
each_kind = pytest.mark.parametrize("scene", [SWINGING, GROWING], ids=["swinging", "growing"])
# Odd numbers, at which no function of these is zero.
PLACES = vector("7/10", "-13/11")


def slope(f: Callable[[arb], arb], sigma: arb) -> arb:
    """The derivative, as a difference."""
    return (f(sigma + STEP) - f(sigma - STEP)) / (2 * STEP)


@each_kind
def test_a_derivative_is_the_limit_of_differences(scene: Scene) -> None:
    """F' is that of F, and the second derivative of its wave is that of the first; F begins at nu^2."""
    with ctx.workprec(BITS):
        washboard = board(scene)
        F = speed(washboard)
        assert abs(F.squared(arb(0)) - ball(washboard.nu**2)) <= CLOSE
        for sigma in map(ball, PLACES):
            assert abs(F.derivative(sigma) - slope(F.squared, sigma)) <= CLOSE
            second = slope(lambda s: F._wave(s, 1), sigma)
            assert abs(F._wave(sigma, 2) - second) <= CLOSE
            assert abs(second) >= arb("0.01")


@each_kind
def test_a_quotient_is_that_of_the_speed(scene: Scene) -> None:
    """F(end + z)/z, of a narrow z beside the end, and of a wide one far from it."""
    with ctx.workprec(BITS):
        washboard = board(scene)
        F, end = speed(washboard), turnings(washboard).lower
        for z in (acb(arb(1) / 1000), acb(arb(3) / 10, arb(-1) / 5)):
            assert abs(F.quotient(end)(z) * z - F.squared(end + z)) <= CLOSE
        wide = acb(arb(3, 2.0**-60), arb(1, 2.0**-60))
        inside = acb(arb(3) + arb(2) ** -61, arb(1) - arb(2) ** -61)
        assert (F.quotient(end)(wide) * inside).overlaps(F.squared(end + inside))


@each_kind
def test_a_wide_ball_is_as_wide_as_its_second_order(scene: Scene) -> None:
    """It holds F of its points, and is as wide as the tangent there and half of the second order."""
    with ctx.workprec(BITS):
        F, radius = speed(board(scene)), arb(2) ** -10
        for sigma in map(ball, PLACES):
            around = F.around(acb(sigma + arb(0, radius.mid())))
            for part in (-1, 0, 1):
                assert around.contains(F.squared(acb(sigma + radius * part)).mid())
            tangent, second = abs(F.derivative(sigma)) * radius, abs(F._wave(sigma, 2)) * radius**2
            # A radius has thirty bits, and a third order is a thousandth of the second, times some units.
            assert around.real.rad() <= tangent * (1 + arb(2) ** -25) + second / 2 * arb("1.1")
