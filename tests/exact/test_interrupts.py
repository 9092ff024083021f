"""Exact solutions that end early or run among others: reach, interrupts, threads and patience."""

from __future__ import annotations

import json
import pickle
import re
import signal
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from builders.scenes import SPIN, TENSOR, one_instant, vector
from flint import acb, arb, ctx
from mpmath import mp, mpf

import taylor_verify
from taylor_verify import exact, explain
from taylor_verify.cli import main
from taylor_verify.exact.balls import Enclosed, Enclosure
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.integral import integral
from taylor_verify.exact.route import ElseSeries
from taylor_verify.exact.solution import Quantities, Settled, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.explain import explanation as explaining
from taylor_verify.numbers.patience import Patience
from taylor_verify.scenes.bodies import RigidBody

BITS = 1500


class Interrupting:
    """An integrand that is interrupted once, at some value, and counts the values that follow."""

    def __init__(self, last: int) -> None:
        self.last, self.count = last, 0

    def __call__(self, z: acb, analytic: bool) -> acb:
        self.count += 1
        if self.count == self.last:
            raise KeyboardInterrupt
        return (z * z + 1).sqrt(analytic=analytic) * (50 * z.sin()).exp()


@pytest.mark.parametrize("last", [1, 7, 400, 1500])
def test_an_interrupt_in_an_integrand_is_the_error_of_the_integral(last: int) -> None:
    """Flint alone would go on to its end and report a SystemError."""
    integrand = Interrupting(last)
    with ctx.workprec(BITS), pytest.raises(KeyboardInterrupt):
        integral(integrand, acb(0), acb(3))
    assert integrand.count == last


def integrate_for_ever() -> None:
    signal.setitimer(signal.ITIMER_REAL, 0.01)
    while True:
        integral(Interrupting(0), acb(0), acb(3))


