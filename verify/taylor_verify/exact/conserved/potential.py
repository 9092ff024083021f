"""The potential V of loads: a polynomial in the attitude R and the centre.

V is linear in r11 .. r33 and c1 .. c3 as that of a weight or of a dipole, or has products of two of them as
that of a spring.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import chain, combinations_with_replacement
from operator import mul
from typing import Self

import numpy as np

from taylor_verify.exact.conserved.derivation import Derivation
from taylor_verify.exact.conserved.polynomial import Polynomial, multiplied, terms
from taylor_verify.exact.invariant import Array
from taylor_verify.exact.row_arithmetic import cross
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.loads import CENTRE, QUATERNION, ROTATION
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import real

Factors = tuple[str, ...]


@dataclass(frozen=True)
class Potential:
    """V as the sum of number times product, each product of one or two of r11 .. r33, c1 .. c3."""

    terms: Mapping[Factors, Fraction]

    @classmethod
    def among(cls, combinations: Sequence[Vector], factors: Sequence[Factors]) -> Self | None:
        """The potential of the shortest combination of T and products that has T; None without one."""
        with_energy = [vector for vector in combinations if vector[0]]
        if not with_energy:
            return None
        energy, *numbers = min(with_energy, key=lambda vector: sum(map(bool, vector)))
        terms = zip(factors, numbers, strict=True)
        return cls({product: number / energy for product, number in terms if number})

    @property
    def has_centre(self) -> bool:
        """True if V depends on the centre."""
        return not set(CENTRE).isdisjoint(chain(*self.terms))

    def __str__(self) -> str:
        """V as a formula."""
        parts = [" ".join((str(number), *names)) for names, number in self.terms.items()]
        return " + ".join(parts).replace("+ -", "- ")

    def value(self, motion: Motion) -> Array:
        """V at every row (n,)."""
        columns = self._columns(motion)
        return self._sum(motion, {names: [columns[n] for n in names] for names in self.terms})

    def by_turn(self, motion: Motion) -> Array:
        """The derivative by a turn of the frame, a rotation vector in space axes (n, 3)."""
        R = motion["attitude"]
        slopes = np.stack([self._slope(motion, name) for name in ROTATION], axis=1)
        G = slopes.reshape(R.shape)
        turns: Array = np.sum([cross(R[:, :, j], G[:, :, j]) for j in range(3)], axis=0)
        return turns

    def by_centre(self, motion: Motion) -> Array:
        """The derivative by the centre (n, 3)."""
        return np.stack([self._slope(motion, name) for name in CENTRE], axis=1)

    def _slope(self, motion: Motion, name: str) -> Array:
        """The derivative by one entry."""
        columns, parts = self._columns(motion), dict[Factors, list[Array]]()
        for names in self.terms:
            if name in names:
                others = list(names)
                others.remove(name)
                # A square has the same entry twice.
                parts[names] = [columns[n] * names.count(name) for n in others]
        return self._sum(motion, parts)

    def _sum(self, motion: Motion, parts: Mapping[Factors, Sequence[Array]]) -> Array:
        like = motion["attitude"]
        result = real([Fraction(0)] * len(like), like)
        for names, columns in parts.items():
            (number,) = real([self.terms[names]], like)
            result = result + reduce(mul, columns, number)
        return result

    def _columns(self, motion: Motion) -> dict[str, Array]:
        R = motion["attitude"]
        columns = dict(zip(ROTATION, R.reshape(len(R), 9).T, strict=True))
        if self.has_centre:
            columns |= dict(zip(CENTRE, motion["centre"].T, strict=True))
        return columns


def potentials(derivation: Derivation, power: Polynomial) -> dict[Factors, Polynomial]:
    """Return the products of which V may consist; pairs only where the power is that of a position."""
    entries = dict(zip(ROTATION, chain(*derivation.attitude), strict=True))
    if derivation.velocity:
        entries |= {name: derivation.known[name] for name in CENTRE}
    products: dict[Factors, Polynomial] = {(name,): entry for name, entry in entries.items()}
    if _is_positional(derivation, power):
        for first, second in combinations_with_replacement(entries, 2):
            products[first, second] = multiplied(entries[first], entries[second])
    return products


def _is_positional(derivation: Derivation, power: Polynomial) -> bool:
    """True if forces that depend on the position alone may have this power, and not linearly."""
    state, places = set(derivation.names), {*QUATERNION, *CENTRE}
    is_linear = True
    for monomial, _ in terms(power):
        moving = sum(name in state for name in monomial)
        if moving != 1 or not places.issuperset(set(monomial) - state):
            return False
        is_linear = is_linear and len(monomial) <= 3
    return not is_linear
