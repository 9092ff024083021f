# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""An expression divided by a literal is multiplied by the literal's reciprocal, rounded to a double.

x' = x/3 from x(0) = 1: at t = 3, x is e. The literal 3.0 is exact in every format.
"""

import sys

import heyoka as hy
import numpy as np

BITS = 237


def error_of(right_hand_side):
    """The relative error of x(3) at 237 bits."""
    one, three = hy.real(1, BITS), hy.real(3, BITS)
    ta = hy.taylor_adaptive([(x, right_hand_side)], [one], fp_type=hy.real)
    ta.propagate_until(three)
    e = np.exp(one)
    return abs((ta.state[0] - e) / e)


x = hy.make_vars("x")
typed, literal = error_of(x / hy.real(3, BITS)), error_of(x / 3.0)
bound = hy.real(2, BITS) ** -220

print("expected  x / 3.0 as exact as x / hy.real(3, 237), an error of", typed)
print("got       an error of", literal, "from", x / 3.0)
sys.exit(0 if literal <= bound else 1)
