# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""numpy.linalg.norm of an array of hy.real (or hy.real128) is a float64, without a word."""

import sys

import heyoka as hy
import numpy as np

BITS = 237
vector = np.array([hy.real("0.1", BITS), hy.real("0.2", BITS)])
wanted, found = np.sqrt(vector @ vector), np.linalg.norm(vector)

print("expected  a hy.real, or an exception:", type(wanted).__name__, wanted)
print("got      ", type(found).__name__, found)
sys.exit(1 if isinstance(found, np.float64) else 0)
