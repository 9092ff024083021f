"""The errors of many free rigid bodies at once: errors of the states, and drifts of conserved quantities.

All sizes are relative to the units of each body, in which its K and H have size one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from taylor_verify.exact.euler.tops import Tops, between, cross
from taylor_verify.judge.bodies.shifts import Errors, Shifts, shifts
from taylor_verify.records.quantities import QUANTITIES
from taylor_verify.scenes.pairs import Pairs, difference, product, two_sum

Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Quantity:
    """The ``errors`` (n, m) of a quantity over its ``scale`` (n); ``change`` (n) is the signed last error.

    ``widths`` (n, m) are the error bounds of the truth.
    """

    name: str
    unit: str
    errors: Floats
    widths: Floats
    scale: Floats
    change: Floats | None = None


@dataclass(frozen=True)
class Measured:
    """The errors of n bodies; ``shifts`` belong to the ``states``, and ``excess`` (n, m) is |q| - 1.

    ``momentum`` (3, n, m) is the exact motion.
    """

    states: tuple[Quantity, ...]
    shifts: tuple[Shifts, ...]
    conserved: tuple[Quantity, ...]
    momentum: Floats
    excess: Floats | None = None


def measured(tops: Tops, answer: Floats, times: Floats) -> Measured:
    """Compare answers (3 or 7, n, m) with the truth: momenta and quaternions at these times (n, m)."""
    K, start = tops.inverse[:, :, None], tops.momentum.hi
    truth = tops.states(times)
    own, H = answer[:3], truth.momentum.hi
    with np.errstate(all="ignore"):
        # The difference of numbers that are near each other is exact; other differences have a relative
        # rounding.
        off = (own - H) - truth.momentum.lo
        omega = K * H
        scale = np.max(lengths(omega), axis=1)
        size = scale[:, None]
        widths = lengths(K * truth.momentum.radius()) / size
        errors = _state("omega", lengths(K * off) / size, widths, scale)
        rate = cross(H, omega)
        velocity = K * rate
        acceleration = lengths(K * (cross(rate, omega) + cross(H, velocity))) / size
        moved = lengths(K * (own - own[:, :, :1])) / size
        shifted = shifts(Errors(K * off / size, velocity / size, acceleration, moved, times))
        ones = np.ones_like(K)
        conserved = (_drift("T", K / 2, own, start), _drift("H2", ones, own, start))
        if truth.quaternion is None:
            return Measured((errors,), (shifted,), conserved, H)
        q = answer[3:]
        turn, widths = _turn(q, truth.quaternion)
        attitude = _state("attitude", lengths(turn), widths, np.ones_like(scale))
        acceleration = np.hypot(np.sum(omega**2, axis=0), lengths(velocity))
        begin = np.broadcast_to(q[:, :, :1], q.shape)
        moved = 2 * lengths(between(begin, q))
        turned = shifts(Errors(turn, omega, acceleration, moved, times))
        in_space = lengths(off + cross(turn, H))
        size = np.max(lengths(H), axis=1)
        drift = Quantity(
            "H_space",
            "scale of H_space",
            in_space / size[:, None],
            np.zeros_like(in_space),
            size,
        )
        squares = [product(entry, entry) for entry in q]
        excess = (squares[0] + squares[1] + squares[2] + squares[3] - 1.0).hi / 2
        every = (*conserved, drift)
        return Measured((errors, attitude), (shifted, turned), every, H, excess)


def _turn(q: Floats, truth: Pairs) -> tuple[Floats, Floats]:
    """Return the turn (3, n, m) from the truth to quaternions q or -q, in body axes, and its width."""
    sign = np.where(np.sum(q * truth.hi, axis=0) < 0, -1.0, 1.0)
    off = (sign * q - truth.hi) - truth.lo
    # Twice the quaternion's radius bounds its change; a turn changes by less than twice that.
    return 2 * between(truth.hi, off), 4 * lengths(truth.radius())


def _state(name: str, errors: Floats, widths: Floats, scale: Floats) -> Quantity:
    return Quantity(name, QUANTITIES[name].unit, errors, widths, scale)


def _drift(name: str, weights: Floats, answer: Floats, start: Floats) -> Quantity:
    """Return the drift of sum w_i H_i^2, as sum w (H - H_0)(H + H_0) in pairs of doubles."""
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
    norms: Floats = np.sqrt(np.sum(vectors * vectors, axis=0))
    return norms
