"""Likely causes of a vehicle whose scene names an added mass: its parts, and those of the Munk moment."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.caused_rows import Array, Law, columns, rows, titles
from builders.scenes import text_of
from builders.trajectories import Columns
from builders.turns import by_turns
from scipy.spatial.transform import Rotation

from taylor_verify.judge.causes.fitted_bodies import nearest_factor
from taylor_verify.judge.causes.material import equations_of
from taylor_verify.scenes.reading.reader import read

VEHICLE = text_of(
    {"mass": 31.9, "inertia": [0.12, 4.2, 4.2], "centre_of_mass": [0, 0, 0.02]}
    | {"added_mass": [0.86, 30.3, 28.3, 0.035, 3.6, 3.5]},
    {"linear_velocity": [1.5, 0.1, -0.05], "angular_velocity": [0.05, 0.1, 0.15]},
    *(3, 61, "attitude"),
)


def crossed(v: Array) -> Array:
    return np.cross(np.eye(3), v)


def coriolis(matrix: Array, nu: Array) -> Array:
    """Fossen's C(nu) of a mass matrix."""
    linear, angular = crossed(matrix[:3] @ nu), crossed(matrix[3:] @ nu)
    return np.block([[np.zeros((3, 3)), -linear], [-linear, -angular]])


def body() -> tuple[Array, Array]:
    """The rigid body of the vehicle, and its added mass."""
    arm = crossed(np.array([0, 0, 0.02]))
    lower = np.diag([0.12, 4.2, 4.2]) - 31.9 * arm @ arm
    own = np.block([[31.9 * np.eye(3), -31.9 * arm], [31.9 * arm, lower]])
    return own, np.diag([0.86, 30.3, 28.3, 0.035, 3.6, 3.5])


def answer(law: Law) -> Columns:
    """The columns of the velocities and the attitude that follow from a law."""
    times = np.round(np.arange(0, 61) * 0.05, 6)
    made = rows(law, [1.5, 0.1, -0.05, 0.05, 0.1, 0.15], np.array([1.0, 0, 0, 0]), times, ())
    return columns(times, made, ("u1", "u2", "u3", "w1", "w2", "w3"))


@pytest.mark.parametrize(
    ("entries", "factor", "of_mass", "words"),
    by_turns(
        [
            ([(5, 1)], 0.0, 1.0, "entry C_51 of the added mass is 0"),
            ([(1, 6)], -1.0, 1.0, "entry C_16 of the added mass has the other sign"),
            (
                [(5, 1), (5, 3), (6, 1), (6, 2)],
                0.0,
                1.0,
                "entries C_51 C_53 C_61 C_62 of the added",
            ),
            ("every", 0.0, 1.0, "added mass left out in the Coriolis terms alone"),
            ("every", 1.0, 0.0, "added mass left out in the mass matrix alone"),
            ("every", 0.0, 0.0, "added mass left out"),
        ],
        6,
        lambda entries, *_: entries == "every",
    ),
)
def test_an_added_mass_that_a_scene_names_is_named(
    entries: Any, factor: float, of_mass: float, words: str, tmp_path: Path
) -> None:
    """Entries of C_A, and the whole of it in one place or in both, have their names."""
    own, added = body()
    factors = np.ones((6, 6))
    for i, k in np.ndindex(6, 6) if entries == "every" else [(i - 1, k - 1) for i, k in entries]:
        factors[i, k] = factor
    mass = own + of_mass * added

    def law(t: float, nu: Array, q: Array) -> Array:
        matrix = coriolis(own, nu) + factors * coriolis(added, nu)
        return np.linalg.solve(mass, -matrix @ nu)

    assert titles(tmp_path, VEHICLE, answer(law))[0].startswith(words)


FULL = np.diag([0.86, 30.3, 28.3, 0.035, 3.6, 3.5])
FULL[1, 5] = FULL[5, 1] = 2.0
FULL[2, 4] = FULL[4, 2] = -1.5
CUT, HALF_CUT = np.diag(np.diag(FULL)), FULL.copy()
HALF_CUT[1, 5] = HALF_CUT[5, 1] = 0.0


