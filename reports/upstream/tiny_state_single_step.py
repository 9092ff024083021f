# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""A state so small that its last Taylor coefficients underflow is taken in one step of any length.

A free rigid body, I = (1, 2, 3): omega may be scaled by s if time is scaled by 1/s, so that the
number of steps should not depend on s. Overflow of the same coefficients is reported.
"""

import sys

import heyoka as hy

w1, w2, w3 = hy.make_vars("w1", "w2", "w3")
BODY = [(w1, -(w2 * w3)), (w2, w3 * w1), (w3, -(w1 * w2) * (1 / 3))]
OMEGA = (0.71875, -0.40625, 0.90625)


def run(size):
    """Outcome, number of steps and |omega_1| over its largest possible value."""
    ta = hy.taylor_adaptive(BODY, [size * w for w in OMEGA])
    outcome, _, _, steps, _, _ = ta.propagate_until(10 / size)
    return outcome.name, steps, float(abs(ta.state[0]) / size)


plain, tiny, huge = run(1.0), run(1e-16), run(1e16)

print("expected  the outcome and the steps of size 1:", plain)
print("got       at the size 1e-16:", tiny)
print("          at the size 1e+16:", huge)
# Energy and momentum bound omega_1 by 2 on this orbit.
sys.exit(0 if tiny[0] != "time_limit" or tiny[2] <= 2 else 1)
