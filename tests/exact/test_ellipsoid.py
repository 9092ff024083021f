"""The ellipsoid in a fluid: its exact inertias by independent routes, and their rounding for solvers."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from builders.ellipsoids import quadrature
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.balls import ball
from taylor_verify.numbers.irrational import PI
from taylor_verify.scenes import ellipsoid
from taylor_verify.scenes.bodies import Ellipsoid, ImmersedBody
from taylor_verify.scenes.ellipsoid import LambIntegral
from taylor_verify.scenes.precision import exact_value
from taylor_verify.scenes.stand_in import STAND_IN_BITS, StandIn, written
from taylor_verify.scenes.tensors import Vector

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


def displaced(ellipsoid: Ellipsoid) -> mpf:
    a, b, c = ellipsoid.semi_axes
    return 4 * mp.pi / 3 * mp.convert(a * b * c * ellipsoid.fluid_density)


def diagonal(body: ImmersedBody) -> list[Any]:
    """1/(M + m_i) and 1/(I_i + j_i), as a scene has them."""
    return [block[i][i] for block in (body.linear, body.angular) for i in range(3)]


def integral(axes: Vector, i: int) -> LambIntegral:
    a, (b, c) = axes[i], (axes[k] for k in range(3) if k != i)
    return LambIntegral(((b / a) ** 2, (c / a) ** 2))


# Against routes that share no formula.


@pytest.mark.parametrize("name", SHAPES)
def test_inertias_lie_in_balls_of_a_certified_quadrature(name: str) -> None:
    """alpha_i, m_i and j_i meet balls that integrate Lamb's integrands themselves.

    With J = (alpha_k - alpha_j)/(a_j^2 - a_k^2) as an integral of its own, nothing cancels in j_i.
    """
    body = shape(SHAPES[name], fluid=3)
    axes, exact = body.semi_axes, body.inertias
    with ctx.workprec(200):
        displaced = 4 * arb.pi() * ball(axes[0] * axes[1] * axes[2])
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            alpha, J = quadrature(axes, (i,)), quadrature(axes, (j, k))
            gap, total = ball(axes[j] ** 2 - axes[k] ** 2), ball(axes[j] ** 2 + axes[k] ** 2)
            assert alpha.overlaps(integral(axes, i).evaluated())
            m, inertia = exact.added_mass[i], exact.added_inertia[i]
            for value, enclosed in (
                (m, displaced * alpha / (2 - alpha)),
                (inertia, displaced * gap**2 * J / (5 * (2 - total * J))),
            ):
                assert not value or enclosed.rel_accuracy_bits() >= 100
                assert enclosed.overlaps(ball(value))


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


@pytest.mark.parametrize("name", SHAPES)
def test_integrals_sum_to_their_identities(name: str) -> None:
    """The alphas add to 2, and weighted with a_i^2 to 2 a1 a2 a3 R_F(a1^2, a2^2, a3^2)."""
    axes = shape(SHAPES[name]).semi_axes
    with ctx.workprec(BITS), mp.workprec(2 * BITS):
        alphas = [integral(axes, i).evaluated() for i in range(3)]
        squares = [a * a for a in axes]
        product = mp.convert(axes[0] * axes[1] * axes[2])
        weighted = 2 * product * mp.elliprf(*map(mp.convert, squares))
        total = sum((alpha * ball(q) for alpha, q in zip(alphas, squares, strict=True)), arb(0))
        assert sum(alphas, arb(0)).overlaps(arb(2))
        assert total.overlaps(ball(exact_value(weighted)))
        assert total.rel_accuracy_bits() >= BITS - 20


def test_a_sphere_carries_half_the_mass_it_displaces() -> None:
    """m = rho V/2 and j = 0 exactly, so that p = 1/(M + rho V/2) and r = 5/(2 M a^2)."""
    body = shape((2, 2, 2), density=3, fluid=5).body()
    volume = Fraction(32, 3) * PI
    p, r = written(body.linear[0][0]), written(body.angular[0][0])
    assert p == 1 / (volume * (3 + Fraction(5, 2)))
    assert r == 5 / (2 * 3 * volume * 4)


@pytest.mark.parametrize("little", [Fraction(1, 10**9), Fraction(1, 10**300)])
def test_beside_a_sphere_the_added_inertia_is_quadratic(little: Fraction) -> None:
    """j = rho V (a^2 - b^2)^2/15, to the order of the difference: no digit of it cancels."""
    body = shape((1, 1 + little, 1 - 2 * little), fluid=3)
    squares = [a * a for a in body.semi_axes]
    with mp.workprec(3 * BITS):
        for i, j in enumerate(added(body)[1]):
            gap = mp.convert(squares[i - 1] - squares[i - 2])
            assert abs(15 * j / (displaced(body) * gap**2) - 1) <= 10 * mp.convert(little)


def spheroid(e: mpf, is_prolate: bool) -> tuple[mpf, mpf]:
    """alpha along the axis and across it, in the eccentricity: Lamb, arts. 114 and 373."""
    if is_prolate:
        along = 2 * (1 - e**2) / e**3 * (mp.atanh(e) - e)
        return along, 1 / e**2 - (1 - e**2) / e**3 * mp.atanh(e)
    root = mp.sqrt(1 - e**2)
    return 2 / e**2 * (1 - root / e * mp.asin(e)), root / e**3 * mp.asin(e) - root**2 / e**2


@pytest.mark.parametrize("axes", [(2, 1, 1), (1, 1, 3), (1, 4, 4), (Fraction(1, 50), 1, 1)])
def test_spheroids_have_elementary_coefficients(axes: tuple[Fraction, ...]) -> None:
    """m and j of spheroids are Lamb's logarithms and arcs in the eccentricity."""
    body = shape(axes)
    (i,) = (n for n in range(3) if axes.count(axes[n]) == 1)
    c, a = Fraction(axes[i]), Fraction(axes[(i + 1) % 3])
    with mp.workprec(BITS):
        e2 = 1 - min(a, c) ** 2 / max(a, c) ** 2
        along, across = spheroid(mp.sqrt(mp.convert(e2)), is_prolate=c > a)
        rho_V, gap, total = displaced(body), mp.convert(c**2 - a**2), mp.convert(c**2 + a**2)
        exact = body.inertias
        j = rho_V / 5 * gap**2 * (across - along) / (2 * gap + total * (along - across))
        expected = [rho_V * along / (2 - along), rho_V * across / (2 - across), j]
        numbers = [exact.added_mass[i], exact.added_mass[i - 1], exact.added_inertia[i - 1]]
        for value, number in zip(expected, numbers, strict=True):
            # The elementary formulas cancel: a factor e^-3, below 10 for these, and a dozen roundings.
            assert abs(value / mp.convert(number) - 1) <= mp.ldexp(1, 12 - BITS)
        assert exact.added_inertia[i] == 0


