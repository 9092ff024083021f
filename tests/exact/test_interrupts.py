"""An interrupt ends an exact solution at once, also inside a call of flint."""

from __future__ import annotations

import signal

import pytest
from flint import acb, ctx

from taylor_verify.exact.integral import integral
from taylor_verify.exact.solution import Unsettled

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
