"""`taylor-verify exact`: decimal text of the exact motion with its radius, the attitude in any form."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from builders.scenes import scene_text
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.cli import main
from taylor_verify.exact.attitude_forms import in_form
from taylor_verify.exact.printed import decimal_text, document
from taylor_verify.exact.route import solution
from taylor_verify.numbers.rotation import rotation_matrix, rotation_rows
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.turns import AXES, Turn, product


class Asked:
    """The command, asked for JSON; ``status`` and ``error`` are those of the last call."""

    def __init__(self, capsys: pytest.CaptureFixture[str]) -> None:
        self.capsys = capsys
        self.status, self.error = -1, ""

    def __call__(self, *arguments: str) -> Any:
        self.status = main(["exact", *arguments, "--json"])
        out, self.error = self.capsys.readouterr()
        return json.loads(out) if out else None


@pytest.fixture
def exact(capsys: pytest.CaptureFixture[str]) -> Asked:
    return Asked(capsys)


def vectors(row: dict[str, Any]) -> dict[str, list[Fraction]]:
    """Every vector and matrix of a row as one list of exact numbers."""
    return {
        name: [Fraction(text) for entry in value for text in _texts(entry)]
        for name, value in row.items()
        if name not in ("t", "radius")
    }


def _texts(entry: Any) -> list[str]:
    return entry if isinstance(entry, list) else [entry]


def significant(text: str) -> int:
    """How many significant digits a decimal text writes."""
    return len(re.sub(r"e.*|[-.]", "", text).lstrip("0"))


# Numbers as text.


@given(
    st.fractions().filter(bool),
    st.integers(-4000, 4000),
    st.integers(1, 60),
)
def test_a_number_is_printed_to_half_a_unit_in_its_last_digit(
    value: Fraction, power: int, digits: int
) -> None:
    """The text has exactly the digits asked for and is the nearest such number, however large."""
    value *= Fraction(10) ** power
    text = decimal_text(value, digits)
    assert re.fullmatch(r"-?\d+(\.\d+)?(e[+-]\d+)?", text)
    assert significant(text) == digits
    assert abs(Fraction(text) - value) <= abs(value) / (2 * 10 ** (digits - 1))


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (Fraction(0), 9, "0"),
        (Fraction(1, 2), 4, "0.5000"),
        (Fraction(-10), 2, "-10"),
        (Fraction(10), 1, "1e+1"),
        (Fraction(999), 2, "1.0e+3"),
        (Fraction(1, 10**5), 2, "0.000010"),
        (Fraction(1, 10**6), 2, "1.0e-6"),
    ],
)
def test_zeros_are_written_where_they_are_digits_and_nowhere_else(
    value: Fraction, digits: int, text: str
) -> None:
    """Trailing zeros fill up the digits; zeros that are no digits give way to an exponent."""
    assert decimal_text(value, digits) == text


# The document.


def test_the_document_has_the_keys_of_the_contract(exact: Asked) -> None:
    """scene, route, evidence, digits, regime and rows; a row has t, what is tracked, and radius."""
    document = exact("euler/generic", "--at", "10", "--digits", "12")
    assert exact.status == 0
    assert list(document) == ["scene", "route", "evidence", "digits", "regime", "rows"]
    assert (document["scene"], document["route"], document["digits"]) == (
        "euler/generic",
        "arb",
        12,
    )
    (row,) = document["rows"]
    assert list(row) == ["t", "omega", "radius"]
    assert all(isinstance(text, str) and significant(text) == 12 for text in row["omega"])


def test_tracked_quantities_appear_with_the_attitude_row_by_row(exact: Asked) -> None:
    """For kirchhoff both impulses, a proper 3x3 attitude and the centre, and nothing else."""
    arguments = ("--at", "1", "--digits", "15", "--route", "taylor")
    (row,) = exact("kirchhoff/whole-motion", *arguments)["rows"]
    names = ["t", "linear_impulse", "angular_impulse", "attitude", "centre", "radius"]
    assert list(row) == names
    r = [[Fraction(text) for text in line] for line in row["attitude"]]
    assert [len(line) for line in r] == [3, 3, 3]
    radius = Fraction(row["radius"])
    for i in range(3):
        for j in range(3):
            product = sum(r[i][k] * r[j][k] for k in range(3))
            # |R|_F^2 = 3, so a relative radius moves R R^T by at most 2 * 3 * radius, and a bit.
            assert abs(product - (i == j)) <= 7 * radius


def test_the_regime_is_that_of_the_orbit_on_either_route(exact: Asked) -> None:
    """`--route taylor` takes another way to the numbers of the same orbit."""
    names = {
        exact("euler/generic", "--at", "1", *route)["regime"]
        for route in ([], ["--route", "mpmath"], ["--route", "taylor"])
    }
    assert len(names) == 1
    assert names != {"no closed form"}


@pytest.mark.parametrize(
    "scene", ["euler/nesc-brick", "kirchhoff/swimmer-vehicle", "manufactured/kirchhoff-path"]
)
def test_the_start_is_the_initial_state_itself(exact: Asked, scene: str) -> None:
    """Numbers that the scene tells exactly come back exactly: a zero is no noise of forty digits."""
    asked = load(scene)
    at = ("--at", str(asked.clock.start), "--digits", "40", "--route", "taylor")
    (row,) = exact(scene, *at)["rows"]
    values, start = vectors(row), asked.initial
    stated = {"omega": start.omega} if isinstance(start, Spin) else {"linear_impulse": start.linear}
    for name, vector in stated.items():
        assert values[name] == [Fraction(decimal_text(value, 40)) for value in vector]
    assert values["attitude"] == [entry for row in rotation_matrix(start.attitude) for entry in row]


# Times.


@pytest.mark.parametrize("arguments", [["--at=-5,3"], ["--at", "-5,3"]])
def test_times_may_be_negative_with_and_without_an_equals_sign(
    exact: Asked, arguments: list[str]
) -> None:
    """A leading minus is a time, before the scene or after it."""
    after = exact("euler/generic", *arguments)
    before = exact(*arguments, "euler/generic")
    assert [row["t"] for row in after["rows"]] == ["-5", "3"]
    assert after == before


def test_t_repeats_the_text_given_and_times_come_in_any_order(exact: Asked) -> None:
    """Equal times written differently have equal rows, each with its own text."""
    rows = exact("euler/generic", "--at", "10,1e1, 20/2,-.5,1e1")["rows"]
    assert [row.pop("t") for row in rows] == ["10", "1e1", "20/2", "-.5", "1e1"]
    assert rows[0] == rows[1] == rows[2] == rows[4] != rows[3]


@pytest.mark.parametrize("at", ["nan", "inf", "-inf", "1,,2", "", "1/0", "1e99999", "ten", "1;2"])
def test_a_time_that_is_no_number_is_a_wrong_call(exact: Asked, at: str) -> None:
    """One line that names the option, exit 2, and the same line in the document."""
    document = exact("euler/generic", f"--at={at}")
    assert document is not None
    assert document["faults"] == [document["error"]]
    assert document["error"] in exact.error
    assert exact.status == 2
    assert exact.error.count("\n") == 1
    assert "expected" in exact.error
    assert "--at" in exact.error


# What there is not.


@pytest.mark.parametrize("route", ["arb", "mpmath"])
def test_a_closed_form_that_is_missing_is_said_and_the_exit_is_3(exact: Asked, route: str) -> None:
    """`regime` is "no closed form" and there are no rows; the text names the route that has some."""
    document = exact("euler/constant-moment", "--at", "1", "--route", route)
    assert exact.status == 3
    assert document["regime"] == "no closed form"
    assert document["rows"] == []
    assert "--route taylor" in exact.error


def test_without_a_closed_form_the_answer_is_enclosed_by_taylor_series(exact: Asked) -> None:
    """Nobody has to ask for the route: the exit is 0, and the radius is proven."""
    document = exact("euler/constant-moment", "--at", "1")
    assert exact.status == 0
    assert (document["regime"], document["route"]) == ("no closed form", "taylor")
    assert document["evidence"] == "proven"
    assert len(document["rows"]) == 1


@pytest.mark.parametrize("digits", ["0", "10001"])
def test_digits_out_of_range_are_a_wrong_call(exact: Asked, digits: str) -> None:
    """Exit 2 and one line that names the option."""
    assert "--digits" in exact("euler/generic", "--at", "1", "--digits", digits)["error"]
    assert exact.status == 2


def test_a_tensor_of_no_real_solid_is_a_warning(exact: Asked, tmp_path: Any) -> None:
    """The triangle inequality is warned about on stderr, and the motion is computed."""
    file = tmp_path / "unreal.toml"
    file.write_text(scene_text("inertia = [1, 2, 9]"))
    assert exact(str(file), "--at", "1")["rows"]
    assert exact.status == 0
    assert "warning" in exact.error


def test_a_person_sees_the_numbers_that_a_program_reads(
    capsys: pytest.CaptureFixture[str], exact: Asked
) -> None:
    """The text for the terminal holds every decimal string of the document."""
    arguments = ["euler/with-attitude", "--at", "1,2", "--route", "taylor", "--digits", "9"]
    rows = exact(*arguments)["rows"]
    assert main(["exact", *arguments]) == 0
    shown = capsys.readouterr().out
    for row in rows:
        assert f"t = {row['t']}" in shown
        assert row["radius"] in shown
        for line in row["attitude"]:
            assert re.search(r" +".join(re.escape(text) for text in line), shown)


def test_the_separatrix_is_printed_at_any_time(capsys: pytest.CaptureFixture[str]) -> None:
    """Two components that are e^(-3 10^8) at t = 10^9 have digits in mpmath, and a bound in balls."""
    asked = ["exact", "euler/separatrix", "--at", "1e9", "--digits", "20", "--json"]
    assert main([*asked, "--route", "mpmath"]) == 0
    (row,) = json.loads(capsys.readouterr().out)["rows"]
    assert row["omega"][0].endswith("e-132974985")
    assert len(row["omega"][0].split("e")[0].replace(".", "")) == 20
    assert main(asked) == 0
    (row,) = json.loads(capsys.readouterr().out)["rows"]
    assert row["omega"][0] == "0"
    assert float(row["absolute"]["omega"]) < 1e-25


@pytest.mark.parametrize(("digits", "lines"), [(12, 6), (30, 12)])
def test_a_matrix_fits_a_terminal(
    digits: int, lines: int, capsys: pytest.CaptureFixture[str]
) -> None:
    """No line has more than 80 characters; entries that do not fit beside each other have a line each."""
    assert main(["exact", "euler/with-attitude", "--at", "10", "--digits", str(digits)]) == 0
    _, *rows = capsys.readouterr().out.strip().split("\n\n")[-1].splitlines()
    assert max(map(len, rows)) <= 80
    assert len(rows) == lines


# Forms of the attitude

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
