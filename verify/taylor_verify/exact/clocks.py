"""The loads of a manufactured motion as a quadratic system: cosines and sines carried as variables.

The equations z' = N(z) become z' = N(z) + z*' - N(z*), N quadratic and z* a linear form of the clock w:

w      1, then u = cos nu t and v = sin nu t of every wave; 1' = 0, u' = -nu v, v' = nu u

so that all is quadratic in z and w together, and autonomous. The 1 turns what is linear into products.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, NamedTuple

import numpy as np
from flint import arb, fmpq
from mpmath import mp

from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.precision import exact_value, floor_log2
from taylor_verify.scenes.tensors import Vector

Polynomial = Mapping[tuple[int, int], Fraction]
Floats = np.ndarray[Any, np.dtype[np.float64]]

# A float64 has less.
_FLOAT_DIGITS: Final = 20


def at(motion: Manufactured, elapsed: Fraction, digits: int) -> Vector:
    """The clock at a time since the start: at the start exact, elsewhere to so many digits."""
    if not elapsed:
        return (Fraction(1),) + (Fraction(1), Fraction(0)) * len(motion.waves)
    found = [Fraction(1)]
    for wave in motion.waves:
        angle = wave.frequency * elapsed
        # The digits of the angle before its point are lost to the ones behind it.
        with mp.workdps(digits + len(str(abs(angle.numerator) // angle.denominator))):
            c, s = mp.cos_sin(mp.convert(angle))
            found += [exact_value(c), exact_value(s)]
    return tuple(found)


def balls_at(motion: Manufactured, elapsed: Fraction) -> list[arb]:
    """The clock at a time since the start in balls, at the ambient precision."""
    found = [arb(1)]
    for wave in motion.waves:
        angle = wave.frequency * elapsed
        s, c = arb(fmpq(angle.numerator, angle.denominator)).sin_cos()
        found += [c, s]
    return found


def floats(motion: Manufactured | None, times: Sequence[Fraction]) -> Floats:
    """The clock at each time, (times, variables); no variables without a manufactured motion."""
    if motion is None:
        return np.zeros((len(times), 0))
    return np.array([[float(c) for c in at(motion, t, _FLOAT_DIGITS)] for t in times])


class Swing(NamedTuple):
    """S (d, n) and N (n, n) of z* = S w and w' = N w; no columns without a motion."""

    waves: Floats
    turning: Floats

    @property
    def fastest(self) -> float:
        """The highest frequency."""
        return float(np.abs(self.turning).max(initial=0.0))

    def at(self, clock: Floats) -> tuple[Floats, Floats]:
        """z* and its rate (..., d) at w (..., n)."""
        return clock @ self.waves.T, clock @ self.turning.T @ self.waves.T


def swing(motion: Manufactured | None, units: Vector, time: Fraction) -> Swing:
    """The clock of a motion that is counted in ``units``, with time in ``time``."""
    if motion is None:
        return Swing(np.zeros((len(units), 0)), np.zeros((0, 0)))
    columns = [motion.constant, *(v for wave in motion.waves for v in (wave.cosine, wave.sine))]
    rows = [[float(z / one) for z, one in zip(c, units, strict=True)] for c in columns]
    turning = np.zeros((len(columns), len(columns)))
    for k, wave in enumerate(motion.waves):
        u, v = 1 + 2 * k, 2 + 2 * k
        turning[v, u] = float(wave.frequency * time)
        turning[u, v] = -turning[v, u]
    return Swing(np.array(rows).T, turning)


def rates(motion: Manufactured, first: int) -> list[Polynomial]:
    """The rates of the clock, whose variables begin at ``first``."""
    found: list[Polynomial] = [{}]
    for k, wave in enumerate(motion.waves):
        u, v = first + 1 + 2 * k, first + 2 + 2 * k
        found += [{(first, v): -wave.frequency}, {(first, u): wave.frequency}]
    return found


def loads(free: Sequence[Polynomial], motion: Manufactured, first: int) -> list[Polynomial]:
    """z*' - N(z*) for the rates N = ``free`` of the variables that z* is of, the first ones of all."""
    forms = [_form(motion, i, first) for i in range(len(motion.constant))]
    found: list[Polynomial] = []
    for i, right in enumerate(free):
        total = _derivative(motion, i, first)
        for (a, b), coefficient in right.items():
            for p, x in forms[a].items():
                for q, y in forms[b].items():
                    pair = (min(p, q), max(p, q))
                    total[pair] = total.get(pair, Fraction(0)) - coefficient * x * y
        found.append({pair: c for pair, c in total.items() if c})
    return found


def exponent(motion: Manufactured) -> int | None:
    """log2 of the highest frequency; None of a motion that stands still."""
    return floor_log2(motion.highest) if motion.highest else None


def _form(motion: Manufactured, i: int, first: int) -> Mapping[int, Fraction]:
    """Component i of z* by the variables of the clock."""
    form = {first: motion.constant[i]}
    for k, wave in enumerate(motion.waves):
        form[first + 1 + 2 * k], form[first + 2 + 2 * k] = wave.cosine[i], wave.sine[i]
    return {place: c for place, c in form.items() if c}


def _derivative(motion: Manufactured, i: int, first: int) -> dict[tuple[int, int], Fraction]:
    """Component i of z*'."""
    found = {}
    for k, wave in enumerate(motion.waves):
        found[first, first + 1 + 2 * k] = wave.frequency * wave.sine[i]
        found[first, first + 2 + 2 * k] = -wave.frequency * wave.cosine[i]
    return found
