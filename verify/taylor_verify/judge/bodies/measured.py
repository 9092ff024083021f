"""The errors of many free rigid bodies at once: of omega beside the exact motion, and of what is conserved.

All sizes are relative, so that the units are those of each body: its K and H are of size one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from taylor_verify.exact.euler.tops import Tops, cross
from taylor_verify.exact.pairs import Pairs, difference, two_sum
from taylor_verify.judge.bodies.shifts import Errors, Shifts, shifts
from taylor_verify.records.quantities import QUANTITIES

Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Quantity:
    """The ``errors`` (n, m) of a quantity over its ``scale`` (n); ``change`` (n) is the last with its sign.

    ``widths`` (n, m) are how wide the truth is.
    """

    name: str
    unit: str
    errors: Floats
    widths: Floats
    scale: Floats
    change: Floats | None = None


@dataclass(frozen=True)
class Measured:
    """The errors of omega, T and H2 of n bodies, the exact motion (3, n, m), and shifts of time."""

    omega: Quantity
    conserved: tuple[Quantity, Quantity]
    truth: Floats
    shifts: Shifts


def measured(tops: Tops, answer: Floats, times: Floats) -> Measured:
    """Compare answers (3, n, m), the momenta at these times (n, m), with the exact motions."""
    K, start = tops.inverse[:, :, None], tops.momentum.hi
    truth = tops.motion(times)
    with np.errstate(all="ignore"):
        # Neighbours have an exact difference; of other numbers it is rounded by a part of itself.
        off = K * ((answer - truth.hi) - truth.lo)
        omega = K * truth.hi
        scale = np.max(lengths(omega), axis=1)
        size = scale[:, None]
        errors = Quantity(
            "omega",
            QUANTITIES["omega"].unit,
            lengths(off) / size,
            lengths(K * truth.radius()) / size,
            scale,
        )
        rate = cross(truth.hi, omega)
        velocity = K * rate
        acceleration = K * (cross(rate, omega) + cross(truth.hi, velocity))
        moved = lengths(K * (answer - answer[:, :, :1])) / size
        found = shifts(Errors(off / size, velocity / size, acceleration / size, moved, times))
        ones = np.ones_like(K)
        conserved = (_drift("T", K / 2, answer, start), _drift("H2", ones, answer, start))
    return Measured(errors, conserved, truth.hi, found)


def _drift(name: str, weights: Floats, answer: Floats, start: Floats) -> Quantity:
    """The drift of sum w_i H_i^2: of w (H - H_0)(H + H_0), whose factors are pairs of doubles."""
    begin = start[:, :, None]
    steps = [
        difference(row, first) * Pairs(*two_sum(row, first)) * weight
        for row, first, weight in zip(answer, begin, weights, strict=True)
    ]
    change = steps[0] + steps[1] + steps[2]
    scale = np.sum(weights[:, :, 0] * start**2, axis=0)
    signed = change.hi / scale[:, None]
    widths = np.zeros_like(signed)
    return Quantity(name, f"scale of {name}", abs(signed), widths, scale, signed[:, -1])


def lengths(vectors: Floats) -> Floats:
    """Return the lengths (...) of vectors (3, ...)."""
    found: Floats = np.sqrt(np.sum(vectors * vectors, axis=0))
    return found
