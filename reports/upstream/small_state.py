# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""Relative accuracy falls in proportion to the size of the state, once that is below one.

x' = v, v' = -x is linear: from (s, 0), x(10) is s cos 10. All sizes here are powers of two.
"""

import math
import sys

import heyoka as hy

x, v = hy.make_vars("x", "v")


def error_of(size):
    """The relative error of x(10) from (size, 0), and the number of steps."""
    ta = hy.taylor_adaptive([(x, v), (v, -x)], [size, 0.0])
    outcome, _, _, steps, _, _ = ta.propagate_until(10.0)
    error = float(abs(ta.state[0] / size / math.cos(10.0) - 1))
    return error, steps, outcome.name


unit, small = error_of(1.0), error_of(2.0**-27)

print("expected  the same relative error at every size:", unit)
print("got       at the size 2^-27:", small)
# The cosine and the states are each rounded a few times a step: a thousand epsilons is generous.
sys.exit(0 if small[0] <= 1000 * sys.float_info.epsilon else 1)
