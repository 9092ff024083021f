# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""Of steps that were all cut (by max_delta_t or by the end) the smallest is inf and the largest 0."""

import sys

import heyoka as hy


def decay(x0, end, **options):
    """Integrate x' = -x; return the integrator, and what propagate_until returned."""
    x = hy.make_vars("x")
    ta = hy.taylor_adaptive([(x, -x)], [x0])
    return ta, ta.propagate_until(end, **options)


if __name__ == "__main__":
    _, (outcome, min_h, max_h, steps, _, _) = decay(1.0, 1.0, max_delta_t=0.125)

    print("expected  the smallest and the largest step that were used, 0.125 both")
    print(f"got       {outcome.name} after {steps} steps, smallest {min_h}, largest {max_h}")
    sys.exit(0 if min_h <= max_h else 1)
