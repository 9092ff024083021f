"""The fourth integrals of bodies beyond Clebsch's body of revolution, and the families that have them.

Legend: x, y the impulses in body axes, F^2 = x.x, FG = x.y; for a diagonal energy

    T = sum over i of (p_i x_i^2 + 2 b_i x_i y_i + r_i y_i^2)/2,

and (i, j, k) runs through the cyclic orders. Multiples of F^2 and FG may be added to T: they turn the
space frame and leave x and y alone. So only differences of the p_i and of the b_i count.

A body is recognised by its coefficients alone, in rationals: an integral that holds nearly is none.
Each integral is written in + - * of whatever x, y and the coefficients are, so that the same formula
gives its terms here and is put into the equations of motion, symbols and all, where it is tested.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import numpy as np
from flint import Ordering, fmpq_mpoly_ctx

from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.row_arithmetic import Array, norms
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import fraction, rational
from taylor_verify.records.quantities import IMPULSES
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse, Motion
from taylor_verify.scenes.mpfr import real
from taylor_verify.scenes.scene import Scene

# Coefficients of monomials, by the exponents of x1 x2 x3 y1 y2 y3.
Terms = Mapping[tuple[int, ...], Fraction]
# A vector of numbers of whatever kind.
Numbers = Sequence[Any]
# A family's word, and the coefficients of its integral.
Family = tuple[str, tuple[Any, ...]]

CYCLIC: Final = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


# The integrals.


def clebsch2(x: Numbers, y: Numbers, r: Numbers, theta: Any) -> Any:
    """Clebsch's second case, p_i = p0 + theta r_j r_k, with b_1 = b_2 = b_3."""
    return sum(y[i] * y[i] - theta * r[i] * x[i] * x[i] for i in range(3))


def neumann(x: Numbers, y: Numbers, r: Any, p: Numbers) -> Any:
    """r_1 = r_2 = r_3 with any p and b_1 = b_2 = b_3; where FG = 0, Neumann's point on a sphere."""
    return sum(r * p[i] * y[i] * y[i] - p[j] * p[k] * x[i] * x[i] for i, j, k in CYCLIC)


def steklov(x: Numbers, y: Numbers, r: Numbers, mu: Any) -> Any:
    """Steklov's body, b_i = mu r_j r_k + b0 and p_i = mu^2 r_i (r_j - r_k)^2 + p0."""
    return sum(
        y[i] * y[i]
        - 2 * mu * r[i] * x[i] * y[i]
        + mu * mu * (r[j] - r[k]) * (r[j] - r[k]) * x[i] * x[i]
        for i, j, k in CYCLIC
    )


def lyapunov(x: Numbers, y: Numbers, r: Any, b: Numbers) -> Any:
    """Lyapunov's body (Kolosov's), r_1 = r_2 = r_3 = r, any b and r p_i = (b_j - b_k)^2 + p0."""
    return sum(
        r * r * b[i] * y[i] * y[i]
        - 2 * r * b[j] * b[k] * x[i] * y[i]
        + b[i] * (b[j] - b[k]) * (b[j] - b[k]) * x[i] * x[i]
        for i, j, k in CYCLIC
    )


def chaplygin(x: Numbers, y: Numbers, a: Any, c: Any, d: Any) -> Any:
    """Chaplygin's body, where FG = 0 alone.

    T = a (y1^2 + y2^2 + 2 y3^2)/2 + c (x1^2 - x2^2)/2 + d x1 x2.
    """
    even = a * (y[0] * y[0] - y[1] * y[1]) + c * x[2] * x[2]
    odd = 2 * a * y[0] * y[1] + d * x[2] * x[2]
    return even * even + odd * odd


def chaplygin_leak(x: Numbers, y: Numbers, a: Any, c: Any, d: Any) -> Any:
    """The effect of FG on Chaplygin's integral K where FG is not zero: K' = leak FG."""
    return 4 * a * a * x[2] * (2 * c * y[0] * y[1] - d * (y[0] * y[0] - y[1] * y[1]))


