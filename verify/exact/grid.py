"""The fixed point of the Taylor recursion: its bits, its orders, its steps, and noise in its last bits.

A fixed point loses what lies below its last bits: a tiny component of the start, a tiny moment, the
product of a tiny coefficient. Two runs that lose the same datum would agree on a motion without it.
So every step begins with noise: each component, unless the equations keep it at zero for ever, is
moved at random by as much as the roundings of one step may move it. An unstable motion makes of the
noise what it makes of a lost datum, and two runs with unlike noise then disagree.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from random import Random
from typing import Final

from mpmath import libmp

from verify.scenes.precision import floor_log2, power_of_two

# mpmath's integers: those of gmpy2 where it is installed, which are twice as fast, else Python's.
Integer: Final = libmp.MPZ
# A step of radius/e^2 is the cheapest for the quadratic cost of a convolution: bits * ln 2 / 2
# orders; the linear cost asks for a few more. Two ratios, taken in turn every STEP_DIGITS: two
# evaluations that are compared differ by an odd number of these, and so in order, step and noise too.
_ORDERS_PER_BIT: Final = (0.36, 0.40)
STEP_DIGITS: Final = 6
# Steps are cut to so many bits: exact, and cheap to multiply by.
_STEP_BITS: Final = 6


@dataclass(frozen=True)
class Grid:
    """The fixed point: integers count 2^-bits of a unit.

    A series has at most ``order`` terms, the last of which is to fall below 2^slack last bits.
    ``parity`` is 0 or 1: grids of unlike parity share neither order per bit, nor a step, nor noise.
    """

    bits: int
    slack: int
    parity: int

    @property
    def orders_per_bit(self) -> float:
        return _ORDERS_PER_BIT[self.parity]

    @property
    def order(self) -> int:
        return ceil((self.bits - self.slack) * self.orders_per_bit)

    @property
    def last_terms(self) -> int:
        """How many terms tell where a series ends: an eighth, so that gaps in it do not deceive."""
        return max(self.order // 8, 3) + 1

    def integers(self, values: Iterable[Fraction]) -> list[int]:
        return [Integer(round(value * 2**self.bits)) for value in values]

    def step(self, width: Fraction, log2_factor: float) -> Fraction:
        """The width times 2^log2_factor, cut to six bits; the last bit is the parity.

        So no step on one grid equals a step on a grid of the other parity.
        """
        whole = int(log2_factor // 1)
        wide = width * power_of_two(whole) * Fraction(2.0 ** (log2_factor - whole))
        unit = power_of_two(floor_log2(wide) - _STEP_BITS + 1)
        count = int(wide / unit)
        if count % 2 != self.parity:
            # 31 has one bit less; 63 halves is the odd number of six bits below 32.
            size = abs(count) - 1
            count = (size if size >> _STEP_BITS - 1 else 2 * size + 1) * (1 if count > 0 else -1)
            unit = unit if size >> _STEP_BITS - 1 else unit / 2
        return count * unit

    def noise(self) -> Iterator[int]:
        """Endless random integers, as large as what the roundings of one step may leave."""
        draw, largest = Random(self.parity), 1 << self.slack
        while True:
            yield Integer(draw.randint(-largest, largest))
