"""Likely causes of right motions: frames, paths that do not follow from them, and rows at other times."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import Array, columns, rows, titles
from builders.scenes import text_of
from builders.trajectories import Columns, file_judgement, named, write_csv
from builders.turns import by_turns
from builders.wrong_dynamics import turned
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import read

CURRENT = np.array([0.3, -0.2, 0.1])
NU, Q = [0.9, 0.1, -0.2, 0.3, -0.4, 0.5], np.array([0.8, 0.2, -0.4, 0.4])
MASS = np.array([3.0, 4.0, 5.0, 0.6, 0.9, 1.1])
VEHICLE = text_of(
    {
        **{"mass": 2, "inertia": [0.4, 0.5, 0.6], "added_mass": [1, 2, 3, 0.2, 0.4, 0.5]},
        "current": [0.3, -0.2, 0.1],
        "force": ["1 - 0.5*u1", "-0.6*u2", "-0.7*u3"],
        "couple": ["0.1*sin(t)", "0", "0"],
    },
    {"linear_velocity": [0.9, 0.1, -0.2], "angular_velocity": [0.3, -0.4, 0.5]}
    | {"attitude": [0.8, 0.2, -0.4, 0.4], "centre": [1, 2, 3]},
    *(3, 31, "attitude", "centre"),
)
TIMES = np.round(np.arange(0, 31) * 0.1, 6)
NAMES = ("u1", "u2", "u3", "w1", "w2", "w3")
# The rate of the centre by R and the linear velocity.
Path_ = Callable[[Array, Array], Array]


def over_ground(R: Array, U: Array) -> Array:
    return R @ U + CURRENT


def matrix(q: Array) -> Array:
    return Rotation.from_quat(np.roll(q, -1, axis=-1)).as_matrix()


def law(t: float, nu: Array) -> Array:
    P, U, W = MASS * nu, nu[:3], nu[3:]
    push = np.array([1, 0, 0]) - np.array([0.5, 0.6, 0.7]) * U
    force = np.cross(P[:3], W) + push
    couple = np.cross(P[3:], W) + np.cross(P[:3], U) + np.array([0.1 * np.sin(t), 0, 0])
    return np.concatenate([force, couple]) / MASS


@cache
def vehicle(path: Path_ = over_ground) -> Array:
    """The rows (nu, q, c) of the vehicle by a rate of its path."""
    solved = solve_ivp(
        lambda t, z: np.concatenate(
            [law(t, z[:6]), turned(z[6:10], z[3:6]), path(matrix(z[6:10]), z[:3])]
        ),
        (0, 3),
        [*NU, *Q / np.linalg.norm(Q), 1, 2, 3],
        "DOP853",
        t_eval=TIMES,
        rtol=3e-14,
        atol=1e-16,
    )
    return solved.y.T


def table(made: Array) -> Columns:
    return columns(TIMES, made[:, :10], NAMES) | named(("c1", "c2", "c3"), made[:, 10:])


def along(first: int, count: int) -> Path_:
    """The path of a vehicle that turns by ``count`` of yaw, pitch and roll from the ``first`` on."""

    def path(R: Array, U: Array) -> Array:
        angles = Rotation.from_matrix(R).as_euler("ZYX")
        some = [a * (first <= k < first + count) for k, a in enumerate(angles)]
        return Rotation.from_euler("ZYX", some).apply(U) + CURRENT

    return path


def in_steps(count: int, weight: float = 0.0) -> Array:
    """The path in so many Euler steps a row, by the rates at the begin of each step, or between."""
    made = vehicle().copy()
    solved = solve_ivp(
        lambda t, z: np.concatenate([law(t, z[:6]), turned(z[6:10], z[3:6])]),
        (0, 3),
        [*NU, *Q / np.linalg.norm(Q)],
        "DOP853",
        dense_output=True,
        rtol=3e-14,
        atol=1e-16,
    )
    h = 0.1 / count
    steps = []
    for k in range(30 * count):
        z = solved.sol((k + weight) * h)
        steps.append(h * over_ground(matrix(z[6:]), z[:3]))
    places = np.cumsum(np.vstack([[1, 2, 3], *steps]), axis=0)
    made[:, 10:] = places[::count]
    return made


@pytest.mark.parametrize(
    ("path", "words"),
    by_turns(
        [
            (lambda R, U: R.T @ U + CURRENT, "is the path by R^T"),
            (along(0, 1), "is the path by the heading alone"),
            (lambda R, U: U + CURRENT, "is the path without the attitude"),
            (lambda R, U: R @ U, "is the path without the current"),
            (lambda R, U: R @ (U + CURRENT), "is the path with the current in body axes"),
            (lambda R, U: R @ U - CURRENT, "is the path with the current of the other sign"),
            (lambda R, U: R @ U + 2 * CURRENT, "is the path with the current twice"),
            (lambda R, U: R @ U + 0.9 * CURRENT, "drifts with the constant velocity"),
            (along(0, 2), "contradicts the file's own velocities and attitude"),
            (along(1, 1), "contradicts the file's own velocities and attitude"),
            (lambda R, U: R.T @ U + 0.9 * CURRENT, "contradicts the file's own velocities"),
        ],
        4,
    ),
)
def test_a_path_that_does_not_follow_has_its_cause(path: Path_, words: str, tmp_path: Path) -> None:
    """A path by another rate is named; beside right velocities one by no known rate is said to be wrong."""
    (title,) = titles(tmp_path, VEHICLE, table(vehicle(path)))
    assert title.startswith(f"the centre {words}")


@pytest.mark.parametrize(
    ("count", "weight", "words"),
    by_turns(
        [
            (
                5,
                0.0,
                "is the path of steps of first order, c += h c' at the begin of each step, h = 0.02",
            ),
            (
                2,
                1.0,
                "is the path of steps of first order, c += h c' at the end of each step, h = 0.05",
            ),
            (5, 0.1, "contradicts"),
            (1, 0.5, "contradicts"),
        ],
        2,
    ),
)
def test_a_path_in_steps_of_first_order_is_named(
    count: int, weight: float, words: str, tmp_path: Path
) -> None:
    """Euler steps of the path have their size; other quadratures beside a right motion do not."""
    (title,) = titles(tmp_path, VEHICLE, table(in_steps(count, weight)))
    assert title.startswith(f"the centre {words}")


def with_velocity(change: Callable[[Array, Array], Array]) -> Columns:
    """The vehicle with another linear velocity of R and U."""
    made = vehicle().copy()
    made[:, :3] = [change(matrix(z[6:10]), z[:3]) for z in made]
    return table(made)


@pytest.mark.parametrize(
    ("change", "words"),
    by_turns(
        [
            (
                lambda R, U: U + R.T @ CURRENT,
                "is over ground, not relative to the fluid: the current",
            ),
            (over_ground, "is over ground, not relative to the fluid, and in space axes"),
            (
                lambda R, U: U + CURRENT,
                "is over ground, not relative to the fluid, and the current is not",
            ),
            (lambda R, U: U - R.T @ CURRENT, "has the current taken off"),
            (
                lambda R, U: U + 0.9 * R.T @ CURRENT,
                "is relative to a moving frame, with the velocity",
            ),
            (lambda R, U: R @ U, "is in space axes"),
        ],
        3,
    ),
)
def test_a_velocity_over_ground_is_told_from_other_frames(
    change: Callable[[Array, Array], Array], words: str, tmp_path: Path
) -> None:
    """Velocities over ground are named by the scene's current; those of another frame have its velocity."""
    (title,) = titles(tmp_path, VEHICLE, with_velocity(change))
    assert title.startswith(f"the linear velocity {words}")