def sokolov(x: Numbers, y: Numbers, a: Any, c: Any, d: Any) -> Any:
    """Sokolov's body, T = a (y1^2 + y2^2 + 2 y3^2)/2 + (c x1 + d x2) y3 - (c^2 + d^2) x3^2/(2 a)."""
    along_x, along_y = c * x[0] + d * x[1], c * y[0] + d * y[1]
    level = x[0] * y[0] + x[1] * y[1]
    size = c * c + d * d
    squares = y[0] * y[0] + y[1] * y[1] + y[2] * y[2]
    once = along_y * level + along_x * y[2] * y[2]
    twice = (along_x * along_x - size * x[2] * x[2]) * y[2] - 2 * size * x[2] * level
    return y[2] * (a * a * y[2] * squares + 2 * a * once + twice)


FORMULAS: Final[dict[str, Callable[..., Any]]] = {
    formula.__name__: formula
    for formula in (clebsch2, neumann, steklov, lyapunov, chaplygin, sokolov)
}


# Who has one.


@dataclass(frozen=True)
class Fourth:
    """A polynomial integral, by its terms.

    ``name`` is the family's word. ``leak`` holds the terms of g in I' = g FG, for an integral of the
    motions with FG = 0 alone, and ``span`` the time for which a motion that has left FG = 0 by
    rounding is followed.
    """

    name: str
    terms: Terms
    leak: Terms
    span: Fraction

    def value(self, motion: Motion) -> Array:
        """I at every row."""
        return _evaluated(self.terms, _columns(motion))

    def scale(self, motion: Motion) -> Any:
        """sum |c| X^m Y^n over the terms c of degrees m in x and n in y, with X = max |x|, Y = max |y|.

        At least |I|; where it is zero, I is zero whatever the direction of x and y, and 1 stands
        for it.
        """
        x, y = motion["linear_impulse"], motion["angular_impulse"]
        X, Y = max(norms(x)), max(norms(y))
        sizes = real([abs(c) for c in self.terms.values()], x)
        degrees = [(sum(powers[:3]), sum(powers[3:])) for powers in self.terms]
        total = sum(c * X**m * Y**n for c, (m, n) in zip(sizes, degrees, strict=True))
        return total if total != 0 else total + 1

    def sensitivity(self, motion: Motion) -> Mapping[str, Array]:
        """|dI/dx| and |dI/dy| at every row.

        With a leak, a disturbance also moves FG, and I by the leak's mean size times the span as
        long as that lasts: at most what stands here.
        """
        columns = _columns(motion)
        gradient = [_evaluated(_derivative(self.terms, n), columns) for n in range(6)]
        by_x, by_y = norms(np.stack(gradient[:3], axis=1)), norms(np.stack(gradient[3:], axis=1))
        if self.leak:
            sizes = abs(_evaluated(self.leak, columns))
            lost = sum(sizes) / len(sizes) * real([abs(self.span)], by_x)[0]
            by_x = by_x + lost * norms(motion["angular_impulse"])
            by_y = by_y + lost * norms(motion["linear_impulse"])
        return {"linear_impulse": by_x, "angular_impulse": by_y}


def fourth_integral(scene: Scene) -> Fourth | None:
    """The fourth integral of a free body that is no body of revolution about a body axis, or None.

    Decided in the scene's own rationals, so that of a scene rounded to a rung what is left of a
    relation between its coefficients decides.
    """
    family = family_of(scene)
    if family is None:
        return None
    name, coefficients = family
    leak = _terms(chaplygin_leak, coefficients) if name == "chaplygin" else {}
    elapsed = scene.clock.elapsed
    span = elapsed[-1] if elapsed else Fraction(0)
    return Fourth(name, _terms(FORMULAS[name], coefficients), leak, span)


def family_of(scene: Scene) -> Family | None:
    """The family of a free body that has a fourth integral, or None."""
    body, start = solid(scene)
    if not body.is_free or body.axis_of_symmetry is not None:
        return None
    return diagonal_family(body) or _kovalevskaya_family(body, start)


