"""Sample times as numbers of a rung, rounded all at once where that is provably one rounding each.

Equally spaced times are quotients (a + k b)/d of whole numbers. If numbers of the rung can represent
numerator and denominator exactly, the IEEE 754 division rounds the quotient once to nearest. A factor that
is a power of two changes no digit inside the range of the rung.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any, Final

import numpy as np

from taylor_verify.numbers.precision import Rung, exact_value, floor_log2
from taylor_verify.records.precisions import FORMATS
from taylor_verify.scenes.instants import EquallySpaced, Instants
from taylor_verify.scenes.motion import Clock

_HARDWARE: Final[dict[str, Any]] = {
    number_format.name: np.dtype(number_format.numpy).type
    for number_format in FORMATS.values()
    if number_format.numpy
}
# The numerators are formed in 64-bit integers, one bit of which is the sign.
_INTEGER_BITS: Final = 63


class TypedTimes(Instants):
    """Numbers of a rung of the hardware: ``typed`` holds each of them exactly, as a NumPy array."""

    def __init__(self, typed: np.ndarray[Any, Any]) -> None:
        super().__init__(len(typed), lambda k: exact_value(typed[k]))
        self.typed = typed

    @property
    def are_distinct(self) -> bool:
        return bool((self.typed[1:] != self.typed[:-1]).all())


def rounded_times(clock: Clock, unit: Fraction, rung: Rung) -> Sequence[Fraction]:
    """Return the time since the initial state over ``unit``, a power of two, each rounded once to the rung.

    Raises OverflowError for a time outside the range of the rung.
    """
    if isinstance(clock.instants, EquallySpaced):
        a, b, d = clock.instants.over_common_denominator(clock.start)
        count, shift = len(clock.instants), -floor_log2(unit)
        largest = max(abs(a), abs(a + (count - 1) * b))
        if _is_held(largest, d, rung) and _is_in_range(largest, d, shift, rung):
            kind = _HARDWARE[rung.name]
            numerators = (a + b * np.arange(count, dtype=np.int64)).astype(kind)
            return TypedTimes(np.ldexp(numerators / kind(d), shift))
    return tuple(rung.round(t / unit) for t in clock.elapsed)


def are_distinct(times: Sequence[Fraction]) -> bool:
    """Return True if no two times are equal; they are monotonic, because rounding preserves the order."""
    if isinstance(times, TypedTimes):
        return times.are_distinct
    return all(time != following for time, following in pairwise(times))


def _is_in_range(largest: int, d: int, shift: int, rung: Rung) -> bool:
    """Return True if every quotient n/d 2^shift with 0 < n <= largest is a normal number of the rung."""
    if rung.emin is None or rung.emax is None:
        return True
    return shift - d.bit_length() > rung.emin and largest.bit_length() + shift < rung.emax


def _is_held(largest: int, d: int, rung: Rung) -> bool:
    """Return True if the rung is a hardware type that can represent all these whole numbers."""
    kind = _HARDWARE.get(rung.name)
    if kind is None or np.finfo(kind).nmant + 1 != rung.bits:
        return False
    return max(largest, d).bit_length() <= min(rung.bits, _INTEGER_BITS)
