# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""The array that a continuous output returns is overwritten by its next call."""

import math
import sys

import heyoka as hy
import numpy as np


def kept(equations, w, first, second):
    """Keep the answer of a continuous output for one time while asking for another."""
    ta = hy.taylor_adaptive(equations, w)
    *_, c_out, _ = ta.propagate_until(second, c_output=True)
    at_first = c_out(first)
    c_out(second)
    return np.array(at_first)


if __name__ == "__main__":
    x = hy.make_vars("x")
    (found,) = kept([(x, -x)], [1.0], 1.0, 2.0)

    print("expected  the answer for t = 1 to stay what it was:", math.exp(-1))
    print("got      ", found)
    sys.exit(0 if math.isclose(found, math.exp(-1)) else 1)
