"""Likely causes where the attitude, the path or another quantity tells what omega alone does not."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import RIGID, Array, Law, causes, rigid, titles
from builders.scenes import THREE_INSTANTS, text_of
from builders.trajectories import QUATERNION, VECTORS, Columns, file_judgement, named, write_csv

from taylor_verify.exact.route import solution
from taylor_verify.judge.causes.quaternion_rows import steady_signs
from taylor_verify.judge.conventions.axis_orders import quaternion_columns
from taylor_verify.judge.files.judgement import FileJudgement
from taylor_verify.numbers.precision import exact_value
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import load, read
from taylor_verify.words.causes import steps_in_words

FREE = RIGID.format(load="")
CUBIC: Law = lambda t, w, q: -0.02 * w**3  # noqa: E731 (a law of one line)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (
            rigid(pace=1 / 1.05),
            ["clock = 0.952381: the motion is 1.05 times too slow, or t counts 1/1.05"],
        ),
        (
            rigid(gyro=-1.0, pace=0.97),
            ["clock = 0.97: the motion is", "with that: gyroscopic term with the other sign"],
        ),
        (
            rigid(gyro=0.5, pace=1.001),
            ["clock = 1.001: the motion is", "with that: factor of the gyroscopic term = 0.5"],
        ),
        (rigid(moment=CUBIC, gyro=-1.0, pace=0.97), []),
    ],
    ids=["clock", "other sign", "half", "and a cubic drag"],
)
def test_the_attitude_tells_a_clock_from_a_factor_of_the_equations(
    made: Columns, words: list[str], tmp_path: Path
) -> None:
    """Omega shows a clock times a factor of the gyroscopic term, and the attitude the clock."""
    titled = titles(tmp_path, FREE, made)
    assert [title[: len(start)] for title, start in zip(titled, words, strict=True)] == words


STRAIGHT = text_of(
    {
        **{"mass": 18, "inertia": [0.4, 1.5, 1.6], "added_mass": [1.5, 16, 18, 0.1, 1, 1.1]},
        "force": ["7 - 6*u1", "-30*u2", "-30*u3"],
    },
    {"linear_velocity": [0.2, 0, 0], "angular_velocity": [0, 0, 0]},
    *(5, 51, "attitude", "centre"),
)
RUN = np.round(np.arange(51) * 0.1, 6)


def straight(drag: float = 6.0, noise: float = 0.0, late: float = 0.0) -> Columns:
    """The columns of a straight run with another drag, noise of the velocity, or the velocity late."""
    last, pace = 7 / drag, drag / 19.5
    u = last + (0.2 - last) * np.exp(-pace * np.maximum(RUN - late, 0.0))
    c = last * RUN - (0.2 - last) / pace * np.expm1(-pace * RUN)
    made = np.zeros((51, 13))
    made[:, 0] = u + noise * np.sin(7.3 * np.arange(51) ** 2)
    made[:, 6], made[:, 10] = 1.0, c
    names = ("u1", "u2", "u3", *VECTORS["omega"], *QUATERNION, "c1", "c2", "c3")
    return named(("t", *names), np.c_[RUN, made])


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (straight(drag=6.3), ["`6` in force 1, 7 - 6*u1, = 6.3 for 6 (+5 %)"]),
        (straight(late=0.1), ["the linear velocity is late by 0.1, one row"]),
        (straight(noise=5e-4), []),
    ],
    ids=["drag", "late", "noise"],
)
def test_on_a_line_every_velocity_is_that_of_another_time(
    made: Columns, words: list[str], tmp_path: Path
) -> None:
    """No time of a row is said to be wrong in a straight run, unless the path has it too."""
    assert titles(tmp_path, STRAIGHT, made) == words


SPRING = {"inertia": [1, 1, 1], "moment": ["0", "0", "-0.1*atan2(r21, r11)"]}
HEADING = {"omega": [0, 0, 0], "attitude": [0.4, 0, 0, 0.9]}
SWUNG = text_of(SPRING, HEADING, 1, 11, "omega", "attitude")


def heading(angles: Array) -> Array:
    return np.c_[np.cos(angles / 2), 0 * angles, 0 * angles, np.sin(angles / 2)]


def test_a_balance_across_the_jump_of_an_angle_is_undecided_and_the_state_is_judged(
    tmp_path: Path,
) -> None:
    """Rows that turn over the heading of pi have no balance of work; the attitude fails all the same."""
    t = np.round(np.arange(11) * 0.1, 6)
    start = 2 * np.arctan2(0.9, 0.4)
    made = np.c_[t, 0 * t, 0 * t, np.full(11, 1.5), heading(start + 1.5 * t)]
    path = write_csv(tmp_path / "mine.csv", named(("t", "w1", "w2", "w3", *QUATERNION), made))
    verdicts = file_judgement(path, read(SWUNG, "scene")).verdicts
    by_name = {verdict.quantity: verdict.verdict for verdict in verdicts}
    assert by_name["attitude"] is Status.FAIL
    assert by_name["T"] is Status.UNDECIDED


@pytest.mark.parametrize(
    ("spans", "count", "words"),
    [
        ([0.2, 0.2, 0.2], 4, "h = 0.05"),
        ([0.2, 0.1, 0.3], 4, "4 equal steps from row to row"),
        ([-0.2, -0.1], 1, "one step from row to row"),
    ],
)
def test_steps_between_uneven_rows_have_no_one_length(
    spans: list[float], count: int, words: str
) -> None:
    """The length of a step is said where all are alike, and else their number."""
    assert steps_in_words(spans, count) == words


def counted(scene: str, units: float, file: Path) -> FileJudgement:
    """The judgement of the right omega at other times than it has."""
    times = [Fraction(k, 5) for k in range(61)]
    omega = solution(load(scene)).motion(times, 20)["omega"].astype(float)
    columns = {
        "t": [units * float(t) for t in times],
        **dict(zip(VECTORS["omega"], omega.T.tolist(), strict=True)),
    }
    return file_judgement(write_csv(file, columns), scene)


def test_of_rows_far_beyond_a_scene_the_near_ones_are_judged_first(tmp_path: Path) -> None:
    """A clock in frames goes 25 spans: its first rows show the factor, and a note says which they are."""
    judged = counted("euler/constant-moment", 25, tmp_path / "mine.csv")
    assert [verdict.verdict for verdict in judged.verdicts].count(Status.FAIL) > 1
    assert any("clock = 0.04" in cause.sentence for cause in judged.causes)
    assert any("are far beyond the scene" in note for note in judged.notes)


def test_milliseconds_are_named_where_damping_leaves_no_floor(tmp_path: Path) -> None:
    """So late nothing is known of an error of the damped body, but the unit of its times is."""
    judged = counted("euler/damped", 1000, tmp_path / "mine.csv")
    assert [verdict.verdict for verdict in judged.verdicts] == [Status.FAIL]
    assert "t counts thousandths" in judged.conventions[0].sentence


# Rows of the right motion beside other times: by what rule the times are others.


SPIN = THREE_INSTANTS.replace("end = 2\nsamples = 3", "end = 8\nsamples = 401")
EVEN = np.round(np.arange(401) * 0.02, 6)
FRAMES = np.arange(401) / 55
# The step of a simulator whose rows are not at whole steps.
STEP = 1 / 240


def float32_sums(count: int, step: float) -> Array:
    return np.cumsum(np.full(count, np.float32(step)), dtype=np.float32).astype(float)


SUMS = np.concatenate([[0.0], float32_sums(400, 0.02)])


TRACKED = SPIN.replace('"euler"', '"euler"\ntrack = ["omega", "attitude"]')


def with_times(written: Array, exact: Array, scene: str = SPIN) -> Columns:
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
    (title,) = titles(tmp_path, SPIN, with_times(written, exact))
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
    assert not titles(tmp_path, SPIN, with_times(EVEN, EVEN + off(EVEN)))


def test_a_clock_that_drifts_is_named_where_the_attitude_shows_it(tmp_path: Path) -> None:
    """Times of a law of two numbers explain omega and attitude, one for each row."""
    made = with_times(EVEN, EVEN - 1e-3 * EVEN + 1e-4 * EVEN**2, TRACKED)
    (title,) = titles(tmp_path, TRACKED, made)
    assert title.endswith("holds the motion at t -0.001 t +0.0001 t^2")


@pytest.mark.parametrize(
    ("written", "words"),
    [(SUMS, ["times are a running sum in float32"]), (EVEN + 1e-7 * EVEN**2, [])],
    ids=["sum", "as large"],
)
def test_a_sum_in_float32_is_named_where_the_rows_are_rounded_nearly_as_much(
    written: Array, words: list[str], tmp_path: Path
) -> None:
    """The rounding of the rows hides a hundredth of the offsets, and the stamps are the sum exactly."""
    made = with_times(written, EVEN)
    rounded = {name: [round(x, 8) for x in made[name]] for name in VECTORS["omega"]}
    assert titles(tmp_path, SPIN, made | rounded) == words


HEAVY = np.diag([3.0, 2.0, 2.5, 1.5, 1.2, 0.9]) + 0.2 * np.eye(6)[::-1]
FLUID = text_of(
    {"mass_matrix": HEAVY.tolist()},
    {"linear_impulse": [1, -0.6, 0.8], "angular_impulse": [0.5, 0.9, -0.4]},
    *(8, 81),
)


@pytest.mark.parametrize(("clock", "words"), [(1 / 60, "clock = 0.0166667"), (1 / 7, "factor of")])
def test_times_in_frames_are_nearer_than_a_factor_of_the_mass(
    clock: float, words: str, tmp_path: Path
) -> None:
    """Momenta alone do not tell a heavier body from a slower clock, but for the number of its frames."""
    times = np.arange(81) * 0.1
    motion = solution(read(FLUID, "free")).motion([exact_value(t * clock) for t in times], 20)
    asked = ("linear_impulse", "angular_impulse")
    rows = [motion.quantities[name].astype(float) for name in asked]
    names = [column for name in asked for column in VECTORS[name]]
    made = named(("t", *names), np.c_[times, np.hstack(rows)])
    (cause,) = causes(tmp_path, FLUID, made)
    assert cause.sentence.startswith(words)
    assert "not told apart from" in cause.sentence
