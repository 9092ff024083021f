"""A rigid body with wheels that turn at a constant momentum, in exact rationals and body axes."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.named_numbers import MOMENT, MOMENTUM, Dimension, Part, Shape


@dataclass(frozen=True)
class Gyrostat(Body):
    """A rigid body with wheels: (I omega)' = (I omega + h) x omega + M.

    ``inertia`` I is that of the body with its wheels locked, ``rotor`` the constant momentum h of the
    wheels; ``moment`` M is as in RigidBody.
    """

    inertia: Matrix
    rotor: Vector
    moment: Vector = ZERO_VECTOR
    damping: Fraction = Fraction(0)
    loads: Loads | None = None

    MODEL = "euler"
    STATE = Spin
    ENERGY = "the inertia tensor"
    PARTS = (
        Part("inertia", Shape.SYMMETRIC, Dimension(1, 2, 0), is_energy=True),
        Part("rotor", Shape.VECTOR, MOMENTUM),
        Part("moment", Shape.VECTOR, MOMENT, is_load=True),
    )

    @property
    def is_conservative(self) -> bool:
        """True without loads and without damping; with damping the wheels do work."""
        return self.is_free and not self.damping

    @property
    def energy_matrix(self) -> Matrix:
        """I: 2T = omega . I omega, without the energy of the wheels against the body."""
        return self.inertia

    @cached_property
    def inverse_inertia(self) -> Matrix:
        """K = I^-1, so that omega = K (H - h)."""
        return tensors.inverse(self.inertia)
