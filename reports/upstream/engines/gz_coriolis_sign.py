# /// script
# requires-python = ">=3.10"
# dependencies = ["numpy>=2"]
# ///
"""The Hydrodynamics plugin applies the Coriolis force of added mass with the wrong sign.

Versions: gz-sim 11.0.0 (commit 93bbf3ed1), and since buildCoriolisMatrix takes negative coefficients.

Expected: a force -C_A(v) v on a body with the parameters that the plugin asks for (xDotU, ... < 0).

Came: +C_A(v) v. A body that nothing else acts on then changes its momentum in space, body and fluid
together, by 54 % within ten seconds; with the other sign it keeps it to rounding. The power is zero
with both: skew symmetry and energy, which the tests look at, cannot tell the signs apart.

Evidence: `buildCoriolisMatrix` (HydrodynamicsUtils.hh) is said to return -C_A, and for diag(-1, .. -6)
its test expects the rows of +C_A: entry (1, 5) is 9, as -S(M_A v) of Fossen (2011), equation 6.43, has
it. PreUpdate adds -Cmat * state to a wrench whose negative is applied. `buildFullCoriolisMatrix`
returns +C_A too, and is added with the other sign.
https://github.com/gazebosim/gz-sim/tree/main/src/systems/hydrodynamics
"""

import sys

import numpy as np

rigid = np.array([30.0, 30, 30, 0.12, 4.2, 4.2])
Ma = -np.array([4.876161, 126.324739, 126.324739, 0, 33.46, 33.46])


def plugin_force(v):
    """Cmat of buildCoriolisMatrix, then PreUpdate: wrench = -Cmat v, and its negative is applied."""
    c, s = np.zeros((6, 6)), Ma * v
    c[0, 4], c[0, 5], c[1, 3], c[1, 5], c[2, 3], c[2, 4] = -s[2], s[1], s[2], -s[0], -s[1], s[0]
    c[3, 1], c[3, 2], c[4, 0], c[4, 2], c[5, 0], c[5, 1] = -s[2], s[1], s[2], -s[0], -s[1], s[0]
    c[3, 4], c[3, 5], c[4, 3], c[4, 5], c[5, 3], c[5, 4] = -s[5], s[4], s[5], -s[3], -s[4], s[3]
    return -(-c @ v)


def drift(sign):
    """The largest change of the size of the whole momentum in 10 s, by RK4; no force but the fluid's."""

    def rates(v):
        p, q = np.split(rigid * v, 2)
        own = np.r_[np.cross(p, v[3:]), np.cross(q, v[3:]) + np.cross(p, v[:3])]
        return (own + sign * plugin_force(v)) / (rigid - Ma)

    v, h = np.array([1.5, 0.2, -0.1, 0.1, 0.05, 0.2]), 0.01
    sizes = []
    for _ in range(1000):
        a = rates(v)
        b = rates(v + h / 2 * a)
        c = rates(v + h / 2 * b)
        v = v + h / 6 * (a + 2 * b + 2 * c + rates(v + h * c))
        sizes.append(np.linalg.norm(((rigid - Ma) * v)[:3]))
    return max(sizes) / min(sizes) - 1


got = drift(1)
print(f"expected  the momentum stays: the sign turned changes it by {drift(-1):.1e}")
print(f"got       the plugin changes it by {got:.2g}")
sys.exit(1 if got > 1e-3 else 0)
