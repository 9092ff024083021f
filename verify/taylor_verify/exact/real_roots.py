"""The real roots of a rational polynomial, in balls.

Sturm's theorem counts the roots of an interval by the signs of exact values, and quadratic refinement
narrows it: every step is proved by a change of sign, and none takes long. The roots of flint come from one
call, which takes minutes where two of them agree to some hundred digits.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Final

from flint import arb, ctx, fmpq, fmpq_poly

_ZERO: Final = fmpq(0)


def real_roots(polynomial: fmpq_poly) -> list[arb]:
    """Return the real roots of a polynomial without repeated roots, by size; a root zero is exact.

    Each ball has about the ambient relative precision.
    """
    roots: list[arb] = []
    if polynomial.degree() > 0 and not polynomial[0]:
        polynomial = polynomial // fmpq_poly([0, 1])
        roots.append(arb(0))
    roots += [_refined(polynomial, low, high) for low, high in _isolated(polynomial)]
    return sorted(roots, key=arb.mid)


def _isolated(polynomial: fmpq_poly) -> list[tuple[fmpq, fmpq]]:
    """Return disjoint intervals (low, high] in ascending order, each with one root."""
    if polynomial.degree() < 1:
        return []
    chain, bound = _sturm_chain(polynomial), _bound(polynomial)
    ends = [(z, _changes(chain, z)) for z in (-bound, bound)]
    pending, intervals = [tuple(ends)], []
    while pending:
        (low, before), (high, after) = pending.pop()
        if before - after == 1:
            intervals.append((low, high))
        elif before - after > 1:
            middle = (low + high) / 2
            between = middle, _changes(chain, middle)
            pending += [(between, (high, after)), ((low, before), between)]
    return intervals


def _sturm_chain(polynomial: fmpq_poly) -> list[fmpq_poly]:
    chain = [polynomial, polynomial.derivative()]
    while chain[-1].degree() > 0:
        rest = (chain[-2] % chain[-1]).numer()
        # Only signs are read: a positive factor keeps the numbers short.
        chain.append(fmpq_poly(-rest // rest.content()))
    return chain


def _changes(chain: list[fmpq_poly], z: fmpq) -> int:
    """Return Sturm's number of sign changes: it falls by the number of roots in (low, high]."""
    signs = [value > 0 for member in chain if (value := member(z)) != 0]
    return sum(a != b for a, b in pairwise(signs))


def _bound(polynomial: fmpq_poly) -> fmpq:
    """Return a power of two above every root: none exceeds twice the largest |c_k/c_0|^(1/k) (Fujiwara)."""
    first, *others = reversed(polynomial.coeffs())
    exponents = [-(-_log2(c / first) // k) for k, c in enumerate(others, 1) if c]
    return fmpq(2) ** (1 + max(exponents, default=0))


def _log2(value: fmpq) -> int:
    """Return an exponent that is at least log2 |value|, by less than 2."""
    return abs(value.p).bit_length() - value.q.bit_length() + 1


def _refined(f: fmpq_poly, low: fmpq, high: fmpq) -> arb:
    """Narrow an interval (low, high] with one root, which is not zero, by quadratic refinement.

    The interval is cut into ``parts`` and the one where the chord meets the axis is tried. If the root is
    there, the number of parts is squared; if not, the interval is halved.
    """
    scale = fmpq(2) ** -ctx.prec
    at_low, at_high = f(low), f(high)
    above = at_low if at_low else f.derivative()(low)  # it has the sign of f just above low
    parts = fmpq(4)
    while at_high and not (low * high > 0 and high - low <= scale * min(abs(low), abs(high))):
        step = (high - low) / parts
        number = min(fmpq((parts * at_low / (at_low - at_high)).floor()), parts - 1)
        left, right = low + number * step, low + (number + 1) * step
        at_left, at_right = f(left), f(right)
        if (left == low or at_left * above > 0) and at_right * above <= 0:
            parts = parts**2
        else:
            parts, middle = fmpq(4), (low + high) / 2
            at_middle = f(middle)
            is_above = at_middle * above > 0
            left, at_left = (middle, at_middle) if is_above else (low, at_low)
            right, at_right = (high, at_high) if is_above else (middle, at_middle)
        low, at_low, high, at_high = left, at_left, right, at_right
    return arb(high) if not at_high else arb(low).union(arb(high))
