"""Exact solutions among other work: interrupts, threads, and patience."""

from __future__ import annotations

import signal
from concurrent.futures import ThreadPoolExecutor

import pytest
from flint import acb, ctx

from taylor_verify import exact, explain
from taylor_verify.exact.integral import integral
from taylor_verify.exact.solution import Unsettled
from taylor_verify.explain import explanation as explaining
from taylor_verify.numbers.patience import Patience

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
