"""The function that carries x3 in elementary motions: f is a quadratic, or has a repeated root d.

Legend: z = x3; v is z itself if f is a quadratic, else 1/(z - d). Then v'^2 = Q(v) = A v^2 + 2 B v + C with
rational A, B, C, so that v'' = A v + B.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from taylor_verify.exact.kirchhoff.quartic import Nutation, derivative, repeated_root, value


@dataclass(frozen=True)
class Carrier:
    """v at the start, and the coefficients of Q; ``d`` is None where v is z itself."""

    d: Fraction | None
    v: Fraction
    A: Fraction
    B: Fraction
    C: Fraction

    @classmethod
    def of(cls, nutation: Nutation) -> Carrier:
        """Return the carrier of an f of degree two, or with one repeated root and no start there."""
        f, z = nutation.f, nutation.z
        if len(f) == 3:
            return cls(None, z, f[0], f[1] / 2, f[2])
        d = repeated_root(f)
        assert d is not None
        second = derivative(derivative(f))
        lead = f[0] if len(f) == 5 else Fraction(0)
        A, B = value(second, d) / 2, value(derivative(second), d) / 12
        return cls(d, 1 / (z - d), A, B, lead)
