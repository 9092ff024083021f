"""Taylor coefficients in balls: of the turn and the way that the state makes of the frame.

Row k of a series holds the coefficients of order k times h^k, so that the step is s from 0 to 1.
"""

from __future__ import annotations

from typing import Final

from flint import arb, arb_mat, ctx

from taylor_verify.exact.enclosure.system import Forms, column

Rows = list[list[arb]]

# What the last coefficient of a step keeps: it is a last bit of the first one.
_LEAST_BITS: Final = 24
_ZERO: Final = arb(0)


def falling_bits(count: int) -> list[int]:
    """The precision of each of so many coefficients, from the ambient one down.

    A step is so long that the coefficients fall to the last bit of the first one. What is rounded off
    below that bit is in their balls, like every rounding.
    """
    return [_LEAST_BITS + ctx.prec * (count - k) // count for k in range(count)]


def frame_series(forms: Forms, state: Rows, h: arb, with_centre: bool) -> Rows:
    """The turn since the beginning of the step as a quaternion q, and the way d since then in body axes.

    q' = h q Omega/2 and d' = h (U + d x Omega), with Omega as a quaternion without a scalar part. A row
    holds four entries of q, which begins as 1, and with a centre three of d, which begins as 0.
    """
    order = len(state) - 1
    spins = _linear(forms.spin * h, state)
    size = 7 if with_centre else 4
    if with_centre:
        speeds = _linear(forms.velocity * h, state)
    rows = [[arb(1)] + [_ZERO] * (size - 1)]
    # One column for each order of q and d that is known; the spins stand in reverse.
    columns = arb_mat(size, order)
    backward = [entry for spin in spins[-2::-1] for entry in spin] + [_ZERO] * (3 * order)
    with ctx.workprec(ctx.prec):
        for k, bits in enumerate(falling_bits(order)):
            ctx.prec = bits
            for i, entry in enumerate(rows[k]):
                columns[i, k] = entry
            first = 3 * (order - 1 - k)
            spun = columns * arb_mat(order, 3, backward[first : first + 3 * order])
            p = spun.entries()
            fresh = [
                (-p[3] - p[7] - p[11]) / (2 * k + 2),
                (p[0] + p[8] - p[10]) / (2 * k + 2),
                (p[1] + p[9] - p[5]) / (2 * k + 2),
                (p[2] + p[4] - p[6]) / (2 * k + 2),
            ]
            if with_centre:
                carried = (p[17] - p[19], p[18] - p[14], p[13] - p[15])
                fresh += [(u + c) / (k + 1) for u, c in zip(speeds[k], carried, strict=True)]
            rows.append(fresh)
    return rows


def scaled(series: Rows, factor: arb) -> Rows:
    """The series of a step longer by this factor."""
    if not series:
        return []
    power, rows = factor, [series[0]]
    with ctx.workprec(ctx.prec):
        for row, bits in zip(series[1:], falling_bits(len(series) - 1), strict=True):
            ctx.prec = bits
            rows.append([entry * power for entry in row])
            power *= factor
    return rows


def value(series: Rows, s: arb) -> list[arb]:
    """The sum at s, every entry as one product of matrices."""
    powers = [arb(1)]
    for _ in series[1:]:
        powers.append(powers[-1] * s)
    flat = [entry for row in series for entry in row]
    row: list[arb] = (
        arb_mat(1, len(series), powers) * arb_mat(len(series), len(series[0]), flat)
    ).entries()
    return row


def _linear(form: arb_mat, series: Rows) -> Rows:
    return [(form * column(row)).entries() for row in series]
