"""Euler's equations of a rigid body, in the angular momentum.

H  angular momentum, body axes        K  inverse inertia tensor, omega = K H
M  moment, body axes                  I  inertia tensor, H = I omega
r  momentum of wheels, which H is without
D  differences of K's diagonal, D1 = K33 - K22, D2 = K11 - K33, D3 = K22 - K11; their sum is 0
D11, D22  K11 - K33 and K22 - K33

The integrated form is H' = (H + r) x K H + M. Whatever symmetric K is stored, it is a rigid body:
|H + r|^2 is constant identically, which no pair of separately rounded I and I^-1 gives. H is without r:
so omega = K H is not a difference of large numbers, however strong the wheels are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from taylor_verify.models.algebra import ABSENT, Terms, add, apply, cross, is_absent, minus, times
from taylor_verify.models.form import Named, frame_rates, labelled


def angular_velocity(H: Terms, K: Sequence[Terms]) -> list[Any]:
    """Return omega = K H, body axes."""
    return apply(K, H)


def momentum_rate(H: Terms, K: Sequence[Terms], M: Terms) -> list[Any]:
    """H' = H x K H + M, body axes: Euler's equations for any symmetric tensor K.

    Only differences of K's diagonal enter, because H x H = 0. In a nearly spherical body they are
    small and known to full precision, because the difference of neighbouring numbers is exact. With K
    itself the rate would be a difference of large numbers.
    """
    if all(is_absent(K[i][j]) for i in range(3) for j in range(3) if i != j):
        return add(_principal_rate(H, differences(K)), M)
    # K - K33 1 is again a symmetric tensor: the body without a spherical part.
    deviation = [
        [minus(K[i][j], K[2][2]) if i == j else K[i][j] for j in range(3)] for i in range(3)
    ]
    deviation[2][2] = ABSENT
    return add(turning(H, deviation), M)


def differences(K: Sequence[Terms]) -> list[Any]:
    """Return D, in the arithmetic of K."""
    k1, k2, k3 = (K[i][i] for i in range(3))
    return [minus(k3, k2), minus(k1, k3), minus(k2, k1)]


def _principal_rate(H: Terms, D: Terms, summed: int | None = None) -> list[Any]:
    """Return H x K H in principal axes, with three products of the state instead of six.

    The difference at the index ``summed``, if there is one, is minus the sum of the two others.
    """
    products = [H[1] * H[2], H[2] * H[0], H[0] * H[1]]
    rates = [times(d, product) for d, product in zip(D, products, strict=True)]
    if summed is not None:
        first, second = (times(d, products[summed]) for i, d in enumerate(D) if i != summed)
        rates[summed] = minus(-first, second)
    return rates


def turning(H: Terms, deviation: Sequence[Terms]) -> list[Any]:
    """Return H x K H for K = deviation + any sphere."""
    return cross(H, apply(deviation, H))


# The equations of a form. They are values, so that two scenes with equal equations share one compiled
# integrator. ``formed`` has the indices of differences that the rung cannot represent; the arithmetic of
# the solver computes and rounds these itself.


def euler_equations(n: Named) -> dict[str, Any]:
    """Return H' = (H + r) x K H + M, and the rate of the attitude where it is tracked."""
    return _with_frame(n, momentum_rate(n.vector("H"), n.symmetric("K"), n.vector("M")))


def _with_frame(n: Named, H_rate: list[Any]) -> dict[str, Any]:
    """Return the rates of H, with the r x omega of wheels, and that of the attitude where it is tracked."""
    omega = angular_velocity(n.vector("H"), n.symmetric("K"))
    rate = add(H_rate, cross(n.vector("r"), omega))
    return labelled("H", rate) | frame_rates(n, omega, U=None)


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
        return _with_frame(n, add(_principal_rate(H, D, place), n.vector("M")))


@dataclass(frozen=True)
class TensorEuler:
    """Euler's equations with products of inertia: a spherical part is subtracted from K."""

    formed: tuple[int, ...] = ()

    def __call__(self, n: Named) -> dict[str, Any]:
        H, K = n.vector("H"), n.symmetric("K")
        deviation = [list(row) for row in K]
        deviation[2][2] = ABSENT
        for i in (1, 2):
            difference = minus(K[i - 1][i - 1], K[2][2]) if i in self.formed else n[f"D{i}{i}"]
            deviation[i - 1][i - 1] = difference
        return _with_frame(n, add(turning(H, deviation), n.vector("M")))


# The form of the text.


def heinbockel_moment(omega: Terms, omega_rate: Terms, I: Sequence[Terms]) -> list[Any]:
    """The left side of Heinbockel (2.2.70), M_m = I_im omega_i' - e_tmj I_ij omega_i omega_t.

    It is not integrated. A test uses it to prove that the form above equals the form of the text, index by
    index; (2.2.71) is its expansion and (2.2.72) its form in principal axes. For indices 0, 1, 2 the
    permutation symbol e_ijk is (i - j)(j - k)(k - i)/2.
    """
    return [
        sum(I[i][m] * omega_rate[i] for i in range(3))
        - sum(
            (t - m) * (m - j) * (j - t) // 2 * I[i][j] * omega[i] * omega[t]
            for t in range(3)
            for j in range(3)
            for i in range(3)
        )
        for m in range(3)
    ]
