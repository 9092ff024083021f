"""Likely causes of motions of one pace, as a decay: a method may do what a number of the equations does."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.caused_rows import Array, titles
from builders.scenes import text_of
from builders.trajectories import QUATERNION, VECTORS, Columns, named
from builders.turns import by_turns
from scipy.spatial.transform import Rotation

from taylor_verify import check, run
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import read

DRAG = ["-0.1*w1", "-0.1*w2", "0.08 - 0.1*w3"]
DECAY = text_of({"inertia": [2, 1.5, 1.2], "moment": DRAG}, {"omega": [0, 0, 1]}, 10, 51)
PRECESSION = text_of({"inertia": [2, 2, 0.7]}, {"omega": [0.6, 0.1, 1.2]}, 10, 51)
START = [0.8, 0.2, -0.4, 0.4]
STEADY = text_of(
    {"inertia": [1, 2, 3]}, {"omega": [0, 0, 1.3], "attitude": START}, 10, 51, "attitude"
)
TIMES, EVERY = np.round(np.arange(51) * 0.2, 6), 0.2
# The factor by which a step multiplies what decays or turns, of z = h lambda.
Factor = Callable[[complex], complex]
EULER: Factor = lambda z: 1 + z  # noqa: E731 (a law in a row of a table)
BACKWARD: Factor = lambda z: 1 / (1 - z)  # noqa: E731
TRAPEZOID: Factor = lambda z: (1 + z / 2) / (1 - z / 2)  # noqa: E731
MIDPOINT: Factor = lambda z: 1 + z + z * z / 2  # noqa: E731
GAUSS: Factor = lambda z: (1 + z / 2 + z * z / 12) / (1 - z / 2 + z * z / 12)  # noqa: E731


def of_omega(rows: Array) -> Columns:
    return named(("t",), TIMES[:, None]) | named(VECTORS["omega"], rows)


def decay(factor: Factor, h: float, inertia: float = 1.2) -> Columns:
    """Omega towards its last value 0.8, a step of h multiplying the rest by a factor."""
    a_row = factor(-0.1 * h / inertia).real ** round(EVERY / h)
    return of_omega(np.outer(0.8 + 0.2 * a_row ** np.arange(51), [0, 0, 1]))


def precession(factor: Factor, h: float) -> Columns:
    """Omega of the body of revolution, whose part across the axis turns by the factors of the steps."""
    turn = factor(1j * h * (0.7 - 2) / 2 * 1.2) ** round(EVERY / h)
    across = (0.6 + 0.1j) * turn ** np.arange(51)
    return of_omega(np.stack([across.real, across.imag, np.full(51, 1.2)], axis=1))


@pytest.mark.parametrize(
    ("made", "words"),
    by_turns(
        [
            (decay(EULER, 0.1), "loads taken every 0.1 and held in between"),
            (decay(BACKWARD, 0.1), "implicit gyroscopic step: backward Euler, h = 0.1"),
            (decay(TRAPEZOID, 0.2), "truncation of order 2: implicit midpoint, h = 0.2"),
            (decay(MIDPOINT, 0.2), "truncation of order 2: midpoint, h = 0.2"),
        ],
        2,
    ),
)
def test_a_method_is_named_for_the_number_that_it_imitates(
    made: Columns, words: str, tmp_path: Path
) -> None:
    """Its error is that of another inertia, or of other loads, but the method needs no number to fit."""
    (title,) = titles(tmp_path, DECAY, made)
    assert title.startswith(words)


def test_a_phase_that_a_method_sets_is_no_other_tensor(tmp_path: Path) -> None:
    """The trapezoid turns a precession by another angle, as another I_33 would."""
    (title,) = titles(tmp_path, PRECESSION, precession(TRAPEZOID, 0.1))
    assert title.startswith("truncation of order 2")


@pytest.mark.parametrize(
    "made",
    [
        precession(GAUSS, 0.2),
        precession(lambda z: 0.99987654321 * np.exp(1.0012345678 * z), 0.2),
    ],
    ids=["Gauss of order 4", "one that damps"],
)
def test_nothing_is_said_of_a_method_that_is_not_known(made: Columns, tmp_path: Path) -> None:
    """A long number that a method of another kind makes as well is no cause."""
    assert titles(tmp_path, PRECESSION, made) == []


def test_a_number_that_somebody_wrote_is_said(tmp_path: Path) -> None:
    """Another inertia of few digits explains what no method does."""
    (title,) = titles(tmp_path, DECAY, decay(np.exp, 0.2, 1.23))
    assert title.startswith("I_33 = 1.23 for 1.2 (+2.5 %)")


def test_what_dies_away_from_the_start_is_no_jump(tmp_path: Path) -> None:
    """A decay behind a filter of first order is soon a decay again, from another start."""
    pace, filtered = 0.1 / 1.2, 1 / 0.05
    lagging = np.exp(-pace * TIMES) * filtered / (filtered - pace)
    lagging += (1 - filtered / (filtered - pace)) * np.exp(-filtered * TIMES)
    made = of_omega(np.outer(0.8 + 0.2 * lagging, [0, 0, 1]))
    assert titles(tmp_path, DECAY, made) == []


SPIN = Rotation.from_rotvec(np.outer(TIMES, [0, 0, 1.3]))
FIRST = Rotation.from_quat(START, scalar_first=True)


def spun(rate: Array) -> Columns:
    """The steady spin, its attitude relative to a frame that turns at a rate, space axes."""
    turns = Rotation.from_rotvec(-np.outer(TIMES, rate)) * FIRST * SPIN
    omega = of_omega(np.outer(np.ones(51), [0, 0, 1.3]))
    return omega | named(QUATERNION, turns.as_quat(scalar_first=True))


def test_the_error_of_a_steady_turn_is_no_frame_that_turns(tmp_path: Path) -> None:
    """A method turns such a body at another rate about the same axis; a frame may turn about any."""
    assert titles(tmp_path, STEADY, spun(1e-4 * FIRST.apply([0, 0, 1]))) == []
    (title,) = titles(tmp_path, STEADY, spun(np.array([0, 1e-4, 0])))
    assert title.startswith("attitude is relative to a frame that turns")


SURGE = text_of(
    {"mass_matrix": np.diag([30, 60, 60, 0.3, 8, 8]).tolist()}
    | {"force": ["12 - 9*u1", "-60*u2", 0], "couple": [0, 0, "-5*w3"]},
    {"linear_velocity": [0.2, 0, 0], "angular_velocity": [0, 0, 0]},
    *(8, 41, "attitude", "centre"),
)


def surge(mass: float, drag: float, every: int) -> dict[str, Any]:
    """The columns of so many steps of explicit Euler from row to row, or of the exact motion, on a line."""
    times = np.linspace(0, 8, 41)
    u, c = np.full(41, 0.2), np.zeros(41)
    rate, end = drag / mass, 12 / drag
    h = 0.2 / (every or 1)
    for k in range(40):
        steps, whole = (1 - rate * h) ** np.arange(every + 1), np.exp([0.0, -0.2 * rate])
        powers = steps if every else whole
        before = u[k] - end
        u[k + 1] = end + before * powers[-1]
        way = h * np.sum(powers[:-1]) if every else (1 - powers[-1]) / rate
        c[k + 1] = c[k] + 0.2 * end + before * way
    zeros = np.zeros(41)
    vectors = {"linear_velocity": u, "omega": zeros, "centre": c}
    rows = {name: np.stack([own, zeros, zeros], axis=1) for name, own in vectors.items()}
    return {"t": times, **rows, "attitude": np.broadcast_to(np.eye(3), (41, 3, 3))}


@pytest.mark.parametrize(
    ("mass", "drag", "every", "words"),
    by_turns(
        [
            (33, 9, 2, None),
            (30, 9, 2, "explicit Euler, h = 0.1"),
            (33, 9, 0, "M_11 = 33 for 30"),
            (30, 10, 2, "`9` in force 1, 12 - 9*u1, = 10 for 9 (+11.1 %), beside steps of"),
        ],
        2,
    ),
)
def test_on_a_line_a_number_is_said_if_it_was_written(
    mass: float, drag: float, every: int, words: str | None
) -> None:
    """Velocities along one direction tell a body beside a coarse step from no number of the equations."""
    causes = check(
        read(SURGE, "surge"), surge(mass, drag, every), tolerance=1e-9, partial=True
    ).causes
    titles = [cause.sentence for cause in causes]
    assert [title[: len(words or "")] for title in titles] == ([words] if words else [])


def test_one_row_that_is_repeated_tells_no_more_numbers_than_it_has() -> None:
    """A body and a load, six numbers, would explain three: nothing is proven by that."""
    judged = run(
        "euler/nesc-brick", solver=lambda problem: {"omega": [[0.3, 1, 0.2]] * len(problem.times)}
    )
    assert judged["omega"].verdict is Status.FAIL
    assert not judged.causes
