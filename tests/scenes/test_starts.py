"""Starts and bodies of other forms: attitudes, rates with a unit, velocities, mass matrices; all exact."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import radians
from typing import Any

import numpy as np
import pytest
from builders.scenes import faults_of, read_scene, remus_inertia
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from taylor_verify.exact.route import solution
from taylor_verify.explain.explanation import explanation
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import PI, ball
from taylor_verify.numbers.precision import float_text
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Matrix, Vector, apply
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.stand_in import STAND_IN_BITS, StandIn, written
from taylor_verify.scenes.stand_in import written as irrational


def turned(attitude: str) -> Matrix:
    scene = read_scene(initial=f"omega = [1, 2, 3]\n{attitude}", top='track = ["attitude"]')
    return rotation_matrix(scene.initial.attitude)


def rotation(rows: Sequence[Sequence[Fraction]]) -> Rotation:
    return Rotation.from_matrix(np.array(rows, dtype=float))


@pytest.mark.parametrize(
    ("attitude", "expected"),
    [
        ('euler = { sequence = "zyx", degrees = [10, 5, -3] }', ("ZYX", [10, 5, -3])),
        ('euler = { sequence = "zxz", degrees = [200, -50, 3] }', ("ZXZ", [200, -50, 3])),
        ("axis_angle = { axis = [0, 0, 2], degrees = 30 }", ("ZYX", [30, 0, 0])),
    ],
)
def test_angles_are_turns_about_axes_that_move_along(
    attitude: str, expected: tuple[str, list[float]]
) -> None:
    """SciPy's intrinsic sequences are the same rotation."""
    other = Rotation.from_euler(*expected, degrees=True)
    assert (rotation(turned(attitude)).inv() * other).magnitude() < 1e-14


@pytest.mark.parametrize(
    ("attitude", "expected"),
    [
        ('rotation_vector = [0.3, "-1/5", 0.7]', Rotation.from_rotvec([0.3, -0.2, 0.7])),
        ("mrp = [0.1, 0.2, -0.4]", Rotation.from_mrp([0.1, 0.2, -0.4])),
        (
            f"axis_angle = {{ axis = [0, 3, 4], radians = {radians(77)!r} }}",
            Rotation.from_rotvec([0, 77 * 3 / 5, 77 * 4 / 5], degrees=True),
        ),
    ],
)
def test_vectors_are_the_rotations_of_scipy(attitude: str, expected: Rotation) -> None:
    """Two programs, one rotation."""
    assert (rotation(turned(attitude)).inv() * expected).magnitude() < 1e-14


def test_quarter_turns_and_parameters_are_exact() -> None:
    """Their matrices are rational, and so is that of a half turn about a body axis."""
    quarter = ((0, -1, 0), (1, 0, 0), (0, 0, 1))
    assert turned('euler = { sequence = "xyz", degrees = [0, 0, 90] }') == quarter
    assert turned("axis_angle = { axis = [0, 0, 7], degrees = 90 }") == quarter
    assert turned("mrp = [1, 0, 0]") == ((1, 0, 0), (0, -1, 0), (0, 0, -1))
    assert turned("mrp = [0, 0, 0]") == turned("rotation_vector = [0, 0, 0]")


@pytest.mark.parametrize(
    ("attitude", "expected"),
    [
        ("mrp = [0, 0, 0]\nattitude = [1, 0, 0, 0]", "one form of the attitude"),
        ('euler = { sequence = "zzx", degrees = [1, 2, 3] }', "three axes"),
        ('euler = { sequence = "zyx", degrees = [1, 2] }', "3 numbers"),
        ('euler = { sequence = "zyx" }', "either `degrees` or `radians`, got neither"),
        ('euler = { sequence = "zyx", degrees = [1, 2, 3], radians = [1, 2, 3] }', "got both"),
        ("axis_angle = { axis = [0, 0, 0], degrees = 1 }", "an axis that is not zero"),
        ("axis_angle = { axis = [0, 0, 1], degrees = 1e30 }", "angles of at most"),
        ("roll = 3", "turns about axes that move along"),
        ("mrp = [0, 0, 0]\nattitude = [0, 0, 0, 0]", "a quaternion that is not zero"),
        (
            "attitude = { mrp = [0, 0, 1] }",
            "(write `mrp = ..` in [initial], in place of `attitude`)",
        ),
        ("attitude = { yaw = 3 }", "write `euler = ..` or `rotation_vector = ..` or"),
        (
            "euler = [10, 5, 0]",
            'yaw, pitch and roll are `euler = { sequence = "zyx", degrees = [10, 5, 0]',
        ),
    ],
)
def test_a_faulty_form_is_refused(attitude: str, expected: str) -> None:
    """The fault says what the form needs."""
    with pytest.raises(Refused) as refused:
        turned(attitude)
    assert expected in str(refused.value)


