"""Likely causes of rows with the noise of a sensor: what is left by a cause has no memory."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import RIGID, TENSOR, TIMES, Law, Q, rigid, titles
from builders.trajectories import QUATERNION, VECTORS, Columns, named
from builders.turns import by_turns
from builders.wrong_dynamics import turned
from scipy.integrate import solve_ivp

HEAVIER = TENSOR + np.diag([0.0, 0.0, 0.15])
DAMPED: Law = lambda t, w, q: -0.07 * TENSOR @ w  # noqa: E731 (a law of one line)


def with_noise(made: Columns, size: float) -> Columns:
    draws = np.random.default_rng(7)
    rows = {name: np.array(made[name], float) for name in VECTORS["omega"]}
    return made | {n: (r + size * draws.standard_normal(len(r))).tolist() for n, r in rows.items()}


def by_rk45() -> Columns:
    """The right motion by a sound method at a coarse tolerance."""

    def rates(t: float, z: np.ndarray) -> np.ndarray:
        w = z[:3]
        return np.r_[np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w)), turned(z[3:], w)]

    z = solve_ivp(rates, (0, 8), np.r_[0.8, -0.5, 1.1, Q], t_eval=TIMES, rtol=2e-3, atol=1e-5).y.T
    q = z[:, 3:] / np.linalg.norm(z[:, 3:], axis=1, keepdims=True)
    return named(("t",), TIMES[:, None]) | named(VECTORS["omega"], z[:, :3]) | named(QUATERNION, q)


@pytest.mark.parametrize(
    ("made", "words"),
    by_turns(
        [
            (lambda: rigid(gyro=0.0), "no gyroscopic term"),
            (lambda: rigid(HEAVIER), "I_33 = 3.2"),
            (lambda: rigid(moment=DAMPED), "damping = 0.07"),
            (lambda: rigid(), "omega contradicts the file's own attitude"),
            (by_rk45, None),
        ],
        5,
    ),
)
def test_a_fault_is_named_through_noise(
    made: Callable[[], Columns], words: str | None, tmp_path: Path
) -> None:
    """A cause of all rows stands out of noise; an error of steps has a memory, and no name."""
    sentences = titles(tmp_path, RIGID.format(load=""), with_noise(made(), 5e-5))
    assert [each[: len(words or "")] for each in sentences] == [words] * bool(words)
