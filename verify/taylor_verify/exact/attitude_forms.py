"""An exact attitude in another form than its matrix, with the errors of its entries proven in balls.

quaternion   scalar first, body to space, its scalar not negative
zyx          yaw, pitch and roll in radians: R = R_z(yaw) R_y(pitch) R_x(roll); no roll straight up or down
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from math import log2
from typing import Any, Final

import numpy as np
from flint import arb, ctx

from taylor_verify.exact.balls import midpoint, upper
from taylor_verify.numbers.irrational import Irrational, ball
from taylor_verify.numbers.precision import exact_value

Array = np.ndarray[Any, Any]
Balls = Sequence[Sequence[arb]]

_SPARE_BITS: Final = 64


def _quaternion(R: Balls) -> list[arb]:
    """Return q from the column of 4 q q^T that has the largest diagonal entry."""
    trace = R[0][0] + R[1][1] + R[2][2]
    odd = [R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1]]
    rows = [[1 + trace, *odd]]
    for i in range(3):
        even = [R[i][k] + R[k][i] for k in range(3)]
        even[i] = 1 - trace + 2 * R[i][i]
        rows.append([odd[i], *even])
    k = max(range(4), key=lambda i: float(rows[i][i].mid()))
    q = [entry / (2 * rows[k][k].sqrt()) for entry in rows[k]]
    return [-entry for entry in q] if q[0] < 0 else q


def _zyx(R: Balls) -> list[arb]:
    square = R[2][1] * R[2][1] + R[2][2] * R[2][2]
    # A ball that holds zero has no root: either sign of the root is then allowed for.
    level = square.sqrt() if square > 0 else arb(0, ball(exact_value(upper(square))).sqrt())
    pairs = [(R[1][0], R[0][0]), (-R[2][0], level), (R[2][1], R[2][2])]
    if all(entry == 0 for entry in (R[0][0], R[1][0], R[2][1], R[2][2])):
        # Straight up or down yaw and roll turn about one axis: all of the turn is called yaw.
        pairs[0] = (-R[0][1], R[1][1])
    return [arb.atan2(sine, cosine) for sine, cosine in pairs]


FORMS: Final[Mapping[str, Callable[[Balls], list[arb]]]] = {
    "quaternion": _quaternion,
    "zyx": _zyx,
}


def in_form(form: str, matrix: Array, errors: Array, digits: int) -> tuple[Array, Array]:
    """Return an attitude in a form of FORMS and the errors of its entries, infinite at a singularity."""
    bits = ctx.prec
    ctx.prec = int(digits * log2(10)) + _SPARE_BITS
    try:
        entries = [_ball(v, e) for v, e in zip(matrix.flat, errors.flat, strict=True)]
        turned = FORMS[form]([entries[k : k + 3] for k in (0, 3, 6)])
        values = [midpoint(entry) for entry in turned]
        wide = [upper(abs(entry - entry.mid())) for entry in turned]
    finally:
        ctx.prec = bits
    return np.array(values, dtype=object), np.array(wide, dtype=object)


def _ball(value: Any, error: Any) -> arb:
    exact = value if isinstance(value, Fraction | Irrational) else exact_value(value)
    return ball(exact) + arb(0, ball(exact_value(error)))
