"""Likely causes of attitudes by Euler angles whose rates are taken for the body's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import RIGID, TENSOR, TIMES, Q, titles
from builders.trajectories import QUATERNION, VECTORS, Columns, named
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation


def by_angles(factor: float) -> Columns:
    """Rows of the free body, and of roll, pitch and yaw that are integrals of p, q and factor r."""
    start = Rotation.from_quat(Q, scalar_first=True).as_euler("ZYX")[::-1]
    weights, inverse = np.array([1.0, 1.0, factor]), np.linalg.inv(TENSOR)
    solved = solve_ivp(
        lambda t, z: np.r_[inverse @ np.cross(TENSOR @ z[:3], z[:3]), weights * z[:3]],
        (0, TIMES[-1]),
        np.r_[0.8, -0.5, 1.1, start],
        "DOP853",
        t_eval=TIMES,
        rtol=3e-14,
        atol=1e-15,
    )
    omega, angles = np.split(solved.y.T, 2, axis=1)
    q = Rotation.from_euler("ZYX", angles[:, ::-1]).as_quat(scalar_first=True)
    return named(("t",), TIMES[:, None]) | named(VECTORS["omega"], omega) | named(QUATERNION, q)


@pytest.mark.parametrize(("factor", "is_named"), [(1.0, True), (1.02, False)])
def test_body_rates_taken_for_rates_of_angles_are_named(
    factor: float, is_named: bool, tmp_path: Path
) -> None:
    """Integrals of p, q and r in the place of roll, pitch and yaw are named; near ones are not."""
    sentences = titles(tmp_path, RIGID.format(load=""), by_angles(factor))
    assert [title.startswith("attitude by roll' = p") for title in sentences] == [True] * is_named
