"""Renamings of axes that vectors refute are left out of the search, and no other."""

from __future__ import annotations

import numpy as np
import pytest

from taylor_verify.judge.conventions.axis_orders import AXES
from taylor_verify.judge.conventions.unrefuted_axes import unrefuted


@pytest.mark.parametrize("size", [1e-150, 1e-3, 1.0, 1e150], ids=str)
@pytest.mark.parametrize("error", [0.0, 1e-9, 1e-2])
def test_axes_are_refuted_by_their_largest_error_alone(size: float, error: float) -> None:
    """Axes whose error is small in every row stay; generic rows refute all others."""
    draw = np.random.default_rng(1)
    for axes in AXES:
        vectors = draw.normal(size=(24, 3))
        across = draw.normal(size=(24, 3))
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        right = axes.vectors(vectors) + error * across
        assert unrefuted(size * vectors, size * right, 1.01 * size * error) == {axes}


def test_what_is_not_finite_refutes_nothing() -> None:
    """Rows beyond float64 are left to those who read them."""
    rows = np.full((2, 3), np.inf)
    with np.errstate(invalid="ignore"):
        assert unrefuted(rows, rows, 1.0) == set(AXES)
