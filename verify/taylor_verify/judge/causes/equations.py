"""Equations of motion, right and with one thing wrong, as homogeneous quadratic rates of float64 rows.

Euler:      z = (omega, 1), I omega' = (I omega + h) x omega + M, h the momentum of wheels
Kirchhoff:  z = (x, y, 1), x' = x x W + X, y' = y x W + x x U + L, U = A x + B y, W = B^T x + C y
with the attitude: q' = q W / 2 besides, q a quaternion, scalar first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from taylor_verify.judge.causes.flow import Floats, bilinear
from taylor_verify.scenes.bodies import Body, ImmersedBody, RigidBody
from taylor_verify.scenes.gyrostat import Gyrostat

_KNOWN: Final = (RigidBody, Gyrostat, ImmersedBody)


@dataclass(frozen=True)
class Equations:
    """A body's equations of motion with weights for their terms.

    ``tensor`` is I, or the 6x6 matrix of the energy. ``load`` is M, or (X, L). ``gyroscopic`` weighs
    (I omega) x omega, or y x W; ``munk`` weighs x x U and ``turning`` x x W. ``damping`` c adds -c z, and
    ``drag`` d the moment -d omega (in a fluid: force -d U and couple -d W). ``rotor`` is h.
    """

    tensor: Floats
    load: Floats
    gyroscopic: float = 1.0
    munk: float = 1.0
    turning: float = 1.0
    damping: float = 0.0
    drag: float = 0.0
    rotor: tuple[float, ...] = (0.0, 0.0, 0.0)

    @staticmethod
    def are_known(body: Body) -> bool:
        """Return True if this kind of body has equations here, and its loads are constant."""
        return type(body) in _KNOWN and body.manufactured is None

    @classmethod
    def of(cls, body: Body) -> Equations:
        """Return the right equations of a body whose loads are constant."""
        values = body.parts()
        loads = [entry for name in body.load_names() for entry in values[name]]
        found = cls(np.array(body.energy_matrix, dtype=float), np.array(loads, dtype=float))
        rotor = tuple(map(float, values.get("rotor", found.rotor)))
        return replace(found, rotor=rotor, damping=float(body.damping))

    def slowed(self, factor: float) -> Equations:
        """Return the equations with this factor at all that is quadratic in the state."""
        return replace(self, gyroscopic=factor, munk=factor, turning=factor)

    @property
    def is_rigid(self) -> bool:
        return len(self.tensor) == 3

    @property
    def moving(self) -> int:
        """The number of components that move: 3 or 6."""
        return len(self.tensor)

    @cached_property
    def inverse(self) -> Floats:
        return np.asarray(np.linalg.inv(self.tensor), dtype=float)

    @property
    def is_possible(self) -> bool:
        """Return True if the tensor is positive definite."""
        return bool(np.all(np.linalg.eigvalsh(self.tensor) > 0))

    def rates(self, z: Floats) -> Floats:
        """Return z' of rows z = (omega, 1) or (x, y, 1)."""
        made = self._rigid(z) if self.is_rigid else self._immersed(z)
        return np.column_stack([made, np.zeros(len(z))])

    def omega(self, z: Floats) -> Floats:
        """Return the angular velocity of every row, body axes."""
        return z[:, :3] if self.is_rigid else z[:, :6] @ self.tensor[:, 3:]

    @property
    def map(self) -> Floats:
        """Q of the rates."""
        return bilinear(self.rates, self.moving + 1)

    def _rigid(self, z: Floats) -> Floats:
        omega, one = z[:, :3], z[:, 3:]
        torque = self.gyroscopic * np.cross(omega @ self.tensor, omega) + one**2 * self.load
        torque = torque + one * np.cross(self.rotor, omega)
        driven = (torque - self.drag * one * omega) @ self.inverse
        return driven - self.damping * one * omega

    def _immersed(self, z: Floats) -> Floats:
        state, one = z[:, :6], z[:, 6:]
        x, y = state[:, :3], state[:, 3:]
        velocities = state @ self.tensor
        U, W = velocities[:, :3], velocities[:, 3:]
        x_rate = self.turning * np.cross(x, W)
        y_rate = self.gyroscopic * np.cross(y, W) + self.munk * np.cross(x, U)
        found: Floats = np.column_stack([x_rate, y_rate]) + one**2 * self.load
        return found - one * (self.damping * state + self.drag * velocities)