@pytest.mark.parametrize(
    ("part", "words"),
    [
        (
            np.array([2, 2, 2, 0.4, 0.5, 0.6]),
            ["the impulses x and y are those of the rigid body alone"],
        ),
        (np.array([2, 2, 2, 0.6, 0.9, 1.1]), ["the impulse x is that of the rigid body alone"]),
        (
            np.array([2, 2, 2.5, 0.4, 0.5, 0.6]),
            ["the impulse x has factors", "the impulse y is that"],
        ),
    ],
)
def test_impulses_of_the_rigid_body_alone_are_named(
    part: Array, words: list[str], tmp_path: Path
) -> None:
    """Impulses without the added mass are named for both, or for that of the two that lacks it."""
    made = vehicle().copy()
    made[:, :6] *= part
    own = columns(TIMES, made[:, :10], ("x1", "x2", "x3", "y1", "y2", "y3"))
    named_ones = titles(tmp_path, VEHICLE, own)
    assert len(named_ones) == len(words)
    assert all(title.startswith(own) for title, own in zip(named_ones, words, strict=True))


TENSOR = np.array([2.3, 1.7, 3.1])
LOADS = ["0.3*sin(2*t) - 0.2*q1", "-0.1*w2", "0.2*step(t - 2)"]
SPIN = {"omega": [0.8, -0.5, 1.1], "attitude": [0.8, 0.2, -0.4, 0.4]}
RIGID = text_of({"inertia": TENSOR.tolist(), "moment": LOADS}, SPIN, 4, 41, "omega", "attitude")
RATES = ("w1", "w2", "w3")
SPAN = np.round(np.arange(0, 41) * 0.1, 6)


