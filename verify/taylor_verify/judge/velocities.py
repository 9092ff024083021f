"""Velocities of a body whose state is momenta; a file may have either.

U   velocity of the body's origin, body axes        Omega   angular velocity, body axes
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from mpmath import mp

from taylor_verify.exact.solution import Quantities
from taylor_verify.numbers.tensors import Matrix, inverse, transpose
from taylor_verify.records.quantities import VELOCITIES
from taylor_verify.scenes.bodies import Body

Array = np.ndarray[Any, Any]


def velocity_forms(body: Body) -> Mapping[str, Mapping[str, Matrix]]:
    """Return the forms U = A x + B y and Omega = B^T x + C y of a body that has velocities, by group."""
    parts = body.parts()
    A, B, C = parts["linear"], parts["coupling"], parts["angular"]
    return {
        "linear_velocity": {"linear_impulse": A, "angular_impulse": B},
        "omega": {"linear_impulse": transpose(B), "angular_impulse": C},
    }


def velocity(group: str, body: Body, quantities: Quantities) -> Any:
    """Return the velocity of a column group at every sample, from the exact coefficients."""
    linear = velocity_forms(body)[group].items()
    return sum(quantities[name] @ exact_matrix(matrix).T for name, matrix in linear)


def velocities(body: Body, quantities: Quantities) -> dict[str, Any]:
    """Return every velocity at every sample, by column group."""
    return {group: velocity(group, body, quantities) for group in VELOCITIES}


def momenta(body: Body, quantities: Quantities) -> dict[str, Any]:
    """Return the momenta at every sample, by the exact mass matrix: (x, y) = M (U, Omega)."""
    M = exact_matrix(inverse(body.energy_matrix))
    both = np.concatenate([quantities[name] for name in VELOCITIES], axis=1) @ M.T
    return {name: both[:, 3 * k : 3 * k + 3] for k, name in enumerate(body.STATE.MOVING)}


def exact_matrix(matrix: Sequence[Sequence[Any]]) -> Array:
    """Return a matrix of rationals in the ambient precision."""
    return np.array([[mp.convert(entry) for entry in row] for row in matrix], dtype=object)