def test_a_disc_is_approached_in_proportion_to_its_thickness() -> None:
    """For c -> 0: m_3 -> 8/3 rho a^3 and j_1 -> 16/45 rho a^5; what is missing falls off like c."""
    with mp.workprec(BITS):
        missing = []
        for power in (20, 40):
            m, j = added(shape((3, 3 + Fraction(1, 10**100), Fraction(1, 10**power)), fluid=7))
            missing.append(
                (m[2] / (mpf(8) / 3 * 7 * 3**3) - 1, j[0] / (mpf(16) / 45 * 7 * 3**5) - 1)
            )
        for thick, thin in zip(*missing, strict=True):
            assert 0 < abs(thick) <= mpf(10) ** -20
            # The next term of the series is of the order c^2 (log c), 1e-18 of this one.
            assert abs(thin / thick * mpf(10) ** 20 - 1) <= mpf(10) ** -17


def test_an_elliptic_plate_moves_the_mass_of_a_complete_integral() -> None:
    """For c -> 0 and a > b: m_3 -> 4 pi rho a b^2 / (3 E(k)), k^2 = 1 - b^2/a^2 (Lamb, art. 114)."""
    with mp.workprec(BITS):
        m, _ = added(shape((5, 2, Fraction(1, 10**50))))
        plate = 4 * mp.pi * 5 * 2**2 / (3 * mp.ellipe(1 - mpf(4) / 25))
        assert 0 < abs(m[2] / plate - 1) <= mpf(10) ** -49


def test_a_needle_is_a_row_of_slices() -> None:
    """For a -> oo every slice x moves like an ellipse in a plane, scaled by (1 - x^2/a^2)^(1/2).

    Per length an ellipse b, c has rho pi c^2 along b, rho pi b^2 along c and rho pi (b^2 - c^2)^2/8
    about its centre; along the needle there is nothing.
    """
    a, b, c = 10**15, 3, 2
    with mp.workprec(BITS):
        m, j = added(shape((a, b, c)))
        rho_V = 4 * mp.pi / 3 * a * b * c
        slices = {
            "m2": (m[1], mp.pi * c**2 * mpf(4 * a) / 3),
            "m3": (m[2], mp.pi * b**2 * mpf(4 * a) / 3),
            "j1": (j[0], mp.pi * (b**2 - c**2) ** 2 / 8 * mpf(16 * a) / 15),
            "j2": (j[1], mp.pi * b**2 * mpf(4 * a**3) / 15),
            "j3": (j[2], mp.pi * c**2 * mpf(4 * a**3) / 15),
        }
        # The ends are missing: of the order (b/a)^2 log(a/b), here 9e-30 times 34.
        bound = 10 * (mpf(b) / a) ** 2 * mp.log(a)
        assert {
            name: 0 < abs(x / y - 1) <= bound for name, (x, y) in slices.items()
        } == dict.fromkeys(slices, True)
        assert 0 < m[0] / rho_V <= bound


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


# Units, and no fluid.


@pytest.mark.parametrize("s", [Fraction(1, 8), Fraction(7, 3)])
def test_other_units_of_length(s: Fraction) -> None:
    """Lengths scaled by s scale p by s^-3 and r by s^-5, exactly."""
    small, large = (diagonal(shape(axes).body()) for axes in ((3, 2, 1), (3 * s, 2 * s, s)))
    scaled = [
        written(number) / s**power for number, power in zip(small, (3,) * 3 + (5,) * 3, strict=True)
    ]
    assert [*map(written, large)] == scaled


def test_without_a_fluid_the_body_is_alone() -> None:
    """In a fluid of no density M and I are those of the solid, 3 M = 4 pi a b c rho and so on, exactly."""
    body = shape((3, 2, 1), fluid=0).body()
    mass = 8 * PI
    assert [*map(written, diagonal(body))] == [
        1 / mass,
        1 / mass,
        1 / mass,
        *(5 / (mass * squares) for squares in (5, 10, 13)),
    ]
