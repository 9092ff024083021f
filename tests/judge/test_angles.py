"""Angles and rates of another meaning are found by the exact attitude, and the floor has their poles."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import cos, pi, radians
from typing import Any

import numpy as np
import pytest
from builders.trajectories import QUATERNION, VECTORS, exact_columns, rows_of
from scipy.spatial.transform import Rotation

from taylor_verify.judge.conventions.angle_meanings import with_angles
from taylor_verify.judge.conventions.convention_search import conventions
from taylor_verify.judge.conventions.meanings import readings, rotations
from taylor_verify.judge.floor.gimbal import with_angles_rounded
from taylor_verify.judge.floor.rounded_input import InputRounding
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.columns.assigned import request
from taylor_verify.solvers.files.file import TrajectoryFile, from_columns
from taylor_verify.solvers.files.formats.column import Column

SCENE = "euler/with-attitude"
SOUND = exact_columns(SCENE)
OMEGA = rows_of(SOUND, VECTORS["omega"])
TURNS = Rotation.from_quat(np.roll(rows_of(SOUND, QUATERNION), -1, axis=1))
ZYX = TURNS.as_euler("ZYX")


def of_columns(names: str, rows: Any, wanted: Sequence[str] = ()) -> TrajectoryFile:
    table = np.column_stack([SOUND["t"], rows])
    columns = [Column(n, list(c)) for n, c in zip(["t", *names.split()], table.T, strict=True)]
    return from_columns(columns, "mine", request(wanted))


@cache
def plain() -> TrajectoryFile:
    return of_columns("yaw pitch roll", ZYX)


VECTOR = TURNS.as_rotvec()
GIBBS = np.tan(np.linalg.norm(VECTOR, axis=1, keepdims=True) / 2) * (
    VECTOR / np.linalg.norm(VECTOR, axis=1, keepdims=True)
)


@pytest.mark.parametrize(
    ("form", "numbers", "words"),
    [
        ("", np.degrees(ZYX), "the angles are in degrees"),
        ("", ZYX * [1, -1, 1], "the angles have the other sign in angle 2 (pitch)"),
        ("", ZYX[:, ::-1], "the angles stand in the order 3 2 1"),
        ("", TURNS.as_euler("zyx"), "the angles are about axes that stay fixed"),
        ("", TURNS.as_euler("ZXZ"), "the angles are of the sequence zxz"),
        ("", TURNS.inv().as_euler("ZYX"), "the angles take space to body axes"),
        ("", np.degrees(ZYX[:, ::-1]), "the angles are in degrees; stand in the order 3 2 1"),
        ("rotvec", VECTOR / 2, "are a rotation vector with half of the angle"),
        ("rotvec", np.degrees(VECTOR), "are a rotation vector in degrees"),
        ("rotvec", GIBBS, "are a Gibbs vector"),
        ("rotvec", -VECTOR, "take space to body axes"),
        ("mrp", VECTOR, "are a rotation vector"),
        ("gibbs", TURNS.as_mrp(), "are modified Rodrigues parameters"),
    ],
)
def test_each_meaning_of_three_numbers_is_found_and_mended(
    form: str, numbers: Any, words: str
) -> None:
    """Units, signs, orders, sequences, other vectors along the axis: named, and read as they are meant."""
    wanted = [f"{form}=2:4"] if form else []
    asked = of_columns("a b c" if form else "yaw pitch roll", numbers, wanted)
    file, finding = with_angles(asked, load(SCENE), rung("f64"))
    assert finding.is_certain
    assert finding.words.endswith(words)
    R, right = (rotations(f.groups["quaternion"].doubles()) for f in (file, plain()))
    assert np.max(np.abs(R - right)) < 1e-13


def test_nothing_is_found_in_sound_angles_and_in_wrong_ones() -> None:
    """Angles that no meaning explains stay as they are."""
    for angles in (ZYX, ZYX * [1, 1, 0.5]):
        file = of_columns("yaw pitch roll", angles)
        assert with_angles(file, load(SCENE), rung("f64")) == (file, None)


def test_numbers_that_are_all_zero_are_no_axis_and_angle() -> None:
    """A quaternion of length zero is no attitude, and no other meaning of it is near to the exact one."""
    file = of_columns("q0 q1 q2 q3", np.zeros((len(ZYX), 4)))
    assert with_angles(file, load(SCENE), rung("f64")) == (file, None)


def euler_rates() -> Any:
    """The rates of roll, pitch and yaw of the motion."""
    _, pitch, roll = ZYX.T
    p, q, r = OMEGA.T
    turn = (q * np.sin(roll) + r * np.cos(roll)) / np.cos(pitch)
    return np.array([p + turn * np.sin(pitch), q * np.cos(roll) - r * np.sin(roll), turn]).T


@pytest.mark.parametrize(
    ("rates", "words", "others"),
    [
        (euler_rates(), "are rates of Euler angles", 0),
        (OMEGA * 2, "are turns between two rows, in radians for each 2", 1),
    ],
)
def test_rates_of_angles_and_turns_between_rows(rates: Any, words: str, others: int) -> None:
    """omega of these columns is that of the motion: the attitude beside it tells."""
    q = np.roll(TURNS.as_quat(), 1, axis=1)
    # Every second second there is a row, but for the last of the scene's own samples.
    file = of_columns("w1 w2 w3 q0 q1 q2 q3", np.column_stack([rates, q]))
    (finding,) = conventions(file, load(SCENE), rung("f64")).findings
    # A factor of two may be a mistake of its own.
    assert len(finding.alternatives) == others
    assert words in finding.words


def test_turns_between_rows_are_asked_of_even_rows_alone() -> None:
    """Rows at odd times have no spacing by which a rate could be counted."""
    assert len(readings("omega")) + 1 == len(readings("omega", spacing=3))  # type: ignore[arg-type]


@pytest.mark.parametrize(("pitch", "sequence"), [(0.0, "zyx"), (89.9, "zyx"), (0.1, "zxz")])
def test_the_floor_grows_towards_the_singularity(pitch: float, sequence: str) -> None:
    """Two angles are rounded by u over the cosine of the second one, or its sine."""
    rows = np.tile([0.1, radians(pitch), 0.2], (len(OMEGA), 1))
    file = of_columns("a b c", rows, [f"{sequence}=2:4"])
    inputs = InputRounding("nothing", {})
    moved = with_angles_rounded(inputs, file, range(2), 2.0**-53).at_samples
    lever = radians(pitch) if sequence == "zxz" else cos(pitch * pi / 180)
    assert moved["attitude"] == pytest.approx([3**0.5 * 2.0**-53 / lever] * 2, rel=1e-4)
    assert set(moved) >= {"attitude", "H_space"}
    assert with_angles_rounded(inputs, of_columns("w1 w2 w3", OMEGA), range(2), 1.0) is inputs
