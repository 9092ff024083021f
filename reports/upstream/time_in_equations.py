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

x = hy.make_vars("x")


def error_of(start):
    """The absolute error of x after 100 units."""
    ta = hy.taylor_adaptive([(x, hy.cos(hy.time - start))], [0.0], time=start)
    ta.propagate_for(100.0)
    return abs(ta.state[0] - math.sin(100.0))


errors = {start: error_of(start) for start in (0.0, 1e6, 1e10, 1e15)}

print(f"expected  the error of t0 = 0 at every t0: {errors[0.0]:.1e}")
for start, error in errors.items():
    print(f"got       t0 = {start:g}: {error:.1e}")
sys.exit(0 if errors[1e10] <= 1e-10 else 1)