@cache
def rigid(shift: float = 0.0) -> Array:
    """The rows of omega and attitude at times so much later; loads are read later by as much as well."""
    return at(tuple((SPAN[1:] + shift).tolist()))


@cache
def at(times: tuple[float, ...], late: float = 0.0) -> Array:
    """The rows at the start and at times; the loads are those of a time ``late`` before."""

    def law(t: float, w: Array, q: Array) -> Array:
        t -= late
        load = np.array([0.3 * np.sin(2 * t) - 0.2 * q[1], -0.1 * w[1], 0.2 * (t > 2)])
        return (np.cross(TENSOR * w, w) + load) / TENSOR

    # The switch is a row of its own.
    every, edge = np.array([0.0, *times]), 2.0 + late
    instants = np.unique([*every, edge])
    made = rows(law, [0.8, -0.5, 1.1], Q / np.linalg.norm(Q), instants, [edge])
    return made[np.searchsorted(instants, every)]


def of_rates(omega: Array, q: Array) -> Columns:
    return columns(SPAN, np.hstack([omega, q]), RATES)


def seen_from(of_omega: Array, of_attitude: Array) -> Columns:
    """The body as it is seen from frames that turn at these rates, in space axes."""
    made = rigid()
    q = made[:, 3:] / np.linalg.norm(made[:, 3:], axis=1, keepdims=True)
    R = matrix(q)
    turns = Rotation.from_rotvec(-np.outer(SPAN, of_attitude)) * Rotation.from_matrix(R)
    return of_rates(
        made[:, :3] - np.einsum("nji,j->ni", R, of_omega), np.roll(turns.as_quat(), 1, 1)
    )


ORBIT, OTHER, NONE = np.array([0, 0, 0.1]), np.array([0, 0.2, 0]), np.zeros(3)


