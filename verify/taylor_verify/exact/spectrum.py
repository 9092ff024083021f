"""The eigenvalues of a symmetric 3x3 matrix of exact numbers, in balls, where all three differ.

Legend: t the trace, c2 the sum of the principal minors, d the determinant; z1 > z2 > z3 the eigenvalues
and y_k = z_k - t/3 those of the part without trace: the roots of y^3 - (S/3) y - Q/27 with S = t^2 - 3 c2
and Q = 2 t^3 - 9 t c2 + 27 d. Delta = (4 S^3 - Q^2)/27 is the squared product of the three differences.

By Viete y_k = (2/3) S^(1/2) cos(theta - 2 pi k/3), k = 0, 1, 2: for 4 c^3 - 3 c is the cosine of three
times the angle whose cosine is c, here of 3 theta between 0 and pi, with the sine (27 Delta)^(1/2) and the
cosine Q but for a factor. The differences are sines of theta, of pi/3 - theta and of their sum times
2 (S/3)^(1/2). Since S, Q and Delta are exact, no ball loses bits however nearly two eigenvalues agree.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple, Self

from flint import arb

from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.tensors import Matrix, cross, dot


class Gaps(NamedTuple):
    """The differences z1 - z2, z2 - z3 and z1 - z3."""

    upper: arb
    lower: arb
    whole: arb


class Spectrum(NamedTuple):
    """Balls about z1, z2, z3, about y1, y2, y3 and about the gaps: narrow ones beside their sizes."""

    values: list[arb]
    deviations: list[arb]
    gaps: Gaps


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

    def spectrum(self) -> Spectrum:
        """Return the eigenvalues at the ambient precision of flint; the discriminant must be positive."""
        sine, cosine = (27 * ball(self.discriminant)).sqrt(), ball(self.skewness)
        theta, rest = arb.atan2(sine, cosine) / 3, arb.atan2(sine, -cosine) / 3
        root = ball(self.spread).sqrt() * 2
        high, low = root * theta.cos() / 3, -root * rest.cos() / 3
        middle = cosine / (27 * high * low)
        sines = (angle.sin() for angle in (rest, theta, theta + arb.pi() / 3))
        gaps = Gaps(*(root * sine / arb(3).sqrt() for sine in sines))
        return Spectrum(self._values(high, low, gaps), [high, middle, low], gaps)

    def _values(self, high: arb, low: arb, gaps: Gaps) -> list[arb]:
        """z1, z2, z3 without cancellation, from y1, y3 and the gaps; a zero is exact.

        For the largest z in size |t/3| <= |z|, so that t/3 + y loses a bit or two. Of the other two the
        product is P = d/z, the sum (c2 - P)/z, and the larger one in size half of the sum plus or minus the
        gap, whichever adds up. The error of the sum is about that of |P/z|, which is no more than that one.
        """
        mean = ball(self.trace / 3)
        is_top = bool((2 * mean + high + low).mid() >= 0)  # at a tie either choice is right
        z = mean + (high if is_top else low)
        product = ball(self.determinant) / z
        total = (ball(self.minors) - product) / z
        gap = gaps.lower if is_top else gaps.upper
        if total.mid() >= 0:
            larger = (total + gap) / 2
            others = [larger, product / larger]
        else:
            larger = (total - gap) / 2
            others = [product / larger, larger]
        return [z, *others] if is_top else [*others, z]
