"""Carlson's integral R_J with a complex last argument, by duplication (Carlson 1995; DLMF 19.36).

mpmath's elliprj takes a quadrature for such arguments, which need not end.
"""

from __future__ import annotations

from mpmath import mp, mpc, mpf

# The truncated series errs by the sixth power of the spread of the arguments.
_ORDER = 6


def integral_j(x: mpf | mpc, y: mpf | mpc, z: mpf | mpc, p: mpc) -> mpc:
    """R_J(x, y, z, p) = (3/2) int_0^oo ds/((s + p) sqrt((s + x)(s + y)(s + z))).

    x is real and not negative; y and z are real and positive, or conjugates; p is off the negative real
    axis. On the path of integration the product of the three roots is positive, so that principal roots
    are right at every step.
    """
    mean = (x + y + z + 2 * p) / 5
    spread = max(abs(mean - a) for a in (x, y, z, p))
    delta = (p - x) * (p - y) * (p - z)
    enough = mp.power(mp.eps / 4, mpf(1) / _ORDER)
    start, quarter, total = mean, mpf(1), mpc(0)
    x0, y0, z0 = x, y, z
    while quarter * spread >= enough * abs(mean):
        rx, ry, rz, rp = mp.sqrt(x), mp.sqrt(y), mp.sqrt(z), mp.sqrt(p)
        step = rx * ry + ry * rz + rz * rx
        d = (rp + rx) * (rp + ry) * (rp + rz)
        total += quarter / d * _arc(quarter**3 * delta / d**2)
        x, y, z, p = ((a + step) / 4 for a in (x, y, z, p))
        mean = (mean + step) / 4
        quarter /= 4
    X, Y, Z = (quarter * (start - a) / mean for a in (x0, y0, z0))
    P = -(X + Y + Z) / 2
    E2 = X * Y + X * Z + Y * Z - 3 * P**2
    E3 = X * Y * Z + 2 * E2 * P + 4 * P**3
    E4 = (2 * X * Y * Z + E2 * P + 3 * P**3) * P
    E5 = X * Y * Z * P**2
    series = (
        1 - 3 * E2 / 14 + E3 / 6 + 9 * E2**2 / 88 - 3 * E4 / 22 - 9 * E2 * E3 / 52 + 3 * E5 / 26
    )
    return quarter * mp.power(mean, mpf(-3) / 2) * series + 6 * total


def _arc(e: mpc) -> mpc:
    """R_C(1, 1 + e) = arctan(sqrt e)/sqrt e."""
    root = mp.sqrt(e)
    return mp.atan(root) / root if root else mpc(1)
