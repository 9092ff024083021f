"""Angular velocities with a unit: exact multiples of one rational, so that regimes are decided as ever."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from builders.scenes import faults_of, read_scene
from flint import arb, ctx

from taylor_verify.exact.route import solution
from taylor_verify.explain.explanation import explanation
from taylor_verify.numbers.irrational import PI, ball
from taylor_verify.numbers.tensors import apply
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.stand_in import STAND_IN_BITS, StandIn, written

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