@pytest.mark.parametrize(
    ("of_omega", "of_attitude", "words"),
    [
        (
            ORBIT,
            ORBIT,
            [
                "omega and attitude are relative to a frame that turns, in space axes, at (0, 0, 0.1)"
            ],
        ),
        (ORBIT, NONE, ["omega is relative to a frame that turns, in space axes, at (0, 0, 0.1)"]),
        (
            NONE,
            OTHER,
            ["attitude is relative to a frame that turns, in space axes, at (0, 0.2, 0)"],
        ),
        (
            ORBIT,
            -ORBIT,
            [
                "omega is relative to a frame that turns, in space axes, at (0, 0, 0.1)",
                "attitude is relative to a frame that turns, in space axes, at (0, 0, -0.1)",
            ],
        ),
    ],
)
def test_a_frame_that_turns_is_one_for_omega_and_attitude(
    of_omega: Array, of_attitude: Array, words: list[str], tmp_path: Path
) -> None:
    """A frame that turns is said once, with its rate; omega and attitude of different ones have theirs."""
    assert titles(tmp_path, RIGID, seen_from(of_omega, of_attitude)) == words


def with_late(omega: float, attitude: float) -> Columns:
    """Omega and attitude that are late; before the start there is only the start."""
    w, q = (at(tuple(np.maximum(SPAN[1:] - each, 1e-9))) for each in (omega, attitude))
    return of_rates(w[:, :3], q[:, 3:])


ROUNDED = tuple((SPAN[1:] + 0.004 * np.sin(37 * SPAN[1:])).tolist())


@pytest.mark.parametrize(
    ("made", "words"),
    by_turns(
        [
            (
                lambda: of_rates(rigid(-0.04)[:, :3], rigid(-0.04)[:, 3:]),
                ["the clock is late by 0.04"],
            ),
            (lambda: with_late(0.0, 0.1), ["attitude is late by 0.1, one row"]),
            (lambda: with_late(0.03, 0.0), ["omega is late by 0.03"]),
            (lambda: of_rates(at(ROUNDED)[:, :3], at(ROUNDED)[:, 3:]), ["times scatter"]),
            (lambda: of_rates(at(ROUNDED)[:, :3], rigid()[:, 3:]), []),
            (
                lambda: columns(SPAN, at(tuple(SPAN[1:].tolist()), 0.04), RATES),
                ["loads late = 0.04"],
            ),
        ],
        3,
    ),
)
def test_rows_at_other_times_under_loads_are_named(
    made: Callable[[], Columns], words: list[str], tmp_path: Path
) -> None:
    """All rows late, or one quantity, under loads by time and attitude; late loads are another cause."""
    named_ones = titles(tmp_path, RIGID, made())
    assert len(named_ones) == len(words)
    assert all(title.startswith(own) for title, own in zip(named_ones, words, strict=True))


@pytest.mark.parametrize(("unit", "is_named"), [(1000.0, True), (1200.0, False), (500.0, False)])
def test_a_unit_of_time_under_loads_is_found_where_times_are_too_far(
    unit: float, is_named: bool, tmp_path: Path
) -> None:
    """Milliseconds under loads fail with their name; other factors leave the far times undecided."""
    made = rigid()
    file = columns(SPAN * unit, made, RATES)
    path = write_csv(tmp_path / "mine.csv", file)
    judged = file_judgement(path, read(RIGID, "scene"))
    statuses = {verdict.verdict for verdict in judged.verdicts}
    assert any("milliseconds" in finding.words for finding in judged.conventions) == is_named
    assert statuses == {Status.FAIL if is_named else Status.UNDECIDED}


@pytest.mark.parametrize(
    ("column", "limit", "words"),
    [
        (0, 0.8, "the linear velocity is cut off on axis 1 above 0.8"),
        (5, 0.8, "omega is cut off on axis 3 above 0.8"),
    ],
)
def test_a_column_that_is_cut_off_is_named(
    column: int, limit: float, words: str, tmp_path: Path
) -> None:
    """A sensor shows no more than its range: the motion is right where it is within."""
    made = vehicle().copy()
    assert np.count_nonzero(made[:, column] > limit) > 3
    made[:, column] = np.minimum(made[:, column], limit)
    (title,) = titles(tmp_path, VEHICLE, table(made))
    assert title.startswith(words)