def diagonal_family(body: ImmersedBody) -> Family | None:
    """Clebsch's second case, r_i = r, Steklov's or Lyapunov's family, where the energy is diagonal."""
    if not all(tensors.is_diagonal(m) for m in (body.linear, body.coupling, body.angular)):
        return None
    p, b, r = (
        [matrix[i][i] for i in range(3)] for matrix in (body.linear, body.coupling, body.angular)
    )
    if _equal(r):
        if _equal(b):
            return "neumann", (r[0], _centred(p))
        rest = [r[0] * p[i] - (b[j] - b[k]) ** 2 for i, j, k in CYCLIC]
        return ("lyapunov", (r[0], _centred(b))) if _equal(rest) else None
    if _equal(b):
        theta = _slope(p, r)
        fits = _equal([p[i] - theta * r[j] * r[k] for i, j, k in CYCLIC])
        return ("clebsch2", (r, theta)) if fits else None
    mu = _slope(b, r)
    of_b = [b[i] - mu * r[j] * r[k] for i, j, k in CYCLIC]
    of_p = [p[i] - mu**2 * r[i] * (r[j] - r[k]) ** 2 for i, j, k in CYCLIC]
    return ("steklov", (r, mu)) if _equal(of_b) and _equal(of_p) else None


def _kovalevskaya_family(body: ImmersedBody, start: Impulse) -> Family | None:
    """Chaplygin's and Sokolov's: r_1 = r_2 = r_3/2, as in Kovalevskaya's top."""
    A, B, C = body.linear, body.coupling, body.angular
    a = C[0][0]
    if tensors.diagonal((a, a, 2 * a)) != C:
        return None
    zero, shared, c, d = Fraction(0), B[0][0], B[0][2], B[1][2]
    if (c or d) and B == ((shared, zero, c), (zero, shared, d), (zero, zero, shared)):
        p0 = A[0][0]
        of_sokolov = A == tensors.diagonal((p0, p0, p0 - (c**2 + d**2) / a))
        return ("sokolov", (a, c, d)) if of_sokolov else None
    c, d, p0 = (A[0][0] - A[1][1]) / 2, A[0][1], A[2][2]
    of_chaplygin = A == ((p0 + c, d, zero), (d, p0 - c, zero), (zero, zero, p0))
    is_orthogonal = tensors.dot(start.linear, start.angular) == 0
    if is_orthogonal and of_chaplygin and tensors.diagonal((shared,) * 3) == B:
        return "chaplygin", (a, c, d)
    return None


def _equal(values: Sequence[Fraction]) -> bool:
    return all(value == values[0] for value in values[1:])


def _centred(values: Sequence[Fraction]) -> list[Fraction]:
    """Return the values less their mean, which adds only F^2, FG and T to an integral."""
    mean = sum(values, Fraction(0)) / 3
    return [value - mean for value in values]


def _slope(values: Sequence[Fraction], r: Sequence[Fraction]) -> Fraction:
    """s from two of v_i = v0 + s r_j r_k, for r that are not all equal."""
    i, j, k = next(order for order in CYCLIC if r[order[0]] != r[order[1]])
    return (values[i] - values[j]) / (r[k] * (r[j] - r[i]))


# Polynomials.


def _terms(formula: Callable[..., Any], coefficients: Sequence[Any]) -> Terms:
    """The formula multiplied out, its coefficients being rational."""
    state = fmpq_mpoly_ctx.get(IMPULSES, Ordering.lex).gens()
    polynomial = formula(state[:3], state[3:], *map(_rational, coefficients))
    return {
        tuple(int(power) for power in powers): fraction(c)
        for powers, c in polynomial.to_dict().items()
    }


def _rational(value: Any) -> Any:
    """A number, or a list of some, as flint multiplies a polynomial by it."""
    if isinstance(value, list):
        return [_rational(entry) for entry in value]
    return rational(value)


def _derivative(polynomial: Terms, place: int) -> Terms:
    """Return the derivative by the variable at this place."""
    return {
        (*powers[:place], powers[place] - 1, *powers[place + 1 :]): powers[place] * c
        for powers, c in polynomial.items()
        if powers[place]
    }


def _columns(motion: Motion) -> list[Array]:
    both = np.concatenate([motion["linear_impulse"], motion["angular_impulse"]], axis=1)
    return [both[:, n] for n in range(6)]


def _evaluated(polynomial: Terms, columns: Sequence[Array]) -> Array:
    """The polynomial at every row, at the ambient precision."""
    total: Array = 0 * columns[0]
    for powers, c in zip(polynomial, real(list(polynomial.values()), columns[0]), strict=True):
        term = c
        for column, power in zip(columns, powers, strict=True):
            for _ in range(power):
                term = term * column
        total = total + term
    return total
