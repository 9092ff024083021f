"""Polynomials in named symbols with rational coefficients, on unit quaternions q0..q3, by FLINT.

q0^2 is replaced by 1 - q1^2 - q2^2 - q3^2 in every product. So a polynomial has one form, and is zero for
every attitude only if it has no terms.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from functools import lru_cache
from typing import Final

from flint import Ordering, fmpq_mpoly, fmpq_mpoly_ctx

from taylor_verify.numbers.irrational import fraction
from taylor_verify.scenes.loads.loads import QUATERNION

Polynomial = fmpq_mpoly
Monomial = tuple[str, ...]
"""The symbols of a product, each as often as its power."""

# A product of long sums is no form in which anything is found.
MOST_TERMS: Final = 3000


class TooLong(ArithmeticError):
    """A polynomial of more than MOST_TERMS terms."""


def symbols_of(names: Iterable[str]) -> dict[str, Polynomial]:
    """The symbols of these names, and of q0..q3, each a polynomial by itself."""
    every = (*QUATERNION, *sorted({*names} - {*QUATERNION}))
    return dict(zip(every, fmpq_mpoly_ctx.get(every, Ordering.lex).gens(), strict=True))


def multiplied(first: Polynomial, second: Polynomial) -> Polynomial:
    """The product. Raises TooLong."""
    if len(first) * len(second) > MOST_TERMS:
        raise TooLong
    return reduced(first * second)


def reduced(polynomial: Polynomial) -> Polynomial:
    """The polynomial with no higher power of q0 than the first."""
    # It is the first symbol, so that its square leads the relation of a unit quaternion.
    if polynomial.is_zero() or polynomial.degrees()[0] < 2:
        return polynomial
    return polynomial % _relation(polynomial.context())


@lru_cache(maxsize=16)
def _relation(context: fmpq_mpoly_ctx) -> Polynomial:
    q0, q1, q2, q3 = context.gens()[:4]
    return q0**2 + q1**2 + q2**2 + q3**2 - 1


def rate_of(polynomial: Polynomial, rates: Mapping[str, Polynomial]) -> Polynomial:
    """The derivative by time, where ``rates`` has those of all symbols that are not constant."""
    parts = (multiplied(polynomial.derivative(name), rate) for name, rate in rates.items())
    return sum(parts, 0 * polynomial)


def terms(polynomial: Polynomial) -> Iterator[tuple[Monomial, Fraction]]:
    """Yield the monomials with their coefficients."""
    names = polynomial.context().names()
    for powers, number in polynomial.to_dict().items():
        monomial = (name for name, n in zip(names, powers, strict=True) for _ in range(int(n)))
        yield tuple(monomial), fraction(number)
