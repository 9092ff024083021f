"""Equations of motion, correct or with one error, as homogeneous quadratic rates of float64 rows.

Euler:      z = (omega, 1), I omega' = (I omega + h) x omega + M, h the momentum of wheels
Kirchhoff:  z = (x, y, 1), x' = x x W + X, y' = y x W + x x U + L, U = A x + B y, W = B^T x + C y
with the attitude: also q' = q W / 2, where q is a quaternion, scalar first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from taylor_verify.judge.causes.flow import Floats, bilinear
from taylor_verify.scenes.bodies import Body

# Parts of a body, beside its energy, its loads and its damping, that have terms here.
_WITH_TERMS: Final = frozenset({"rotor"})


@dataclass(frozen=True)
class Equations:
    """A body's equations of motion, with a weight for each term.

    ``tensor`` is I, or the 6x6 matrix of the energy. ``load`` is M, or (X, L). ``gyroscopic`` weighs
    (I omega) x omega, or y x W; ``munk`` weighs x x U and ``turning`` x x W. ``damping`` c adds -c z, and
    ``drag`` d the moment -d omega (in a fluid: force -d U and couple -d W). ``rotor`` is h.
    """

    tensor: Floats
    load: Floats
    damping: float
    gyroscopic: float = 1.0
    munk: float = 1.0
    turning: float = 1.0
    drag: float = 0.0
    rotor: tuple[float, ...] = (0.0, 0.0, 0.0)

    @staticmethod
    def are_known(body: Body) -> bool:
        """Return True if every part of the body has its terms here, and its loads are constant."""
        is_constant = body.manufactured is None and body.loads is None
        return body.others <= _WITH_TERMS and is_constant

    @classmethod
    def of(cls, body: Body) -> Equations:
        """Return the correct equations of a body whose loads are constant."""
        values = body.parts()
        loads = [entry for name in body.load_names() for entry in values[name]]
        tensor = np.array(body.energy_matrix, dtype=float)
        plain = cls(tensor, np.array(loads, dtype=float), damping=float(body.damping))
        return replace(plain, rotor=tuple(map(float, values.get("rotor", plain.rotor))))

    def slowed(self, factor: float) -> Equations:
        """Return the equations with all terms that are quadratic in the state multiplied by a factor."""
        return replace(self, gyroscopic=factor, munk=factor, turning=factor)

    @property
    def is_rigid(self) -> bool:
        return len(self.tensor) == 3

    @property
    def moving(self) -> int:
        """Number of components that change in time: 3 or 6."""
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
        rates = self._rigid(z) if self.is_rigid else self._immersed(z)
        return np.column_stack([rates, np.zeros(len(z))])

    def omega(self, z: Floats) -> Floats:
        """Return the angular velocity of every row, body axes."""
        return z[:, :3] if self.is_rigid else z[:, :6] @ self.tensor[:, 3:]

    @property
    def map(self) -> Floats:
        """Quadratic map Q of the rates."""
        return bilinear(self.rates, self.moving + 1)

    def _rigid(self, z: Floats) -> Floats:
        omega, unit = z[:, :3], z[:, 3:]
        torque = self.gyroscopic * np.cross(omega @ self.tensor, omega) + unit**2 * self.load
        torque = torque + unit * np.cross(self.rotor, omega)
        driven = (torque - self.drag * unit * omega) @ self.inverse
        return driven - self.damping * unit * omega

    def _immersed(self, z: Floats) -> Floats:
        state, unit = z[:, :6], z[:, 6:]
        x, y = state[:, :3], state[:, 3:]
        velocities = state @ self.tensor
        U, W = velocities[:, :3], velocities[:, 3:]
        x_rate = self.turning * np.cross(x, W)
        y_rate = self.gyroscopic * np.cross(y, W) + self.munk * np.cross(x, U)
        rates: Floats = np.column_stack([x_rate, y_rate]) + unit**2 * self.load
        return rates - unit * (self.damping * state + self.drag * velocities)
