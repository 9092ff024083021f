"""Polynomials: their values, and the real roots of rational ones in balls."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from flint import arb, fmpq_poly

from taylor_verify.numbers.irrational import rational


def polynomial(*coefficients: Fraction) -> fmpq_poly:
    """Return the polynomial of these coefficients, the constant one first."""
    return fmpq_poly([rational(c) for c in coefficients])


def value_of(coefficients: Sequence[Any], x: Any) -> Any:
    """Return the polynomial at x in any numbers, by Horner's rule; the constant coefficient first."""
    *rest, total = coefficients
    for coefficient in reversed(rest):
        total = total * x + coefficient
    return total


def real_roots(function: fmpq_poly) -> list[arb]:
    """Return the real roots of a polynomial without repeated roots, by size; a root zero is exact.

    Each ball has about the ambient relative precision. Flint isolates all complex roots, and those that it
    proves real have no imaginary part: a tenth of a second where two agree to a hundred digits.
    """
    roots: list[arb] = []
    if function.degree() > 0 and not function[0]:
        function = function // fmpq_poly([0, 1])
        roots.append(arb(0))
    if function.degree() > 0:
        enclosed: Any = function.numer().complex_roots()
        roots += [root.real for root, _ in enclosed if root.imag.is_zero()]
    return sorted(roots, key=arb.mid)
