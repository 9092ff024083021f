"""The motion of the body frame in space: attitude and centre.

q  unit quaternion, scalar first, body to space: v_space = R(q) v_body
c  the body's origin in space axes
"""

from __future__ import annotations

from fractions import Fraction
from math import isqrt, lcm
from typing import Any

from taylor_verify.models.algebra import Terms, add, cross, dot, minus, plus, times
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.motion import IDENTITY, Quaternion


def attitude_rate(q: Terms, omega: Terms) -> list[Any]:
    """Return q' = q (0, omega) / 2, the same as R' = R [omega]x."""
    q0, q1, q2, q3 = q
    w1, w2, w3 = omega
    doubled = [
        minus(0, dot([q1, q2, q3], omega)),
        plus(times(q0, w1), minus(times(q2, w3), times(q3, w2))),
        plus(times(q0, w2), minus(times(q3, w1), times(q1, w3))),
        plus(times(q0, w3), minus(times(q1, w2), times(q2, w1))),
    ]
    return [component / 2 for component in doubled]


def rotation(q: Terms) -> list[list[Any]]:
    """Return R(q), which is |q|^2 times a rotation where q is not a unit quaternion."""
    q0, q1, q2, q3 = q
    s0, s1, s2, s3 = q0 * q0, q1 * q1, q2 * q2, q3 * q3
    return [
        [s0 + s1 - s2 - s3, 2 * (q1 * q2 - q0 * q3), 2 * (q1 * q3 + q0 * q2)],
        [2 * (q1 * q2 + q0 * q3), s0 - s1 + s2 - s3, 2 * (q2 * q3 - q0 * q1)],
        [2 * (q1 * q3 - q0 * q2), 2 * (q2 * q3 + q0 * q1), s0 - s1 - s2 + s3],
    ]


def centre_rate(q: Terms, U: Terms) -> list[Any]:
    """Return c' = U + 2 r x (r x U + q0 U), r = (q1, q2, q3): R(q) U of a unit quaternion, space axes.

    This takes fifteen products of the state; R(q) and its product with U take nineteen.
    """
    q0, *r = q
    turned = cross(r, add(cross(r, U), [times(q0, component) for component in U]))
    return add(U, [times(2, component) for component in turned])


def unit_quaternion(quaternion: Quaternion, rung: Rung) -> Quaternion:
    """Return the quaternion over its norm, each component rounded once."""
    if quaternion == IDENTITY:
        return quaternion
    # 64 guard bits: the error of the square root changes the rounding only near a tie, with
    # probability 2^-64 and by one unit in the last place.
    scale = lcm(*(entry.denominator for entry in quaternion))
    whole = [entry.numerator * (scale // entry.denominator) for entry in quaternion]
    squared = sum(n * n for n in whole)
    shift = max(0, rung.bits + 64 - squared.bit_length() // 2)
    norm = isqrt(squared << 2 * shift)
    e0, e1, e2, e3 = (rung.round(Fraction(n << shift, norm)) for n in whole)
    return (e0, e1, e2, e3)
