"""The ellipsoid in a fluid: its coefficients by independent routes, and what a scene makes of them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import gmpy2
import pytest
from builders.ellipsoids import quadrature
from flint import ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.balls import ball
from taylor_verify.exact.ellipsoid import deviation, inertias
from taylor_verify.scenes import ellipsoid
from taylor_verify.scenes.bodies import COEFFICIENT_BITS, Ellipsoid
from taylor_verify.scenes.ellipsoid import lamb_integrals
from taylor_verify.scenes.precision import exact_value

BITS = COEFFICIENT_BITS
# Rounding to nearest is off by 2^-BITS of the number at most; the rest is for what precedes it.
ROUNDING = mpf(2) ** -BITS * (1 + mpf(2) ** -30)

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
    """m_i and j_i of a body without mass, at the ambient precision: 1/p_i and 1/r_i alone."""
    body = replace(ellipsoid, density=Fraction(0)).body(mp.prec)
    blocks = body.linear, body.angular
    m, j = ([1 / mp.convert(block[i][i]) for i in range(3)] for block in blocks)
    return m, j


def displaced(ellipsoid: Ellipsoid) -> mpf:
    a, b, c = ellipsoid.semi_axes
    return 4 * mp.pi / 3 * mp.convert(a * b * c * ellipsoid.fluid_density)


# Against routes that share no formula.


@pytest.mark.parametrize("name", SHAPES)
def test_lambs_integrals_lie_in_balls_of_a_certified_quadrature(name: str) -> None:
    """alpha_i and J_i, by duplication, lie in balls that integrate Lamb's integrands themselves."""
    axes = shape(SHAPES[name]).semi_axes
    with gmpy2.context(precision=300), ctx.workprec(200):
        alphas, divided = lamb_integrals(axes)
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            for value, of in ((alphas[i], (i,)), (divided[i], (j, k))):
                enclosed = quadrature(axes, of)
                assert enclosed.rel_accuracy_bits() >= 120
                assert enclosed.overlaps(ball(exact_value(value)))


@pytest.mark.parametrize("name", [*SHAPES, *EXTREME])
def test_coefficients_are_rounded_once(name: str) -> None:
    """Every coefficient is within half a last place of Lamb's own formulas in balls, also at the ends."""
    body = shape((SHAPES | EXTREME)[name]).body()
    assert deviation(body, BITS + 40) <= ROUNDING


@pytest.mark.parametrize("name", ["all but spherical", "three scales", "all but a spheroid"])
def test_added_inertia_alone_is_as_accurate(name: str) -> None:
    """Of a body without mass r_i is 1/j_i: axes that all but agree, or are worlds apart, cost no digit."""
    body = shape(EXTREME[name], density=0).body()
    assert deviation(body, BITS + 40) <= ROUNDING


axis = st.builds(
    lambda size, gap, power: Fraction(size) * (1 + gap * Fraction(1, 10**power)),
    st.integers(1, 4),
    st.integers(0, 2),
    st.integers(0, 60),
)
densities = st.fractions(0, 1000, max_denominator=1000)


@settings(max_examples=15)
@given(st.tuples(axis, axis, axis), densities.filter(bool), densities)
def test_coefficients_of_any_ellipsoid(
    axes: tuple[Fraction, ...], density: Fraction, fluid: Fraction
) -> None:
    """The two routes agree to the last bit for bodies drawn with axes equal, nearly equal and not."""
    body = Ellipsoid(axes, density, fluid).body()
    assert deviation(body, BITS + 40) <= ROUNDING


@settings(max_examples=15)
@given(st.tuples(axis, axis, axis), st.permutations(range(3)))
def test_axes_in_another_order_are_the_same_body(
    axes: tuple[Fraction, ...], order: list[int]
) -> None:
    """To rename the axes renames the coefficients and changes no bit; so equal axes have equal ones."""
    as_given = shape(axes).body()
    renamed = shape(tuple(axes[i] for i in order)).body()
    for block, other in ((as_given.linear, renamed.linear), (as_given.angular, renamed.angular)):
        assert [block[i][i] for i in order] == [other[i][i] for i in range(3)]
    for i, j in ((0, 1), (1, 2), (2, 0)):
        is_equal = as_given.angular[i][i] == as_given.angular[j][j]
        assert is_equal or axes[i] != axes[j]


