"""Taylor coefficients in balls: of the state, and of the turn and the path that it makes of the frame.

Row k of a series holds the coefficients of order k times h^k, so that the step is s from 0 to 1.
"""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb, arb_mat

from taylor_verify.exact.enclosure.system import Balls, column

Series = list[list[arb]]


def state_series(system: Balls, point: Sequence[arb], h: arb, order: int) -> Series:
    """The coefficients of the motion from a point, up to ``order``."""
    n = len(point)
    hessian = system.hessian * h
    rows = [list(point)]
    forward, backward = list(point), list(point)
    for k in range(order):
        # Each product of two unlike orders counts once in H, and twice in the symmetric Hessian.
        half = (k + 1) // 2
        left, right = forward[: half * n], backward[: half * n]
        if k % 2 == 0:
            left = forward[: (half + 1) * n]
            right = right + [z / 2 for z in rows[half]]
        count = len(left) // n
        products = arb_mat(count, n, left).transpose() * arb_mat(count, n, right)
        rates = (hessian * column(products.entries())).entries()
        fresh = [rate / (k + 1) for rate in rates]
        if k == 0:
            fresh = [z + h * c for z, c in zip(fresh, system.constant, strict=True)]
        rows.append(fresh)
        forward += fresh
        backward[:0] = fresh
    return rows


def frame_series(
    system: Balls, state: Series, h: arb, with_centre: bool
) -> tuple[list[list[arb]], Series]:
    """The turn G, nine entries row by row, and the path b: G' = h G [Omega]x, b' = h G U.

    G begins as 1 and b as 0. Without a centre the path has no rows.
    """
    order = len(state) - 1
    forms = [_linear(system.spin, z) for z in state]
    if with_centre:
        assert system.velocity is not None
        forms = [f + _linear(system.velocity, z) for f, z in zip(forms, state, strict=True)]
    width = len(forms[0])
    turns = [[arb(int(i == j)) for i in range(3) for j in range(3)]]
    path = [[arb(0)] * 3] if with_centre else []
    forward, backward = list(turns[0]), list(forms[0])
    for k in range(order):
        products = arb_mat(k + 1, 9, forward).transpose() * arb_mat(k + 1, width, backward)
        factor = h / (k + 1)
        fresh = [
            (products[3 * r + i, j] - products[3 * r + j, i]) * factor
            for r in range(3)
            for i, j in ((1, 2), (2, 0), (0, 1))
        ]
        turns.append(fresh)
        forward += fresh
        backward[:0] = forms[k + 1]
        if with_centre:
            path.append(
                [
                    sum((products[3 * r + i, 3 + i] for i in range(3)), arb(0)) * factor
                    for r in range(3)
                ]
            )
    return turns, path


def scaled(series: Series, factor: arb) -> Series:
    """The series of a step longer by this factor."""
    power, rows = arb(1), []
    for row in series:
        rows.append([entry * power for entry in row])
        power *= factor
    return rows


def value(series: Series, s: arb) -> list[arb]:
    """The sum at s, every entry as one product of matrices."""
    powers = [arb(1)]
    for _ in series[1:]:
        powers.append(powers[-1] * s)
    flat = [entry for row in series for entry in row]
    row: list[arb] = (
        arb_mat(1, len(series), powers) * arb_mat(len(series), len(series[0]), flat)
    ).entries()
    return row


def _linear(form: arb_mat, state: Sequence[arb]) -> list[arb]:
    entries: list[arb] = (form * column(state)).entries()
    return entries
