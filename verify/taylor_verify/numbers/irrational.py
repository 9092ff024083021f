"""Numbers of a field Q(c1, c2, ...) of real constants, such as pi and Lamb's integrals, held exactly.

A number is a quotient of two polynomials in the constants, with integer coefficients and without a common
factor. A constant that cancels is gone, and a number without constants is a Fraction again: so two numbers
are equal if their difference vanishes as a polynomial. They are different if a ball about the difference
excludes zero. Where neither is shown, because the constants may obey a relation that nobody has proven or
refuted, Undecided is raised: no decision is ever taken on a rounded number.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from numbers import Rational
from typing import Any, Final

from flint import Ordering, arb, ctx, fmpq, fmpz_mpoly, fmpz_mpoly_ctx

# More constants than any scene has: pi, two of Lamb's three integrals, and three tangents or roots.
_PLACES: Final = fmpz_mpoly_ctx.get(("c1", "c2", "c3", "c4", "c5", "c6"), Ordering.lex)
_ONE: Final = _PLACES.constant(1)
_FIRST_GUARD_BITS: Final = 32
_SIGN_BITS: Final = 8
# A difference of polynomials of height H and degree d that is not zero is hardly ever below H^-(d + 1).
_MOST_BITS: Final = 4096
_MOST_TIMES_HEIGHT: Final = 4
# Enclosures of a constant are shared by precisions up to the next multiple.
_BITS_APART: Final = 256
_NEAR_BITS: Final = 128


class Undecided(ArithmeticError):
    """The error for a comparison of two numbers that is neither proven nor refuted."""


class Constant(ABC):
    """A real constant that no formula here treats as rational. Equal constants compare equal."""

    @abstractmethod
    def evaluated(self) -> arb:
        """Return a ball about the constant, computed at the ambient precision."""


@dataclass(frozen=True)
class Pi(Constant):
    """The constant pi."""

    def __str__(self) -> str:
        return "pi"

    def evaluated(self) -> arb:
        return arb.pi()


class Irrational:
    """A number of the field of its ``constants``. It adds, multiplies and compares with rationals too.

    A number of two such fields lies in the field of all their constants. Comparisons, ``bool`` and ``abs``
    raise Undecided where a sign is not proven.
    """

    __slots__ = ("__dict__", "constants", "denominator_polynomial", "numerator_polynomial")

    def __init__(
        self, constants: tuple[Constant, ...], numerator: fmpz_mpoly, denominator: fmpz_mpoly
    ) -> None:
        self.constants = constants
        self.numerator_polynomial, self.denominator_polynomial = numerator, denominator

    # Arithmetic.

    def __add__(self, other: Any) -> Any:
        return self._combined(other, lambda a, b, c, d: (a * d + c * b, b * d))

    def __sub__(self, other: Any) -> Any:
        return self._combined(other, lambda a, b, c, d: (a * d - c * b, b * d))

    def __rsub__(self, other: Any) -> Any:
        return self._combined(other, lambda a, b, c, d: (c * b - a * d, b * d))

    def __mul__(self, other: Any) -> Any:
        return self._combined(other, lambda a, b, c, d: (a * c, b * d))

    def __truediv__(self, other: Any) -> Any:
        return self._combined(other, lambda a, b, c, d: (a * d, b * c))

    def __rtruediv__(self, other: Any) -> Any:
        return self._combined(other, lambda a, b, c, d: (c * b, d * a))

    __radd__, __rmul__ = __add__, __mul__

    def __pow__(self, power: Any) -> Any:
        if not isinstance(power, int):
            return NotImplemented
        above, below = self.numerator_polynomial, self.denominator_polynomial
        if power < 0:
            above, below = below, above
        return _number(self.constants, above ** abs(power), below ** abs(power))

    def __neg__(self) -> Irrational:
        return Irrational(self.constants, -self.numerator_polynomial, self.denominator_polynomial)

    def __pos__(self) -> Irrational:
        return self

    def __abs__(self) -> Irrational:
        return self if self.sign > 0 else -self

    def _combined(self, other: Any, rule: Callable[..., tuple[fmpz_mpoly, fmpz_mpoly]]) -> Any:
        """Return the rule for a/b and c/d, this number and the other one."""
        constants = self.constants
        if isinstance(other, Irrational):
            constants = _joined(constants, other.constants)
            c, d = other._polynomials_in(constants)
        elif isinstance(other, Rational):
            c, d = _constant(other.numerator), _constant(other.denominator)
        else:
            return NotImplemented
        a, b = self.numerator_polynomial, self.denominator_polynomial
        return _number(constants, *rule(a, b, c, d))

    def _polynomials_in(self, constants: tuple[Constant, ...]) -> tuple[fmpz_mpoly, fmpz_mpoly]:
        """Return numerator and denominator as polynomials in these constants, which hold its own."""
        above, below = self.numerator_polynomial, self.denominator_polynomial
        if constants[: len(self.constants)] == self.constants:
            return above, below
        variables = _PLACES.gens()
        places = [variables[constants.index(constant)] for constant in self.constants]
        unused = variables[len(places) :]
        return above.compose(*places, *unused), below.compose(*places, *unused)

    # Comparisons.

    @cached_property
    def sign(self) -> int:
        """+1 or -1, proven. Raises Undecided where the number may be zero."""
        return 1 if self.enclosure(_SIGN_BITS) > 0 else -1

    def __bool__(self) -> bool:
        return self.sign != 0

    def __eq__(self, other: object) -> bool:
        difference = self.__sub__(other)
        return NotImplemented if difference is NotImplemented else not difference

    def __hash__(self) -> int:
        return hash((str(self.numerator_polynomial), str(self.denominator_polynomial)))

    def __lt__(self, other: Any) -> Any:
        return _compared(self.__sub__(other), lambda difference: difference < 0)

    def __le__(self, other: Any) -> Any:
        return _compared(self.__sub__(other), lambda difference: difference <= 0)

    def __gt__(self, other: Any) -> Any:
        return _compared(self.__sub__(other), lambda difference: difference > 0)

    def __ge__(self, other: Any) -> Any:
        return _compared(self.__sub__(other), lambda difference: difference >= 0)

    # Values.

    def enclosure(self, bits: int) -> arb:
        """Return a ball about the number with ``bits`` relative bits, so that it excludes zero.

        Raises Undecided where far more bits do not exclude it; ``around`` has a ball in any case.
        """
        narrow = self._narrowest.get("ball")
        if narrow is not None and narrow.rel_accuracy_bits() >= bits:
            return narrow
        guard = _FIRST_GUARD_BITS
        while guard <= self._most_bits:
            value = self._evaluated(bits + guard)
            if value.rel_accuracy_bits() >= bits:
                self._narrowest["ball"] = value
                return value
            guard *= 2
        raise Undecided(f"a difference of numbers with {self._named} in them may be zero, or not")

    def around(self, bits: int) -> arb:
        """Return a ball about the number as in ``enclosure``, or one that contains zero."""
        try:
            return self.enclosure(bits)
        except Undecided:
            return self._evaluated(self._most_bits)

    def near(self, bits: int = _NEAR_BITS) -> Fraction:
        """Return a rational that differs by less than 2^-bits of the number."""
        mantissa, exponent = self.enclosure(bits + 1).mid().man_exp()
        return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)

    def floor_log2(self) -> int:
        """Return the largest e with 2^e <= |value|."""
        value, bits = abs(self), _SIGN_BITS
        while True:
            with ctx.workprec(bits + _FIRST_GUARD_BITS):
                ball = value.enclosure(bits)
                low, high = (_exponent(end) for end in (ball.lower(), ball.upper()))
            if low == high:
                return low
            if bits > self._most_bits:
                raise Undecided(f"a number with {self._named} in it may be a power of two, or not")
            bits *= 2

    def __float__(self) -> float:
        return float(self.near())

    def __int__(self) -> int:
        whole = int(self.near())
        # A number just below a whole one is near it.
        return whole - self.sign if whole and abs(self) < abs(whole) else whole

    def _mpmath_(self, bits: int, rounding: str) -> Any:
        """Return the number as mpmath converts it, to the last bit or one beside it."""
        from mpmath import libmp, mp

        mantissa, exponent = self.enclosure(bits + _SIGN_BITS).mid().man_exp()
        return mp.make_mpf(libmp.from_man_exp(int(mantissa), int(exponent), bits, rounding))

    def __reduce__(self) -> tuple[Any, ...]:
        parts = (self.numerator_polynomial, self.denominator_polynomial)
        return _from_terms, (self.constants, *(_terms(part) for part in parts))

    def __repr__(self) -> str:
        return f"({self.numerator_polynomial})/({self.denominator_polynomial})"

    @property
    def _named(self) -> str:
        return " and ".join(map(str, self.constants))

    @cached_property
    def _narrowest(self) -> dict[str, arb]:
        return {}

    @cached_property
    def _most_bits(self) -> int:
        parts = (self.numerator_polynomial, self.denominator_polynomial)
        height = max(abs(int(c)).bit_length() for part in parts for c in part.coeffs())
        degree = max(int(part.total_degree()) for part in parts)
        return _MOST_BITS + _MOST_TIMES_HEIGHT * height * (degree + 1)

    def _evaluated(self, bits: int) -> arb:
        with ctx.workprec(bits):
            values = [_evaluated(constant, bits) for constant in self.constants]
            above = _polynomial_at(self.numerator_polynomial, values)
            return above / _polynomial_at(self.denominator_polynomial, values)


def ball(value: Fraction | int | Irrational | arb) -> arb:
    """A ball about an exact number, narrow at the ambient precision; a ball as it is."""
    if isinstance(value, arb):
        return value
    if isinstance(value, Irrational):
        return value.around(ctx.prec) * 1
    return arb(rational(value))


def rational(value: Fraction | float) -> fmpq:
    """Return an exact number as FLINT has it."""
    return fmpq(*value.as_integer_ratio())


def fraction(value: fmpq) -> Fraction:
    """Return a rational number of FLINT."""
    return Fraction(int(value.p), int(value.q))


def generator(constants: tuple[Constant, ...], place: int) -> Irrational:
    """Return the constant at this place as a number of the field of all of them."""
    return Irrational(constants, _PLACES.gens()[place], _ONE)


PI: Final = generator((Pi(),), 0)


def _number(
    constants: tuple[Constant, ...], above: fmpz_mpoly, below: fmpz_mpoly
) -> Irrational | Fraction:
    """Return a quotient in lowest terms; a Fraction if no constant is left."""
    if below.is_zero():
        raise ZeroDivisionError("a quotient by zero")
    if above.is_zero():
        return Fraction(0)
    if above.is_constant() and below.is_constant():
        return Fraction(int(above.coeffs()[0]), int(below.coeffs()[0]))
    shared = above.gcd(below)
    if not shared.is_one():
        above, below = above / shared, below / shared
    if below.leading_coefficient() < 0:
        above, below = -above, -below
    if above.is_constant() and below.is_constant():
        return Fraction(int(above.coeffs()[0]), int(below.coeffs()[0]))
    return Irrational(constants, above, below)


def _terms(polynomial: fmpz_mpoly) -> dict[tuple[int, ...], int]:
    return {tuple(map(int, k)): int(c) for k, c in polynomial.to_dict().items()}


def _from_terms(
    constants: tuple[Constant, ...],
    above: dict[tuple[int, ...], int],
    below: dict[tuple[int, ...], int],
) -> Irrational:
    return Irrational(constants, _PLACES.from_dict(above), _PLACES.from_dict(below))


def _joined(first: tuple[Constant, ...], second: tuple[Constant, ...]) -> tuple[Constant, ...]:
    """Return the constants of both, those of the first one before the others."""
    if first[: len(second)] == second:
        return first
    return tuple(dict.fromkeys(first + second))


def _compared(difference: Any, question: Callable[[Any], bool]) -> Any:
    if difference is NotImplemented:
        return NotImplemented
    return question(difference.sign if isinstance(difference, Irrational) else difference)


def _constant(value: Any) -> fmpz_mpoly:
    return _PLACES.constant(int(value))


@lru_cache(maxsize=64)
def _shared(constant: Constant, bits: int) -> arb:
    with ctx.workprec(bits):
        return constant.evaluated()


def _evaluated(constant: Constant, bits: int) -> arb:
    """Return a ball about a constant, computed with at least so many bits."""
    return _shared(constant, -(-bits // _BITS_APART) * _BITS_APART)


def _polynomial_at(polynomial: fmpz_mpoly, values: list[arb]) -> arb:
    """Return the polynomial at these values of its variables."""
    powers: list[list[arb]] = []
    for value, degree in zip(values, polynomial.degrees(), strict=False):
        powers.append([arb(1)])
        for _ in range(int(degree)):
            powers[-1].append(powers[-1][-1] * value)
    total = arb(0)
    for exponents, coefficient in polynomial.to_dict().items():
        term = arb(coefficient)
        for power, exponent in zip(powers, exponents, strict=False):
            term *= power[int(exponent)]
        total += term
    return total


def _exponent(point: arb) -> int:
    """Return floor(log2) of a positive exact ball."""
    mantissa, exponent = point.man_exp()
    return int(exponent) + abs(int(mantissa)).bit_length() - 1
