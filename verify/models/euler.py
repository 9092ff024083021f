"""Euler's equations of a rigid body, in the angular momentum.

H  angular momentum, body axes        K  inverse inertia tensor, omega = K H
M  moment, body axes                  I  inertia tensor, H = I omega

The integrated form is H' = H x K H + M. Whatever symmetric K is stored, it is a rigid body:
|H|^2 is constant identically, which no pair of separately rounded I and I^-1 gives.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from verify.models.algebra import Terms, add, apply, cross, is_absent, minus, times


def angular_velocity(H: Terms, K: Sequence[Terms]) -> list[Any]:
    """omega = K H, body axes."""
    return apply(K, H)


def momentum_rate(H: Terms, K: Sequence[Terms], M: Terms) -> list[Any]:
    """H' = H x K H + M, body axes: Euler's equations for any symmetric tensor K."""
    free = _principal_rate(H, K) if _is_diagonal(K) else cross(H, angular_velocity(H, K))
    return add(free, M)


def _principal_rate(H: Terms, K: Sequence[Terms]) -> list[Any]:
    """H x K H in principal axes, where three products of the state serve for six."""
    H23, H31, H12 = H[1] * H[2], H[2] * H[0], H[0] * H[1]
    return [
        minus(times(K[2][2], H23), times(K[1][1], H23)),
        minus(times(K[0][0], H31), times(K[2][2], H31)),
        minus(times(K[1][1], H12), times(K[0][0], H12)),
    ]


def _is_diagonal(K: Sequence[Terms]) -> bool:
    return all(is_absent(K[i][j]) for i in range(3) for j in range(3) if i != j)


def heinbockel_moment(omega: Terms, omega_rate: Terms, I: Sequence[Terms]) -> list[Any]:
    """The left side of Heinbockel (2.2.70), M_m = I_im omega_i' - e_tmj I_ij omega_i omega_t.

    Not integrated: it stands here so that a test can prove the form above equal to the text's, index
    by index; (2.2.71) is its expansion and (2.2.72) its form in principal axes.
    """
    return [
        sum(I[i][m] * omega_rate[i] for i in range(3))
        - sum(
            _permutation_sign(t, m, j) * I[i][j] * omega[i] * omega[t]
            for t in range(3)
            for j in range(3)
            for i in range(3)
        )
        for m in range(3)
    ]


def _permutation_sign(i: int, j: int, k: int) -> int:
    """The permutation symbol e_ijk for indices 0, 1, 2."""
    return (i - j) * (j - k) * (k - i) // 2
