"""The clock of a manufactured motion: its cosines and sines as the variables of a linear system.

w       1, then u = cos nu t and v = sin nu t of every wave
z*      S w, the motion that was chosen
w'      W w, that is 1' = 0, u' = -nu v, v' = nu u
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Final

import numpy as np
from flint import arb, ctx, fmpq

from taylor_verify.numbers.precision import floor_log2
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.manufactured import Manufactured

Exact = np.ndarray[Any, Any]
"""An object array of rationals."""
Floats = np.ndarray[Any, np.dtype[np.float64]]

# A float64 has less.
_FLOAT_BITS: Final = 66


def swing(motion: Manufactured) -> tuple[Exact, Exact]:
    """S (d, n) and W (n, n), exactly."""
    columns = [motion.constant, *(v for wave in motion.waves for v in (wave.cosine, wave.sine))]
    turning = np.full((len(columns), len(columns)), Fraction(0), dtype=object)
    for k, wave in enumerate(motion.waves):
        u, v = 1 + 2 * k, 2 + 2 * k
        turning[v, u], turning[u, v] = wave.frequency, -wave.frequency
    return np.array(columns, dtype=object).T, turning


def standing(d: int) -> Manufactured:
    """The motion of d components that are zero: its clock is the 1 alone."""
    return Manufactured((Fraction(0),) * d, ())


def start(motion: Manufactured) -> Vector:
    """The clock at the start."""
    return (Fraction(1),) + (Fraction(1), Fraction(0)) * len(motion.waves)


def balls_at(motion: Manufactured, elapsed: Fraction) -> list[arb]:
    """The clock at a time since the start in balls, at the ambient precision."""
    clock = [arb(1)]
    for wave in motion.waves:
        angle = wave.frequency * elapsed
        s, c = arb(fmpq(angle.numerator, angle.denominator)).sin_cos()
        clock += [c, s]
    return clock


def floats(motion: Manufactured | None, times: Sequence[Fraction]) -> Floats:
    """The clock at each time, (times, variables); its 1 alone without a manufactured motion."""
    if motion is None:
        return np.ones((len(times), 1))
    # The digits of the angle before its point are lost to the ones behind it.
    largest = 1 + motion.highest * max(map(abs, times), default=Fraction(0))
    with ctx.workprec(_FLOAT_BITS + floor_log2(largest)):
        return np.array([[float(c) for c in balls_at(motion, t)] for t in times])


def exponent(motion: Manufactured) -> int | None:
    """log2 of the highest frequency; None of a motion that stands still."""
    return floor_log2(motion.highest) if motion.highest else None
