"""An ellipsoid is enclosed itself: its coefficients enter as balls about Lamb's numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from flint import acb, arb, ctx
from mpmath import mp

from taylor_verify.exact.as_written import as_written
from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.exact.enclosure.operations import Bilinear
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import _distance
from taylor_verify.numbers.irrational import Irrational, ball
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import Ellipsoid
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.named_numbers import entrywise
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.stand_in import StandIn

SHAPES = {
    "triaxial": vector(3, 2, 1),
    "prolate": vector(1, 1, 2),
    "oblate": vector(2, "0.5", 2),
    "sphere": vector("1.5", "1.5", "1.5"),
    "nearly equal axes": vector(1, "1.000000000000000000000000000001", 2),
    "disc": vector(1, "1.5", "1e-6"),
    "disc of revolution": vector(1, 1, "1e-6"),
}
# A disc of so little mass turns a million times as fast.
LATER = {name: Fraction(1, 10**6 if "disc" in name else 1) for name in SHAPES}
START = Impulse(vector("0.1", "0.2", 1), vector("0.3", 0, 1), centre=vector(1, 2, 3))


def shaped(name: str, fluid: int = 1) -> Scene:
    body = Ellipsoid(SHAPES[name], Fraction(1), Fraction(fluid)).body()
    return one_instant(body, START, "attitude", "centre")


def with_numbers(scene: Scene, number: Callable[[Fraction], Fraction]) -> Scene:
    """The scene of another body of rationals, in place of the numbers that its rationals stand for."""
    return replace(scene, body=scene.body.changed(lambda _, part: entrywise(number, part)))


def near(scene: Scene, bits: int) -> Scene:
    """The scene of a rational body that is so many bits from the ellipsoid."""

    def rational(number: Fraction) -> Fraction:
        if not isinstance(number, StandIn):
            return number
        return exact_value(midpoint(number.exactly.enclosure(bits)))

    return with_numbers(scene, rational)


def quadrature(axes: Vector, i: int) -> arb:
    """a1 a2 a3 int dt / ((a_i^2 + t) D), enclosed.

    With t = s (1/u^2 - 1) the integrand is analytic in u from 0 to 1; s is the largest a_i^2.
    """
    squares = [a * a for a in axes]
    s = max(squares)

    def integrand(u: acb, analytic: bool) -> acb:
        # A factor 1/(a^2 + t) is u^2/(s + (a^2 - s) u^2).
        terms = [ball(s) + ball(q - s) * u * u for q in squares]
        value = 2 * ball(s) * u**2 / terms[i]
        for term in terms:
            value /= term.sqrt(analytic=analytic)
        return value

    return ball(axes[0] * axes[1] * axes[2]) * acb.integral(integrand, 0, 1).real


@pytest.mark.parametrize("name", SHAPES)
def test_the_balls_contain_lambs_coefficients(name: str) -> None:
    """A certified quadrature of Lamb's own integrands gives the added mass along each axis."""
    axes = SHAPES[name]
    with ctx.workprec(100):
        body = as_written(shaped(name)).body
        velocity = kind_of(body).equations(body).velocity
        volume = 4 * arb.pi() * ball(axes[0] * axes[1] * axes[2]) / 3
        for i in range(3):
            alpha = quadrature(axes, i)
            true = 1 / (volume + volume * alpha / (2 - alpha))
            assert true.rel_accuracy_bits() > 30
            assert ball(velocity[i, i]).overlaps(true)
            assert ball(velocity[i, i]).rel_accuracy_bits() > 90


def equations(scene: Scene, bits: int) -> list[arb]:
    system = posed(as_written(scene))
    with ctx.workprec(bits):
        factors = filter(None, system.pieces(Fraction(0), True).tape.factors())
    return [
        number
        for each in factors
        for number in (each.constant, *(entry[0] for entry in each.products + each.sums))
        if number is not None
    ]


@pytest.mark.parametrize("bits", by_turns([100, 60, 700]))
@pytest.mark.parametrize("name", SHAPES)
def test_every_equation_contains_that_of_a_sharper_body(name: str, bits: int) -> None:
    """Each entry holds the one of the body to far more bits; what is zero is zero exactly."""
    sharper = equations(near(shaped(name), 2 * bits + 800), 2 * bits + 800)
    for enclosed, true in zip(equations(shaped(name), bits), sharper, strict=True):
        assert enclosed.overlaps(true)
        assert enclosed.is_zero() == true.is_zero()
        # Differences of nearly equal coefficients as well.
        assert enclosed.is_zero() or enclosed.rel_accuracy_bits() >= bits - 8


def test_a_rounded_coefficient_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """With numbers of 30 bits in place of their balls the equations are those of another body."""

    def contains_the_body() -> bool:
        pairs = zip(equations(shaped("triaxial"), 60), sharper, strict=True)
        return all(enclosed.overlaps(true) for enclosed, true in pairs)

    def coarse(number: Irrational, bits: int) -> Any:
        with ctx.workprec(30):
            return (+honest(number, bits)).mid()

    sharper, honest = equations(near(shaped("triaxial"), 400), 400), Irrational.enclosure
    assert contains_the_body()
    monkeypatch.setattr(Irrational, "enclosure", coarse)
    assert not contains_the_body()


@pytest.mark.parametrize("fluid", [0, 1])
def test_in_a_vacuum_no_mass_is_added(fluid: int) -> None:
    """Then U is x by the mass, and x x U is zero exactly."""
    tape = posed(as_written(shaped("triaxial", fluid))).pieces(Fraction(0), True).tape
    products = [operation for operation in tape.operations if isinstance(operation, Bilinear)]
    linear = {tape.states[i] for i in range(3)}
    assert all({a, b} - linear for each in products for _, a, b in each.products) is (fluid == 0)


@pytest.mark.parametrize("name", by_turns(SHAPES, 8))
def test_the_motion_is_that_of_the_ellipsoid_at_any_digits(name: str) -> None:
    """At 150 digits it is not that of the rationals that a scene holds."""
    scene, later = shaped(name), [LATER[name]]
    motion = solution(scene, "taylor").motion(later, 150)
    finer = solution(near(scene, 800), "taylor").motion(later, 160)
    coarse = solution(with_numbers(scene, Fraction), "taylor").motion(later, 150)
    with mp.workdps(200):
        for quantity in motion.quantities:
            apart = _distance(motion[quantity][0], finer[quantity][0])
            assert apart <= 2 * motion.radius_of(quantity)[0]
        apart = _distance(motion["centre"][0], coarse["centre"][0])
        # That body is another one: proven, as its balls lie apart.
        assert apart > motion.radius[0] + coarse.radius[0]


@pytest.mark.parametrize("name", ["prolate", "oblate", "sphere", "disc of revolution"])
def test_the_closed_form_is_of_the_same_body_as_the_enclosure(name: str) -> None:
    """They overlap at 140 digits, more than the rationals of the scene have."""
    scene, later = shaped(name), [3 * LATER[name]]
    motion, closed = (solution(scene, route).motion(later, 140) for route in ("taylor", "arb"))
    with mp.workdps(170):
        for quantity in motion.quantities:
            apart = _distance(motion[quantity][0], closed[quantity][0])
            assert apart <= (motion.radius[0] + closed.radius[0]) * 2
