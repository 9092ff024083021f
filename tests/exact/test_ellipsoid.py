"""The ellipsoid in a fluid: its inertias by independent routes, rounded for solvers, enclosed as balls."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from flint import acb, arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.as_written import as_written
from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.exact.enclosure.operations import Bilinear
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import _distance
from taylor_verify.numbers.irrational import PI, Irrational, ball
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes import ellipsoid
from taylor_verify.scenes.bodies import Ellipsoid, ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.named_numbers import entrywise
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.stand_in import STAND_IN_BITS, StandIn, written

BITS = STAND_IN_BITS

SHAPES = {
    "triaxial": (3, 2, 1),
    "in another order": (Fraction(1, 2), 5, Fraction(4, 3)),
    "prolate": (1, 1, 2),
    "oblate": (Fraction(1, 3), 2, 2),
    "sphere": (2, 2, 2),
    "nearly a sphere": (1, 1 + Fraction(1, 10**9), 1 - Fraction(1, 10**12)),
    "flat": (1, 2, Fraction(1, 1000)),
    "slender": (Fraction(1, 100), 1, Fraction(1, 50)),
}
EXTREME = {
    "disc": (1, 1, Fraction(1, 10**300)),
    "needle": (10**300, 2, 1),
    "three scales": (10**2000, 1, Fraction(1, 10**2000)),
    "all but spherical": (1, 1 + Fraction(1, 10**300), 1 - Fraction(1, 10**200)),
    "all but a spheroid": (2, 2 + Fraction(1, 10**1000), 1),
}


def shape(axes: tuple[Fraction | int, ...], density: int = 1, fluid: int = 1) -> Ellipsoid:
    return Ellipsoid(tuple(map(Fraction, axes)), Fraction(density), Fraction(fluid))


def added(ellipsoid: Ellipsoid) -> tuple[list[mpf], list[mpf]]:
    """m_i and j_i at the ambient precision."""
    exact = ellipsoid.inertias
    return [*map(mp.convert, exact.added_mass)], [*map(mp.convert, exact.added_inertia)]


def diagonal(body: ImmersedBody) -> list[Any]:
    """1/(M + m_i) and 1/(I_i + j_i), as a scene has them."""
    return [block[i][i] for block in (body.linear, body.angular) for i in range(3)]


# Against routes that share no formula.


# Without mass, only three different axes give every motion an inertia.
BODIES = [(axes, 1) for axes in (SHAPES | EXTREME).values()]
BODIES += [(axes, 0) for axes, _ in BODIES if len(set(axes)) == 3]


@pytest.mark.parametrize(("axes", "density"), BODIES)
def test_coefficients_are_rounded_once(axes: tuple[Fraction, ...], density: int) -> None:
    """Every rational has 400 bits, and is within 2^-400 of the number that it stands for."""
    body = shape(axes, density).body()
    assert body.ellipsoid is not None
    inertias = (*body.ellipsoid.inertias.masses, *body.ellipsoid.inertias.moments)
    for number, inertia in zip(diagonal(body), inertias, strict=True):
        check_rounding(number)
        assert number.exactly == 1 / inertia


def check_rounding(number: Fraction) -> None:
    assert isinstance(number, StandIn)
    assert number.denominator & (number.denominator - 1) == 0
    zeros = number.numerator & -number.numerator
    assert (number.numerator // zeros).bit_length() <= BITS
    with ctx.workprec(BITS + 200):
        exactly = number.exactly.enclosure(BITS + 100)
        assert abs(ball(number) / exactly - 1) <= arb(2) ** -BITS


axis = st.builds(
    lambda size, gap, power: Fraction(size) * (1 + gap * Fraction(1, 10**power)),
    st.integers(1, 4),
    st.integers(0, 2),
    st.integers(0, 60),
)
densities = st.fractions(0, 1000, max_denominator=1000)


@settings(max_examples=15)
@given(st.tuples(axis, axis, axis), densities.filter(bool), densities, st.permutations(range(3)))
def test_axes_in_another_order_are_the_same_body(
    axes: Vector, density: Fraction, fluid: Fraction, order: list[int]
) -> None:
    """To rename the axes renames the coefficients and changes no bit; so equal axes have equal ones.

    Two of the integrals are in the numbers, and which two depends on the order.
    """
    as_given = diagonal(Ellipsoid(axes, density, fluid).body())
    renamed = diagonal(Ellipsoid(tuple(axes[i] for i in order), density, fluid).body())
    for number in as_given:
        check_rounding(number)
    assert [as_given[i] for i in order] + [as_given[3 + i] for i in order] == renamed
    for i, j in ((0, 1), (1, 2), (2, 0)):
        is_equal = as_given[3 + i] == as_given[3 + j]
        assert is_equal is (axes[i] == axes[j])


@pytest.mark.parametrize("name", [*SHAPES, *EXTREME])
def test_the_fluid_resists_most_along_the_shortest_axis(name: str) -> None:
    """Added masses have the opposite order of the semi-axes, exactly, however little these differ."""
    body = shape((SHAPES | EXTREME)[name])
    axes, m = body.semi_axes, body.inertias.added_mass
    for i in range(3):
        for j in range(3):
            assert (m[i] > m[j]) is (axes[i] < axes[j])
            assert (m[i] == m[j]) is (axes[i] == axes[j])


def test_a_sphere_carries_half_the_mass_it_displaces() -> None:
    """m = rho V/2 and j = 0 exactly, so that p = 1/(M + rho V/2) and r = 5/(2 M a^2)."""
    body = shape((2, 2, 2), density=3, fluid=5).body()
    volume = Fraction(32, 3) * PI
    p, r = written(body.linear[0][0]), written(body.angular[0][0])
    assert p == 1 / (volume * (3 + Fraction(5, 2)))
    assert r == 5 / (2 * 3 * volume * 4)


# The flow itself.


def energy_of_turning(ellipsoid: Ellipsoid) -> mpf:
    """Twice the kinetic energy of the fluid about an ellipsoid that turns about axis 1 at unit rate.

    The potential is C y z chi(l), chi(l) = int from l dt / ((b^2 + t)(c^2 + t) D) on the confocal
    surface l. C makes the normal velocity on the body that of the body, at one point; that it does so
    at all of them is checked at another. Green's theorem then gives the energy from the surface.
    """
    a, b, c = (mp.convert(axis) for axis in ellipsoid.semi_axes)

    def chi(start: mpf) -> mpf:
        def integrand(t: mpf) -> mpf:
            B, C = b * b + t, c * c + t
            return 1 / (B * C * mp.sqrt((a * a + t) * B * C))

        return mp.quad(integrand, [start, start + 1, start + 10, start + 100, mp.inf])

    def confocal(x: mpf, y: mpf, z: mpf) -> mpf:
        def f(t: mpf) -> mpf:
            return x**2 / (a**2 + t) + y**2 / (b**2 + t) + z**2 / (c**2 + t) - 1

        return mp.findroot(f, mpf("1e-3"))

    def constant(theta: mpf, phi: mpf) -> mpf:
        x, y, z = (
            a * mp.cos(theta),
            b * mp.sin(theta) * mp.cos(phi),
            c * mp.sin(theta) * mp.sin(phi),
        )
        normal = x / a**2, y / b**2, z / c**2

        def potential(s: mpf) -> mpf:
            there = x + s * normal[0], y + s * normal[1], z + s * normal[2]
            return there[1] * there[2] * chi(confocal(*there))

        # e1 x r on the body, along the normal; the fluid's derivative in the same direction.
        return (-z * normal[1] + y * normal[2]) / mp.diff(potential, 0, h=mpf("1e-9"), direction=1)

    C = constant(mpf(1), mpf("0.7"))
    assert abs(constant(mpf("0.4"), mpf(2)) / C - 1) <= mpf("1e-6")
    # -rho (surface integral of phi dphi/dn); of y z (y n_z - z n_y) it is int (y^2 - z^2) dV.
    volume = 4 * mp.pi * a * b * c / 3
    return -mp.convert(ellipsoid.fluid_density) * C * chi(mpf(0)) * volume * (b**2 - c**2) / 5


# One-sided differences of step 1e-9 leave 1e-8; the boundary condition is held to a hundred times that.
FLOW_BOUND = mpf("1e-6")


def flow_error(ellipsoid: Ellipsoid) -> mpf:
    """How far j_1 is off the energy of the flow that it stands for."""
    with mp.workdps(30):
        _, j = added(ellipsoid)
        return abs(j[0] / energy_of_turning(ellipsoid) - 1)


def disc_error() -> mpf:
    with mp.workdps(60):
        _, j = added(shape((1, 1 + Fraction(1, 10**50), Fraction(1, 10**30))))
        return abs(j[0] * 45 / 16 - 1)


@pytest.mark.parametrize("axes", [(1, 2, 3), (3, 2, 1), (2, Fraction(1, 2), 1)])
def test_added_inertia_is_the_energy_of_the_flow(axes: tuple[Fraction, ...]) -> None:
    """j_1 is twice the energy of the potential flow that keeps to the surface of the turning body."""
    assert flow_error(shape(axes, fluid=2)) <= FLOW_BOUND


def test_a_wrong_sign_in_the_added_inertia_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the differences of the alphas turned about, the flow and the disc say it is another body."""
    sound, triaxial = ellipsoid._alphas, shape((1, 2, 3))

    def turned(axes: Vector) -> tuple[Any, tuple[Any, ...]]:
        constants, alphas = sound(axes)
        return constants, tuple(Fraction(4, 3) - alpha for alpha in alphas)

    assert disc_error() <= mpf("1e-29")
    try:
        monkeypatch.setattr(ellipsoid, "_alphas", turned)
        ellipsoid.inertias.cache_clear()
        assert not flow_error(triaxial) <= FLOW_BOUND
        assert not disc_error() <= mpf("1e-29")
    finally:
        monkeypatch.undo()
        ellipsoid.inertias.cache_clear()


