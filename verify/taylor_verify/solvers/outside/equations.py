"""The equations as the protocol hands them over, in plain arithmetic that every library can compile.

They are written in scalars, without a loop or an array, so that numba compiles them, JAX traces them
and Python runs them as they stand. Euler: H' = (H + r) x K H + M. Kirchhoff: x' = x x Omega + X and
y' = y x Omega + x x U + L, with U = A x + B y and Omega = B^T x + C y. Damping d takes d H, or d x and d y,
from these. With the attitude
q' = q (0, Omega) / 2, with the centre c' = R U.

s  state: H, or x and y; then q, then c, as far as tracked (3, 6, 7, 10 or 13 numbers)
p  parameters: K by rows, M and the momentum r of wheels (15), or A B C by rows, X and L (33); last d
q  attitude, scalar first, body to space       c  centre, in space axes
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Rates = Callable[[Any, Any], tuple[Any, ...]]
Vectors = Callable[..., tuple[Any, ...]]
Jit = Callable[[Any], Any]


def euler(s: Any, p: Any) -> tuple[Any, ...]:
    """Return H' and omega: 3 and 3."""
    w1 = p[0] * s[0] + p[1] * s[1] + p[2] * s[2]
    w2 = p[3] * s[0] + p[4] * s[1] + p[5] * s[2]
    w3 = p[6] * s[0] + p[7] * s[1] + p[8] * s[2]
    H1, H2, H3 = s[0] + p[12], s[1] + p[13], s[2] + p[14]
    return (
        H2 * w3 - H3 * w2 + p[9] - p[15] * s[0],
        H3 * w1 - H1 * w3 + p[10] - p[15] * s[1],
        H1 * w2 - H2 * w1 + p[11] - p[15] * s[2],
        w1,
        w2,
        w3,
    )


def kirchhoff(s: Any, p: Any) -> tuple[Any, ...]:
    """Return x', y', Omega and U: four times 3."""
    x1, x2, x3, y1, y2, y3 = s[0], s[1], s[2], s[3], s[4], s[5]
    U1 = p[0] * x1 + p[1] * x2 + p[2] * x3 + p[9] * y1 + p[10] * y2 + p[11] * y3
    U2 = p[3] * x1 + p[4] * x2 + p[5] * x3 + p[12] * y1 + p[13] * y2 + p[14] * y3
    U3 = p[6] * x1 + p[7] * x2 + p[8] * x3 + p[15] * y1 + p[16] * y2 + p[17] * y3
    w1 = p[9] * x1 + p[12] * x2 + p[15] * x3 + p[18] * y1 + p[19] * y2 + p[20] * y3
    w2 = p[10] * x1 + p[13] * x2 + p[16] * x3 + p[21] * y1 + p[22] * y2 + p[23] * y3
    w3 = p[11] * x1 + p[14] * x2 + p[17] * x3 + p[24] * y1 + p[25] * y2 + p[26] * y3
    return (
        x2 * w3 - x3 * w2 + p[27] - p[33] * x1,
        x3 * w1 - x1 * w3 + p[28] - p[33] * x2,
        x1 * w2 - x2 * w1 + p[29] - p[33] * x3,
        y2 * w3 - y3 * w2 + x2 * U3 - x3 * U2 + p[30] - p[33] * y1,
        y3 * w1 - y1 * w3 + x3 * U1 - x1 * U3 + p[31] - p[33] * y2,
        y1 * w2 - y2 * w1 + x1 * U2 - x2 * U1 + p[32] - p[33] * y3,
        w1,
        w2,
        w3,
        U1,
        U2,
        U3,
    )


def attitude_rate(q0: Any, q1: Any, q2: Any, q3: Any, w1: Any, w2: Any, w3: Any) -> tuple[Any, ...]:
    """Return q' = q (0, omega) / 2."""
    return (
        0.5 * (-q1 * w1 - q2 * w2 - q3 * w3),
        0.5 * (q0 * w1 + q2 * w3 - q3 * w2),
        0.5 * (q0 * w2 + q3 * w1 - q1 * w3),
        0.5 * (q0 * w3 + q1 * w2 - q2 * w1),
    )


def to_space(q0: Any, q1: Any, q2: Any, q3: Any, v1: Any, v2: Any, v3: Any) -> tuple[Any, ...]:
    """Return the vector in space axes: v + 2 r x (r x v + q0 v), r = (q1, q2, q3)."""
    a1 = q2 * v3 - q3 * v2 + q0 * v1
    a2 = q3 * v1 - q1 * v3 + q0 * v2
    a3 = q1 * v2 - q2 * v1 + q0 * v3
    return (
        v1 + 2.0 * (q2 * a3 - q3 * a2),
        v2 + 2.0 * (q3 * a1 - q1 * a3),
        v3 + 2.0 * (q1 * a2 - q2 * a1),
    )


def _as_it_is(function: Any) -> Any:
    return function


def rates(columns: list[str], jit: Jit = _as_it_is) -> Rates:
    """Return the rates of all that an answer with these columns needs; ``jit`` compiles each function."""
    turn: Vectors = jit(attitude_rate)
    shift: Vectors = jit(to_space)
    is_euler = "w1" in columns
    free: Rates = jit(euler if is_euler else kirchhoff)
    # The size of the momentum; numba takes it for a constant.
    n = 3 if is_euler else 6

    def momentum(s: Any, p: Any) -> tuple[Any, ...]:
        return free(s, p)[:n]

    def with_attitude(s: Any, p: Any) -> tuple[Any, ...]:
        f = free(s, p)
        return f[:n] + turn(s[n], s[n + 1], s[n + 2], s[n + 3], f[n], f[n + 1], f[n + 2])

    def with_attitude_and_centre(s: Any, p: Any) -> tuple[Any, ...]:
        f = free(s, p)
        turned = turn(s[6], s[7], s[8], s[9], f[6], f[7], f[8])
        return f[:6] + turned + shift(s[6], s[7], s[8], s[9], f[9], f[10], f[11])

    asked = momentum
    if "q0" in columns:
        asked = with_attitude_and_centre if "c1" in columns else with_attitude
    compiled: Rates = jit(asked)
    return compiled
