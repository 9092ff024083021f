"""How fast a problem's motion can be: the bound on which the longest step rests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from verify.models.problem import Problem
from verify.scenes import tensors
from verify.scenes.bodies import RigidBody
from verify.scenes.tensors import Matrix, Vector

_SLOWEST = 2.0**-10  # keeps a step finite for a body that is (almost) at rest


@dataclass(frozen=True)
class RateBound:
    """Bounds |omega| ahead of a state, in the problem's units of time.

    With z the momenta, G the matrix of 2T = z.G z and g the largest eigenvalue of G, the velocities
    G z have norm at most sqrt(2T g). Loads w raise sqrt(2T) by at most sqrt(g) |w| a unit of time.
    Doubles suffice: the bound is used to within a few per cent.
    """

    energy_matrix: np.ndarray[tuple[int, int], np.dtype[np.float64]]
    load: float
    states: tuple[str, ...]

    @property
    def is_free(self) -> bool:
        return self.load == 0

    def ahead(self, state: Sequence[float], span: float) -> float:
        """The largest rate within ``span`` of this state of the problem's form."""
        named = dict(zip(self.states, state, strict=True))
        z = np.array([named.get(name, 0.0) for name in _momenta(len(self.energy_matrix))])
        g = float(np.linalg.eigvalsh(self.energy_matrix)[-1])
        doubled_energy = max(float(z @ self.energy_matrix @ z), 0.0)
        return max((doubled_energy * g) ** 0.5 + g * self.load * abs(span), _SLOWEST)


def rate_bound(problem: Problem) -> RateBound:
    """The bound for a problem, from its parameters in its own units."""
    G, loads = _scaled_energy(problem)
    return RateBound(
        np.array([[float(entry) for entry in row] for row in G]),
        float(tensors.dot(loads, loads)) ** 0.5,
        problem.form.states,
    )


def _momenta(count: int) -> tuple[str, ...]:
    return ("H1", "H2", "H3") if count == 3 else ("x1", "x2", "x3", "y1", "y2", "y3")


def _scaled_energy(problem: Problem) -> tuple[Matrix, Vector]:
    """G and the loads in the problem's units, in which the energy is of order one."""
    body, units = problem.given.body, problem.units
    torque = units.momentum / units.time
    if isinstance(body, RigidBody):
        K = tensors.inverse(body.inertia)
        return _divided(K, units.inverse_inertia), tensors.scaled(1 / torque, body.moment)
    G = tensors.blocks(
        _divided(body.linear, units.inverse_mass),
        _divided(body.coupling, units.coupling),
        _divided(body.angular, units.inverse_inertia),
    )
    force = tensors.scaled(units.time / units.impulse, body.force)
    return G, force + tensors.scaled(1 / torque, body.couple)


def _divided(matrix: Matrix, unit: Fraction) -> Matrix:
    return tuple(tensors.scaled(1 / unit, row) for row in matrix)
