"""All events of a motion are enclosed, and none is missed."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np
import pytest
from builders.written_loads import ABOUT_AXES, about_axes
from mpmath import mp

from taylor_verify.cli import main
from taylor_verify.exact import events, exact
from taylor_verify.exact.event_times import Events, EventTime, Incomplete
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.reading.reader import load

DIGITS: Final = 20
GENERIC: Final = load("euler/generic")


def touch(first: EventTime, second: EventTime) -> bool:
    with mp.workdps(2 * DIGITS):
        return bool(abs(first.t - second.t) <= first.radius + second.radius)


@cache
def of_generic(text: str, until: int = 12) -> Events:
    return events(GENERIC, text, until, DIGITS)


def same(first: Events, second: Events) -> bool:
    return len(first) == len(second) and all(map(touch, first, second))


@pytest.mark.parametrize(
    ("scene", "column", "place", "until"),
    [
        ("euler/generic", "w2", ("omega", 1), 20),
        ("euler/generic", "w3", ("omega", 2), -12),
        ("euler/with-attitude", "r11", ("attitude", (0, 0)), 8),
        ("kirchhoff/screw", "y1", ("angular_impulse", 0), 8),
    ],
)
def test_every_change_of_sign_is_an_event(
    scene: str, column: str, place: tuple[str, int | tuple[int, int]], until: int
) -> None:
    """The closed form changes its sign within the radius of every event, and nowhere else."""
    crossed = events(scene, f"{column} = 0", until, DIGITS)
    quantity, entry = place
    with mp.workdps(3 * DIGITS):
        ends = [event.t + side * event.radius for event in crossed for side in (-1, 1)]
        at_ends = exact(scene, ends, 2 * DIGITS)[quantity]
    signs = [int(mp.sign(row[entry])) for row in at_ends]
    assert all(before == -after != 0 for before, after in zip(signs[::2], signs[1::2], strict=True))
    grid = [Fraction(until * k, 200) for k in range(1, 201)]
    sampled = np.array([float(row[entry]) for row in exact(scene, grid, 10)[quantity]])
    assert len(crossed) == np.count_nonzero(np.diff(np.sign(sampled)))
    assert crossed.passed


@pytest.mark.parametrize(
    ("first", "second"),
    [
        # I2 w2' = (I3 - I1) w3 w1, and w1 has no zero.
        ("extremum w2", "w1*w3 = 0"),
        ("w2 = 0", "2*w2 + w3 = w3 - w2"),
        ("w2 = 0", "exp(w2) = 1"),
        ("w2 = 0", "atan(w2)/(1 + w1^2) = 0"),
        ("w2 = 1/3", "asin(w2/2) = asin(1/6)"),
        ("extremum w2", "extremum sin(w2/2)"),
        ("extremum w2", "extremum tanh(w2)"),
    ],
)
def test_equal_events_have_equal_times(first: str, second: str) -> None:
    """An identity of the equations, or a monotone function, changes no time of an event."""
    assert same(*map(of_generic, (first, second)))


def test_flips_come_at_equal_intervals() -> None:
    """The middle component of a free body crosses zero at every half period."""
    flips = events(GENERIC, "w2 = 0", 20, DIGITS)
    with mp.workdps(2 * DIGITS):
        gaps = [b.t - a.t for a, b in pairwise(flips)]
        assert abs(gaps[0] - gaps[1]) <= 4 * max(event.radius for event in flips)


def test_a_zero_that_is_touched_is_undecided() -> None:
    """The square of a component touches zero where that crosses it; near zeros are two."""
    crossed, touched = (of_generic(text, 8) for text in ("w2 = 0", "w2^2 = 0"))
    assert same(crossed, Events("", Fraction(8), DIGITS, touched.undecided))
    assert not touched.times
    assert not touched.passed
    first, second = str(touched).splitlines()
    assert first == "0 times of w2^2 = 0, proven, and others that are undecided"
    assert second.startswith("undecided: touched or crossed at t = ")
    assert str(crossed).splitlines()[0] == "1 time of w2 = 0, none missed"
    assert len(events(GENERIC, "w2^2 = 1e-30", 8, DIGITS)) == 2


@pytest.mark.parametrize("text", ["T = 0.9745", "extremum H2"])
def test_what_is_conserved_has_no_event_or_is_undecided(text: str) -> None:
    """A constant is beside a value, or no time is distinguished."""
    answer = events(GENERIC, text, 3, DIGITS)
    assert not answer.times
    assert answer.passed is (not answer.undecided)


def test_the_start_is_known_exactly() -> None:
    """An event at the very start has no radius; one at the end of the span is undecided."""
    spinning = about_axes('["1", "0", "0"]', end="2")
    at_start, at_end = (events(spinning, text, 1, DIGITS) for text in ("w1 = 0", "w1 = 1"))
    assert [(event.t, event.radius) for event in at_start] == [(0, 0)]
    assert [event.t for event in at_end.undecided] == [1]


def test_a_corner_is_an_extremum() -> None:
    """A moment that changes its sign by the clock makes an extremum at that time, exactly."""
    swung = about_axes('["1 if t < 1/4 else -1", "0", "0"]')
    assert [(event.t, event.radius) for event in events(swung, "extremum w1", 1)] == [(0.25, 0)]


def test_a_kink_of_the_expression_is_no_loss() -> None:
    """Beside the zero of an absolute value there are two crossings, one on each side."""
    below, above = (events(GENERIC, f"w2 = {value}", 6, DIGITS) for value in ("-1/9", "1/9"))
    both = events(GENERIC, "abs(w2) = 1/9", 6, DIGITS)
    merged = sorted((*below, *above), key=lambda event: event.t)
    assert same(both, Events("", Fraction(6), DIGITS, tuple(merged)))


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("w2", "`EXPRESSION = VALUE` or `extremum EXPRESSION`"),
        ("w2 == 0", "`EXPRESSION = VALUE`"),
        ("w2 = foo", "got `foo` @ event, column 7"),
        ("w2 = 1 if t < 2 else 0", "an expression that does not jump"),
        ("x1 = 0", "a known name"),
    ],
)
def test_a_text_that_is_no_event_is_refused(text: str, why: str) -> None:
    """A fault of the text is one sentence with its place."""
    with pytest.raises(Refused, match=why):
        events(GENERIC, text, 1)


def test_events_before_the_end_of_a_motion_are_known() -> None:
    """w' = w^2 has no bound at t = 1: the events before that are all, up to the time that is reached."""
    endless = about_axes('["w1^2", "0", "0"]', "[1, 0, 0]", end="2")
    with pytest.raises(
        Incomplete, match=r"omega seems to grow without bound: .* near t = 1\.0"
    ) as cut:
        events(endless, "w1 = 4", 2, DIGITS)
    (event,) = cut.value.events
    assert abs(event.t - mp.mpf("0.75")) <= event.radius <= mp.mpf(10) ** -DIGITS
    assert Fraction(999999, 1000000) < cut.value.events.until < 1
    assert cut.value.events.passed


