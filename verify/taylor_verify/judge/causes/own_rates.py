"""Angular velocities of a file that has attitudes alone, by differences of high order of its own rows.

About the attitude of a row the rotation vectors theta(t) of the other rows, body axes, have theta' = omega
at that row. A polynomial through nine rows gives it, and the one through seven says how well.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.quaternion_rows import conjugate, product, rotation_vectors

# Rows to either side, without which a row has no rate.
ASIDE: Final = 4


def rates_of_attitudes(times: Floats, q: Floats, noise: float) -> tuple[Floats, float]:
    """Return omega (n, 3), body axes, of rows of q (n + 8, 4) but four at each end, and its error.

    ``noise`` is the error of the components of q.
    """
    (finer, weights), (coarser, _) = (_derivative(times, q, aside) for aside in (ASIDE, ASIDE - 1))
    rounding = 2 * noise * float(np.max(np.sum(np.abs(weights), axis=1)))
    return finer, max(rounding, float(np.max(np.abs(finer - coarser))) / 2)


def _derivative(times: Floats, q: Floats, aside: int) -> tuple[Floats, Floats]:
    """Return omega of the inner rows by so many rows to either side, with the weights of these rows."""
    inner = np.arange(ASIDE, len(times) - ASIDE)
    window = inner[:, None] + np.arange(-aside, aside + 1)
    weights = _weights(times[window] - times[inner, None])
    here = np.repeat(conjugate(q[inner]), window.shape[1], axis=0)
    turns = rotation_vectors(product(here, q[window].reshape(-1, 4)))
    return np.einsum("rk,rki->ri", weights, turns.reshape(*window.shape, 3)), weights


def _weights(apart: Floats) -> Floats:
    """Return the weights of values at some distances in the slope at distance 0 (Lagrange), (rows, k)."""
    scale = np.max(np.abs(apart), axis=1, keepdims=True)
    powers = (apart / scale)[:, None, :] ** np.arange(apart.shape[1])[None, :, None]
    slope = np.zeros((apart.shape[1], 1))
    slope[1] = 1.0
    return np.asarray(np.linalg.solve(powers, slope)[..., 0] / scale)
