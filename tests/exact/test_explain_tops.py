"""The words and periods of tops in disguise: a free solid whose y is a top, and wheels that cancel H."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from builders.scenes import one_instant, vector
from mpmath import mp

from taylor_verify.exact.elements import Elements, elements
from taylor_verify.exact.kirchhoff.solid import solid, velocities
from taylor_verify.exact.route import solution
from taylor_verify.numbers import tensors
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.scene import Scene

X, Y = vector("0.5", "0.2", "0.3"), vector("0.3", "0.5", 1)


def immersed(b: Fraction, x: tensors.Vector = X) -> Scene:
    """A free solid with A = 2 and B = b, of three different moments."""
    one = vector(1, 1, 1)
    A, B = (tensors.diagonal(tensors.scaled(Fraction(k), one)) for k in (2, b))
    body = ImmersedBody(A, B, tensors.diagonal(vector(1, 2, 3)))
    return one_instant(body, Impulse(x, Y))


def story_of(orbit: Elements) -> str:
    return " ".join(orbit.sentences)


@pytest.mark.parametrize("b", [Fraction(0), Fraction(1, 2)])
def test_what_recurs_in_a_top_of_a_solid_is_named(b: Fraction) -> None:
    """After the period y and C y are those of the start, and x is not; Omega is only where b is 0."""
    scene = immersed(b)
    body, _ = solid(scene)
    orbit = elements(scene, 30)
    period = Fraction(mp.nstr(orbit["period"].value, 30))
    rows = solution(scene).motion([Fraction(0), period], 25).quantities
    x, y = (rows[f"{name}_impulse"].astype(float) for name in ("linear", "angular"))
    Omega = x @ np.array(body.coupling, float) + y @ np.array(body.angular, float)
    recurs = {
        name: bool(np.abs(vectors[1] - vectors[0]).max() <= 1e-12)
        for name, vectors in (("x", x), ("y", y), ("Omega", Omega))
    }
    assert recurs == {"x": False, "y": True, "Omega": not b}
    assert orbit["period"].meaning == "of the top: omega recurs in body axes"
    if b:
        assert "C y as its omega" in story_of(orbit)
        assert "x and Omega = b x + C y need not recur" in story_of(orbit)
    else:
        assert "Omega = C y as its omega" in story_of(orbit)
        assert "does: x need not recur" in story_of(orbit)


def test_without_linear_impulse_omega_is_that_of_the_top() -> None:
    """Where x is 0 a multiple in B turns nothing, and no x is spoken of."""
    scene = immersed(Fraction(1, 2), vector(0, 0, 0))
    body, start = solid(scene)
    assert velocities(body, start)[1] == tensors.apply(body.angular, start.angular)
    orbit = elements(scene, 20)
    assert "Omega = C y as its omega" in story_of(orbit)
    assert "need not recur" not in story_of(orbit)


def test_a_body_whose_wheels_cancel_its_momentum_has_one_steady_spin() -> None:
    """H = I omega + h = 0 is a steady spin itself, and stable; no other spin has |H| = 0."""
    omega = vector("1/2", "1/4", "1/3")
    inertia = tensors.diagonal(vector(1, 2, 3))
    rotor = tensors.scaled(Fraction(-1), tensors.apply(inertia, omega))
    orbit = elements(one_instant(RigidBody(inertia, rotor=rotor), Spin(omega)), 20)
    assert orbit.regime == "steady"
    assert orbit["H2"].value == 0
    assert not [name for name in orbit if name.startswith("spin_")]
    assert "With H = 0 there is one steady spin, this motion. It is stable" in story_of(orbit)
    assert "0 steady spins" not in story_of(orbit)
    assert "H is along omega" not in story_of(orbit)