def test_events_before_the_end_of_a_motion_are_printed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """They stand on stdout with the time up to which they are all; the reason follows; exit 3."""
    scene = tmp_path / "ends.toml"
    moment = 'moment = ["-1 - sqrt(w1)", 0, 0]'
    scene.write_text(ABOUT_AXES.format(moment=moment[9:], omega="[1, 0, 0]", end="2"))
    assert main(["exact", str(scene), "--event", "w1 = 1/2", "--until", "2", "--digits", "12"]) == 3
    printed = capsys.readouterr()
    first, second = printed.out.splitlines()
    assert "1 time of w1 = 1/2 up to t = 0.61370" in first
    assert second.startswith("t = 0.2")
    assert (
        "sqrt(w1) in body.moment[0] has no value or no derivative near t = 0.613706" in printed.err
    )


@pytest.mark.parametrize(("text", "status"), [("w2 = 0", 0), ("w2^2 = 0", 3), ("sqrt(w2) = 2", 3)])
def test_the_exit_status_says_what_is_undecided(
    text: str, status: int, capsys: pytest.CaptureFixture[str]
) -> None:
    """A touched zero, or an expression without a value, is exit 3."""
    arguments = ["exact", "euler/generic", "--event", text, "--until", "6", "--digits", "12"]
    assert main([*arguments, "--json"]) == status
    assert '"undecided": [' in capsys.readouterr().out
