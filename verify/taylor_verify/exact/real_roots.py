"""The real roots of a rational polynomial, in balls."""

from __future__ import annotations

from typing import Any

from flint import arb, fmpq_poly


def real_roots(polynomial: fmpq_poly) -> list[arb]:
    """Return the real roots of a polynomial without repeated roots, by size; a root zero is exact.

    Each ball has about the ambient relative precision. Flint isolates all complex roots, and those that it
    proves real have no imaginary part: a tenth of a second where two agree to a hundred digits.
    """
    roots: list[arb] = []
    if polynomial.degree() > 0 and not polynomial[0]:
        polynomial = polynomial // fmpq_poly([0, 1])
        roots.append(arb(0))
    if polynomial.degree() > 0:
        enclosed: Any = polynomial.numer().complex_roots()
        roots += [root.real for root, _ in enclosed if root.imag.is_zero()]
    return sorted(roots, key=arb.mid)
