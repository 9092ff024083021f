"""Newton's iteration for the equation of an implicit step, to roundoff."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from taylor_verify.solvers.geometric.fixed_step import Unsolved
from taylor_verify.solvers.geometric.vectors import Matrix, Vector, ahead, apply, cross, dot, solved

# The iteration squares its error. A correction below the root of the roundoff is the last one.
_ROUNDOFF: Final = 2.0**-53
# From a first guess that is right to a half, six squarings lead beyond float64: where so many
# more do not, the step is too long for the equation.
_MOST: Final = 25

System = Callable[[Vector], tuple[Vector, Matrix]]


def root(system: System, guess: Vector) -> tuple[Vector, int]:
    """Return the zero of a map with the columns of its derivative, and the number of evaluations.

    Raises Unsolved where the iteration does not settle.
    """
    v = guess
    for count in range(1, _MOST + 1):
        value, columns = system(v)
        change = solved(columns, value)
        v = ahead(v, -1.0, change)
        if dot(change, change) <= _ROUNDOFF * dot(v, v):
            return v, count
    raise Unsolved(
        f"Newton's iteration for the implicit step did not settle in {_MOST}: take shorter steps"
    )


def midpoint_columns(K: Matrix, c: float, v: Vector, omega: Vector) -> Matrix:
    """Return the columns of d(w - c v x K w)/dw = 1 - c ([v]x K - [omega]x), v = w + r, omega = K w."""
    return (
        _column((1.0, 0.0, 0.0), K, c, v, omega),
        _column((0.0, 1.0, 0.0), K, c, v, omega),
        _column((0.0, 0.0, 1.0), K, c, v, omega),
    )


def _column(unit: Vector, K: Matrix, c: float, v: Vector, omega: Vector) -> Vector:
    turned, bent = cross(unit, omega), cross(v, apply(K, unit))
    return ahead(ahead(unit, -c, turned), -c, bent)
