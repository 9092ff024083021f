"""Rationals that stand for irrational numbers of a scene, such as 2 degrees or the mass of an ellipsoid.

Models and solvers round every number to their own precision, so a scene holds the rational of 400 bits
that is nearest to an irrational number. The exact motion is that of the number, which the rational carries.
Whatever is computed from such a rational, its rounding included, is a plain Fraction.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Final, Self

from taylor_verify.numbers.irrational import Irrational
from taylor_verify.numbers.precision import rounded
from taylor_verify.scenes.named_numbers import Value, entrywise

STAND_IN_BITS: Final = 400
"""120 digits, beyond every precision of a solver."""
_SPARE_BITS: Final = 64


class StandIn(Fraction):
    """The rational of 400 bits nearest to an irrational number, ``exactly``."""

    exactly: Irrational

    def __new__(cls, nearest: Fraction, exactly: Irrational) -> Self:
        self = super().__new__(cls, nearest)
        self.exactly = exactly
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return StandIn, (Fraction(self.numerator, self.denominator), self.exactly)

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self


def stand_in(number: Any) -> Fraction:
    """Return the rational that stands for a number; a rational number itself."""
    if not isinstance(number, Irrational):
        return Fraction(number)
    return StandIn(rounded(number.near(STAND_IN_BITS + _SPARE_BITS), STAND_IN_BITS), number)


def written(value: Value) -> Any:
    """Return a number, vector or matrix with the irrational numbers that its rationals stand for."""
    return entrywise(lambda n: n.exactly if isinstance(n, StandIn) else n, value)
