"""Every kind of body gives the truth all that it asks for, and its parts agree with each other."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import pytest
from builders.scenes import IMPULSE, LOADED, MOMENT, OMEGA, SPIN, TENSOR

from taylor_verify.exact.quadratic_forms import Equations, exact
from taylor_verify.exact.registry import KINDS, kind_of
from taylor_verify.numbers.tensors import apply, dot
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load

SAMPLES = {
    "euler": (RigidBody(TENSOR, MOMENT), SPIN),
    "wheels": (RigidBody(TENSOR, MOMENT, OMEGA), SPIN),
    "kirchhoff": (LOADED, IMPULSE),
}


def rates(equations: Equations, z: Sequence[Fraction]) -> list[Fraction]:
    """The right-hand side at z, exactly."""
    linear, quadratic = equations.linear @ exact(z), exact(z) @ equations.hessian @ exact(z) / 2
    return list(equations.constant + linear + quadratic)


def test_every_shipped_body_has_a_kind() -> None:
    """No scene has a body of a type without a line in the registry, and no line is without a scene."""
    assert {type(load(name).body) for name in names()} == set(KINDS)


@pytest.mark.parametrize("model", SAMPLES)
def test_the_momentum_has_the_equations_of_the_state(model: str) -> None:
    """Its rate is the momentum of the rate of z, its spin and energy are those of z; exactly."""
    body, initial = SAMPLES[model]
    kind: Any = kind_of(body)
    z = kind.state(initial)
    p = kind.momentum(body, z)
    assert kind.of_momentum(body, p) == z
    assert kind.with_state(initial, z) == initial
    by_state, by_momentum = kind.equations(body), kind.momentum_equations(body)
    assert tuple(rates(by_momentum, p)) == kind.momentum(body, tuple(rates(by_state, z)))
    assert (by_momentum.spin @ exact(p) == by_state.spin @ exact(z)).all()
    energy = dot(z, apply(kind.energy(body), z))
    assert dot(p, apply(kind.momentum_energy(body), p)) == energy
