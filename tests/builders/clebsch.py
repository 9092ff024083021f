"""Clebsch's bodies of revolution in exact numbers, and their equations of motion in mpmath."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from mpmath import mp, mpf

from builders.scenes import vector
from taylor_verify.scenes.bodies import Clebsch

State = Sequence[Fraction]  # x1 x2 x3 y1 y2 y3
Six = list[mpf]


def body(*six: str | int | Fraction) -> Clebsch:
    """p, p', q, q', r, r'."""
    return Clebsch(*vector(*six))


PLAIN = body(1, 2, 0, 0, 1, "1/2")  # no screw coupling
STOUT = body(6, 6, "1/3", "1/3", 1, 2)
GENERIC = vector("1/2", "1/3", 1, "1/5", "-1/4", 1)
FALLING = vector("3/5", 0, "4/5", "1/6", "1/2", "1/2")  # F = 1, FG = y3
UPRIGHT = vector(0, 0, 1, "1/3", "1/7", 1)


def falling(solid: Clebsch, start: State) -> Clebsch:
    """The body with p' such that x3 = F is a double root of f, from a start with FG = F y3, F = 1."""
    y1, y2, y3 = start[3:]
    assert sum(x * y for x, y in zip(start[:3], start[3:], strict=True)) == y3
    drop = 1 - start[2]
    rise = solid.r * (y1**2 + y2**2) + 2 * (solid.q - solid.q_prime) * y3 * drop
    return replace(solid, p_prime=solid.p + rise / (drop * (1 + start[2])))


def at_the_border(solid: Clebsch, start: State) -> Clebsch:
    """The same with q' too, such that A = 0 in Hydromechanics 49 (25): the root is triple."""
    y1, y2, y3 = start[3:]
    drop, r = 1 - start[2], solid.r
    s = ((2 - drop) * r * y3 / 4 - r * (y1**2 + y2**2) / (drop * y3)) / drop
    return falling(replace(solid, q_prime=solid.q - s), start)


# The equations, written here once more: nothing elliptic, nothing shared.


def velocities(solid: Clebsch, s: Sequence[mpf]) -> tuple[Six, Six]:
    """U = dT/dx and Omega = dT/dy of Hydromechanics 49 (1)."""
    linear = [mp.convert(c) for c in (solid.p, solid.p, solid.p_prime)]
    screw = [mp.convert(c) for c in (solid.q, solid.q, solid.q_prime)]
    angular = [mp.convert(c) for c in (solid.r, solid.r, solid.r_prime)]
    U = [linear[i] * s[i] + screw[i] * s[3 + i] for i in range(3)]
    Omega = [screw[i] * s[i] + angular[i] * s[3 + i] for i in range(3)]
    return U, Omega


def cross(a: Sequence[mpf], b: Sequence[mpf]) -> Six:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def derivative(solid: Clebsch, s: Sequence[mpf]) -> Six:
    """x' = x x Omega, y' = y x Omega + x x U."""
    U, Omega = velocities(solid, s)
    turning = zip(cross(s[3:], Omega), cross(s[:3], U), strict=True)
    return cross(s[:3], Omega) + [a + b for a, b in turning]


# Eighth-order differences: the error is h^8 D^9/630, and rounding leaves 10^-digits / h.
_WEIGHTS = (Fraction(4, 5), Fraction(-1, 5), Fraction(4, 105), Fraction(-1, 280))


def around(middle: Fraction, h: Fraction) -> list[Fraction]:
    """The nine times whose states `slope` asks for."""
    return [middle + k * h for k in range(-len(_WEIGHTS), len(_WEIGHTS) + 1)]


def slope(near: Sequence[Sequence[mpf]], h: Fraction) -> Six:
    """The derivative in the middle of nine states at steps of h, at the ambient precision."""
    return [
        sum(
            mp.convert(weight / h) * (near[4 + k][i] - near[4 - k][i])
            for k, weight in enumerate(_WEIGHTS, 1)
        )
        for i in range(6)
    ]