# Angular velocities with a unit

DEGREE = PI / 180


def body(omega: str, inertia: str = "[1, 2, 3]") -> Scene:
    return read_scene(f"inertia = {inertia}", f"omega = {omega}")


def rate(omega: str) -> Any:
    """Return the angular velocity, its irrational numbers exactly."""
    initial = body(omega).initial
    assert isinstance(initial, Spin)
    return written(initial.omega)


def test_a_degree_is_held_to_400_bits() -> None:
    """The rational has 400 bits, is within 2^-400 of pi/180, and carries that number."""
    initial = body('["1 deg/s", 0, 0]').initial
    assert isinstance(initial, Spin)
    degree = initial.omega[0]
    assert isinstance(degree, StandIn)
    assert degree.exactly == DEGREE
    assert degree.numerator.bit_length() <= STAND_IN_BITS
    assert degree.denominator & (degree.denominator - 1) == 0
    with ctx.workprec(2 * STAND_IN_BITS):
        assert abs(ball(degree) * 180 / arb.pi() - 1) <= arb(2) ** -STAND_IN_BITS


def test_zero_is_zero_and_ratios_are_those_written() -> None:
    """0, "0" and "0 deg/s" are 0; 2 to -1 stays 2 to -1; a fraction is exact as well."""
    assert rate('["2 deg/s", "0", "-1 deg/s"]') == (2 * DEGREE, 0, -DEGREE)
    assert rate('["1/3 deg/s", 0, "0 deg/s"]') == (DEGREE / 3, 0, 0)
    assert rate('["2deg/s", "+2.0  deg/s", "0.2e1 deg/s"]') == (2 * DEGREE,) * 3


def test_units_may_stand_beside_each_other() -> None:
    """A turn a minute is six degrees a second, and radians a second are the number itself."""
    mixed = rate('["1 rpm", "6 deg/s", "0.1 rad/s"]')
    assert mixed == (6 * DEGREE, 6 * DEGREE, Fraction(1, 10))
    assert body('["0.1 rad/s", "1 rad/s", 0]').notes == ()


# For moments 2, 3, 6 the separatrix is 2 w1^2 = 18 w3^2.
REGIMES = {
    "steady": ("[0, 30, 0]", '[0, "30 deg/s", 0]'),
    "separatrix": ("[3, 7, 1]", '["3 deg/s", "7 deg/s", "1 deg/s"]'),
    "generic": ("[3, 10, 2]", '["3 deg/s", "10 deg/s", "2 deg/s"]'),
}


@pytest.mark.parametrize(("bare", "degrees"), REGIMES.values(), ids=REGIMES)
def test_the_regime_is_that_of_the_numbers_without_their_unit(bare: str, degrees: str) -> None:
    """A common factor changes no regime: not even the separatrix, which a rounded rate would miss."""
    regime = solution(body(degrees, "[2, 3, 6]"), "arb").regime
    assert regime == solution(body(bare, "[2, 3, 6]"), "arb").regime


def test_explain_says_how_degrees_were_formed() -> None:
    """The shipped satellite is told with its unit, the exact motion, and the bits that a solver gets."""
    scene = load("euler/satellite-degrees")
    assert isinstance(scene.initial, Spin)
    assert written(scene.initial.omega) == (2 * DEGREE, 0, -DEGREE)
    (sentence,) = explanation(scene, "f64")["body"]
    assert "initial.omega is given in deg/s" in sentence
    assert "400 bits" in sentence
    assert "The exact motion is that of these angles" in sentence


