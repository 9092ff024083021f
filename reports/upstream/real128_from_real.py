# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""hy.real128(x) of a hy.real x with more than 113 bits cuts off where it could round to nearest."""

import random
import sys

import heyoka as hy

if not hasattr(hy, "real128"):
    print("this build of heyoka has no real128")
    sys.exit(2)

DRAWS = 1000
draw = random.Random(1)
cut = 0
for _ in range(DRAWS):
    # 200 bits, odd: exactly between no two numbers of 113 bits.
    x = hy.real(draw.getrandbits(200) | 1, 200)
    cut += bool(hy.real128(x) != hy.real128(hy.real(x, 113)))

print("expected  hy.real128(x) == hy.real128(hy.real(x, 113)), the nearest, for each x")
print(f"got       another number for {cut} of {DRAWS}")
sys.exit(1 if cut else 0)
