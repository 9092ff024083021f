"""An interrupt ends an exact solution at once, also inside a call of flint."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from builders.processes import PATIENCE, interruptible, wait_until
from flint import acb, ctx

from taylor_verify.exact.integral import integral
from taylor_verify.exact.solution import Unsettled

BITS = 1500
# The processor time of an answer, from the interrupt to its end.
SECONDS = 4.0


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


@pytest.mark.slow
def test_an_interrupt_ends_a_long_exact_answer() -> None:
    """Two thousand digits take half a minute in integrals; Ctrl-C in their midst soon exits with 130."""
    words = ["-m", "taylor_verify", "exact", "kirchhoff/weber", "--at", "2", "--digits", "2000"]
    before = processor_seconds(resource.RUSAGE_CHILDREN)
    with interruptible():
        child = subprocess.Popen(
            [sys.executable, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )
    with child:
        wait_until(lambda: running_seconds(child.pid) >= 6)
        spent = running_seconds(child.pid)
        child.send_signal(signal.SIGINT)
        assert child.wait(PATIENCE) == 130
    assert processor_seconds(resource.RUSAGE_CHILDREN) - before - spent <= SECONDS


def processor_seconds(whose: int) -> float:
    """Return the seconds of processor time of this process or of its children that have ended."""
    used = resource.getrusage(whose)
    return used.ru_utime + used.ru_stime


def running_seconds(pid: int) -> float:
    """Return the seconds of processor time of a process that runs, by Linux's own account."""
    numbers = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(numbers[11]) + int(numbers[12])) / os.sysconf("SC_CLK_TCK")
