"""A manufactured motion: chosen first, as a trigonometric polynomial, and the loads made to fit it.

z*(t)  omega (a rigid body) or x and y as one vector of six (a solid in a fluid), body axes
t      time since the start
nu     angular frequency of a wave, 1/time

z* solves the equations of motion of any body whose loads are the remainder when z* is put into them:
M = I omega*' + omega* x I omega*, or X = x*' - x* x Omega* and
L = y*' - y* x Omega* - x* x U*. So a motion under loads that change with time has an exact answer, for
every tensor and every T.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector


@dataclass(frozen=True)
class Wave:
    """cosine cos(nu t) + sine sin(nu t), of the vector z*; ``frequency`` nu is positive."""

    frequency: Fraction
    cosine: Vector
    sine: Vector


@dataclass(frozen=True)
class Manufactured:
    """z*(t) = constant + the sum of the waves, all coefficients exact."""

    constant: Vector
    waves: tuple[Wave, ...]

    @property
    def start(self) -> Vector:
        """z*(0), where every cosine is 1 and every sine 0: rational as its coefficients are."""
        return reduce(tensors.plus, (wave.cosine for wave in self.waves), self.constant)

    @property
    def reach(self) -> Vector:
        """Bounds of the components at all times: the sums of the sizes of their coefficients."""
        vectors = [self.constant, *(v for w in self.waves for v in (w.cosine, w.sine))]
        return tuple(sum(map(abs, column), Fraction(0)) for column in zip(*vectors, strict=True))

    @property
    def highest(self) -> Fraction:
        """The highest frequency; 0 of a constant."""
        return max((wave.frequency for wave in self.waves), default=Fraction(0))

    def mapped(self, matrix: Matrix) -> Manufactured:
        """Return the motion of the vector matrix z*, for example of H = I omega."""
        return self._changed(lambda z: tensors.apply(matrix, z), Fraction(1))

    def in_units(self, sizes: Vector, time: Fraction) -> Manufactured:
        """Return the motion with component i multiplied by sizes[i], and every time by ``time``."""
        return self._changed(
            lambda z: tuple(c * size for c, size in zip(z, sizes, strict=True)), time
        )

    def _changed(self, change: Callable[[Vector], Vector], time: Fraction) -> Manufactured:
        waves = (Wave(w.frequency / time, change(w.cosine), change(w.sine)) for w in self.waves)
        return Manufactured(change(self.constant), tuple(waves))
