"""Polynomials in named symbols with exact coefficients, on unit quaternions q0..q3.

q0^2 is replaced by 1 - q1^2 - q2^2 - q3^2 wherever it appears. So a polynomial has one form, and is zero
for every attitude only if it has no terms.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Final

Monomial = tuple[str, ...]
"""The symbols of a product, sorted, each as often as its power."""

# A product of long sums is no form in which anything is found.
MOST_TERMS: Final = 3000
_SCALAR: Final = "q0"
_REPLACED: Final = (
    ((), Fraction(1)),
    *(((name, name), Fraction(-1)) for name in ("q1", "q2", "q3")),
)


class TooLong(ArithmeticError):
    """A polynomial of more than MOST_TERMS terms."""


@dataclass(frozen=True)
class Polynomial:
    """A sum of monomials with their coefficients, none of which is zero."""

    terms: Mapping[Monomial, Fraction] = field(default_factory=dict)

    @classmethod
    def number(cls, value: Fraction) -> Polynomial:
        """A constant."""
        return cls({(): value} if value else {})

    @classmethod
    def symbol(cls, name: str) -> Polynomial:
        """A symbol by itself."""
        return cls({(name,): Fraction(1)})

    def __add__(self, other: Polynomial) -> Polynomial:
        return _collected((*self.terms.items(), *other.terms.items()))

    def __sub__(self, other: Polynomial) -> Polynomial:
        return self + other.times(Fraction(-1))

    def times(self, number: Fraction) -> Polynomial:
        """The multiple by a number."""
        if not number:
            return Polynomial()
        return Polynomial({m: c * number for m, c in self.terms.items()})

    def __mul__(self, other: Polynomial) -> Polynomial:
        if len(self.terms) * len(other.terms) > MOST_TERMS:
            raise TooLong
        return _collected(
            term
            for first, a in self.terms.items()
            for second, b in other.terms.items()
            for term in _product(first, second, a * b)
        )

    def __rmul__(self, number: int) -> Polynomial:
        return self.times(Fraction(number))

    def rate(self, rates: Mapping[str, Polynomial]) -> Polynomial:
        """The derivative by time, where ``rates`` has those of all symbols that are not constant."""
        return total(
            self._part(name) * rate
            for name, rate in rates.items()
            if any(name in monomial for monomial in self.terms)
        )

    def _part(self, name: str) -> Polynomial:
        """The derivative by one symbol."""
        parts: list[tuple[Monomial, Fraction]] = []
        for monomial, coefficient in self.terms.items():
            if power := monomial.count(name):
                place = monomial.index(name)
                left = monomial[:place] + monomial[place + 1 :]
                parts.append((left, coefficient * power))
        return _collected(parts)


def total(parts: Iterable[Polynomial]) -> Polynomial:
    """The sum of polynomials."""
    return _collected(term for part in parts for term in part.terms.items())


def _product(
    first: Monomial, second: Monomial, factor: Fraction
) -> Iterator[tuple[Monomial, Fraction]]:
    joined = tuple(sorted(first + second))
    if joined.count(_SCALAR) < 2:
        yield joined, factor
        return
    place = joined.index(_SCALAR)
    left = joined[:place] + joined[place + 2 :]
    for replaced, sign in _REPLACED:
        yield tuple(sorted(left + replaced)), sign * factor


def _collected(terms: Iterable[tuple[Monomial, Fraction]]) -> Polynomial:
    sums: defaultdict[Monomial, Fraction] = defaultdict(Fraction)
    for monomial, coefficient in terms:
        sums[monomial] += coefficient
    return Polynomial({monomial: number for monomial, number in sums.items() if number})
