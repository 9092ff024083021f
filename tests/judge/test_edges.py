"""The edges of what the judge measures and says, part by part."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from builders.verdicts import row
from mpmath import mpf

from taylor_verify.judge.conventions.readings import readings, rotations
from taylor_verify.judge.conventions.search import conventions
from taylor_verify.judge.conventions.worlds import worlds
from taylor_verify.judge.errors import courses, state
from taylor_verify.judge.errors.balances import ClockWork
from taylor_verify.judge.errors.compared import Compared, Shifted
from taylor_verify.judge.errors.shift import LEAVES, strays_from
from taylor_verify.judge.files.coverage import Extent, span_notes
from taylor_verify.judge.files.stored import storing
from taylor_verify.judge.floor.carrying import Carrying, carrying
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.velocities import momenta, velocities
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.scenes.reading.reader import load


def test_the_table_of_a_judgement_has_its_text_above() -> None:
    """A notebook shows the text of a judgement without its brackets, whole."""
    judged = Judgement((row(),), None)
    assert f">{repr(judged)[1:-1]}<" in judged._repr_html_()


def test_the_growth_of_an_error_is_known_until_the_end() -> None:
    """The last of the times is that of the scene; a growth in proportion has a pace at any size."""
    scene = load("euler/generic")
    growth = carrying(scene)
    assert growth is not None
    assert growth.times[-1] == float(scene.clock.instants[-1])
    assert Carrying((0.0, 0.25, 0.5, 1.0), (1.0, 10.0, 20.0, 40.0)).pace == 40


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize(("instants", "rows"), [((5, 6, 7), (7, 8, 9)), ((5, 3, 1), (7, 6, 4))])
def test_a_file_is_late_against_the_start_of_its_scene(
    instants: tuple[int, ...], rows: tuple[int, ...], order: int
) -> None:
    """A row at 7 is late by 2 where the scene starts at 5, forwards or back, first or last in the file."""
    plain = load("euler/generic")
    scene = replace(plain, clock=Clock(Fraction(5), tuple(map(Fraction, instants))))
    words = [world.words for world in worlds(scene, tuple(map(Fraction, rows[::order])))]
    assert "t is late by 2" in words


def test_a_file_that_ends_at_its_start_says_so() -> None:
    """The only row is the first one: the rest was not judged."""
    zero, end = Fraction(0), Fraction(10)
    scene = replace(load("euler/generic"), clock=Clock(zero, (zero, end)))
    extent = Extent((zero,), start=zero, sign=1, begin=zero, end=end, slack=zero)
    (note,) = span_notes(scene, (zero,), extent)
    assert note.startswith("the last row is at t = 0, and the scene ends at t = 10")


def test_a_file_without_numbers_has_no_conventions() -> None:
    """Where no row is finite, nothing is searched."""
    file: Any = SimpleNamespace(finite=np.zeros(3, dtype=bool))
    assert conventions(file, load("euler/generic"), rung("f64")).findings == ()


def test_the_reach_of_an_answer_is_a_distance() -> None:
    """An answer that goes as far as (3, 4, 0) from its first row reaches 5, over the scale of 2."""
    rows = np.array([[mpf(x) for x in row] for row in ([1, 1, 1], [4, 5, 1], [0, 1, 1])])
    run: Any = SimpleNamespace(answer={"omega": rows}, elapsed=range(3))
    errors: Any = SimpleNamespace(quantity="omega", parts={"omega": mpf(2)})
    assert Compared(run, errors).reach == 5 / 2


@pytest.mark.parametrize(("rate", "is_finite"), [(1e120, True), (1e160, False)])
def test_a_comparison_is_finite_while_its_squares_are(rate: float, is_finite: bool) -> None:
    """The squares of all rates are summed in float64."""
    one = np.ones((1, 3))
    for moving in ((one, rate * one), (rate * one, one)):
        fit = Shifted((Fraction(0),), one, *moving, 1.0, Fraction(1), np.zeros(1))
        assert fit.is_finite == is_finite


@pytest.mark.parametrize(("off", "strays"), [(5.0, ()), (20.0, (7,))])
def test_a_stray_lies_off_by_a_part_of_the_shift(off: float, strays: tuple[int, ...]) -> None:
    """A shift of 10 at the speed 10 makes 100: a tenth of that is not off, however quiet the others."""
    course, speed = np.full(40, 10.0), np.full(40, 10.0)
    assert 5.0 < LEAVES * 100 < 20.0
    shifts = course + np.where(np.arange(40) == 7, off / 10, 0.0)
    assert strays_from(course, shifts, speed, np.full(40, 1e-9)) == strays


@pytest.mark.parametrize("zero", [0.0, mpf(0)])
def test_a_quaternion_of_no_length_is_no_rotation(zero: Any) -> None:
    """Its matrix is not a number, and nothing is divided by zero."""
    (R,) = rotations(np.array([[zero] * 4]))
    assert all(entry != entry for entry in R.flat)


def test_velocities_stand_for_momenta() -> None:
    """The momenta of the velocities are those that the velocities were made of."""
    body = load("kirchhoff/general-body").body
    own = {
        name: np.array([[mpf(k + i) for i in range(3)] for k in (1, 5)])
        for name in body.STATE.MOVING
    }
    back = momenta(body, velocities(body, own))
    assert all(np.max(abs(back[name] - own[name])) <= 1e-12 for name in own)


def test_the_slack_of_a_clock_grows_with_its_start() -> None:
    """A late clock is rounded as its own size is."""
    slacks = []
    for start in map(Fraction, (0, 990)):
        times = tuple(start + k for k in range(11))
        scene = replace(load("euler/generic"), clock=Clock(start, times))
        slacks.append(Extent.of(scene, times, rung("f64")).slack)
    assert slacks[1] == 100 * slacks[0] > 0


def test_a_printed_number_is_known_to_half_its_last_digit() -> None:
    """Six significant digits of a number between 1 and 10 leave 5e-6."""
    file: Any = SimpleNamespace(is_single_precision=False, digits=6)
    stored = storing(file, rung("f64"))
    assert stored is not None
    assert stored.u == pytest.approx(5e-6, abs=0)


def test_the_width_of_a_truth_is_relative_to_its_vector() -> None:
    """A vector of length 5 that is known to 1e-10 is known to 5e-10."""
    truth = Motion({"omega": np.array([[mpf(3), mpf(4), mpf(0)]])}, np.array([mpf(1e-10)]))
    asked: Any = SimpleNamespace(name="omega", unit="1", groups=("omega",))
    distances = state._vectors(asked, truth, truth, None)
    assert float(distances.widths["omega"][0]) == pytest.approx(5e-10, abs=0)


@pytest.mark.parametrize(("turns", "square"), [(0.0, 1 / 2), (400.0, 2.0)])
def test_a_drift_of_the_clock_is_its_integral(turns: float, square: float) -> None:
    """Where the work is in proportion to time, P = t, N steps leave u r (N/3)^(1/2) by t = 1.

    The square of r is 1/2 for short steps, and 2 for steps of a radian.
    """
    P = np.linspace(0.0, 1.0, 1001)[:, None]
    work = ClockWork(1.0, mpf(1), np.array([turns]), P)
    (drift,) = work.drift(Fraction(1, 2**53), 400, np.ones(1), mpf(1))
    assert drift * 2**53 == pytest.approx((square * 400 / 3) ** 0.5, rel=1e-3)


@pytest.mark.parametrize("number", [float, mpf])
def test_units_of_angular_velocity(number: Any) -> None:
    """A turn is 2 pi, a degree its 360th part; a turn in a minute is a 60th of it in a second."""
    parts = {
        "": 1 / (2 * np.pi),
        "in degrees per unit of time": 1 / 360,
        "in turns per unit of time": 1,
        "in turns per minute, the unit of time being the second": 1 / 60,
    }
    rows, R = np.array([[number(0), number(3), number(0)]]), np.eye(3)[None]
    plain = [reading for reading in readings("omega") if "space" not in "".join(reading.words)]
    assert len(plain) == len(parts)
    for reading, (unit, part) in zip(plain, parts.items(), strict=True):
        assert "".join(reading.words) == f"w1 w2 w3 are {unit}" * bool(unit)
        assert float(reading.read(rows, R)[0, 1]) == pytest.approx(3 * 2 * np.pi * part)


def test_units_of_time_are_as_long_as_their_names() -> None:
    """A file may count time in any of these units, for a scene in seconds."""
    scene = load("euler/generic")
    lengths = {
        world.time_words[0].partition("(")[2].partition(" for")[0]: world.scale
        for world in worlds(scene, scene.clock.instants)
        if world.scale != 1 and not world.shift
    }
    names = ("milli", "micro", "nano")
    parts = {f"{name}seconds": Fraction(1, 1000**k) for k, name in enumerate(names, 1)}
    assert lengths == parts | {"minutes": 60, "hours": 3600, "days": 86400}


def test_a_search_for_a_shift_leaves_no_gap() -> None:
    """Every shift up to eight radians of turn is within a quarter of a radian of one that is tried."""
    tried: list[float] = []
    fit: Any = SimpleNamespace(
        **{"error": np.ones((3, 1)), "size": 1.0, "rate": 2.0, "unit": Fraction(1), "left": 1.0},
        weight=np.ones(3),
    )

    def left_by(shifts: Any) -> list[float]:
        tried.extend(float(shift[-1]) * fit.rate for shift in shifts)
        return [1.0] * len(shifts)

    compared: Any = SimpleNamespace(
        run=SimpleNamespace(times=np.linspace(0, 1, 3)), left_by=left_by, evaluated=lambda _: None
    )
    assert courses.best_start(compared, fit, courses.constant) is fit
    tried.sort()
    assert tried[0] <= -8 < 8 <= tried[-1]
    assert np.max(np.diff(tried)) <= 1 / 2
