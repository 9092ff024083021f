"""The ellipsoid in a fluid: its exact inertias by independent routes, and their rounding for solvers."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.numbers.irrational import PI, ball
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes import ellipsoid
from taylor_verify.scenes.bodies import Ellipsoid, ImmersedBody
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
