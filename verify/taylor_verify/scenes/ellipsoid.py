"""Mass, inertia and added masses of a homogeneous ellipsoid, exactly, in pi and Lamb's integrals.

Legend: semi-axes a_i, V = 4 pi a_1 a_2 a_3/3, (i, j, k) any order of (1, 2, 3), M mass, I moments of
inertia about the axes, m added masses, j added moments of inertia, rho the density of the fluid; Lamb,
Hydrodynamics, arts. 114 and 115, with s = a_j^2 - a_k^2:

    alpha_i = (2/3) a_1 a_2 a_3 R_D(a_j^2, a_k^2, a_i^2),    alpha_1 + alpha_2 + alpha_3 = 2,
    m_i = rho V alpha_i/(2 - alpha_i),
    j_i = rho V s^2 (alpha_k - alpha_j)/(5 (2 s + (a_j^2 + a_k^2)(alpha_j - alpha_k))).

Two equal semi-axes have equal alphas, and three have 2/3: then fewer integrals are left, or none. What
cancels in these formulas costs no digit: their numbers are exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, Final, NamedTuple, final

from flint import acb, arb

from taylor_verify.numbers.irrational import Constant, Pi, ball, generator
from taylor_verify.numbers.tensors import Vector

_MOST_CACHED: Final = 256


@final
@dataclass(frozen=True)
class LambIntegral(Constant):
    """alpha_i of an ellipsoid: a function of the squares of the other two semi-axes over a_i."""

    squares: tuple[Fraction, Fraction]

    def __str__(self) -> str:
        return "Lamb's integrals"

    def evaluated(self) -> arb:
        """Return (2/3) (a_j/a_i)(a_k/a_i) R_D((a_j/a_i)^2, (a_k/a_i)^2, 1), by Arb."""
        y, z = map(ball, self.squares)
        return 2 * (y * z).sqrt() * acb.elliptic_rd(y, z, acb(1)).real / 3


class Inertias(NamedTuple):
    """Mass M, inertia I, added mass and added inertia, along or about body axes 1, 2, 3.

    Each number is a Fraction or an Irrational.
    """

    mass: Any
    inertia: tuple[Any, ...]
    added_mass: tuple[Any, ...]
    added_inertia: tuple[Any, ...]

    @property
    def masses(self) -> tuple[Any, ...]:
        """M + m_i."""
        return tuple(self.mass + m for m in self.added_mass)

    @property
    def moments(self) -> tuple[Any, ...]:
        """I_i + j_i."""
        return tuple(I + j for I, j in zip(self.inertia, self.added_inertia, strict=True))


@lru_cache(maxsize=_MOST_CACHED)
def inertias(semi_axes: Vector, density: Fraction, fluid_density: Fraction) -> Inertias:
    """Return the inertias of an ellipsoid exactly."""
    constants, alphas = _alphas(semi_axes) if fluid_density else ((Pi(),), (Fraction(0),) * 3)
    a, b, c = semi_axes
    volume = generator(constants, 0) * (Fraction(4, 3) * a * b * c)
    mass, displaced = volume * density, volume * fluid_density
    squares = [axis * axis for axis in semi_axes]
    inertia, added_mass, added_inertia = [], [], []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        gap, total = squares[j] - squares[k], squares[j] + squares[k]
        difference = alphas[k] - alphas[j]
        inertia.append(mass * total / 5)
        added_mass.append(displaced * alphas[i] / (2 - alphas[i]))
        added_inertia.append(
            displaced * gap * gap * difference / (5 * (2 * gap - total * difference))
            if gap
            else Fraction(0)
        )
    return Inertias(mass, tuple(inertia), tuple(added_mass), tuple(added_inertia))


def _alphas(semi_axes: Vector) -> tuple[tuple[Constant, ...], tuple[Any, ...]]:
    """Return the constants of the field, and alpha_1, alpha_2, alpha_3 in it."""
    if len(set(semi_axes)) == 1:
        return (Pi(),), (Fraction(2, 3),) * 3
    single = [i for i in range(3) if semi_axes.count(semi_axes[i]) == 1]
    # Two of three different ones, or the one that differs from the other two.
    places = single[:2] if len(single) == 3 else single
    constants = (Pi(), *(LambIntegral(_squares(semi_axes, i)) for i in places))
    alphas: dict[int, Any] = {
        place: generator(constants, number) for number, place in enumerate(places, start=1)
    }
    others = [i for i in range(3) if i not in alphas]
    rest = (2 - sum(alphas.values(), Fraction(0))) / len(others)
    return constants, tuple(alphas.get(i, rest) for i in range(3))


def _squares(semi_axes: Vector, i: int) -> tuple[Fraction, Fraction]:
    j, k = (i + 1) % 3, (i + 2) % 3
    return (semi_axes[j] / semi_axes[i]) ** 2, (semi_axes[k] / semi_axes[i]) ** 2