def munk(matrix: Array, nu: Array, part: float = 1.0, coupling: float = 0.0) -> Array:
    """Part of the Munk moment of the masses, and of the coupling, of a mass matrix."""
    momentum = part * matrix[:3, :3] @ nu[:3] + coupling * matrix[:3, 3:] @ nu[3:]
    return np.r_[np.zeros(3), np.cross(momentum, nu[:3])]


@pytest.mark.parametrize(
    ("in_mass", "in_terms", "without", "words"),
    by_turns(
        [
            (CUT, CUT, munk, "added mass cut to its diagonal"),
            (FULL, CUT, munk, "added mass cut to its diagonal in the Coriolis terms alone"),
            (HALF_CUT, HALF_CUT, munk, None),
            (FULL, FULL, munk, "no Munk moment of the masses"),
            (FULL, FULL, partial(munk, coupling=1.0), "no Munk moment"),
            (FULL, FULL, partial(munk, part=0.9), None),
        ],
        6,
    ),
)
def test_parts_of_an_added_mass_are_named(
    in_mass: Array, in_terms: Array, without: Any, words: str | None, tmp_path: Path
) -> None:
    """An added mass cut to its diagonal, and a Munk moment left out, have their names; near ones do not."""
    own, _ = body()
    is_cut = in_terms is not FULL

    def law(t: float, nu: Array, q: Array) -> Array:
        terms = -coriolis(own + in_terms, nu) @ nu
        return np.linalg.solve(own + in_mass, terms - (not is_cut) * without(own + FULL, nu))

    scene = VEHICLE.replace("[0.86, 30.3, 28.3, 0.035, 3.6, 3.5]", str(FULL.tolist()))
    named_ones = titles(tmp_path, scene, answer(law))
    near = ("added mass cut to its diagonal", "no Munk moment")
    if words is None:
        assert not any(title.startswith(near) for title in named_ones)
    else:
        assert named_ones == [words]


WHOLE = VEHICLE.replace("mass = 31.9", f"mass_matrix = {(body()[0] + FULL).tolist()}")
WHOLE = "\n".join(
    line
    for line in WHOLE.splitlines()
    if not line.startswith(("inertia", "centre_of", "added_mass"))
)
# A steady run, on which what a matrix turns the velocities by is hardly seen.
GENTLE = WHOLE.replace("[1.5, 0.1, -0.05]", "[1.8, 0.004, -0.003]").replace(
    "[0.05, 0.1, 0.15]", "[0.006, 0.002, 0.0015]"
)
LOWER = np.block([[np.ones((3, 6))], [np.zeros((3, 3)), np.ones((3, 3))]])
MISSING = "the added mass is missing"


@pytest.mark.parametrize(
    ("factors", "noise", "words"),
    [
        (np.zeros((6, 6)), 0.0, f"{MISSING}, moments of inertia known up to a common number"),
        (LOWER, 0.0, f"{MISSING}: Munk moment of a rigid body, and a factor of the rest"),
        (LOWER + 0.1 * (1 - LOWER), 0.0, "Munk moment of a rigid body, and a factor of the rest"),
        (np.zeros((6, 6)), 3e-6, ""),
        (LOWER, 3e-6, ""),
    ],
    ids=["whole", "lower left block", "a tenth of it", "whole, and noise", "block, and noise"],
)
def test_a_missing_added_mass_is_named_where_the_scene_has_masses_alone(
    factors: Array, noise: float, words: str, tmp_path: Path
) -> None:
    """A rigid body is left of the terms: as few numbers as it has are said, or none.

    Beside the errors of a method a run as steady as this fixes no entry of a matrix, and what is left is
    measured in the motion of the file where the scene's is unstable.
    """
    own, _ = body()

    def law(t: float, nu: Array, q: Array) -> Array:
        matrix = coriolis(own, nu) + factors * coriolis(FULL, nu)
        return np.linalg.solve(own + FULL, noise * np.sin(7 * t) * nu - matrix @ nu)

    times = np.round(np.arange(0, 61) * 0.05, 6)
    made = rows(law, [1.8, 0.004, -0.003, 0.006, 0.002, 0.0015], np.eye(4)[0], times, ())
    sentences = titles(tmp_path, GENTLE, columns(times, made, ("u1", "u2", "u3", "w1", "w2", "w3")))
    if words:
        assert sentences[0].startswith(words)
    else:
        assert not sentences


