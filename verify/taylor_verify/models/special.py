"""The equations of motion of bodies with more symmetry: shorter, and exactly those of form.py.

D  differences of K's diagonal: see euler.py       D11, D22  K11 - K33 and K22 - K33
p, p', q, q', r, r'  Clebsch's coefficients about any body axis

Equations here are values: two scenes that need the same ones share one compiled integrator. An index
that is ``formed`` is that of a difference which the rung cannot hold and which the arithmetic of the
solver therefore forms, and rounds, itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from taylor_verify.models.algebra import ABSENT, add, minus
from taylor_verify.models.euler import angular_velocity, differences, principal_rate, turning
from taylor_verify.models.form import CLEBSCH_NAMES, Named, frame_rates, labelled
from taylor_verify.models.kirchhoff import clebsch_rates, velocities


@dataclass(frozen=True)
class PrincipalEuler:
    """Euler's equations in principal axes: a coefficient for each of the three products.

    ``summed`` is the index of a difference that is minus the sum of the two others.
    """

    formed: tuple[int, ...] = ()
    summed: int | None = None

    def __call__(self, n: Named) -> dict[str, Any]:
        H, K, D = n.vector("H"), n.symmetric("K"), n.vector("D")
        for i in self.formed:
            D[i - 1] = differences(K)[i - 1]
        place = None if self.summed is None else self.summed - 1
        rates = labelled("H", add(principal_rate(H, D, place), n.vector("M")))
        return rates | frame_rates(n, angular_velocity(H, K), U=None)


@dataclass(frozen=True)
class TensorEuler:
    """Euler's equations with products of inertia: a sphere is taken away from K."""

    formed: tuple[int, ...] = ()

    def __call__(self, n: Named) -> dict[str, Any]:
        H, K = n.vector("H"), n.symmetric("K")
        deviation = [list(row) for row in K]
        deviation[2][2] = ABSENT
        for i in (1, 2):
            kept = minus(K[i - 1][i - 1], K[2][2]) if i in self.formed else n[f"D{i}{i}"]
            deviation[i - 1][i - 1] = kept
        rates = labelled("H", add(turning(H, deviation), n.vector("M")))
        return rates | frame_rates(n, angular_velocity(H, K), U=None)


@dataclass(frozen=True)
class ClebschAbout:
    """Kirchhoff's equations for Clebsch's T about body axis 1, 2 or 3.

    ``equal`` lists those of p, q, r that are the same along the axis as across it: p' is p then, and
    has no name of its own.
    """

    axis: int = 3
    equal: tuple[str, ...] = ()

    def __call__(self, n: Named) -> dict[str, Any]:
        six = [
            n[name.removesuffix("'") if name[0] in self.equal else name] for name in CLEBSCH_NAMES
        ]
        # A cyclic change of names turns the axes and mirrors nothing.
        order = [(self.axis + k) % 3 for k in range(3)]
        x, y, X, L = ([n.vector(letter)[i] for i in order] for letter in ("x", "y", "X", "L"))
        found = clebsch_rates(x, y, six, X, L)
        x_rate, y_rate = ([rate[order.index(i)] for i in range(3)] for rate in found)
        A, B, C = (self._about(six[k], six[k + 1]) for k in (0, 2, 4))
        U, Omega = velocities(n.vector("x"), n.vector("y"), A, B, C)
        return labelled("x", x_rate) | labelled("y", y_rate) | frame_rates(n, Omega, U)

    def _about(self, transverse: Any, axial: Any) -> Sequence[Sequence[Any]]:
        diagonal = [axial if i == self.axis - 1 else transverse for i in range(3)]
        return [[diagonal[i] if i == j else ABSENT for j in range(3)] for i in range(3)]