@pytest.mark.parametrize("name", SHAPES)
def test_integrals_sum_to_their_identities(name: str) -> None:
    """The alphas add to 2, and weighted with a_i^2 to 2 a1 a2 a3 R_F(a1^2, a2^2, a3^2)."""
    axes = shape(SHAPES[name]).semi_axes
    with mp.workprec(BITS), gmpy2.context(precision=BITS):
        squares = [mp.convert(a * a) for a in axes]
        alphas = [mp.convert(exact_value(alpha)) for alpha in lamb_integrals(axes)[0]]
        weighted = sum(alpha * q for alpha, q in zip(alphas, squares, strict=True))
        product = mp.convert(axes[0] * axes[1] * axes[2])
        # A few hundred duplications round a dozen times each: below 2^13 last places.
        bound = mp.ldexp(1, 13 - BITS)
        assert abs(sum(alphas) - 2) <= 2 * bound
        assert abs(weighted / (2 * product * mp.elliprf(*squares)) - 1) <= bound


def test_a_sphere_carries_half_the_mass_it_displaces() -> None:
    """m = rho V/2 and j = 0, so that p = 1/(M + rho V/2) and r = 5/(2 M a^2)."""
    body = shape((2, 2, 2), density=3, fluid=5).body()
    with mp.workprec(BITS):
        volume = 32 * mp.pi / 3
        p, r = mp.convert(body.linear[0][0]), mp.convert(body.angular[0][0])
        bound = mp.ldexp(1, 3 - BITS)  # three roundings here, one there
        assert abs(p * volume * (3 + mpf(5) / 2) - 1) <= bound
        assert abs(r * 2 * 3 * volume * 4 / 5 - 1) <= bound


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
        balls = inertias(body, BITS)
        j = rho_V / 5 * gap**2 * (across - along) / (2 * gap + total * (along - across))
        expected = [rho_V * along / (2 - along), rho_V * across / (2 - across), j]
        coefficients = [balls.added_mass[i], balls.added_mass[i - 1], balls.added_inertia[i - 1]]
        for value, other in zip(expected, coefficients, strict=True):
            # The elementary formulas cancel: a factor e^-3, below 10 for these, and a dozen roundings.
            assert abs(value / mpf(other.mid().str(130, radius=False)) - 1) <= mp.ldexp(
                1, 12 - BITS
            )
        assert balls.added_inertia[i].is_zero()


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


def ball_error(ellipsoid: Ellipsoid) -> mpf:
    return deviation(ellipsoid.body(), BITS + 40)


@pytest.mark.parametrize("axes", [(1, 2, 3), (3, 2, 1), (2, Fraction(1, 2), 1)])
def test_added_inertia_is_the_energy_of_the_flow(axes: tuple[Fraction, ...]) -> None:
    """j_1 is twice the energy of the potential flow that keeps to the surface of the turning body."""
    assert flow_error(shape(axes, fluid=2)) <= FLOW_BOUND


def test_a_wrong_sign_of_J_in_the_added_inertia_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """With J turned about, the flow, the disc and the balls each say that the body is another one."""
    sound = ellipsoid.lamb_integrals

    def turned(axes: tuple[Fraction, ...]) -> tuple[list[mpf], list[mpf]]:
        alphas, divided = sound(axes)
        return alphas, [-J for J in divided]

    triaxial = shape((1, 2, 3))
    assert (ball_error(triaxial) <= ROUNDING, disc_error() <= mpf("1e-29")) == (True, True)
    try:
        monkeypatch.setattr(ellipsoid, "lamb_integrals", turned)
        ellipsoid.inverse_inertias.cache_clear()
        assert not ball_error(triaxial) <= ROUNDING
        assert not flow_error(triaxial) <= FLOW_BOUND
        assert not disc_error() <= mpf("1e-29")
    finally:
        monkeypatch.undo()
        ellipsoid.inverse_inertias.cache_clear()


# Units, and no fluid.


@pytest.mark.parametrize("power", [-3, 4])
def test_other_units_of_length(power: int) -> None:
    """Lengths scaled by s scale p by s^-3 and r by s^-5, to the bit where s is a power of two."""
    s = Fraction(2) ** power
    small, large = shape((3, 2, 1)).body(), shape((3 * s, 2 * s, s)).body()
    for i in range(3):
        assert large.linear[i][i] * s**3 == small.linear[i][i]
        assert large.angular[i][i] * s**5 == small.angular[i][i]


def test_without_a_fluid_the_body_is_alone() -> None:
    """In a fluid of no density M and I are those of the solid, 3 M = 4 pi a b c rho and so on."""
    body = shape((3, 2, 1), fluid=0).body()
    with mp.workprec(BITS):
        mass, bound = 8 * mp.pi, mp.ldexp(1, 3 - BITS)
        assert all(abs(mp.convert(body.linear[i][i]) * mass - 1) <= bound for i in range(3))
        for i, squares in enumerate((5, 10, 13)):
            assert abs(mp.convert(body.angular[i][i]) * mass * squares / 5 - 1) <= bound
