"""The steady screws as rows: each number put back into the equations that define it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from taylor_verify.explain.explanation import explanation
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.reading.reader import load

GENERAL = "kirchhoff/general-body"
# Fifteen digits are written, of numbers of size one and of products of a few of them.
NEAR = 1e-12


@pytest.fixture(scope="module")
def rows() -> list[dict[str, Any]]:
    screws: list[dict[str, Any]] = explanation(GENERAL, "f32")["screws"]
    return screws


def blocks() -> tuple[Any, Any, Any, Any]:
    """A, B, C and x of the scene, as doubles."""
    scene = load(GENERAL)
    body, start = scene.body, scene.initial
    assert isinstance(body, ImmersedBody)
    assert isinstance(start, Impulse)
    exact_blocks = (body.linear, body.coupling, body.angular, start.linear)
    A, B, C, x = (np.array(entries, dtype=float) for entries in exact_blocks)
    return A, B, C, x


def test_a_row_is_a_steady_motion(rows: list[dict[str, Any]]) -> None:
    """Of its axis, mu and turning: Omega = lambda x and U = lambda y + mu x, and the velocity is U.n."""
    A, B, C, start = blocks()
    F = np.linalg.norm(start)
    assert len(rows) == 3
    for row in rows:
        n, turning = np.array(row["axis"], dtype=float), float(row["turning"])
        x = F * n
        y = np.linalg.solve(C, turning * n - B.T @ x)
        U = A @ x + B @ y
        assert np.linalg.norm(U - turning / F * y - float(row["mu"]) * x) <= NEAR
        assert abs(U @ n - float(row["velocity"])) <= NEAR
        assert float(row["pitch"]) == pytest.approx(
            2 * np.pi * float(row["velocity"]) / turning, rel=NEAR
        )


def test_the_spectrum_is_that_of_the_linearised_equations(rows: list[dict[str, Any]]) -> None:
    """The exponents are the eigenvalues of the derivative of (x', y') by differences, beside two zeros."""
    A, B, C, start = blocks()
    F = np.linalg.norm(start)

    def rate(z: Any) -> Any:
        x, y = z[:3], z[3:]
        U, Omega = A @ x + B @ y, B.T @ x + C @ y
        return np.concatenate([np.cross(x, Omega), np.cross(y, Omega) + np.cross(x, U)])

    for row in rows:
        n = np.array(row["axis"], dtype=float)
        z = np.concatenate([F * n, np.linalg.solve(C, float(row["turning"]) * n - B.T @ (F * n))])
        # The rates are quadratic, so that a difference of any width is the derivative.
        J = np.array([(rate(z + e) - rate(z - e)) / 2 for e in np.eye(6)]).T
        spectrum = [complex(float(re), float(im)) for re, im in row["spectrum"]]
        expected = np.linalg.eigvals(J)
        # A double zero comes as the root of a rounding.
        for s in spectrum:
            assert np.min(np.abs(expected - s)) <= 1e-6
        assert (max(s.real for s in spectrum) > 1e-6) == (row["stability"] == "unstable")


def test_a_body_of_revolution_has_no_rows() -> None:
    """Where the screws are not three, or are told by closed forms, the list is empty."""
    assert explanation("euler/spherical", "f32")["screws"] == []
