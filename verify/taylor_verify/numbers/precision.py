"""The precision ladder: f32, f64, f80, f128 and mpN, and the rounding of exact numbers to a rung."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from decimal import MAX_EMAX, MIN_EMIN, Context, Decimal
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from taylor_verify.records.precisions import FORMATS, bits_of

if TYPE_CHECKING:
    from taylor_verify.numbers.irrational import Irrational

_LEAST_BITS = 24
# The errors in a verdict are doubles: 2^-1000 is one, and 2^-1075 would be rounded to zero.
_MOST_BITS = 1000
_USUAL_DIGITS = 15


@dataclass(frozen=True)
class Rung:
    """A binary floating-point format: ``bits`` of significand, exponents from ``emin`` to ``emax``.

    The largest number is below 2^(emax + 1), the smallest normal one is 2^emin. MPFR's exponent
    range is so wide that it counts as unbounded (None).
    """

    name: str
    bits: int
    emin: int | None = None
    emax: int | None = None

    @property
    def unit_roundoff(self) -> Fraction:
        """u = 2^-bits: the largest relative error of one rounding to nearest."""
        return Fraction(1, 2**self.bits)

    def round(self, value: Fraction) -> Fraction:
        """Return the nearest number of this format, ties to even; subnormals as IEEE 754 has them.

        Raises OverflowError where the format has no such number.
        """
        return self.round_scaled(value, 0)

    def round_scaled(self, value: Fraction, shift: int) -> Fraction:
        """Return the number of this format nearest to value times 2^shift; raises as `round` does."""
        if not value:
            return value
        significand, exponent = nearest(value.numerator, value.denominator, self.bits)
        exponent += shift
        if self.emin is not None and exponent + self.bits <= self.emin + 1:
            # The number may be subnormal: its last place is then that of the smallest normal number.
            value *= power_of_two(shift)
            quantum = power_of_two(max(floor_log2(value), self.emin) - self.bits + 1)
            return round(value / quantum) * quantum
        if self.emax is not None and exponent + significand.bit_length() > self.emax + 1:
            text = float_text(value * power_of_two(shift))
            raise OverflowError(f"{text} is outside the range of {self.name}")
        return dyadic(significand, exponent)

    def holds(self, value: Fraction) -> bool:
        """Return True if the value is a number of this format."""
        numerator, denominator = abs(value.numerator), value.denominator
        if denominator & (denominator - 1):
            return False
        zeros = (numerator & -numerator).bit_length() - 1 if numerator else 0
        lowest = zeros - denominator.bit_length() + 1
        beyond = numerator.bit_length() - denominator.bit_length() + 1
        return (
            beyond - lowest <= self.bits
            and (self.emin is None or lowest > self.emin - self.bits)
            and (self.emax is None or beyond <= self.emax + 1)
        )


_FORMATS = {
    each.name: Rung(each.name, each.bits, each.emin, each.emax) for each in FORMATS.values()
}


def rung(name: str | Rung) -> Rung:
    """Return the rung of a name, or the Rung given. Raises ValueError for an unknown name."""
    if isinstance(name, Rung):
        return name
    bits = 0
    if isinstance(name, str):
        if name in _FORMATS:
            return _FORMATS[name]
        bits = bits_of(name)
    if not _LEAST_BITS <= bits <= _MOST_BITS:
        raise ValueError(
            f"expected a rung {', '.join(FORMATS)} or mpN with {_LEAST_BITS} <= N <= {_MOST_BITS} "
            f"bits, got {name!r:.60}"
        )
    return Rung(name, bits)


def nearest(numerator: int, denominator: int, bits: int) -> tuple[int, int]:
    """Return significand and exponent of the number of this many bits nearest to a quotient, ties to even.

    The denominator is positive. The significand has all its bits, or is the power of two above them,
    after a carry. It is 0 with the exponent 0 if the quotient is zero.
    """
    if numerator == 0:
        return 0, 0
    size = abs(numerator)
    # One or two bits more than the result has: together with the remainder they decide the rounding.
    exponent = size.bit_length() - denominator.bit_length() - bits - 1
    if exponent > 0:
        whole, rest = divmod(size, denominator << exponent)
    else:
        whole, rest = divmod(size << -exponent, denominator)
    surplus = whole.bit_length() - bits
    significand, low, half = whole >> surplus, whole & ((1 << surplus) - 1), 1 << (surplus - 1)
    if low > half or (low == half and (rest or significand & 1)):
        significand += 1
    return (significand if numerator > 0 else -significand), exponent + surplus


def rounded(value: Fraction, bits: int) -> Fraction:
    """Return the number of this many bits nearest to a value, ties to even; no exponent is too large."""
    significand, exponent = nearest(value.numerator, value.denominator, bits)
    return significand * power_of_two(exponent)


def dyadic(significand: int, exponent: int) -> Fraction:
    """Return significand times 2^exponent."""
    return (
        Fraction(significand << exponent)
        if exponent >= 0
        else Fraction(significand, 1 << -exponent)
    )


@lru_cache(maxsize=4096)
def power_of_two(exponent: int) -> Fraction:
    """Return 2^exponent."""
    # The exponent may be gmpy2's integer, and the cached Fraction is to be made of Python's.
    places = int(exponent)
    return Fraction(1 << places) if places >= 0 else Fraction(1, 1 << -places)


def floor_log2(value: Fraction | Irrational) -> int:
    """Return the largest e with 2^e <= |value|, for a value that is not zero."""
    if not isinstance(value, Fraction | int):
        return value.floor_log2()
    numerator, denominator = abs(value.numerator), value.denominator
    estimate = numerator.bit_length() - denominator.bit_length()
    is_reached = denominator << max(estimate, 0) <= numerator << max(-estimate, 0)
    return estimate if is_reached else estimate - 1


def hexadecimal(value: Fraction) -> str:
    """Return a dyadic rational as an exact hexadecimal float, 0x<integer>p<exponent>, as C reads it."""
    sign = "-" if value < 0 else ""
    return f"{sign}0x{abs(value.numerator):x}p{1 - value.denominator.bit_length():+d}"


def exact_value(number: Any) -> Fraction:
    """Return the rational that a finite binary number (float, NumPy float, mpf) is.

    mpmath's integers may be gmpy2's, and a Fraction made of those is not quite a Fraction.
    """
    numerator, denominator = number.as_integer_ratio()
    return Fraction(int(numerator), int(denominator))


def shortest_decimal(value: Fraction, bits: int) -> str:
    """Return the shortest decimal that a rounding to this many bits takes to the same number as a value.

    Numbers of usual size are written without an exponent.
    """
    asked = rounded(value, bits)
    for digits in itertools.count(1):
        context = Context(prec=digits, Emin=MIN_EMIN, Emax=MAX_EMAX)
        decimal = context.divide(Decimal(asked.numerator), Decimal(asked.denominator))
        if rounded(Fraction(decimal), bits) == asked:
            break
    return decimal_text(decimal)


def as_decimal(value: Fraction) -> Decimal | None:
    """Return the decimal that equals the value, without zeros at its end; None if it has no end."""
    # A denominator of twos and fives alone has no more digits than bits behind the point.
    digits = len(str(value.numerator)) + value.denominator.bit_length()
    context = Context(prec=digits + 1, Emin=MIN_EMIN, Emax=MAX_EMAX)
    exact = context.divide(Decimal(value.numerator), Decimal(value.denominator))
    return exact.normalize(context) if Fraction(exact) == value else None


def decimal_text(number: Decimal) -> str:
    """Return a decimal as it is; a number of usual size is written without an exponent."""
    is_usual = -_USUAL_DIGITS <= number.adjusted() <= _USUAL_DIGITS
    return format(number, "f") if is_usual else str(number).lower()


def held_exactly(value: Fraction) -> Any:
    """Return the mpf that equals a dyadic rational, whatever the ambient precision of mpmath."""
    from mpmath import libmp, mp

    return mp.make_mpf(libmp.from_man_exp(value.numerator, 1 - value.denominator.bit_length()))


def float_text(value: Fraction | Irrational) -> str:
    """Return a short decimal for messages, also where a double cannot hold the value."""
    from mpmath import libmp

    if not isinstance(value, Fraction | int):
        value = value.near()

    return str(libmp.to_str(libmp.from_rational(value.numerator, value.denominator, 53), 6))


def double_text(value: Fraction | float) -> str:
    """Return every digit of the double nearest to the value; a short decimal where there is none."""
    try:
        return repr(float(value))
    except OverflowError:
        return float_text(Fraction(value))
