"""The motion in float64 from known rows: right at other times, and at a price that the motion explains."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from taylor_verify.exact.route import solution
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.quick_motion import QuickMotion
from taylor_verify.scenes.reading.reader import load

DIGITS = 25
# It starts in a slow moment of its turn, and is eight times as quick three seconds before.
SLOW_START = str(Path(__file__).parent / "cases" / "remus_path.toml")


@pytest.mark.parametrize("name", ["euler/backward", "kirchhoff/whole-motion"])
@pytest.mark.parametrize("rows", [[0], [0, 3], [2, 5, 9]])
def test_float64_follows_the_motion_from_few_rows(name: str, rows: list[int]) -> None:
    """Between rows that are many turns apart, and beyond them, it is the exact motion to five digits."""
    scene = load(name)
    exact = solution(scene)
    known = exact.motion(scene.clock.elapsed, DIGITS).at(rows)
    since = np.array([float(scene.clock.elapsed[k]) for k in rows])
    quick = QuickMotion(scene, known.quantities, since)
    end = scene.clock.elapsed[-1]
    for share in (Fraction(-1, 7), Fraction(3, 10), Fraction(9, 8)):
        times = [end * share, end * share / 3]
        truth, near = exact.motion(times, DIGITS), quick.at(np.array([float(t) for t in times]))
        for quantity, exactly in truth.quantities.items():
            off = near[quantity] - exactly.astype(float)
            assert np.max(np.abs(off)) < 1e-5 * max(1.0, np.max(np.abs(exactly.astype(float))))


def test_an_arc_of_more_than_half_a_turn_keeps_the_sign_of_its_quaternion(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """From a slow moment one arc turns far: the sign of its end is that to which the motion leads.

    With the sign that is nearer, the course would jump, and the gap be halved until no double is in it.
    """
    spans, moved = list[float](), QuickMotion._moved

    def counted(quick: QuickMotion, begins: Floats, states: Floats, lengths: Floats) -> Floats:
        spans.append(np.min(np.abs(lengths)))
        return moved(quick, begins, states, lengths)

    monkeypatch.setattr(QuickMotion, "_moved", counted)
    scene = load(SLOW_START)
    exact = solution(scene)
    elapsed = scene.clock.elapsed
    known = exact.motion(elapsed, DIGITS)
    quick = QuickMotion(scene, known.quantities, np.array([float(t) for t in elapsed]))
    times = [Fraction(-4), Fraction(-1), Fraction(-1, 1000)]
    truth, near = exact.motion(times, DIGITS), quick.at(np.array([float(t) for t in times]))
    for quantity, exactly in truth.quantities.items():
        expected = exactly.astype(float)
        assert np.allclose(near[quantity], expected, rtol=0, atol=1e-5 * np.max(np.abs(expected)))
    assert min(spans) > 1e-4


def test_a_motion_that_explodes_backwards_is_followed_where_it_is_wanted() -> None:
    """A damped body cannot be followed far before its start; rows after it are none the worse."""
    scene = load("euler/damped")
    exact, times = solution(scene), scene.clock.elapsed
    first = exact.motion([Fraction(0)], DIGITS)
    quick = QuickMotion(scene, first.quantities, np.zeros(1), 32)
    assert quick.at(np.array([-1e4])) is None
    near = quick.at(np.array([float(times[3])]))
    expected = exact.motion([times[3]], DIGITS)["omega"].astype(float)
    assert np.allclose(near["omega"], expected, rtol=0, atol=1e-5)
