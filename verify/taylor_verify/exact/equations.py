"""The equations of motion as polynomials with exact coefficients.

Each kind of body writes its own from the texts; they share nothing with models. A polynomial is
homogeneous of degree two: the coefficient of each product of two variables, which are counted from 0, the
smaller first.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from taylor_verify.exact import clocks
from taylor_verify.exact.clocks import Polynomial
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.tensors import Matrix, Vector


@dataclass(frozen=True)
class Equations:
    """z' = constant + linear z + rates, with Omega = spin z and U = velocity z.

    There are no rows of velocity without a U, and none of linear without such terms.
    """

    constant: Vector
    rates: list[Polynomial]
    spin: Matrix
    velocity: Matrix = ()
    linear: Matrix = ()


def driven(free: list[Polynomial], motion: Manufactured | None, clock: int) -> list[Polynomial]:
    """The rates with the loads of a manufactured motion, if there is one, and then those of its clock."""
    if motion is None:
        return free
    loads = clocks.loads(free, motion, clock)
    return [total(p, q) for p, q in zip(free, loads, strict=True)] + clocks.rates(motion, clock)


def cross(left: Matrix, right: Matrix) -> list[Polynomial]:
    """The product (left z) x (right z) of two linear forms of z, each given by three rows.

    With the forms put in, what cancels in exact coefficients is gone: a vector that stays zero for a whole
    body is disturbed by no rounding.
    """
    one, other = (
        [[(place, c) for place, c in enumerate(row) if c] for row in form] for form in (left, right)
    )
    found: list[Polynomial] = []
    for j, k in ((1, 2), (2, 0), (0, 1)):
        rate: dict[tuple[int, int], Fraction] = {}
        backward = [(place, -c) for place, c in one[k]]
        for first, second in ((one[j], other[k]), (backward, other[j])):
            for (a, p), (b, q) in product(first, second):
                # a b and b a are one product.
                pair = (min(a, b), max(a, b))
                rate[pair] = rate[pair] + p * q if pair in rate else p * q
        found.append({pair: c for pair, c in rate.items() if c})
    return found


def times(factor: Fraction, polynomial: Polynomial) -> Polynomial:
    return {pair: factor * coefficient for pair, coefficient in polynomial.items()}


def total(*polynomials: Polynomial) -> Polynomial:
    """The sum; what cancels is gone."""
    found: dict[tuple[int, int], Fraction] = {}
    for polynomial in polynomials:
        for pair, coefficient in polynomial.items():
            found[pair] = found.get(pair, Fraction(0)) + coefficient
    return {pair: coefficient for pair, coefficient in found.items() if coefficient}
