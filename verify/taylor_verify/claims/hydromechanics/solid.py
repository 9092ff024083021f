"""The solid of section 48 in exact symbols: all 21 coefficients of T, loads, attitude and origin.

x, y    impulses, body axes            U = dT/dx, Omega = dT/dy    (P, Q, R are Omega's components)
X, L    force and couple, body axes    A, B, C    T = x.A x/2 + x.B y + y.C y/2
R       body to space, v_space = R v_body, from the quaternion e of norm 1; R' = R [Omega]x
c       the origin in space, c' = R U   n    a direction fixed in space; l = R^T n in body axes
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Final

from taylor_verify.claims.field import (
    QUATERNION,
    Element,
    Field,
    apply,
    cross,
    dot,
    named,
    plus,
    quaternion_rates,
    rotation,
    transposed,
    unit_root,
    values,
)

_PAIRS: Final = ("11", "12", "13", "22", "23", "33")
_ALL: Final = tuple(f"{j}{k}" for j in "123" for k in "123")


class Solid:
    """The symbols of a solid; ``dx`` and ``dy`` are its rates, free symbols unless it obeys (3), (4)."""

    def __init__(self, obeys: bool, loaded: bool) -> None:
        plain = [f"{v}{k}" for v in ("x", "y", "c", "n") for k in (1, 2, 3)]
        if not obeys:
            plain += [f"{v}{k}" for v in ("dx", "dy") for k in (1, 2, 3)]
        if loaded:
            plain += [f"{v}{k}" for v in ("X", "L") for k in (1, 2, 3)]
        plain += [f"A{pair}" for pair in _PAIRS] + [f"B{pair}" for pair in _ALL]
        plain += [f"C{pair}" for pair in _PAIRS]
        self.field = field = Field({**QUATERNION, **values(plain)}, {"e0": unit_root})
        self.x, self.y, self.c, self.n = map(field.vector, ("x", "y", "c", "n"))
        nothing = [field.element(0)] * 3
        self.X, self.L = map(field.vector, ("X", "L")) if loaded else (nothing, nothing)
        A, B, C = field.symmetric("A"), field.matrix("B"), field.symmetric("C")
        self.U = plus(apply(A, self.x), apply(B, self.y))
        self.Omega = plus(apply(transposed(B), self.x), apply(C, self.y))
        self.coupling, self.angular = B, C
        self.T = Fraction(1, 2) * (dot(self.x, self.U) + dot(self.y, self.Omega))
        self.R = rotation([field[f"e{k}"] for k in range(4)])
        self.l = apply(transposed(self.R), self.n)
        if obeys:
            self.dx = plus(cross(self.x, self.Omega), self.X)
            self.dy = plus(cross(self.y, self.Omega), cross(self.x, self.U), self.L)
        else:
            self.dx, self.dy = field.vector("dx"), field.vector("dy")
        field.turn(
            quaternion_rates(field, self.Omega)
            | named("x", self.dx)
            | named("y", self.dy)
            | named("c", apply(self.R, self.U))
        )

    def rates(self, vector: list[Element]) -> list[Element]:
        return self.field.rates(vector)


@cache
def unposed() -> Solid:
    """Any motion at all: x' and y' are free symbols, so that laws can be compared before they hold."""
    return Solid(obeys=False, loaded=True)


@cache
def loaded() -> Solid:
    """A motion under force and couple, by (3) and (4)."""
    return Solid(obeys=True, loaded=True)


@cache
def unloaded() -> Solid:
    """A motion without external force, by (3) and (4)."""
    return Solid(obeys=True, loaded=False)
