"""Units in which a problem has size one: powers of two, so that a change of units has no rounding.

heyoka's error control is absolute below one and relative above; in these units it is relative to
the motion itself, whatever units the scene uses.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Final

from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import floor_log2, power_of_two
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.named_numbers import Dimension, Part, Value, entrywise

# So many units a load may give to a momentum, and within a unit of time: powers of that stay numbers.
_MOST_UNITS: Final = 16


@dataclass(frozen=True)
class Units:
    """scaled value x unit = physical value; each unit is a power of two.

    ``momentum`` is that of H (Euler) or y (Kirchhoff), ``impulse`` that of x. ``path`` is the unit of the
    centre over that of other lengths: a body at rest in size may go far. ``own`` are those of the
    components of the scene's own continuous states.
    """

    time: Fraction
    momentum: Fraction
    impulse: Fraction = Fraction(1)
    path: Fraction = Fraction(1)
    own: Vector = ()

    @property
    def length(self) -> Fraction:
        """Unit of a length: U = B y, times time."""
        return self.momentum / self.impulse

    @property
    def centre(self) -> Fraction:
        """Unit of the centre among the states."""
        return self.length * self.path

    @property
    def mass(self) -> Fraction:
        """Unit of a mass: an impulse per velocity."""
        return self.impulse * self.time / self.length

    def of(self, dimension: Dimension) -> Fraction:
        """Return the unit of any quantity."""
        return power_of_two(self.exponent(dimension))

    def exponent(self, dimension: Dimension) -> int:
        """Return the power of two that the unit of any quantity is."""
        mass, length, time = self._exponents
        return mass * dimension.mass + length * dimension.length + time * dimension.time

    @cached_property
    def _exponents(self) -> tuple[int, int, int]:
        time, momentum, impulse = map(_exponent, (self.time, self.momentum, self.impulse))
        length = momentum - impulse
        return impulse + time - length, length, time

    def counted(self, part: Part, value: Value) -> Value:
        """Return a part of a body or a state, counted in its unit."""
        return _scaled(-self.exponent(part.dimension), value)

    def physical(self, part: Part, value: Value) -> Value:
        """Return a part of a body or a state from its number in units."""
        return _scaled(self.exponent(part.dimension), value)


def _scaled(shift: int, value: Value) -> Value:
    if not shift:
        return value
    factor = power_of_two(shift)
    return entrywise(lambda entry: entry * factor if entry else entry, value)


def _exponent(power: Fraction) -> int:
    return power.numerator.bit_length() - power.denominator.bit_length()


def largest(matrix: Iterable[Vector]) -> Fraction:
    """Return the largest entry."""
    return max(abs(entry) for row in matrix for entry in row)


def size(vector: Vector) -> Fraction:
    """Return a power of two within a factor of two of the norm; 0 for the zero vector."""
    return root(tensors.dot(vector, vector))


def least_rate(load: Fraction, unit: Fraction) -> Fraction:
    """Return the least rate of a unit of time, within which a load gives few units to a momentum."""
    return load / unit / _MOST_UNITS


def least_unit(load: Fraction, time: Fraction) -> Fraction:
    """Return the least unit of a momentum, of which a load gives few within a time; 0 without a load."""
    return binary(load * time / _MOST_UNITS)


def push_time(span: Fraction, *squares: Fraction) -> Fraction:
    """Return about the time for which a load pushes in one direction, at most the span.

    ``squares`` are those of rates at which the body turns under it.
    """
    return min((span, *(1 / root(square) for square in squares if square)))


def root(squared: Fraction) -> Fraction:
    """Return a power of two within a factor of two of the square root; 0 for 0."""
    return power_of_two(floor_log2(squared) // 2) if squared else Fraction(0)


def binary(value: Fraction) -> Fraction:
    """Return the power of two just below the value; 0 for 0."""
    return power_of_two(floor_log2(value)) if value else Fraction(0)