def test_a_centre_of_mass_that_the_terms_lack_is_no_factor_of_one(tmp_path: Path) -> None:
    """A factor of 1 says that the rest of the matrix is right: the numbers beside it are the fault."""
    arm, without = crossed(np.array([0.05, 0, 0.02])), np.diag([31.9, 31.9, 31.9, 0.12, 4.2, 4.2])
    own = without - 31.9 * np.block([[np.zeros((3, 3)), arm], [-arm, arm @ arm]])

    def law(t: float, nu: Array, q: Array) -> Array:
        return np.linalg.solve(own + FULL, -coriolis(without + FULL, nu) @ nu)

    scene = WHOLE.replace(str((body()[0] + FULL).tolist()), str((own + FULL).tolist()))
    (title,) = titles(tmp_path, scene, answer(law))
    assert title.startswith("Coriolis terms of a rigid body, and a factor of the rest: m r_1 = ")


def test_the_factor_of_a_free_body_leaves_the_entries_that_agree_best_unchanged() -> None:
    """Entries that agree to the last digit weigh more than as many that agree to a thousandth."""
    right = equations_of(read(WHOLE, "vehicle"), has_momenta=False)
    fitted = right.mass.copy()
    fitted[[3, 4, 5], [3, 4, 5]] *= [0.9992, 0.9991, 0.9993]
    assert np.allclose(nearest_factor(right, 1.0008 * fitted), fitted, rtol=1e-12)


def test_a_centre_of_mass_that_the_terms_alone_have_is_named(tmp_path: Path) -> None:
    """A mass matrix without m r beside Coriolis terms that have it."""
    own = body()[0]
    mass = np.kron(np.eye(2), np.ones((3, 3))) * own + FULL

    def law(t: float, nu: Array, q: Array) -> Array:
        return np.linalg.solve(mass, -coriolis(own + FULL, nu) @ nu)

    (title,) = titles(tmp_path, WHOLE, answer(law))
    assert title.startswith(
        "coupling by the centre of mass (m r) in the mass matrix alone: m r_3 = 0 "
    )


def test_a_mass_matrix_in_single_precision_is_named(tmp_path: Path) -> None:
    """Its entries are off by some 1e-8, which twelve digits show."""
    own = body()[0]
    mass = (own + FULL).astype(np.float32).astype(float)

    def law(t: float, nu: Array, q: Array) -> Array:
        return np.linalg.solve(mass, -coriolis(mass, nu) @ nu)

    assert titles(tmp_path, WHOLE, answer(law)) == ["mass matrix in float32"]


HUNG = VEHICLE.replace(
    "[initial]",
    "weight = { force = [0, 0, 313], at = [0, 0, 0.02] }\nbuoyancy = { force = [0, 0, -313] }\n[initial]",
)


@pytest.mark.parametrize("in_weight", [True, False])
def test_a_centre_of_mass_at_the_origin_is_so_in_the_weight_too(
    in_weight: bool, tmp_path: Path
) -> None:
    """A scene has at two places what a simulator has once; without the weight the body alone is named."""
    own, added = body()
    mass = np.kron(np.eye(2), np.ones((3, 3))) * own + added
    mass[3:, 3:] = np.diag([0.12, 4.2, 4.2]) + added[3:, 3:]
    at = np.array([0, 0, 0.0 if in_weight else 0.02])

    def law(t: float, nu: Array, q: Array) -> Array:
        R = Rotation.from_quat([*q[1:], q[0]]).as_matrix()
        couple = np.cross(at, R.T @ [0, 0, 313.0])
        return np.linalg.solve(mass, np.r_[np.zeros(3), couple] - coriolis(mass, nu) @ nu)

    title = titles(tmp_path, HUNG, answer(law))[0]
    assert title.startswith("centre of mass at the origin")
    assert title.endswith(", in the weight too") == in_weight
