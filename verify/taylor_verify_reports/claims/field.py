"""Rational functions with exact coefficients, and their time derivative.

An element is a quotient of two polynomials over Q in the names of a field. Some names are square
roots of polynomials in the others (i of -1, F of x.x): their squares are replaced wherever they occur,
so that a numerator has one normal form, and an identity holds exactly if that form is zero. The
denominators are no zero divisors, because none of these polynomials is a square. Vectors and
matrices are NumPy's arrays of elements.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from math import hypot, isqrt
from typing import Any, final

import numpy as np
from flint import fmpq, fmpq_mpoly_ctx

Point = Mapping[str, Fraction | int]


def _lifted(operation: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    """Return an operation that takes numbers too, and leaves arrays to NumPy."""

    def lifted(self: Element, other: Any) -> Any:
        if isinstance(other, np.ndarray):
            return NotImplemented
        return operation(self, self.field.element(other))

    return lifted


@final
class Element:
    """numerator / denominator in one field, the numerator in normal form."""

    __slots__ = ("den", "field", "num")

    def __init__(self, field: Field, num: Any, den: Any) -> None:
        self.field, self.num, self.den = field, num, den

    @_lifted
    def __add__(self, b: Element) -> Element:
        if self.den == b.den:
            return self.field.quotient(self.num + b.num, self.den)
        return self.field.quotient(self.num * b.den + b.num * self.den, self.den * b.den)

    @_lifted
    def __mul__(self, b: Element) -> Element:
        return self.field.quotient(self.num * b.num, self.den * b.den)

    @_lifted
    def __truediv__(self, b: Element) -> Element:
        if b.is_zero:
            raise ZeroDivisionError("expected a divisor that is not identically zero")
        return self.field.quotient(self.num * b.den, self.den * b.num)

    @_lifted
    def __sub__(self, b: Element) -> Element:
        return self + -b  # type: ignore[no-any-return]

    @_lifted
    def __rsub__(self, b: Element) -> Element:
        return b + -self  # type: ignore[no-any-return]

    @_lifted
    def __rtruediv__(self, b: Element) -> Element:
        return b / self  # type: ignore[no-any-return]

    __radd__, __rmul__ = __add__, __mul__

    def __pos__(self) -> Element:
        return self

    def __neg__(self) -> Element:
        return Element(self.field, -self.num, self.den)

    def __pow__(self, exponent: int) -> Element:
        return self.field.quotient(self.num**exponent, self.den**exponent)

    @property
    def is_zero(self) -> bool:
        return bool(self.num == 0)


class Field:
    """Q(names), with some names square roots, a time derivative, and a rational point.

    ``point`` gives the names with their values at the point where a false statement is evaluated; ``roots``
    maps a name to its square, as text. A root that is not rational at the point, and so not in it, is
    taken there to 60 digits. ``turn`` sets the rates, which are zero else. ``symbols`` are all names:
    those that end in 1, 2, 3 also make a vector of three, and those in 11, 12 ... a matrix,
    a symmetric one if only one of 12 and 21 is there.
    """

    def __init__(self, point: Point, roots: Mapping[str, str] | None = None) -> None:
        roots = roots or {}
        # The roots come first: in this order of monomials each root's square leads its relation.
        self.names = (*dict.fromkeys(["i", *roots, *point]),)
        self.point = {name: Fraction(value) for name, value in point.items()}
        self._context = fmpq_mpoly_ctx.get(self.names, "lex")
        self._one = self._context.constant(1)
        self._places = {name: place for place, name in enumerate(self.names)}
        generators = zip(self.names, self._context.gens(), strict=True)
        self.symbols: dict[str, Any] = {n: Element(self, g, self._one) for n, g in generators}
        self.symbols |= _arrays(self.symbols)
        self._rates: dict[str, Element] = {}
        self._relations = {"i": self["i"].num ** 2 + 1}
        for name, text in roots.items():
            square = eval(text, dict(self.symbols)).num
            value = self._at_point(square)[0]
            if self.point.setdefault(name, _root(value)) ** 2 != value and name in point:
                raise ValueError(f"expected {name}^2 = {value} at the point of the field")
            self._relations[name] = self[name].num ** 2 - square

    def __getitem__(self, name: str) -> Any:
        return self.symbols[name]

    def element(self, value: Any) -> Element:
        if isinstance(value, Element):
            return value
        if isinstance(value, float):
            raise TypeError(f"expected an exact number, got {value!r}")
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
        for name, relation in self._relations.items():
            if degrees[self._places[name]] > 1:
                polynomial %= relation
        return polynomial

    # Derivatives and substitutions, of elements and of arrays of elements.

    def turn(self, **rates: Any) -> None:
        """Set d/dt of names, or of vectors; that of a root must agree with that of its square."""
        self._rates = self._components(rates)
        for name, relation in self._relations.items():
            if not self._total(relation).is_zero:
                raise ValueError(f"expected the rate of a root, got another @ {name}")

    def rate(self, value: Any) -> Any:
        """d/dt by the chain and quotient rules."""
        return self._each(self._total, value)

    def _total(self, polynomial: Any) -> Element:
        total = self.element(0)
        for name, rate in self._rates.items():
            slope = polynomial.derivative(self._places[name])
            if slope != 0:
                total = total + Element(self, slope, self._one) * rate
        return total

    def partial(self, value: Any, name: str) -> Any:
        """The partial derivative by a name that is no root and in no root."""
        place = self._places[name]
        return self._each(lambda p: Element(self, p.derivative(place), self._one), value)

    def grad(self, value: Any, letter: str) -> Any:
        """The partial derivatives by the three components of a vector, along a last axis."""
        return np.stack([self.partial(value, f"{letter}{k}") for k in (1, 2, 3)], axis=-1)

    def _each(self, slope: Callable[[Any], Element], value: Any) -> Any:
        """Apply a derivation, given on polynomials, to an element or to an array."""

        def derivative(entry: Any) -> Element:
            element = self.element(entry)
            den = Element(self, element.den, self._one)
            top, bottom = slope(element.num), slope(element.den)
            if bottom.is_zero:
                return top / den  # type: ignore[no-any-return]
            num = Element(self, element.num, self._one)
            return (top * den - num * bottom) / (den * den)  # type: ignore[no-any-return]

        return np.frompyfunc(derivative, 1, 1)(value)

    def at(self, value: Any, **images: Any) -> Any:
        """The value with polynomials for some names, none of them a root."""
        given = self._components(images)
        nums = [given[name].num if name in given else self[name].num for name in self.names]

        def composed(element: Element) -> Element:
            return self.quotient(element.num.compose(*nums), element.den.compose(*nums))

        return np.frompyfunc(composed, 1, 1)(value)

    def _components(self, values: Mapping[str, Any]) -> dict[str, Element]:
        """Elements by their names, of values by names and of arrays by the names of vectors."""
        return {
            f"{name}{k}" if isinstance(value, np.ndarray) else name: self.element(entry)
            for name, value in values.items()
            for k, entry in enumerate(np.ravel(np.asarray(value, object)), start=1)
        }

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
        parts = polynomial, polynomial.derivative(self._places["i"])
        real, imaginary = (part(*rational) for part in parts)
        return Fraction(int(real.p), int(real.q)), Fraction(int(imaginary.p), int(imaginary.q))


def _arrays(symbols: Mapping[str, Element]) -> dict[str, Any]:
    """Vectors and matrices of the names that are numbered; a name stands for itself first."""
    arrays = {}
    for letter in {name.rstrip("123") for name in symbols} - set(symbols):
        if {f"{letter}{k}" for k in "123"} <= set(symbols):
            arrays[letter] = np.array([symbols[f"{letter}{k}"] for k in "123"])
        if f"{letter}11" in symbols:
            arrays[letter] = np.array(
                [
                    [symbols.get(f"{letter}{j}{k}", symbols.get(f"{letter}{k}{j}")) for k in "123"]
                    for j in "123"
                ]
            )
    return arrays


def _root(value: Fraction) -> Fraction:
    """The square root to 60 decimals, exactly where it is an integer over the denominator."""
    scale = value.denominator * 10**60
    return Fraction(isqrt(int(value * scale**2)), scale)


def values(names: Iterable[str]) -> dict[str, Fraction]:
    """A rational for each name, no two alike in the neighbourhood: a point without symmetry."""
    return {name: Fraction(3 + 5 * k % 13, 2 + 3 * k % 7) for k, name in enumerate(names)}