def test_the_angular_velocity_of_a_vehicle_takes_units() -> None:
    """`angular_velocity` in degrees is the Omega of the impulses, exactly."""
    scene = read_scene(
        "ellipsoid = { semi_axes = [3, 2, 1], density = 1, fluid_density = 1 }",
        'linear_velocity = [1, 0, 0]\nangular_velocity = ["1 rpm", 0, "-1 deg/s"]',
    )
    assert isinstance(scene.body, ImmersedBody)
    assert isinstance(scene.initial, Impulse)
    velocity = apply(written(scene.body.angular), written(scene.initial.angular))
    assert velocity == (6 * DEGREE, 0, -DEGREE)
    assert "given in rpm and deg/s" in scene.notes[0]


REFUSED = {
    '["2 deg", 0, 0]': "an angular velocity in rad/s, deg/s or rpm",
    '["2 deg/h", 0, 0]': "an angular velocity in rad/s, deg/s or rpm",
    '["2 °/s", 0, 0]': "an angular velocity in rad/s, deg/s or rpm",
    '["2 deg/s", 1, 0]': "a unit, as its neighbours have one",
    '["1/0 deg/s", 0, 0]': "a denominator that is not zero",
    '["1e99999 deg/s", 0, 0]': "powers of ten up to 5000",
    '["nan deg/s", 0, 0]': "a number",
    '["deg/s", 0, 0]': "a number",
    '["1 deg/s", 0]': "3 numbers",
    '"1 deg/s"': "3 numbers",
}


@pytest.mark.parametrize(("omega", "expected"), REFUSED.items())
def test_what_is_no_rate_is_refused(omega: str, expected: str) -> None:
    """One line, with what is expected and where."""
    (line,) = faults_of(initial=f"omega = {omega}")
    assert line.startswith(f"expected {expected}") or f"with {expected}" in line
    assert "@ initial.omega" in line


def test_a_unit_stands_nowhere_else() -> None:
    """In a moment, a time, a moment of inertia it is refused with the sentence that says so."""
    body = 'inertia = [1, 2, "3 kg m^2"]\nmoment = ["1 N m", 0, 0]'
    faults = faults_of(body, time='end = "10 s"\nsamples = 2')
    assert len(faults) == 3
    assert all("expected a number without a unit" in line for line in faults)


# Mass matrices and velocities

VELOCITIES = 'linear_velocity = [1.5, "1/3", -0.2]\nangular_velocity = [0.1, 0, "-2/7"]'
U, OMEGA = (
    (Fraction(3, 2), Fraction(1, 3), Fraction(-1, 5)),
    (Fraction(1, 10), Fraction(0), Fraction(-2, 7)),
)
ELLIPSOID = "ellipsoid = { semi_axes = [3, 2, 1], density = 1, fluid_density = 1 }"
CLEBSCH = "clebsch = { p = 1, p_prime = 2, q = 0.1, q_prime = 0.2, r = 1, r_prime = 0.5 }"

ENTRY = st.fractions(-5, 5, max_denominator=50)
# L L^T + 1 is symmetric and positive definite, whatever L.
FACTOR = st.lists(st.lists(ENTRY, min_size=6, max_size=6), min_size=6, max_size=6)
VECTOR = st.tuples(ENTRY, ENTRY, ENTRY)


def vehicle(body: str, start: str = VELOCITIES) -> Scene:
    return read_scene(body, start)


def solid(scene: Scene) -> ImmersedBody:
    assert isinstance(scene.body, ImmersedBody)
    return scene.body


def impulses(scene: Scene) -> Vector:
    assert isinstance(scene.initial, Impulse)
    return scene.initial.linear + scene.initial.angular


def wrote(matrix: Matrix) -> str:
    rows = ", ".join("[" + ", ".join(f'"{entry}"' for entry in row) + "]" for row in matrix)
    return f"mass_matrix = [{rows}]"


def positive(factor: list[list[Fraction]]) -> Matrix:
    rows = tuple(map(tuple, factor))
    one = tensors.diagonal((Fraction(1),) * 6)
    return tuple(map(tensors.plus, tensors.product(rows, tensors.transpose(rows)), one))


