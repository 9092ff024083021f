"""Attitudes in every form: angles, vectors, an axis with an angle, rotations; each is the same rotation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.answered import MisshapenAnswer, answer_of
from taylor_verify.solvers.files.columns.assigned import request
from taylor_verify.solvers.files.columns.forms import FORMS, SEQUENCES
from taylor_verify.solvers.files.file import TrajectoryFile, from_columns
from taylor_verify.solvers.files.formats.column import Column
from taylor_verify.solvers.files.objects import trajectory

TURNS = Rotation.from_rotvec([[0.1, -0.2, 0.3], [1.5, 0.2, -2.0], [-0.4, 2.2, 0.9]])
MRP = np.tan(TURNS.magnitude() / 4)[:, None] * TURNS.as_rotvec() / TURNS.magnitude()[:, None]
TIMES = [0.0, 1.0, 2.0]
# The angles of SciPy are doubles, and its matrices are made of doubles.
ROUNDED = 4e-15


def of_rows(rows: Any, names: str, wanted: str = "") -> TrajectoryFile:
    table = np.column_stack([TIMES, rows])
    columns = [Column(n, list(c)) for n, c in zip(["t", *names.split()], table.T, strict=True)]
    return from_columns(columns, "mine", request([wanted] if wanted else []))


def is_the_turn(file: TrajectoryFile, turns: Rotation = TURNS) -> bool:
    read = rotations(file.groups["quaternion"].doubles())
    return bool(np.max(np.abs(read - turns.as_matrix())) < ROUNDED)


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_every_sequence_of_euler_angles(sequence: str) -> None:
    """Three turns about axes that move along, by number, by name or in degrees, as SciPy has them."""
    angles = TURNS.as_euler(sequence.upper())
    assert is_the_turn(of_rows(angles, "a b c", f"{sequence}=2:4"))
    assert is_the_turn(of_rows(np.degrees(angles), "a b c", f"{sequence}_deg=a:c"))
    assert is_the_turn(
        of_rows(angles, f"euler_{sequence}[0] euler_{sequence}[1] euler_{sequence}[2]")
    )
    assert not is_the_turn(of_rows(angles[:, ::-1], "a b c", f"{sequence}=2:4"))
    assert is_the_turn(of_rows(angles[:, ::-1], "a b c", f"{sequence}=4:2"))


FORMS_OF = {
    "rotvec=2:4": TURNS.as_rotvec(),
    "rotvec_deg=2:4": np.degrees(TURNS.as_rotvec()),
    "mrp=2:4": MRP,
    "mrp=a:c": -MRP / np.sum(MRP**2, axis=1)[:, None],
    "321_deg=2:4": TURNS.as_euler("ZYX", degrees=True),
}


def test_a_quaternion_by_its_first_word_is_no_habit_of_a_program() -> None:
    """quaternion=att takes att[0] ... att[3], scalar first."""
    names = " ".join(f"att[{k}]" for k in range(4))
    file = of_rows(np.roll(TURNS.as_quat(), 1, axis=1), names, "quaternion=att")
    assert is_the_turn(file)
    assert not any("habit" in note for note in file.notes)


@pytest.mark.parametrize("wanted", FORMS_OF)
def test_vectors_by_request(wanted: str) -> None:
    """Rotation vectors, and Rodrigues parameters of either branch, are the turn."""
    assert is_the_turn(of_rows(FORMS_OF[wanted], "a b c", wanted))


def test_an_axis_of_any_length_and_its_angle() -> None:
    """The axis is normalised, and the angle is in the unit that is said."""
    rows = np.column_stack([3 * TURNS.as_rotvec(), np.degrees(TURNS.magnitude())])
    assert is_the_turn(of_rows(rows, "a b c d", "axis_angle_deg=2:5"))
    assert is_the_turn(of_rows(rows, "axis_x axis_y axis_z angle_deg"))


def test_rodrigues_parameters_are_exact() -> None:
    """The quaternion of rational parameters is rational, and of unit length."""
    q = FORMS["mrp"].quaternion([Fraction(1, 2), Fraction(1, 3), Fraction(0)])
    assert sum(Fraction(part) ** 2 for part in q) == 1


@pytest.mark.parametrize(
    ("wanted", "fault"),
    [
        ("zyx=2:3", "expected 3 columns, got 2 from 2 to 3"),
        ("mrp_deg=2:4", "expected the name of one of our columns or groups, got `mrp_deg`"),
        ("foo=2", r"got `foo` @ columns foo=2 "),
        ("zyx=2:9", "expected a column of the file, by its name or by a number up to 4, got `9`"),
    ],
)
def test_a_request_that_cannot_be_met_says_so(wanted: str, fault: str) -> None:
    """Another number of columns, a unit of a form that has none, and an end that is no column."""
    with pytest.raises(Refused, match=fault):
        of_rows(MRP, "a b c", wanted)


# Several descriptions of one attitude.


def described(order: int, change: float = 0.0) -> TrajectoryFile:
    q = np.roll(TURNS.as_quat(), order, axis=1)
    angles = TURNS.as_euler("ZYX") + np.array([0, change, 0])
    return of_rows(np.column_stack([q, angles]), "Q1 Q2 Q3 Q4 yaw pitch roll")


@pytest.mark.parametrize(("order", "word"), [(0, "last"), (1, "first")])
def test_angles_settle_the_order_of_a_quaternion(order: int, word: str) -> None:
    """Q1 ... Q4 beside angles are read, by the order in which both agree."""
    file = described(order)
    assert is_the_turn(file)
    assert any(f"agree: the scalar is {word}" in note for note in file.notes)


def test_descriptions_that_differ_are_refused() -> None:
    """Angles and a quaternion that are half a degree apart are not one attitude."""
    with pytest.raises(Refused, match=r"expected the attitude once, got .* which differ"):
        described(0, change=0.02)


# Several frames of one quantity.


@pytest.mark.parametrize(
    ("names", "taken", "left"),
    [
        ("omega_BN_N* omega_BN_B*", "omega_BN_B", "in space axes"),
        ("omega_world_* omega_*", "omega_", "in space axes"),
        ("omega_eci_* omega_bl_* omega_bi_b_*", "omega_bi_b", "the local horizon"),
        ("roll_rate pitch_rate yaw_rate w*", "w", "perhaps rates of Euler angles"),
        ("P Q R P_{inertial} Q_{inertial} R_{inertial}", "P_{inertial}", "the turning earth"),
    ],
)
def test_body_axes_and_space_as_the_frame_come_first(names: str, taken: str, left: str) -> None:
    """The rate of the equations of motion is taken among those of several frames; the others are named."""
    every = " ".join(
        " ".join(name.replace("*", c) for c in "xyz") if "*" in name else name
        for name in names.split()
    )
    file = of_rows(np.tile(np.arange(float(len(every.split()))), (3, 1)), every)
    assert any(
        f"`{taken}" in note and "taken as w1 w2 w3, body axes" in note for note in file.notes
    )
    assert any(f"not taken: {left}" in note or left in note for note in file.notes)


def test_a_rate_in_space_axes_is_turned_by_the_attitude_of_its_file() -> None:
    """It is R^T omega, and without an attitude it stays as it is, and a note says so."""
    rates = np.array([[1.0, 2, 3], [4, 5, 6], [7, 8, 9]])
    names = "omega_world_x omega_world_y omega_world_z"
    file = of_rows(np.column_stack([rates, TURNS.as_euler("ZYX")]), f"{names} yaw pitch roll")
    assert np.max(np.abs(file.groups["omega"].doubles() - TURNS.inv().apply(rates))) < 10 * ROUNDED
    alone = of_rows(rates, names)
    assert np.array_equal(alone.groups["omega"].doubles(), rates)
    assert any("compared along space axes" in note for note in alone.notes)


# Objects.


class Quantity:
    """A quantity as astropy has it."""

    def __init__(self, value: Any, unit: str) -> None:
        self.value, self.unit = value, unit


class Measured:
    """A quantity as pint has it."""

    def __init__(self, magnitude: Any, units: str) -> None:
        self.magnitude, self.units = magnitude, units


class Quaternion:
    """A quaternion as numpy-quaternion has it."""

    def __init__(self, row: Any) -> None:
        self.x, self.y, self.z, self.w = row


OBJECTS: Mapping[str, Callable[[], Any]] = {
    "attitude": lambda: list(TURNS),
    "pose": lambda: RigidTransform.from_components(np.ones((3, 3)), TURNS),
    "q": lambda: [Quaternion(row) for row in TURNS.as_quat()],
    "quat": lambda: np.array([Quaternion(row) for row in TURNS.as_quat()], dtype=object),
    "zyx_deg": lambda: TURNS.as_euler("ZYX", degrees=True),
    "rotvec": TURNS.as_rotvec,
    "mrp": lambda: MRP,
}


def of_object(**values: Any) -> TrajectoryFile:
    return trajectory({"t": TIMES, **values}, load("euler/with-attitude"))


@pytest.mark.parametrize("name", OBJECTS)
def test_objects_of_libraries_are_attitudes(name: str) -> None:
    """Lists of rotations and quaternions, rigid transforms, and arrays named by their form."""
    assert is_the_turn(of_object(**{name: OBJECTS[name]()}))


def test_stacks_of_matrices_are_turned_by_the_times() -> None:
    """Simulink stacks 3 x 3 x n: the axis as long as the times is that of the rows."""
    times, turns = [0.0, 1.0, 2.0, 3.0], Rotation.concatenate([TURNS, TURNS[:1]])
    answer = {
        "tout": times,
        "DCM_be": np.moveaxis(turns.inv().as_matrix(), 0, -1),
        "omega_b": np.arange(12.0).reshape(3, 1, 4),
    }
    file = trajectory(answer, load("euler/with-attitude"))
    matrices = file.groups["attitude"].doubles().reshape(-1, 3, 3)
    assert np.array_equal(matrices, turns.inv().as_matrix().transpose(0, 2, 1))
    assert file.groups["omega"][1] == (1, 5, 9)


@pytest.mark.parametrize("kind", [Quantity, Measured])
def test_units_that_an_object_states_are_read_or_refused(kind: Any) -> None:
    """Degrees of astropy and of pint are converted, and an unknown unit is never dropped."""
    rates = np.ones((3, 3))
    unit = "deg / s" if kind is Quantity else "degree / second"
    file = of_object(omega=kind(rates, unit))
    assert float(file.groups["omega"][0][0]) == pytest.approx(np.pi / 180)
    with pytest.raises(Refused, match="furlong"):
        of_object(omega=kind(rates, "furlong"))


def test_a_unit_of_a_callables_states_is_refused() -> None:
    """A state has quantities of several units, so that one unit of all is never dropped."""
    problem = pose(load("euler/with-attitude"), rung("f64"))
    with pytest.raises(MisshapenAnswer, match="expected states without a unit, got deg / s"):
        answer_of(Quantity(np.ones((3, 7)), "deg / s"), problem)
