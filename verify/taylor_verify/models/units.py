"""Units in which a problem has size one: exact powers of two, so that changing them rounds nothing.

heyoka's error control is absolute below one and relative above; in these units it is relative to
the motion itself, whatever units the scene uses.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from taylor_verify.scenes import tensors
from taylor_verify.scenes.parts import Dimension, Part, Value, entrywise
from taylor_verify.scenes.precision import floor_log2, power_of_two
from taylor_verify.scenes.tensors import Vector


@dataclass(frozen=True)
class Units:
    """scaled value x unit = physical value; each unit is a power of two.

    ``momentum`` is that of H (Euler) or y (Kirchhoff), ``impulse`` that of x.
    """

    time: Fraction
    momentum: Fraction
    impulse: Fraction = Fraction(1)

    @property
    def length(self) -> Fraction:
        """Unit of the centre: U = B y, times time."""
        return self.momentum / self.impulse

    @property
    def mass(self) -> Fraction:
        """Unit of a mass: an impulse per velocity."""
        return self.impulse * self.time / self.length

    def of(self, dimension: Dimension) -> Fraction:
        """Return the unit of any quantity."""
        time, momentum, impulse = map(_exponent, (self.time, self.momentum, self.impulse))
        length = momentum - impulse
        mass = impulse + time - length
        return power_of_two(
            mass * dimension.mass + length * dimension.length + time * dimension.time
        )

    def counted(self, part: Part, value: Value) -> Value:
        """Return a part of a body or a state, counted in its unit."""
        return _scaled(1 / self.of(part.dimension), value)

    def physical(self, part: Part, value: Value) -> Value:
        """Return the part that is so much in its unit."""
        return _scaled(self.of(part.dimension), value)


def _scaled(factor: Fraction, value: Value) -> Value:
    return entrywise(lambda entry: entry * factor if entry else entry, value)


def _exponent(power: Fraction) -> int:
    return power.numerator.bit_length() - power.denominator.bit_length()


def largest(matrix: Iterable[Vector]) -> Fraction:
    """Return the largest entry."""
    return max(abs(entry) for row in matrix for entry in row)


def size(vector: Vector) -> Fraction:
    """Return a power of two within a factor of two of the norm; 0 for the zero vector."""
    squared = tensors.dot(vector, vector)
    return root(squared) if squared else Fraction(0)


def root(squared: Fraction) -> Fraction:
    """Return a power of two within a factor of two of the square root."""
    return power_of_two(floor_log2(squared) // 2)


def binary(value: Fraction) -> Fraction:
    """Return the power of two just below the value; 0 for 0."""
    return power_of_two(floor_log2(value)) if value else Fraction(0)
