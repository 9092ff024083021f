"""Causes of a part of the rows, of single rows, and of two faults at once of which one has no number."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import RIGID, TENSOR, TIMES, Array, Q, columns, rigid, rows, table, titles
from builders.trajectories import Columns
from builders.turns import by_turns
from scipy.spatial.transform import Rotation

MOMENT = np.array([0.3, 0.45, -0.25])
LOADED = RIGID.format(load=f"moment = {MOMENT.tolist()}")
FREE = RIGID.format(load="")
NAMES = ("w1", "w2", "w3")


def begun_late(at: float, moment: Array = 0 * MOMENT) -> Columns:
    """A motion whose moment begins late, and is another one before."""
    return rigid(moment=lambda t, w, q: MOMENT if t >= at else moment, edges=(at,))


def with_rows(change: Callable[[Array], None]) -> Columns:
    made = table(rigid())
    change(made)
    return columns(TIMES, made, NAMES)


def turned_on(made: Array) -> None:
    turn = Rotation.from_rotvec([0, 0, 0.2])
    later = Rotation.from_quat(np.roll(made[40:, 3:], -1, axis=1)) * turn
    made[40:, 3:] = np.roll(later.as_quat(), 1, axis=1)


def turned_round(made: Array) -> None:
    made[30:, 2] *= -1


@pytest.mark.parametrize(
    ("text", "made", "words"),
    by_turns(
        [
            (LOADED, lambda: begun_late(0.3), ["up to t = 0.3: moment left out"]),
            (LOADED, lambda: begun_late(0.3, np.array([0.1, 0.4, 0.2])), []),
            (
                FREE,
                lambda: with_rows(turned_on),
                [
                    "from t = 4 on: attitude has body axes turned by a fixed rotation of 11.46 degrees"
                ],
            ),
            (
                FREE,
                lambda: with_rows(turned_round),
                ["from t = 3 on: omega has the other sign on axis 3"],
            ),
        ],
        4,
        lambda text, made, words: not words,
    ),
)
def test_a_part_of_the_run_has_its_own_cause(
    text: str, made: Callable[[], Columns], words: list[str], tmp_path: Path
) -> None:
    """A load left out for three rows, or a convention from some row on, is named with its time."""
    assert titles(tmp_path, text, made()) == words


def test_one_wrong_row_stands_out_of_the_simulators_own_errors(tmp_path: Path) -> None:
    """An attitude off by 1e-11 in all rows is no fault beside omega that is wrong in one."""
    made = table(rigid())
    made[:, 3:] *= 1 + 3e-12 * np.random.default_rng(1).standard_normal((len(made), 4))
    made[37, :3] *= 1.06
    (title,) = titles(tmp_path, FREE, columns(TIMES, made, NAMES))
    assert title.startswith("one row is wrong (first at t = 3.7)")


def test_a_wrong_row_behind_slow_rows_is_no_interpolation(tmp_path: Path) -> None:
    """A slow motion is nearly straight from row to row: that does not explain another row that is wrong."""
    times = np.round(np.arange(0, 81) * 0.002, 6)
    made = rows(
        lambda t, w, q: np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w)),
        [0.8, -0.5, 1.1],
        Q,
        times,
        (),
    )
    made[79, :3] *= 1.5
    (title,) = titles(tmp_path, FREE.replace("end = 8", "end = 0.16"), columns(times, made, NAMES))
    assert title.startswith("one row is wrong")


DIAGONAL = np.diag(np.diag(TENSOR))


@pytest.mark.parametrize(
    ("made", "words"),
    by_turns(
        [
            (
                lambda: rigid(gyro=0.0, moment=lambda t, w, q: np.array([0, 0.05, 0])),
                ["no gyroscopic term and moment 2, body axes = 0.05"],
            ),
            (
                lambda: rigid(DIAGONAL, moment=lambda t, w, q: np.array([0, 0, -0.07])),
                ["products of inertia left out and moment 3, body axes = -0.07"],
            ),
            (lambda: rigid(DIAGONAL, moment=lambda t, w, q: -0.05 * w**3), []),
        ],
        3,
        lambda made, words: not words,
    ),
)
def test_a_fault_without_numbers_is_named_beside_one_with_a_number(
    made: Callable[[], Columns], words: list[str], tmp_path: Path
) -> None:
    """A term left out and a load have both names; beside a drag of no family it has none."""
    assert titles(tmp_path, FREE, made()) == words