# Enclosed

ELLIPSOIDS = {
    "triaxial": vector(3, 2, 1),
    "prolate": vector(1, 1, 2),
    "oblate": vector(2, "0.5", 2),
    "sphere": vector("1.5", "1.5", "1.5"),
    "nearly equal axes": vector(1, "1.000000000000000000000000000001", 2),
    "disc": vector(1, "1.5", "1e-6"),
    "disc of revolution": vector(1, 1, "1e-6"),
}
# A disc of so little mass turns a million times as fast.
LATER = {name: Fraction(1, 10**6 if "disc" in name else 1) for name in ELLIPSOIDS}
START = Impulse(vector("0.1", "0.2", 1), vector("0.3", 0, 1), centre=vector(1, 2, 3))


def shaped(name: str, fluid: int = 1) -> Scene:
    body = Ellipsoid(ELLIPSOIDS[name], Fraction(1), Fraction(fluid)).body()
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


@pytest.mark.parametrize("name", ELLIPSOIDS)
def test_the_balls_contain_lambs_coefficients(name: str) -> None:
    """A certified quadrature of Lamb's own integrands gives the added mass along each axis."""
    axes = ELLIPSOIDS[name]
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
@pytest.mark.parametrize("name", ELLIPSOIDS)
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


@pytest.mark.parametrize("name", by_turns(ELLIPSOIDS, 8))
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
