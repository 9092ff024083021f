# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""The array that a continuous output returns is overwritten by its next call."""

import sys

import heyoka as hy
import numpy as np

x = hy.make_vars("x")
ta = hy.taylor_adaptive([(x, -x)], [1.0])
*_, c_out, _ = ta.propagate_until(3.0, c_output=True)

first = c_out(1.0)
kept = np.array(first)
c_out(2.0)

print("expected  the answer for t = 1 to stay what it was:", kept)
print("got      ", first)
sys.exit(0 if np.array_equal(first, kept) else 1)
