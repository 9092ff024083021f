# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""One lane of a batch that is not finite stops the sound lanes, whose outcome is then `success`."""

import math
import sys

import heyoka as hy


def lanes(equations, w, end):
    """Integrate several systems side by side, a column of w each: outcomes, times and states."""
    ta = hy.taylor_adaptive_batch(equations, w)
    ta.propagate_until(end)
    return [outcome for outcome, *_ in ta.propagate_res], ta.time, ta.state


if __name__ == "__main__":
    x = hy.make_vars("x")
    outcomes, times, _ = lanes([(x, -x)], [[1.0, 1.0, math.nan, 1.0]], 10.0)

    print("expected  the sound lanes at t = 10, or an outcome that says why they are not")
    for lane, (outcome, time) in enumerate(zip(outcomes, times, strict=True)):
        print(f"got       lane {lane}: {outcome.name} at t = {time:.3g}")
    sys.exit(1 if outcomes[0].name == "success" and times[0] < 10 else 0)