def test_an_interrupt_between_two_values_is_heard() -> None:
    """A signal that comes inside flint, at any time, ends the integral as soon as a value is asked for."""

    def interrupt(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        with ctx.workprec(BITS):
            for _ in range(20):
                with pytest.raises(KeyboardInterrupt):
                    integrate_for_ever()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_an_integral_that_would_take_hours_is_declined() -> None:
    """The nodes of its rules would be made in calls of minutes, which hear no interrupt."""
    with ctx.workprec(33_000), pytest.raises(Unsettled, match="would take hours"):
        integral(Interrupting(0), acb(0), acb(3))


# Threads

DIGITS = (20, 60, 25, 50) * 3


def test_threads_have_their_own_digits() -> None:
    """The working precision of a process serves one call at a time, whatever the others ask for."""
    alone = {digits: exact("euler/generic", ["1/2"], digits) for digits in {*DIGITS}}
    with ThreadPoolExecutor(4) as pool:
        motions = list(pool.map(lambda digits: exact("euler/generic", ["1/2"], digits), DIGITS))
    for digits, motion in zip(DIGITS, motions, strict=True):
        assert (motion["omega"] == alone[digits]["omega"]).all()
        assert max(motion.radius) <= 10.0**-digits


# Patience


def endless() -> str:
    while True:
        pass


def test_what_takes_longer_is_left_out() -> None:
    """Work without end is given up; what is asked for afterwards is not begun."""
    patience = Patience(0.05)
    assert patience.made(lambda: "made", "") == "made"
    assert patience.made(endless, "left out") == "left out"
    assert patience.made(lambda: "made", "left out") == "left out"


def test_an_explanation_says_what_it_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the run there are no gates, one undecided row, a warning; orbit and equations are there."""
    equations = explain("euler/generic")["equations"]
    monkeypatch.setattr(explaining, "_judged", lambda *_: endless())
    monkeypatch.setattr(explaining, "_SECONDS", 1.0)
    content = explain("euler/generic")
    assert any(warning.startswith("left out: the run") for warning in content["warnings"])
    assert [row["verdict"] for row in content["gates"]] == ["undecided"]
    assert content["orbit"]["period"]
    assert content["equations"] == equations


# Times that cannot be reached

# Near the middle axis, in a frame in which no number is zero: the motion loses 0.18 digits a unit of time.
UNSTABLE = "extremes/euler-unstable-axis-turned"
# Under a constant moment a body spins ever faster.
FASTER = one_instant(RigidBody(TENSOR, vector("0.1", "-0.2", "0.05")), SPIN)


def asked(capsys: pytest.CaptureFixture[str], scene: str, times: str) -> tuple[int, Any, str]:
    status = main(["exact", scene, "--at", times, "--digits", "12", "--route", "taylor", "--json"])
    out, error = capsys.readouterr()
    return status, json.loads(out), error


def test_rows_before_a_time_out_of_reach_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    """Rows stand in the order asked, of both signs; the exit is 3, and the first missing time is named."""
    status, document, error = asked(capsys, UNSTABLE, "1e5,-20,60,-1e6,0,2e5")
    assert status == 3
    assert [row["t"] for row in document["rows"]] == ["-20", "60", "0"]
    alone = asked(capsys, UNSTABLE, "-20,60,0")
    assert (alone[0], alone[1]["rows"]) == (0, document["rows"])
    for time in ("t = 100000 needs more than 10100 bits", "t = -1000000 needs"):
        assert re.search(
            rf"loses about 0\.\d+ digits per unit of time; {time}", document["because"]
        )
    assert "200000" not in document["because"]
    assert document["because"] in error.replace("\n", " ")


def test_a_person_sees_the_rows_that_were_reached(capsys: pytest.CaptureFixture[str]) -> None:
    """The text has the certified rows, and stderr has the reason."""
    arguments = ["exact", UNSTABLE, "--at", "20,1e5", "--digits", "12", "--route", "taylor"]
    assert main(arguments) == 3
    out, error = capsys.readouterr()
    assert "t = 20 " in out
    assert "1e5" not in out
    assert "t = 100000" in error


def test_python_raises_and_hands_over_the_rows() -> None:
    """A caller cannot overlook it: the exception has the rows, and says to which times they belong."""
    times = ["1e5", 20, -20]
    with pytest.raises(Unsettled, match="t = 100000 needs more than") as raised:
        taylor_verify.exact(UNSTABLE, times, 12, route="taylor")
    motion, places = raised.value.motion, raised.value.places
    assert motion is not None
    assert [times[place] for place in places] == [20, -20]
    assert motion["omega"].shape == (2, 3)
    assert motion["attitude"].shape == (2, 3, 3)
    assert max(motion.radius) <= mpf(10) ** -12
    alone = taylor_verify.exact(UNSTABLE, times[1:], 12, route="taylor")
    assert np.all(abs(alone["omega"] - motion["omega"]) <= mpf(10) ** -12)
    assert pickle.loads(pickle.dumps(raised.value)).places == places


def test_what_is_raised_without_a_row_has_no_motion() -> None:
    """None, so that nobody reads an empty motion for an answer."""
    with pytest.raises(Unsettled, match="steps") as raised:
        taylor_verify.exact("euler/constant-moment", ["1e30"], 12, route="taylor")
    assert (raised.value.motion, raised.value.places) == (None, ())


def test_steps_that_are_too_many_for_one_time_are_not_for_another() -> None:
    """The limit of steps refuses the first time that is behind it, and the others are answered."""
    few = TaylorSolution(FASTER, most_steps=60)
    times = [Fraction(time) for time in (400, 2, -1, 300)]
    with pytest.raises(Unsettled, match=r"to reach t = 300, .*; expected at most 60") as raised:
        few.motion(times, 12)
    assert raised.value.places == (1, 2)


def test_rows_are_certified_once_they_have_their_digits(monkeypatch: pytest.MonkeyPatch) -> None:
    """The second try, with more bits, asks for the times that lack some and for no other."""
    tries: list[list[Fraction]] = []
    honest = Course.rows

    def counted(self: Course, times: Sequence[Fraction]) -> object:
        tries.append(list(times))
        return honest(self, times)

    monkeypatch.setattr(Course, "rows", counted)
    times = [Fraction(time) for time in (1, 120)]
    motion = TaylorSolution(taylor_verify.load(UNSTABLE)).motion(times, 12)
    assert max(motion.radius) <= mpf(10) ** -12
    assert tries[0] == times
    assert all(later == times[1:] for later in tries[1:])
    assert len(tries) > 1


class _Balls(Enclosed):
    """A closed form with one narrow ball and one that stays wide."""

    regime = "test"

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        return {"omega": [[arb(1, 0.5 if t > 1 else 0.0)] * 3 for t in elapsed]}


class _Numbers(Settled):
    """A closed form with one number that settles and one that does not."""

    regime, route = "test", "mpmath"

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        rows = [[mpf(1) + (mpf(digits) / 100 if t > 1 else 0)] * 3 for t in elapsed]
        return {"omega": np.array(rows, dtype=object)}


@pytest.mark.parametrize("known", [_Balls(), _Numbers()])
def test_a_closed_form_hands_over_its_rows_as_well(known: Enclosed | Settled) -> None:
    """Whatever the route, a row that has its digits is in the exception."""
    with pytest.raises(Unsettled) as raised:
        known.motion([Fraction(2), Fraction(1)], 10)
    assert raised.value.places == (1,)
    assert raised.value.motion is not None
    assert raised.value.motion["omega"].tolist() == [[mpf(1)] * 3]


def test_a_closed_form_that_fails_leaves_the_rows_of_the_series() -> None:
    """The rows of the series stand where a closed form fails and the series ends early."""
    few = TaylorSolution(FASTER, most_steps=60)
    both = ElseSeries(_Balls(), few)
    with pytest.raises(Unsettled, match="steps") as raised:
        both.motion([Fraction(400), Fraction(2)], 12)
    assert raised.value.places == (1,)
    assert both.route == "taylor"
    with mp.workdps(15):
        assert raised.value.motion is not None
        finer = TaylorSolution(FASTER).motion([Fraction(2)], 15)
        assert mp.norm(list((raised.value.motion["omega"] - finer["omega"]).flat)) < mpf(10) ** -12