@given(FACTOR, VECTOR, VECTOR)
@settings(max_examples=10, deadline=None)
def test_the_matrix_is_inverted_and_the_impulses_formed_exactly(
    factor: list[list[Fraction]], velocity: Vector, turning: Vector
) -> None:
    """M times [[A, B], [B^T, C]] is 1; half v.M v is T of the impulses; these give the velocities back."""
    matrix = positive(factor)
    body = ImmersedBody.of_mass_matrix(matrix)
    assert tensors.product(matrix, body.energy_matrix) == tensors.diagonal((Fraction(1),) * 6)
    assert body.mass_matrix == matrix
    momenta = tensors.apply(body.mass_matrix, velocity + turning)
    x, y = momenta[:3], momenta[3:]
    v = velocity + turning
    twice_energy = tensors.dot(x + y, tensors.apply(body.energy_matrix, x + y))
    assert twice_energy == tensors.dot(v, tensors.apply(matrix, v))
    back = (
        tensors.plus(tensors.apply(body.linear, x), tensors.apply(body.coupling, y)),
        tensors.plus(
            tensors.apply(tensors.transpose(body.coupling), x), tensors.apply(body.angular, y)
        ),
    )
    assert back == (velocity, turning)


@pytest.mark.parametrize("form", [CLEBSCH, ELLIPSOID, wrote(remus_inertia())])
def test_velocities_start_a_body_of_every_form(form: str) -> None:
    """U = A x + B y and Omega = B^T x + C y of the impulses formed are the velocities written."""
    scene = vehicle(form)
    assert (
        tensors.apply(irrational(solid(scene).energy_matrix), irrational(impulses(scene)))
        == U + OMEGA
    )


def test_the_impulses_of_an_ellipsoid_are_those_of_lambs_integrals() -> None:
    """They stand for (M + m_i) U_i and (I_i + j_i) Omega_i, and are within 2^-400 of these."""
    scene = vehicle(ELLIPSOID)
    shape = solid(scene).ellipsoid
    assert shape is not None
    factors = (*shape.inertias.masses, *shape.inertias.moments)
    for factor, v, impulse in zip(factors, U + OMEGA, impulses(scene), strict=True):
        assert irrational(impulse) == factor * v
        if v == 0:
            assert impulse == 0
            continue
        assert isinstance(impulse, StandIn)
        with ctx.workprec(2 * STAND_IN_BITS):
            assert abs(ball(impulse) / ball(factor * v) - 1) <= arb(2) ** -STAND_IN_BITS


def test_the_vehicle_that_is_shipped_is_the_remus_with_its_centre_of_mass_below() -> None:
    """M of auv-turn is that of remus-100 plus the terms m z_g, 1.96 cm below the origin."""
    offset = Fraction("30.48") * Fraction("0.0196")
    terms = {(0, 4): offset, (4, 0): offset, (1, 3): -offset, (3, 1): -offset}
    expected = tuple(
        tuple(entry + terms.get((i, k), 0) for k, entry in enumerate(row))
        for i, row in enumerate(remus_inertia())
    )
    scene = load("kirchhoff/auv-turn")
    assert solid(scene).mass_matrix == expected
    assert solid(scene).axis_of_symmetry is None
    v = tensors.apply(solid(scene).energy_matrix, impulses(scene))
    assert v == tuple(map(Fraction, ("1.5", "-0.1", "0", "0", "0", "0.2")))


def test_the_inverse_is_noted_and_said_to_be_exact() -> None:
    """The body of a mass matrix is told with the six rows of its inverse, and how the start was formed."""
    scene = load("kirchhoff/auv-turn")
    assert "its inverse" in scene.notes[0]
    assert "exactly, in rationals" in scene.notes[0]
    rows = solid(scene).energy_matrix
    for i, row in enumerate(rows, 1):
        assert f"Row {i} of the inverse: {', '.join(map(float_text, row))}." in scene.notes
    assert "(x, y) = M (U, Omega) are formed exactly" in scene.notes[-1]
