"""The motion in float64 from known rows: right at other times, and to the last digit beside a row."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from taylor_verify.exact.rates import float_flow
from taylor_verify.exact.route import solution
from taylor_verify.judge.errors.quick_motion import QuickMotion
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 25
# It starts in a slow moment of its turn, and is eight times as quick three seconds before.
SLOW_START = str(Path(__file__).parent / "cases" / "remus_path.toml")


def quick_from(scene: Scene, rows: list[int]) -> QuickMotion:
    """The motion from some of a scene's rows."""
    elapsed = [scene.clock.elapsed[k] for k in rows]
    known = solution(scene).motion(elapsed, DIGITS).quantities
    return QuickMotion(float_flow(scene), known, float_flow(scene).times(elapsed))


@pytest.mark.parametrize("name", ["euler/backward", "kirchhoff/whole-motion", SLOW_START])
@pytest.mark.parametrize("rows", [[0], [0, 3], [2, 5, 9]])
def test_float64_follows_the_motion_from_few_rows(name: str, rows: list[int]) -> None:
    """Between rows that are many turns apart, and beyond them, it is the exact motion to seven digits."""
    scene = load(name)
    quick, flow = quick_from(scene, rows), float_flow(scene)
    end = scene.clock.elapsed[max(rows) + 1]
    for share in (Fraction(-1, 7), Fraction(3, 10), Fraction(9, 8)):
        times = [end * share, end * share / 3]
        states = quick.at(float_flow(scene).times(times))
        assert states is not None
        near = flow.quantities(states)
        for quantity, exactly in solution(scene).motion(times, DIGITS).quantities.items():
            off = near[quantity] - exactly.astype(float)
            assert np.max(np.abs(off)) < 1e-7 * max(1.0, np.max(np.abs(exactly.astype(float))))


@pytest.mark.parametrize("exponent", [-20, -60, -200])
def test_a_way_beside_a_row_has_all_its_digits(exponent: int) -> None:
    """The change of a state over a time far below its rounding is the rate times this time."""
    scene = load("euler/with-attitude")
    quick, flow = quick_from(scene, [0, 5, 9]), float_flow(scene)
    later = 2.0**exponent
    beyond = quick.beyond(np.array([1, 2]), np.array([later, -later]))
    assert beyond is not None
    first, second = flow.two_rates(quick.rows[1:])
    expected = first * np.array([[1.0], [-1.0]]) + second * later / 2
    assert np.allclose(beyond / later, expected, rtol=0, atol=later**2 + 1e-14)


def test_a_motion_that_explodes_backwards_is_followed_where_it_is_wanted() -> None:
    """A damped body cannot be followed far before its start; rows after it are none the worse."""
    scene = load("euler/damped")
    quick, times = quick_from(scene, [0]), list(scene.clock.elapsed)
    assert quick.at(float_flow(scene).times([Fraction(-(10**4))])) is None
    states = quick.at(float_flow(scene).times([times[3]]))
    assert states is not None
    expected = solution(scene).motion([times[3]], DIGITS)["omega"].astype(float)
    assert np.allclose(float_flow(scene).quantities(states)["omega"], expected, rtol=0, atol=1e-7)
