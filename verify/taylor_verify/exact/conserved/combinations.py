"""Linear combinations of polynomials that are zero, in exact numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import chain

from taylor_verify.exact.conserved.polynomial import Polynomial, terms
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Vector


class Combinations:
    """The vectors a with sum a_k p_k = 0, for every list of polynomials p that was added."""

    def __init__(self, count: int) -> None:
        self.basis: list[Vector] = list(tensors.identity(count))

    def add(self, polynomials: Sequence[Polynomial]) -> None:
        """Leave only the combinations for which these polynomials cancel."""
        for row in _rows(polynomials):
            self._meet(row)

    def _meet(self, row: Vector) -> None:
        """Leave only the vectors that are orthogonal to a row."""
        products = [tensors.dot(row, vector) for vector in self.basis]
        pivot = next((k for k, product in enumerate(products) if product), None)
        if pivot is None:
            return
        removed, divisor = self.basis[pivot], products[pivot]
        self.basis = [
            tensors.minus(vector, tensors.scaled(product / divisor, removed)) if product else vector
            for k, (vector, product) in enumerate(zip(self.basis, products, strict=True))
            if k != pivot
        ]


def _rows(polynomials: Sequence[Polynomial]) -> Iterator[Vector]:
    """The coefficients of each monomial in all polynomials."""
    every = [dict(terms(each)) for each in polynomials]
    for monomial in dict.fromkeys(chain(*every)):
        yield tuple(each.get(monomial, Fraction(0)) for each in every)


def orthogonal(vectors: Sequence[Vector]) -> list[Vector]:
    """Orthogonal vectors of the same span."""
    basis: list[Vector] = []
    for vector in vectors:
        for before in basis:
            share = tensors.dot(vector, before) / tensors.dot(before, before)
            vector = tensors.minus(vector, tensors.scaled(share, before))
        basis.append(vector)
    return basis
