"""The exact attitude in other forms: each gives back the matrix, and its errors are proven."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from taylor_verify.exact.attitude_forms import in_form
from taylor_verify.exact.printed import document
from taylor_verify.exact.route import solution
from taylor_verify.numbers.rotation import rotation_matrix, rotation_rows
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.turns import AXES, Turn, product

TIMES = [(text, Fraction(text)) for text in ("0", "1.5", "-7", "60")]


@cache
def printed(form: str) -> tuple[Any, ...]:
    scene = load("euler/with-attitude")
    scene = replace(scene, track=frozenset({"attitude"}))
    rows = document(scene, solution(scene), TIMES, 30, form)["rows"]
    return tuple(np.array(row["attitude"], dtype=object) for row in rows)


def from_angles(angles: Any) -> Any:
    axes = reversed(AXES)
    turns = [Turn(axis, Fraction(angle)) for axis, angle in zip(axes, angles, strict=True)]
    R = np.array(rotation_matrix(product(turns)), dtype=object)
    return np.vectorize(lambda entry: entry.near(), otypes=[object])(R)


@pytest.mark.parametrize(
    ("form", "back"),
    [
        ("quaternion", lambda q: np.array(rotation_rows([Fraction(part) for part in q]))),
        ("zyx", from_angles),
    ],
)
def test_each_form_gives_the_matrix_back(form: str, back: Any) -> None:
    """R of thirty printed digits is R of the thirty digits of its quaternion, and of its angles."""
    for written, R in zip(printed(form), printed("matrix"), strict=True):
        right = np.array([[Fraction(entry) for entry in row] for row in R])
        assert np.max(np.abs(back(written) - right)) < Fraction(10) ** -28


def test_an_angle_at_its_singularity_has_no_proven_digit() -> None:
    """Yaw and roll at a pitch of a right angle are undetermined, and the pitch is not."""
    error = mpf(2) ** -100
    R = np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]) * mpf(1)
    with mp.workprec(200):
        (yaw, pitch, roll), errors = in_form("zyx", R, np.full((3, 3), error), 40)
        assert errors[0] >= mp.pi / 2 <= errors[2]
        assert abs(pitch - mp.pi / 2) <= errors[1] < 4 * error
        assert abs(yaw) + abs(roll) < 4


@pytest.mark.parametrize("pitch", [1, -1])
def test_straight_up_or_down_the_angles_give_an_exact_matrix_back(pitch: int) -> None:
    """All of the turn about the vertical is yaw where the matrix is exact, and none of it is lost."""
    c, s, none = Fraction(4, 5), Fraction(3, 5), Fraction(0)
    R = np.array([[none, -s, c * pitch], [none, c, s * pitch], [Fraction(-pitch), none, none]])
    with mp.workprec(200):
        (yaw, up, roll), errors = in_form("zyx", R, np.full((3, 3), mpf(0)), 40)
        assert abs(yaw - mp.atan2(3, 4)) < mpf(10) ** -40
        assert abs(up - pitch * mp.pi / 2) < mpf(10) ** -40
        assert roll == 0
        assert max(errors) < mpf(10) ** -40
