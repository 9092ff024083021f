"""Vectors and matrices of rationals: the small exact linear algebra that bodies are made of.

A vector is a tuple of Fractions, a matrix a tuple of rows. Nothing here rounds.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import accumulate, pairwise
from operator import mul
from typing import TypeVar

import flint

from taylor_verify.numbers.irrational import fraction, rational

Vector = tuple[Fraction, ...]
Matrix = tuple[Vector, ...]
Number = TypeVar("Number", int, float, Fraction, flint.arb)

_ZERO = Fraction(0)
ZERO_VECTOR: Vector = (_ZERO,) * 3
ZERO_MATRIX: Matrix = (ZERO_VECTOR,) * 3


def diagonal(entries: Vector) -> Matrix:
    """Return the square matrix with these diagonal entries."""
    return tuple(
        tuple(entry if i == j else _ZERO for j in range(len(entries)))
        for i, entry in enumerate(entries)
    )


def identity(size: int) -> Matrix:
    """Return the unit matrix."""
    return diagonal((Fraction(1),) * size)


def transpose(matrix: Matrix) -> Matrix:
    return tuple(zip(*matrix, strict=True))


def dot(a: Vector, b: Vector) -> Fraction:
    # Most tensors are sparse, and a product of rationals is dear.
    return sum((p * q for p, q in zip(a, b, strict=True) if p and q), _ZERO)


def cross(a: Sequence[Number], b: Sequence[Number]) -> tuple[Number, Number, Number]:
    """Return a x b, in whatever numbers."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def cross_matrix(a: Vector) -> Matrix:
    """Return [a]x, so that [a]x b = a x b."""
    return ((_ZERO, -a[2], a[1]), (a[2], _ZERO, -a[0]), (-a[1], a[0], _ZERO))


def plus(a: Vector, b: Vector) -> Vector:
    return tuple(p + q for p, q in zip(a, b, strict=True))


def minus(a: Vector, b: Vector) -> Vector:
    return tuple(p - q for p, q in zip(a, b, strict=True))


def scaled(factor: Fraction, vector: Vector) -> Vector:
    return tuple(factor * entry for entry in vector)


def apply(matrix: Matrix, vector: Vector) -> Vector:
    """Return the matrix times the vector."""
    return tuple(dot(row, vector) for row in matrix)


def product(a: Matrix, b: Matrix) -> Matrix:
    columns = transpose(b)
    return tuple(tuple(dot(row, column) for column in columns) for row in a)


def is_diagonal(matrix: Matrix) -> bool:
    return not any(entry for i, row in enumerate(matrix) for j, entry in enumerate(row) if i != j)


def is_symmetric(matrix: Matrix) -> bool:
    return matrix == transpose(matrix)


def blocks(a: Matrix, b: Matrix, c: Matrix) -> Matrix:
    """Return the symmetric 6x6 matrix [[A, B], [B^T, C]]."""
    upper = tuple(p + q for p, q in zip(a, b, strict=True))
    lower = tuple(p + q for p, q in zip(transpose(b), c, strict=True))
    return upper + lower


def leading_minors(matrix: Matrix) -> Iterator[Fraction]:
    """Yield the determinant of the first entry, of the first two rows and columns, and so on."""
    if is_diagonal(matrix):
        yield from accumulate((row[i] for i, row in enumerate(matrix)), mul)
        return
    for size in range(1, len(matrix) + 1):
        yield fraction(_flint(tuple(row[:size] for row in matrix[:size])).det())


def is_positive_definite(matrix: Matrix) -> bool:
    """Return True if a symmetric matrix is positive definite.

    Its eigenvalues are real: all are positive where the characteristic polynomial changes sign with each
    coefficient, by Descartes' rule.
    """
    if is_diagonal(matrix):
        return all(row[i] > 0 for i, row in enumerate(matrix))
    coefficients = characteristic(matrix)
    return all(a * b < 0 for a, b in pairwise(coefficients))


def inverse(matrix: Matrix) -> Matrix:
    """Return the inverse; ZeroDivisionError if the matrix is singular."""
    if is_diagonal(matrix):
        return diagonal(tuple(1 / row[i] for i, row in enumerate(matrix)))
    return tuple(tuple(map(fraction, row)) for row in _flint(matrix).inv().tolist())


def characteristic(matrix: Matrix) -> tuple[Fraction, ...]:
    """Return the coefficients of det(z - matrix), that of z^0 first."""
    return tuple(map(fraction, _flint(matrix).charpoly().coeffs()))


def _flint(matrix: Matrix) -> flint.fmpq_mat:
    return flint.fmpq_mat([[rational(c) for c in row] for row in matrix])
