"""Attitudes row by row: quaternions (rows, 4), scalar first, body to space."""

from __future__ import annotations

import numpy as np

from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.models.frame import rotation
from taylor_verify.numbers import rotation as rotations


def angles(q: Floats, other: Floats) -> Floats:
    """Return the angle between attitudes row by row; q and -q are one attitude."""
    apart = np.minimum(np.linalg.norm(q - other, axis=1), np.linalg.norm(q + other, axis=1))
    return np.asarray(4 * np.arcsin(np.minimum(apart / 2, 1.0)))


def product(p: Floats, q: Floats) -> Floats:
    """Return the quaternion products of rows."""
    return np.stack(rotations.product(list(p.T), list(q.T)), axis=-1)


def conjugate(q: Floats) -> Floats:
    return np.asarray(q * np.array([1.0, -1.0, -1.0, -1.0]))


def matrices(q: Floats) -> Floats:
    """Return R(q) of rows of unit quaternions, (rows, 3, 3)."""
    return np.array(rotation(list(q.T))).transpose(2, 0, 1)


def rotation_vectors(q: Floats) -> Floats:
    """Return the rotation vectors of rows of quaternions."""
    sine = np.linalg.norm(q[:, 1:], axis=1, keepdims=True)
    angle = 2 * np.arctan2(sine, np.abs(q[:, :1]))
    return np.asarray(np.sign(q[:, :1]) * q[:, 1:] * angle / np.where(sine > 0, sine, 1.0))


def of_rotation_vectors(turns: Floats) -> Floats:
    """Return the quaternions of rotation vectors."""
    angle = np.linalg.norm(turns, axis=1, keepdims=True)
    return np.concatenate(
        [np.cos(angle / 2), np.sin(angle / 2) * turns / np.where(angle > 0, angle, 1.0)], axis=1
    )


def steady_signs(q: Floats) -> Floats:
    """Return unit quaternions whose signs do not jump from row to row, whatever rows are not finite."""
    unit = np.asarray(q / np.linalg.norm(q, axis=1, keepdims=True))
    is_finite = np.all(np.isfinite(unit), axis=1)
    own = unit[is_finite]
    signs = np.sign(np.sum(own[1:] * own[:-1], axis=1))
    steady = np.cumprod(np.concatenate([[1.0], np.where(signs == 0, 1.0, signs)]))
    unit[is_finite] = own * steady[: len(own), None]
    return unit
