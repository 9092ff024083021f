"""Likely causes of rows of the right motion beside other times: by what rule the times are others."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import Array, titles
from builders.scenes import THREE_INSTANTS
from builders.trajectories import QUATERNION, VECTORS, Columns, named

from taylor_verify.exact.route import solution
from taylor_verify.judge.causes.float_answer import steady_signs
from taylor_verify.judge.conventions.axis_orders import quaternion_columns
from taylor_verify.numbers.precision import exact_value
from taylor_verify.scenes.reading.reader import read

FREE = THREE_INSTANTS.replace("end = 2\nsamples = 3", "end = 8\nsamples = 401")
EVEN = np.round(np.arange(401) * 0.02, 6)
FRAMES = np.arange(401) / 55
# The step of a simulator whose rows are not at whole steps.
STEP = 1 / 240


def float32_sums(count: int, step: float) -> Array:
    return np.cumsum(np.full(count, np.float32(step)), dtype=np.float32).astype(float)


SUMS = np.concatenate([[0.0], float32_sums(400, 0.02)])


TRACKED = FREE.replace('"euler"', '"euler"\ntrack = ["omega", "attitude"]')


def with_times(written: Array, exact: Array, scene: str = FREE) -> Columns:
    """Rows that are exact at some times, with others beside them."""
    motion = solution(read(scene, "free")).motion([exact_value(float(t)) for t in exact], 20)
    rows = {name: values.astype(float) for name, values in motion.quantities.items()}
    made = named(("t",), written[:, None]) | named(VECTORS["omega"], rows["omega"])
    if "attitude" in rows:
        made |= named(QUATERNION, steady_signs(quaternion_columns(rows["attitude"])))
    return made


@pytest.mark.parametrize(
    ("written", "exact", "words"),
    [
        (np.floor(FRAMES * 1000) / 1000, FRAMES, "times are cut off after 3 decimals"),
        (np.round(FRAMES, 3), FRAMES, "times are rounded to 3 decimals"),
        (SUMS, EVEN, "times are a running sum in float32"),
        (EVEN, SUMS, "the rows are those at a running sum of the step in float32"),
        (EVEN, np.floor(EVEN / STEP + 1e-9) * STEP, "the last whole step of 0.00416667"),
        (EVEN, np.rint(EVEN / STEP) * STEP, "the nearest whole step of 0.00416667"),
        (EVEN, np.ceil(EVEN / STEP - 1e-9) * STEP, "the next whole step of 0.00416667"),
    ],
    ids=["cut off", "rounded", "float32 stamps", "float32 rows", "last", "nearest", "next"],
)
def test_a_rule_of_the_times_is_named_without_an_attitude(
    written: Array, exact: Array, words: str, tmp_path: Path
) -> None:
    """A rule with one number explains three columns of every row, so it needs no second quantity."""
    (title,) = titles(tmp_path, FREE, with_times(written, exact))
    assert words in title


@pytest.mark.parametrize(
    "off",
    [
        lambda t: 1e-4 * t * t,
        lambda t: 0.004 * np.sin(40 * t),
        lambda t: np.random.default_rng(1).uniform(-0.004, 0, len(t)) * (t > 0),
    ],
    ids=["faster and faster", "to and fro", "drawn"],
)
def test_other_times_without_such_a_rule_have_none(
    off: Callable[[Array], Array], tmp_path: Path
) -> None:
    """Times between whole steps of nothing are no steps, and nothing is rounded or cut off."""
    assert not titles(tmp_path, FREE, with_times(EVEN, EVEN + off(EVEN)))


def test_a_clock_that_drifts_is_named_where_the_attitude_shows_it(tmp_path: Path) -> None:
    """Times of a law of two numbers explain omega and attitude, one for each row."""
    made = with_times(EVEN, EVEN - 1e-3 * EVEN + 1e-4 * EVEN**2, TRACKED)
    (title,) = titles(tmp_path, TRACKED, made)
    assert title.endswith("holds the motion at t -0.001 t +0.0001 t^2")
