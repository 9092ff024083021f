# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""A signal that arrives during a propagation without a Python callback is heard at its end."""

import contextlib
import signal
import sys

import heyoka as hy


def swung(ta, end):
    """How far a long run has come when it ends or is interrupted."""
    with contextlib.suppress(KeyboardInterrupt):
        ta.propagate_until(end)
    return float(ta.time)


def swung_with_callback(ta, end):
    """The same with a callback after each step."""
    with contextlib.suppress(KeyboardInterrupt):
        ta.propagate_until(end, callback=lambda ta: True)
    return float(ta.time)


def interrupted(seconds, end, run=swung):
    """The time of the integrator when an interruption after so many seconds is heard of."""
    x, v = hy.make_vars("x", "v")
    ta = hy.taylor_adaptive([(x, v), (v, -hy.sin(x))], [1.0, 0.0])

    def interrupt(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        return run(ta, end)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


if __name__ == "__main__":
    END = 2e5
    heard, heard_late = interrupted(0.02, END, swung_with_callback), interrupted(0.02, END)

    print(f"expected  to be heard on the way, as with a callback: at t = {heard:g} of {END:g}")
    print(f"got       at t = {heard_late:g}")
    sys.exit(0 if heard_late < END else 1)
