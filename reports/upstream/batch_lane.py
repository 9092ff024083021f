# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""One lane of a batch that is not finite stops the sound lanes, whose outcome is then `success`."""

import math
import sys

import heyoka as hy

x = hy.make_vars("x")
ta = hy.taylor_adaptive_batch([(x, -x)], [[1.0, 1.0, math.nan, 1.0]])
ta.propagate_until(10.0)
outcomes = [outcome.name for outcome, *_ in ta.propagate_res]

print("expected  the sound lanes at t = 10, or an outcome that says why they are not")
for lane, (outcome, time) in enumerate(zip(outcomes, ta.time, strict=True)):
    print(f"got       lane {lane}: {outcome} at t = {time:.3g}")
sys.exit(1 if outcomes[0] == "success" and ta.time[0] < 10 else 0)
