"""The axis of a body of revolution in any direction, also an irrational one, and body axes about it.

Legend: N = n n^T/nu with nu = n.n projects onto the axis e = n/sqrt(nu), and T is Clebsch's about e if

    A = p 1 + (p' - p) N,    B = q 1 + (q' - q) N,    C = r 1 + (r' - r) N.

N is rational, and so is n, but sqrt(nu) rarely is. The body is therefore solved by sqrt(nu) x and
sqrt(nu) y, whose third components n.x and n.y are rational, with the six coefficients over sqrt(nu):
the time is what it was, and f, F^2 and FG are rational. Across the axis, with m.n = 0, mu = m.m and
k = n x m,

    sqrt(nu) v = v_m e1 + v_k e2 + v_n e,    e1 = m/sqrt(mu),    e2 = k/sqrt(nu mu),
    v_m + i v_k = (sqrt(nu) m.v + i k.v)/sqrt(mu),    v_n = n.v.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm
from typing import Any, Final, TypeVar

import numpy as np
from flint import arb
from mpmath import mp

from taylor_verify.exact.carried import Back
from taylor_verify.exact.solution import Number, Time
from taylor_verify.exact.spectrum import Cubic
from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody
from taylor_verify.scenes.motion import Impulse

_UNIT: Final = tensors.diagonal((Fraction(1),) * 3)

Real = TypeVar("Real")


@dataclass(frozen=True)
class Axes:
    """An axis n and a direction m across it, both rational and of any length."""

    n: Vector = _UNIT[2]
    m: Vector = _UNIT[0]

    @classmethod
    def about(cls, n: Vector) -> Axes:
        """Return axes about n."""
        shortest = min(range(3), key=lambda i: abs(n[i]))
        across = tensors.cross(_UNIT[shortest], n) if n[shortest] else _UNIT[shortest]
        return cls(n, across)

    @cached_property
    def k(self) -> Vector:
        return tensors.cross(self.n, self.m)

    @cached_property
    def nu(self) -> Fraction:
        return tensors.dot(self.n, self.n)

    @cached_property
    def mu(self) -> Fraction:
        return tensors.dot(self.m, self.m)

    @property
    def is_upright(self) -> bool:
        """True for the body axes themselves, where v_m, v_k and v_n are v1, v2 and v3."""
        return self == UPRIGHT

    @property
    def number(self) -> int | None:
        """1, 2 or 3 if e is that body axis; None if it is oblique."""
        return _UNIT.index(self.n) + 1 if self.n in _UNIT else None

    def pair(self, v: Vector) -> tuple[Fraction, Fraction]:
        """Return m.v and k.v, the rational parts of v_m and v_k."""
        return tensors.dot(self.m, v), tensors.dot(self.k, v)

    def across(self, v: Vector, number: Callable[[Fraction], Real]) -> tuple[Real, Real]:
        """Return v_m and v_k."""
        along_m, along_k = (number(part) for part in self.pair(v))
        size: Any = root(number(self.mu))
        return root(number(self.nu)) * along_m / size, along_k / size

    def columns(self, number: Number) -> list[list[Any]]:
        """Return e1, e2 and e in body axes."""
        nu, mu = number(self.nu), number(self.mu)
        lengths = root(mu), root(nu * mu), root(nu)
        return [
            [number(entry) / length for entry in vector]
            for vector, length in zip((self.m, self.k, self.n), lengths, strict=True)
        ]


UPRIGHT: Final = Axes()


def root(value: Any) -> Any:
    """Return the square root of a ball or of a number of mpmath."""
    return value.sqrt() if isinstance(value, arb) else mp.sqrt(value)


def clebsch_about(body: ImmersedBody) -> tuple[Clebsch, Axes] | None:
    """The six coefficients of T and the axes about which T is Clebsch's, or None if it is not.

    Axis 3 where there is a choice. Decided in rationals.
    """
    if body.clebsch is not None:
        return body.clebsch, UPRIGHT
    blocks = (body.linear, body.coupling, body.angular)
    n = next(filter(None, map(_direction, (body.angular, body.linear, body.coupling))), None)
    if n is None:
        return None
    six = Clebsch(*(share for block in blocks for share in _shares(block, n)))
    form = body_about(six, n)
    is_clebsch = blocks == (form.linear, form.coupling, form.angular)
    return (six, Axes.about(n)) if is_clebsch else None


def body_about(six: Clebsch, n: Vector) -> ImmersedBody:
    """Return the free body of these six coefficients about the direction n."""
    return ImmersedBody(
        linear=_about(six.p, six.p_prime, n),
        coupling=_about(six.q, six.q_prime, n),
        angular=_about(six.r, six.r_prime, n),
    )


def _direction(matrix: Matrix) -> Vector | None:
    """The axis of c 1 + s n n^T, in whole numbers without a common factor; None if s = 0.

    Where the matrix is not of that form this is some vector, or None.
    """
    cubic = Cubic.of(matrix)
    if not cubic.spread:
        return None
    double = cubic.double_root
    rest = [
        tensors.minus(row, tensors.scaled(double, unit))
        for row, unit in zip(matrix, _UNIT, strict=True)
    ]
    column = next((row for row in rest if any(row)), None)
    return None if column is None else _primitive(column)


def _primitive(v: Vector) -> Vector | None:
    """The shortest vector of whole numbers along v or against it, its first entry positive.

    None where no multiple of v is rational.
    """
    first = next(entry for entry in v if entry)
    ratios = [entry / first for entry in v]
    if not all(isinstance(ratio, Fraction) for ratio in ratios):
        return None
    scale = lcm(*(ratio.denominator for ratio in ratios))
    whole = [int(ratio * scale) for ratio in ratios]
    shared = gcd(*whole)
    return tuple(Fraction(entry, shared) for entry in whole)


def _shares(matrix: Matrix, n: Vector) -> tuple[Fraction, Fraction]:
    """c and c', as if the matrix were c 1 + (c' - c) N."""
    along = tensors.dot(n, tensors.apply(matrix, n)) / tensors.dot(n, n)
    trace = sum((matrix[i][i] for i in range(3)), Fraction(0))
    return (trace - along) / 2, along


def _about(across: Fraction, along: Fraction, n: Vector) -> Matrix:
    """Return across 1 + (along - across) N."""
    share = (along - across) / tensors.dot(n, n)
    return tuple(
        tensors.plus(tensors.scaled(across, unit), tensors.scaled(share * entry, n))
        for unit, entry in zip(_UNIT, n, strict=True)
    )


def at_rest_in_space(start: Impulse) -> Impulse:
    """The start with body axes along those of space, and the centre at their origin."""
    return Impulse(start.linear, start.angular)


def out_of(axes: Axes, start: Impulse) -> Back:
    """Return the way back from the motion in these axes, which started with R = 1 and its centre at 0.

    R = R0 P R' P^T and centre = centre0 + R0 P centre', where P has the columns e1, e2, e.
    """
    to_space = rotation_matrix(start.attitude)
    as_given = {
        "linear_impulse": start.linear,
        "angular_impulse": start.angular,
        "attitude": to_space,
        "centre": start.centre,
    }

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        exactly = np.vectorize(number, otypes=[object])
        P = np.array(axes.columns(number), dtype=object).T
        turned, length = exactly(np.array(to_space)) @ P, root(number(axes.nu))
        for name in ("linear_impulse", "angular_impulse"):
            rows[name] = rows[name] @ P.T / length
        if "attitude" in rows:
            rows["attitude"] = turned @ rows["attitude"] @ P.T
        if "centre" in rows:
            rows["centre"] = rows["centre"] @ turned.T + exactly(np.array(start.centre))
        # A zero of the start has no digits but exact ones.
        for name, place in as_given.items():
            if name in rows:
                rows[name][[t == 0 for t in elapsed]] = exactly(np.array(place))

    return back
