"""The characteristic polynomial of a symmetric 3x3 matrix of exact numbers."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple, Self

from taylor_verify.numbers.tensors import Matrix, cross, dot


class Cubic(NamedTuple):
    """The characteristic polynomial z^3 - t z^2 + c2 z - d of a symmetric matrix."""

    trace: Fraction
    minors: Fraction
    determinant: Fraction

    @classmethod
    def of(cls, matrix: Matrix) -> Self:
        """The polynomial of a matrix."""
        a, b, c = matrix
        pairs = ((0, 1), (1, 2), (2, 0))
        minors = sum(
            (matrix[i][i] * matrix[j][j] - matrix[i][j] ** 2 for i, j in pairs), Fraction(0)
        )
        return cls(a[0] + b[1] + c[2], minors, dot(a, cross(b, c)))

    @property
    def spread(self) -> Fraction:
        return self.trace**2 - 3 * self.minors

    @property
    def skewness(self) -> Fraction:
        return self.trace * (2 * self.trace**2 - 9 * self.minors) + 27 * self.determinant

    @property
    def discriminant(self) -> Fraction:
        """Delta, which is zero where two eigenvalues are equal."""
        return (4 * self.spread**3 - self.skewness**2) / 27

    @property
    def double_root(self) -> Fraction:
        """The eigenvalue that is repeated, where one alone is: it is rational."""
        return (self.trace * self.minors - 9 * self.determinant) / (2 * self.spread)
