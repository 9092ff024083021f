"""Forms of the attitude at the start: each is the same turn, exactly where the quaternion is rational."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import radians

import numpy as np
import pytest
from builders.scenes import read_scene
from scipy.spatial.transform import Rotation

from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.records.faults import Refused


def turned(attitude: str) -> Matrix:
    scene = read_scene(initial=f"omega = [1, 2, 3]\n{attitude}", top='track = ["attitude"]')
    return rotation_matrix(scene.initial.attitude)


def rotation(rows: Sequence[Sequence[Fraction]]) -> Rotation:
    return Rotation.from_matrix(np.array(rows, dtype=float))


@pytest.mark.parametrize(
    ("attitude", "expected"),
    [
        ('euler = { sequence = "zyx", degrees = [10, 5, -3] }', ("ZYX", [10, 5, -3])),
        ('euler = { sequence = "zxz", degrees = [200, -50, 3] }', ("ZXZ", [200, -50, 3])),
        ("axis_angle = { axis = [0, 0, 2], degrees = 30 }", ("ZYX", [30, 0, 0])),
    ],
)
def test_angles_are_turns_about_axes_that_move_along(
    attitude: str, expected: tuple[str, list[float]]
) -> None:
    """SciPy's intrinsic sequences are the same rotation."""
    other = Rotation.from_euler(*expected, degrees=True)
    assert (rotation(turned(attitude)).inv() * other).magnitude() < 1e-14


@pytest.mark.parametrize(
    ("attitude", "expected"),
    [
        ('rotation_vector = [0.3, "-1/5", 0.7]', Rotation.from_rotvec([0.3, -0.2, 0.7])),
        ("mrp = [0.1, 0.2, -0.4]", Rotation.from_mrp([0.1, 0.2, -0.4])),
        (
            f"axis_angle = {{ axis = [0, 3, 4], radians = {radians(77)!r} }}",
            Rotation.from_rotvec([0, 77 * 3 / 5, 77 * 4 / 5], degrees=True),
        ),
    ],
)
def test_vectors_are_the_rotations_of_scipy(attitude: str, expected: Rotation) -> None:
    """Two programs, one rotation."""
    assert (rotation(turned(attitude)).inv() * expected).magnitude() < 1e-14


def test_quarter_turns_and_parameters_are_exact() -> None:
    """Their matrices are rational, and so is that of a half turn about a body axis."""
    quarter = ((0, -1, 0), (1, 0, 0), (0, 0, 1))
    assert turned('euler = { sequence = "xyz", degrees = [0, 0, 90] }') == quarter
    assert turned("axis_angle = { axis = [0, 0, 7], degrees = 90 }") == quarter
    assert turned("mrp = [1, 0, 0]") == ((1, 0, 0), (0, -1, 0), (0, 0, -1))
    assert turned("mrp = [0, 0, 0]") == turned("rotation_vector = [0, 0, 0]")


@pytest.mark.parametrize(
    ("attitude", "expected"),
    [
        ("mrp = [0, 0, 0]\nattitude = [1, 0, 0, 0]", "one form of the attitude"),
        ('euler = { sequence = "zzx", degrees = [1, 2, 3] }', "three axes"),
        ('euler = { sequence = "zyx", degrees = [1, 2] }', "3 numbers"),
        ('euler = { sequence = "zyx" }', "either `degrees` or `radians`, got neither"),
        ('euler = { sequence = "zyx", degrees = [1, 2, 3], radians = [1, 2, 3] }', "got both"),
        ("axis_angle = { axis = [0, 0, 0], degrees = 1 }", "an axis that is not zero"),
        ("axis_angle = { axis = [0, 0, 1], degrees = 1e30 }", "angles of at most"),
        ("roll = 3", "turns about axes that move along"),
        ("mrp = [0, 0, 0]\nattitude = [0, 0, 0, 0]", "a quaternion that is not zero"),
        (
            "attitude = { mrp = [0, 0, 1] }",
            "(write `mrp = ..` in [initial], in place of `attitude`)",
        ),
        ("attitude = { yaw = 3 }", "write `euler = ..` or `rotation_vector = ..` or"),
        (
            "euler = [10, 5, 0]",
            'yaw, pitch and roll are `euler = { sequence = "zyx", degrees = [10, 5, 0]',
        ),
    ],
)
def test_a_faulty_form_is_refused(attitude: str, expected: str) -> None:
    """The fault says what the form needs."""
    with pytest.raises(Refused) as refused:
        turned(attitude)
    assert expected in str(refused.value)
