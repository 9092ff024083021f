"""Attitudes in other columns, and relative to frames that turn."""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.judge.causes.float_answer import Answer, velocities_of
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.quaternion_rows import conjugate, matrices, product

NEAR: Final = 1e-2
# A body turns steadily to this part; the error of a method is slower than this part of its rate.
_STEADY: Final = 1e-4
_SLOW: Final = 0.05


def other_columns(truth: Floats) -> dict[str, Floats]:
    """Return the quaternions of files whose columns hold other components, or one with the other sign."""
    columns: dict[str, Floats] = {}
    for words, rows in (("", truth), ("is transposed, and ", conjugate(truth))):
        columns[f"{words}has the scalar last, read as first"] = np.roll(rows, -1, axis=1)
        columns[f"{words}has the scalar first, read as last"] = np.roll(rows, 1, axis=1)
    for k in (1, 2, 3):
        columns[f"has the other sign in q{k}"] = truth * (1 - 2 * np.eye(4)[k])
    for i, k in ((1, 2), (1, 3), (2, 3)):
        order = np.array([0, 1, 2, 3])
        order[[i, k]] = k, i
        columns[f"has q{i} and q{k} exchanged"] = truth[:, order]
    return columns


def is_near(q: Floats, rows: Floats) -> bool:
    return bool(np.all(np.abs(np.sum(q * rows, axis=1)) > 1 - NEAR))


def mean_turn(turns: Floats) -> Floats:
    """Return the mean of quaternions whose signs are free, (1, 4)."""
    return np.asarray(np.linalg.eigh(turns.T @ turns)[1][:, -1][None])


def degrees(q: Floats) -> float:
    """Return the angle of the turn of a quaternion."""
    return float(np.degrees(2 * np.arccos(min(1.0, abs(float(q[0]))))))


def frame_that_turns(answer: Answer, q: Floats, truth: Floats) -> tuple[Floats, Floats]:
    """Return the constant rate of a frame, by Newton's method, and the attitudes relative to it."""
    elapsed = answer.times - answer.begins
    early = np.argsort(np.abs(elapsed))[1 : max(3, len(elapsed) // 10)]
    rate = _rate(_small_turns(product(q, conjugate(truth)))[early], elapsed[early])
    turned = truth
    for _ in range(4):
        turn = elapsed[:, None] * rate
        angle = np.linalg.norm(turn, axis=1, keepdims=True) + 1e-300
        frame = np.hstack([np.cos(angle / 2), np.sin(angle / 2) * turn / angle])
        turned = product(frame, truth)
        rest = _small_turns(product(q, conjugate(turned)))
        rate = rate + _rate(rest, elapsed)
    # The frame turns as much one way as what is seen from it turns the other way.
    return -rate, turned


def steady_rate(answer: Answer) -> Floats | None:
    """Return the rate of turn, space axes, of a motion that turns steadily; None of any other."""
    assert answer.truth.q is not None
    nu = velocities_of(answer.right, answer.truth.v)
    omega = np.einsum("nij,nj->ni", matrices(answer.truth.q), nu[:, -3:])
    mean = np.mean(omega, axis=0)
    off = float(np.max(np.linalg.norm(omega - mean, axis=1)))
    return mean if off < _STEADY * np.linalg.norm(mean) else None


def is_of_steady_turn(answer: Answer, rate: Floats) -> bool:
    """Return True for a slow rate about the axis of a steady turn, as the error of a method makes it."""
    turn = steady_rate(answer)
    if turn is None:
        return False
    size, slow = float(np.linalg.norm(turn)), float(np.linalg.norm(rate))
    is_along = np.linalg.norm(np.cross(turn, rate)) < _STEADY * size * slow
    return bool(is_along and slow < _SLOW * size)


def _rate(turns: Floats, elapsed: Floats) -> Floats:
    """Return the constant rate that fits small turns best."""
    squares = max(float(np.sum(elapsed**2)), 1e-300)
    return np.asarray(np.sum(turns * elapsed[:, None], axis=0) / squares)


def _small_turns(q: Floats) -> Floats:
    return np.asarray(2 * q[:, 1:] * np.where(q[:, :1] < 0, -1.0, 1.0))
