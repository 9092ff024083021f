# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""A signal that arrives during a propagation without a Python callback is heard at its end."""

import contextlib
import signal
import sys

import heyoka as hy

END = 2e5
x, v = hy.make_vars("x", "v")


def interrupt(*_):
    raise KeyboardInterrupt


def interrupted(**options):
    """The time that the integrator had reached when the interruption was heard."""
    ta = hy.taylor_adaptive([(x, v), (v, -hy.sin(x))], [1.0, 0.0])
    signal.setitimer(signal.ITIMER_REAL, 0.02)
    with contextlib.suppress(KeyboardInterrupt):
        ta.propagate_until(END, **options)
    return ta.time


signal.signal(signal.SIGALRM, interrupt)
heard, heard_late = interrupted(callback=lambda ta: True), interrupted()

print(f"expected  to be heard on the way, as with a callback: at t = {heard:g} of {END:g}")
print(f"got       at t = {heard_late:g}")
sys.exit(0 if heard_late < END else 1)
