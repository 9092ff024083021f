"""A rigid body in exact symbols, in space axes and in body axes (Heinbockel's barred ones).

I, w, M    inertia tensor, angular velocity and moment in body axes; dw the rate of w, free symbols
l          l_ip: component along space axis i of body axis p, so that v_i = l_ip v-bar_p; l = R
e_ijk      the permutation symbol, whose indices run over 0, 1, 2 here
H_mn       e_rmn H_r, M_mn = e_rmn M_r, w_mn = e_kmn w_k: a vector as an antisymmetric tensor
I_mnst     e_jmn e_ist I_ij/2, so that H_mn = I_mnst w_st
law        dH_r/dt - M_r in space axes: what Newton's law sets to zero. As dw is free, it is not zero
           here, and an equation of motion is checked by what it makes of the law
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Any, Final

from taylor_verify.claims.field import (
    QUATERNION,
    Element,
    Field,
    apply,
    cross,
    minus,
    named,
    plus,
    quaternion_rates,
    rotation,
    transposed,
    unit_root,
    values,
)

Tensor = Mapping[Any, Any]
"""Components by their indices."""

INDICES: Final = (0, 1, 2)
PAIRS: Final = tuple(product(INDICES, repeat=2))


def permutation(i: int, j: int, k: int) -> int:
    """e_ijk for indices 0, 1, 2."""
    return (i - j) * (j - k) * (k - i) // 2


def antisymmetric(vector: Sequence[Any]) -> Tensor:
    """e_rmn v_r."""
    return {
        (m, n): sum((permutation(r, m, n) * vector[r] for r in INDICES), start=0) for m, n in PAIRS
    }


def fourth_rank(inertia: Sequence[Sequence[Any]]) -> Tensor:
    """I_mnst = e_jmn e_ist I_ij/2."""
    half = Fraction(1, 2)
    return {
        (*mn, *st): half
        * sum(
            (
                permutation(j, *mn) * permutation(i, *st) * inertia[i][j]
                for i, j in PAIRS
                if permutation(j, *mn) * permutation(i, *st)
            ),
            start=inertia[0][0] * 0,
        )
        for mn, st in product(PAIRS, PAIRS)
    }


def contracted(tensor: Tensor, other: Tensor) -> Tensor:
    """I_mnst w_st."""
    return {mn: sum((tensor[(*mn, *st)] * other[st] for st in PAIRS), start=0) for mn in PAIRS}


def turned(tensor: Tensor, matrix: Sequence[Sequence[Any]]) -> Tensor:
    """t_ij... = l_ip l_jq ... t-bar_pq..., one index after the other."""
    rank = len(next(iter(tensor)))
    for place in range(rank):
        tensor = {
            key: sum(
                (
                    matrix[key[place]][p] * tensor[(*key[:place], p, *key[place + 1 :])]
                    for p in INDICES
                ),
                start=0,
            )
            for key in tensor
        }
    return tensor


class RigidMotion:
    """The symbols; ``full`` takes nine free entries of I, without I_ij = I_ji."""

    def __init__(self, full: bool = False) -> None:
        names = [f"{v}{k}" for v in ("w", "dw", "M", "s") for k in (1, 2, 3)]
        names += [f"I{j}{k}" for j in "123" for k in "123" if full or j <= k]
        self.field = field = Field({**QUATERNION, **values(names)}, {"e0": unit_root})
        self.w, self.dw, self.M = (field.vector(v) for v in ("w", "dw", "M"))
        self.I = field.matrix("I") if full else field.symmetric("I")
        self.l = rotation([field[f"e{k}"] for k in range(4)])
        # A particle of the body at s, in space axes, moves with it.
        self.s = field.vector("s")
        swept = cross(apply(self.l, self.w), self.s)
        field.turn(quaternion_rates(field, self.w) | named("w", self.dw) | named("s", swept))

    def rates(self, tensor: Tensor) -> Tensor:
        return {key: self.field.rate(self.field.element(entry)) for key, entry in tensor.items()}

    @property
    def momentum(self) -> list[Element]:
        """H = I w, body axes."""
        return apply(self.I, self.w)

    @property
    def euler(self) -> list[Element]:
        """I w' + w x I w - M, body axes."""
        return minus(plus(apply(self.I, self.dw), cross(self.w, self.momentum)), self.M)

    @property
    def law(self) -> list[Element]:
        """d(l H)/dt - l M, space axes."""
        spatial = self.field.rates(apply(self.l, self.momentum))
        return minus(spatial, apply(self.l, self.M))

    @property
    def spatial_inertia(self) -> list[list[Element]]:
        """l I l^T."""
        half = [apply(self.I, row) for row in self.l]
        return transposed([apply(self.l, column) for column in half])


@cache
def unsymmetric() -> RigidMotion:
    """Nine free entries of I."""
    return RigidMotion(full=True)
