"""Rational functions with exact coefficients, their time derivative, and the test of an identity.

An element is a quotient of two polynomials over Q in the names of a field. Some names are square
roots of polynomials in the others (i of -1, F of x.x): their squares are replaced wherever they occur,
so that a numerator has one normal form, and an identity holds exactly if that form is zero. The
denominators are no zero divisors, because none of these polynomials is a square.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cache
from math import hypot, isqrt
from typing import Any, Final, TypeVar, cast, final

from flint import fmpq, fmpq_mpoly_ctx

from taylor_verify.claims.claim import Check, Residual

Form = Callable[..., Iterable["Element"]]
Point = Mapping[str, Fraction | int]
Setting = TypeVar("Setting")

_BECAUSE: Final = "expanded in exact rationals: an identity leaves zero"


@final
class Element:
    """numerator / denominator in one field, the numerator in normal form."""

    __slots__ = ("den", "field", "num")

    def __init__(self, field: Field, num: Any, den: Any) -> None:
        self.field, self.num, self.den = field, num, den

    def __add__(self, other: Any) -> Element:
        b = self.field.element(other)
        if self.den == b.den:
            return self.field.quotient(self.num + b.num, self.den)
        return self.field.quotient(self.num * b.den + b.num * self.den, self.den * b.den)

    def __neg__(self) -> Element:
        return Element(self.field, -self.num, self.den)

    def __sub__(self, other: Any) -> Element:
        return self + (-self.field.element(other))

    def __mul__(self, other: Any) -> Element:
        b = self.field.element(other)
        return self.field.quotient(self.num * b.num, self.den * b.den)

    def __truediv__(self, other: Any) -> Element:
        b = self.field.element(other)
        if b.num == 0:
            raise ZeroDivisionError("expected a divisor that is not identically zero")
        return self.field.quotient(self.num * b.den, self.den * b.num)

    def __pow__(self, exponent: int) -> Element:
        result = self.field.element(1)
        for _ in range(exponent):
            result = result * self
        return result

    def __radd__(self, other: Any) -> Element:
        return self.field.element(other) + self

    def __rmul__(self, other: Any) -> Element:
        return self.field.element(other) * self

    def __rsub__(self, other: Any) -> Element:
        return self.field.element(other) + (-self)

    def __rtruediv__(self, other: Any) -> Element:
        return self.field.element(other) / self

    @property
    def is_zero(self) -> bool:
        return bool(self.num == 0)


class Field:
    """Q(names), with some names square roots, a time derivative, and a rational point.

    ``names`` come with their values at the point where a false statement is evaluated; ``roots`` maps
    a name to the function that gives its square. A root that is not rational at the point, and so not
    among the names, is taken there to 60 digits. ``turn`` sets the rates, which are zero else.
    """

    def __init__(
        self,
        names: Point,
        roots: Mapping[str, Callable[[Field], Any]] | None = None,
    ) -> None:
        self.names = (*dict.fromkeys([*names, *(roots or {})]), "i")
        self.point = {name: Fraction(value) for name, value in names.items()}
        self._context = fmpq_mpoly_ctx.get(self.names, "degrevlex")
        self._one = self._context.constant(1)
        self._places = {name: place for place, name in enumerate(self.names)}
        gens = zip(self.names, self._context.gens(), strict=True)
        self._generators = {name: Element(self, g, self._one) for name, g in gens}
        self._squares: dict[int, Any] = {self._places["i"]: self._context.constant(-1)}
        self._rates: dict[str, Element] = {}
        for name, square in (roots or {}).items():
            found = square(self)
            value = self._at_point(found.num)[0]
            if self.point.setdefault(name, _root(value)) ** 2 != value and name in names:
                raise ValueError(f"expected {name}^2 = {value} at the point of the field")
            self._squares[self._places[name]] = found.num

    def __getitem__(self, name: str) -> Element:
        return self._generators[name]

    def vector(self, letter: str) -> list[Element]:
        return [self[f"{letter}{k}"] for k in (1, 2, 3)]

    def symmetric(self, letter: str) -> list[list[Element]]:
        """The matrix of six names: letter, row and column, the lesser index first."""
        return [[self[f"{letter}{min(j, k)}{max(j, k)}"] for k in (1, 2, 3)] for j in (1, 2, 3)]

    def matrix(self, letter: str) -> list[list[Element]]:
        """The matrix of nine names."""
        return [[self[f"{letter}{j}{k}"] for k in (1, 2, 3)] for j in (1, 2, 3)]

    def element(self, value: Any) -> Element:
        if isinstance(value, Element):
            return value
        exact = Fraction(value)
        number = self._context.constant(fmpq(exact.numerator, exact.denominator))
        return Element(self, number, self._one)

    def quotient(self, num: Any, den: Any) -> Element:
        """num / den with the squares of all roots replaced; a constant denominator is divided out."""
        num, den = self._reduced(num), self._reduced(den)
        if num == 0:
            return Element(self, num, self._one)
        if den != self._one and den.is_constant():
            return Element(self, num / den.coefficient(0), self._one)
        return Element(self, num, den)

    def _reduced(self, polynomial: Any) -> Any:
        """The normal form: no root to a power above one."""
        degrees = polynomial.degrees()
        for place, square in self._squares.items():
            if degrees[place] > 1:
                polynomial = self._without_square(polynomial, place, square)
                degrees = polynomial.degrees()
        return polynomial

    def _without_square(self, polynomial: Any, place: int, square: Any) -> Any:
        parts: dict[int, dict[Any, Any]] = {}
        for exponents, coefficient in polynomial.to_dict().items():
            pairs, rest = divmod(int(exponents[place]), 2)
            kept = (*exponents[:place], rest, *exponents[place + 1 :])
            parts.setdefault(pairs, {})[kept] = coefficient
        total = self._context.constant(0)
        for pairs, terms in parts.items():
            total += self._context.from_dict(terms) * square**pairs
        return total

    # The time derivative.

    def turn(self, rates: Mapping[str, Element]) -> None:
        """Set d/dt of these names; that of a root must agree with that of its square."""
        self._rates = dict(rates)
        for place, square in self._squares.items():
            root = self[self.names[place]]
            rate = self._rates.get(self.names[place], self.element(0))
            if not (2 * root * rate - self.rate(Element(self, square, self._one))).is_zero:
                raise ValueError(f"expected the rate of a root, got another @ {self.names[place]}")

    def rate(self, element: Element) -> Element:
        """d/dt by the chain and quotient rules."""
        top, bottom = self._rate(element.num), self._rate(element.den)
        den = Element(self, element.den, self._one)
        if bottom.is_zero:
            return top / den
        return (top * den - Element(self, element.num, self._one) * bottom) / (den * den)

    def _rate(self, polynomial: Any) -> Element:
        total = self.element(0)
        for name, rate in self._rates.items():
            slope = polynomial.derivative(self._places[name])
            if slope != 0:
                total = total + Element(self, slope, self._one) * rate
        return total

    def rates(self, vector: Sequence[Element]) -> list[Element]:
        return [self.rate(entry) for entry in vector]

    def partial(self, element: Element, name: str) -> Element:
        """The partial derivative by a name that is no root and in no root."""
        place = self._places[name]
        top, den = element.num.derivative(place), element.den
        if den.is_constant():
            return self.quotient(top, den)
        return self.quotient(top * den - element.num * den.derivative(place), den * den)

    def without(self, element: Element, names: Iterable[str]) -> Element:
        """The element where these names, none of them a root, are zero."""
        zeros = {self._places[name]: fmpq(0) for name in names}
        return self.quotient(element.num.subs(zeros), element.den.subs(zeros))

    def renamed(self, element: Element, names: Mapping[str, str]) -> Element:
        """The element with some names replaced by others."""
        images = [self[names.get(name, name)].num for name in self.names]
        return self.quotient(element.num.compose(*images), element.den.compose(*images))

    # The value at the point.

    def size(self, element: Element) -> float:
        """The absolute value at the rational point."""
        (a, b), (c, d) = self._at_point(element.num), self._at_point(element.den)
        return hypot(a, b) / hypot(c, d)

    def value(self, element: Element) -> Fraction:
        """The value at the rational point, of an element without i."""
        return self._at_point(element.num)[0] / self._at_point(element.den)[0]

    def _at_point(self, polynomial: Any) -> tuple[Fraction, Fraction]:
        values = [self.point.get(name, Fraction(0)) for name in self.names]
        rational = [fmpq(v.numerator, v.denominator) for v in values]
        imaginary = polynomial.derivative(self._places["i"])
        found = polynomial(*rational), imaginary(*rational)
        return _fraction(found[0]), _fraction(found[1])


def _root(value: Fraction) -> Fraction:
    """The square root to 60 decimals, exactly where it is an integer over the denominator."""
    scale = value.denominator * 10**60
    return Fraction(isqrt(int(value * scale**2)), scale)


def _fraction(value: Any) -> Fraction:
    return Fraction(int(value.p), int(value.q))


def symbols_of(setting: Callable[[], Setting]) -> Setting:
    """Return the symbols of a setting, which are made once."""
    return cast(Setting, _symbols(setting))


@cache
def _symbols(setting: Callable[[], Any]) -> Any:
    return setting()


def identity(setting: Callable[[], Any], form: Form, **changed: Any) -> Check:
    """The check that all the differences of a form vanish identically in its setting.

    A form takes the setting and gives left side minus right side; ``changed`` are arguments of the form
    that make a mutant of it. A difference that is no zero is given the size it has at the point of its
    field.
    """

    def check() -> Residual:
        differences = list(form(symbols_of(setting), **changed))
        if not differences:
            return Residual(float("nan"), 0.0, "nothing was compared")
        nonzero = [d.field.size(d) for d in differences if not d.is_zero]
        # A polynomial that is no zero but vanishes at the point says nothing of its size.
        size = (max(nonzero) or float("nan")) if nonzero else 0.0
        return Residual(size, 0.0, _BECAUSE)

    return check


def values(names: Iterable[str]) -> dict[str, Fraction]:
    """A rational for each name, no two alike in the neighbourhood: a point without symmetry."""
    return {name: Fraction(3 + 5 * k % 13, 2 + 3 * k % 7) for k, name in enumerate(names)}


# Vectors of elements.


def cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [a[j] * b[k] - a[k] * b[j] for j, k in ((1, 2), (2, 0), (0, 1))]


def dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    return sum((p * q for p, q in zip(a, b, strict=True)), start=0)


def minus(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [p - q for p, q in zip(a, b, strict=True)]


def plus(*vectors: Sequence[Any]) -> list[Any]:
    return [sum(entries, start=0) for entries in zip(*vectors, strict=True)]


def apply(matrix: Sequence[Sequence[Any]], v: Sequence[Any]) -> list[Any]:
    return [dot(row, v) for row in matrix]


def transposed(matrix: Sequence[Sequence[Any]]) -> list[list[Any]]:
    return [list(column) for column in zip(*matrix, strict=True)]


def named(letter: str, vector: Sequence[Any]) -> dict[str, Any]:
    """The components of a vector by their names."""
    return {f"{letter}{k}": entry for k, entry in enumerate(vector, start=1)}


def rotation(e: Sequence[Any]) -> list[list[Any]]:
    """R of a quaternion of norm 1, scalar first: v_space = R v_body."""
    e0, e1, e2, e3 = e
    return [
        [1 - 2 * (e2**2 + e3**2), 2 * (e1 * e2 - e0 * e3), 2 * (e1 * e3 + e0 * e2)],
        [2 * (e1 * e2 + e0 * e3), 1 - 2 * (e1**2 + e3**2), 2 * (e2 * e3 - e0 * e1)],
        [2 * (e1 * e3 - e0 * e2), 2 * (e2 * e3 + e0 * e1), 1 - 2 * (e1**2 + e2**2)],
    ]


QUATERNION: Final[Mapping[str, Fraction]] = {
    f"e{k}": Fraction(entry, 5) for k, entry in enumerate((1, 2, 2, 4))
}
"""A rational quaternion of norm 1, for the points of fields with an attitude."""


def unit_root(field: Field) -> Element:
    """e0^2 = 1 - e1^2 - e2^2 - e3^2."""
    return 1 - field["e1"] ** 2 - field["e2"] ** 2 - field["e3"] ** 2


def quaternion_rates(field: Field, omega: Sequence[Any]) -> dict[str, Element]:
    """e' = e (0, omega)/2, omega in body axes; then R' = R [omega]x."""
    e0, e1, e2, e3 = (field[f"e{k}"] for k in range(4))
    w1, w2, w3 = omega
    half = Fraction(1, 2)
    return {
        "e0": half * (-e1 * w1 - e2 * w2 - e3 * w3),
        "e1": half * (e0 * w1 + e2 * w3 - e3 * w2),
        "e2": half * (e0 * w2 + e3 * w1 - e1 * w3),
        "e3": half * (e0 * w3 + e1 * w2 - e2 * w1),
    }
