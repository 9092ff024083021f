"""Attitudes of many parameters and many arcs at once: R(q), vectors in both frames, and the rates of q.

An array of quaternions or of vectors has the axes (parameters, components, arcs).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.models.acting import Frame, of_unit_length
from taylor_verify.models.frame import attitude_rate, rotation


def outer(p: Floats, q: Floats) -> Floats:
    """Return the products p_i q_j of the components, (parameters, products, arcs)."""
    return np.asarray(np.repeat(p, q.shape[1], axis=1) * np.tile(q, (1, p.shape[1], 1)))


def _turning_factors(unit: Floats, axes: Floats) -> Floats:
    """Return the factors of q_i W_j in q' = q W / 2, for these unit vectors."""
    return np.array([attitude_rate(list(q), list(W)) for q in unit for W in axes], dtype=float).T


def _entries(q: Floats) -> Floats:
    return np.ravel(rotation(list(q)))


AFTER: Final = _turning_factors(np.eye(4), np.eye(3))
# W q is the conjugate of q* W*, and W* = -W.
_CONJUGATE: Final = np.diag([1.0, -1, -1, -1])
BEFORE: Final = _CONJUGATE @ _turning_factors(_CONJUGATE, -np.eye(3))
# The factors of q_i q_k in the entries of R(q), which are quadratic forms.
_ROTATION: Final = np.transpose(
    [(_entries(e + d) - _entries(e - d)) / 4 for e in np.eye(4) for d in np.eye(4)]
)


def rotations(q: Floats, frame: Frame = of_unit_length) -> Floats:
    """Return R(q) of quaternions of any length, (parameters, 3, 3, arcs)."""
    if frame is not of_unit_length:
        return np.transpose(frame(list(q.swapaxes(0, 1)))[1], (2, 0, 1, 3))
    R = _ROTATION @ outer(q, q) / np.sum(q * q, axis=1, keepdims=True)
    return np.asarray(R.reshape(len(q), 3, 3, -1))


def to_space(R: Floats, vectors: Floats) -> Floats:
    """Return R v for vectors of three components."""
    return np.asarray(np.einsum("pika,pka->pia", R, vectors))


def to_body(R: Floats, vectors: Floats) -> Floats:
    """Return R^T v for every vector of three components."""
    threes = vectors.reshape(len(vectors), -1, 3, vectors.shape[2])
    turned = np.einsum("pkia,pnka->pnia", R, threes)
    return np.asarray(turned.reshape(len(turned), vectors.shape[1], -1))
