"""Vectors and matrices of rationals: the small exact linear algebra that bodies are made of.

A vector is a tuple of Fractions, a matrix a tuple of rows. Nothing here rounds.
"""

from __future__ import annotations

from fractions import Fraction

Vector = tuple[Fraction, ...]
Matrix = tuple[Vector, ...]

_ZERO = Fraction(0)
ZERO_VECTOR: Vector = (_ZERO,) * 3
ZERO_MATRIX: Matrix = (ZERO_VECTOR,) * 3


def diagonal(entries: Vector) -> Matrix:
    """The square matrix with these diagonal entries."""
    return tuple(
        tuple(entry if i == j else _ZERO for j in range(len(entries)))
        for i, entry in enumerate(entries)
    )


def transpose(matrix: Matrix) -> Matrix:
    return tuple(zip(*matrix, strict=True))


def dot(a: Vector, b: Vector) -> Fraction:
    # Most tensors are sparse, and a product of rationals is dear.
    return sum((p * q for p, q in zip(a, b, strict=True) if p and q), _ZERO)


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def plus(a: Vector, b: Vector) -> Vector:
    return tuple(p + q for p, q in zip(a, b, strict=True))


def minus(a: Vector, b: Vector) -> Vector:
    return tuple(p - q for p, q in zip(a, b, strict=True))


def scaled(factor: Fraction, vector: Vector) -> Vector:
    return tuple(factor * entry for entry in vector)


def apply(matrix: Matrix, vector: Vector) -> Vector:
    """The matrix times the vector."""
    return tuple(dot(row, vector) for row in matrix)


def product(a: Matrix, b: Matrix) -> Matrix:
    columns = transpose(b)
    return tuple(tuple(dot(row, column) for column in columns) for row in a)


def is_diagonal(matrix: Matrix) -> bool:
    return all(entry == 0 for i, row in enumerate(matrix) for j, entry in enumerate(row) if i != j)


def is_symmetric(matrix: Matrix) -> bool:
    return matrix == transpose(matrix)


def blocks(a: Matrix, b: Matrix, c: Matrix) -> Matrix:
    """The symmetric 6x6 matrix [[A, B], [B^T, C]]."""
    upper = tuple(p + q for p, q in zip(a, b, strict=True))
    lower = tuple(p + q for p, q in zip(transpose(b), c, strict=True))
    return upper + lower


def is_positive_definite(matrix: Matrix) -> bool:
    """Whether a symmetric matrix is positive definite: every pivot of its elimination is positive."""
    rows = [list(row) for row in matrix]
    for k, pivot_row in enumerate(rows):
        if pivot_row[k] <= 0:
            return False
        for row in rows[k + 1 :]:
            if row[k]:
                factor = row[k] / pivot_row[k]
                row[k:] = [p - factor * q for p, q in zip(row[k:], pivot_row[k:], strict=True)]
    return True


def inverse(matrix: Matrix) -> Matrix:
    """The inverse by elimination with row exchanges; ZeroDivisionError if the matrix is singular."""
    size = len(matrix)
    if is_diagonal(matrix):
        return diagonal(tuple(1 / matrix[i][i] for i in range(size)))
    rows = [
        list(row) + [Fraction(int(i == j)) for j in range(size)] for i, row in enumerate(matrix)
    ]
    for k in range(size):
        pivot = next((i for i in range(k, size) if rows[i][k] != 0), None)
        if pivot is None:
            raise ZeroDivisionError("the matrix is singular")
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [entry / rows[k][k] for entry in rows[k]]
        for i in range(size):
            if i != k and rows[i][k] != 0:
                rows[i] = [p - rows[i][k] * q for p, q in zip(rows[i], rows[k], strict=True)]
    return tuple(tuple(row[size:]) for row in rows)
