# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""hy.time in an equation is the upper half of the double-double in which heyoka keeps the time.

x' = cos(t - t0) from x(t0) = 0: after 100 units x is sin 100.
"""

import math
import sys

import heyoka as hy


def driven(start, duration):
    """Integrate x' = cos(t - start) from x(start) = 0: after the duration, x is its sine."""
    x = hy.make_vars("x")
    ta = hy.taylor_adaptive([(x, hy.cos(hy.time - start))], [0.0], time=start)
    outcome, *_ = ta.propagate_for(duration)
    return outcome, ta.state[0]


if __name__ == "__main__":
    starts = (0.0, 1e6, 1e10, 1e15)
    errors = {start: abs(driven(start, 100.0)[1] - math.sin(100.0)) for start in starts}

    print(f"expected  the error of t0 = 0 at every t0: {errors[0.0]:.1e}")
    for start, error in errors.items():
        print(f"got       t0 = {start:g}: {error:.1e}")
    sys.exit(0 if errors[1e10] <= 1e-10 else 1)
