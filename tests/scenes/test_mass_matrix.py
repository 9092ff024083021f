"""Bodies by mass matrix and starts by velocity: both exact, by two routes."""

from __future__ import annotations

from fractions import Fraction

import pytest
from builders.scenes import read_scene, remus_inertia
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st

from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import float_text
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.stand_in import STAND_IN_BITS, StandIn
from taylor_verify.scenes.stand_in import written as irrational

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


def written(matrix: Matrix) -> str:
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


@pytest.mark.parametrize("form", [CLEBSCH, ELLIPSOID, written(remus_inertia())])
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
