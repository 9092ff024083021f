"""Impulses and velocities that a right motion has by the mass matrix of another body."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from builders.scenes import text_of
from builders.turns import by_turns

from taylor_verify import check, exact
from taylor_verify.scenes.reading.reader import read

VEHICLE = text_of(
    {"mass": 12.5, "inertia": [0.3, 0.9, 1.1], "centre_of_mass": [0.05, -0.02, 0.03]}
    | {"added_mass": [1.5, 8, 10, 0.05, 0.6, 0.4]},
    {"linear_velocity": [0.8, -0.1, 0.2], "angular_velocity": [0.3, -0.2, 0.5]},
    *(2, 21, "attitude", "centre"),
)
SCENE = read(VEHICLE, "vehicle")
TIMES = list(SCENE.clock.instants)
MOTION = {name: v.astype(float) for name, v in exact(SCENE, TIMES, 17).quantities.items()}
ENERGY = np.array(SCENE.body.energy_matrix, dtype=float)
MASS = np.linalg.inv(ENERGY)
ADDED = np.diag([1.5, 8, 10, 0.05, 0.6, 0.4])
MOMENTA = np.hstack([MOTION["linear_impulse"], MOTION["angular_impulse"]])
IS = "the motion is right, and "
ANOTHER = "are printed by the mass matrix of another body: "


def judged(momenta: Any = None, velocities: Any = None, attitude: Any = MOTION["attitude"]) -> Any:
    """The judgement of the right path, and of an attitude, beside these rows of six."""
    names = (
        ("linear_impulse", "angular_impulse")
        if velocities is None
        else ("linear_velocity", "omega")
    )
    rows = momenta if velocities is None else velocities
    vectors = dict(zip(names, np.split(rows, 2, axis=1), strict=True))
    columns = {"t": [float(t) for t in TIMES], **vectors}
    columns |= {"attitude": attitude, "centre": MOTION["centre"]}
    return check(SCENE, columns, tolerance=1e-8, partial=True)


def with_entry(i: int, k: int, value: float) -> Any:
    other = MASS.copy()
    other[i, k] = other[k, i] = value
    return other


@pytest.mark.parametrize(
    ("factors", "words"),
    by_turns(
        [
            (
                with_entry(1, 1, 18.5) @ ENERGY,
                f"the impulses {ANOTHER}mass matrix: M_22 = 18.5 for 20.5",
            ),
            ((MASS + ADDED) @ ENERGY, f"the impulses {ANOTHER}added mass twice"),
            (np.kron([[0, 1], [1, 0]], np.eye(3)), "x and y stand in each other's place"),
            (
                np.eye(6) - np.kron([[0, 0], [1, 0]], np.cross(np.eye(3), [-0.1, 0.2, 0])),
                "the impulsive couple y is that about the point (-0.1, 0.2, 0) of the body",
            ),
        ],
        2,
    ),
)
def test_impulses_of_another_body_are_named(factors: Any, words: str) -> None:
    """Attitude and path are right, and six numbers of each row are one matrix times the true ones."""
    (cause,) = judged(momenta=MOMENTA @ factors.T).causes
    assert cause.sentence.startswith(IS + words)


def test_one_entry_has_its_digits_beside_a_motion_that_is_nearly_right() -> None:
    """Rows of a fair integrator are off by more than they round; one entry differs all the same."""
    growing = np.linspace(0, 1e-6, len(TIMES))[:, None, None]
    turned = MOTION["attitude"] @ (np.eye(3) + growing * np.cross(np.eye(3), [1, 2, -1]))
    factors = with_entry(3, 3, 0.5) @ ENERGY
    (cause,) = judged(momenta=MOMENTA @ factors.T * (1 + growing[:, 0]), attitude=turned).causes
    words = f"the motion is nearly right, and the impulses {ANOTHER}mass matrix: M_44 = 0.5"
    assert cause.sentence.startswith(words)


def test_impulses_of_velocities_in_other_axes_are_named() -> None:
    """The right mass matrix times velocities of which one vector has exchanged axes."""
    exchanged = np.eye(6)[[0, 1, 2, 4, 3, 5]]
    (cause,) = judged(momenta=MOMENTA @ (MASS @ exchanged @ ENERGY).T).causes
    words = "the impulses are made of velocities of which the angular ones have other axes: 2 1 3"
    assert cause.sentence.startswith(IS + words)


def test_velocities_of_another_body_are_named() -> None:
    """Velocities that are the impulses divided by the rigid body's own mass matrix lack the added mass."""
    (cause,) = judged(velocities=MOMENTA @ np.linalg.inv(MASS - ADDED)).causes
    assert cause.sentence.startswith(f"{IS}the velocities {ANOTHER}added mass left out")


def test_impulses_that_no_matrix_makes_are_of_no_other_body() -> None:
    """A matrix that changes with time is none."""
    growing = 1 + 0.01 * np.arange(len(TIMES))[:, None]
    causes = judged(momenta=np.hstack([MOMENTA[:, :3] * growing, MOMENTA[:, 3:]])).causes
    assert not any("another body" in cause.sentence for cause in causes)


def test_velocities_of_which_one_is_zero_are_of_no_other_body() -> None:
    """No mass matrix makes them: an entry that no row tells is no number, and no cause."""
    velocities = MOMENTA @ np.linalg.inv(with_entry(0, 4, 0.9)).T * [1, 1, 1, 1, 1, 0]
    assert not judged(velocities=velocities).causes
