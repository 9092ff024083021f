"""Clebsch's bodies of revolution and their motions, in exact numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from builders.scenes import vector
from taylor_verify.scenes.bodies import Clebsch

State = Sequence[Fraction]  # x1 x2 x3 y1 y2 y3


def body(*six: str | int | Fraction) -> Clebsch:
    """p, p', q, q', r, r'."""
    return Clebsch(*vector(*six))


PLAIN = body(1, 2, 0, 0, 1, "1/2")  # no screw coupling
STOUT = body(6, 6, "1/3", "1/3", 1, 2)
FALLING = vector("3/5", 0, "4/5", "1/6", "1/2", "1/2")  # F = 1, FG = y3


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


def exact(text: str) -> tuple[Fraction, ...]:
    return tuple(Fraction(word) for word in text.split())


# Bodies by p p' q q' r r', and starts by x and y: every regime, and the difficulties of each.
SHARP = "1 2 1/10 3/10 1 1/2"  # p' > p
BLUNT = "2 1 1/10 3/10 1 1/2"  # p' < p
EVEN = "1 1 1/10 3/10 1 1/2"  # p' = p
ALIKE = "1 1 1/10 1/10 1 1/2"  # p' = p, q' = q
COUPLED = "1 2 0 0 1 1/2"
GENERIC = "1/2 1/3 1 1/5 -1/4 1"
TO_A_POLE = "3/5 0 4/5 1/6 1/2 1/2"  # F = 1, G = y3
OVER_BOTH = "3/5 1/5 4/5 1/5 -3/5 0"

MOTIONS = {
    "four real roots": (SHARP, GENERIC, "four-roots"),
    "the two largest of four": ("3 1 -1/10 7/20 2 1", "1 1 3/4 1/4 -1/4 -1/8", "four-roots"),
    "the two smallest of four": ("5 1 1/10 -2/5 2 1", "1/2 -1/2 -1 1/8 3/8 1/8", "four-roots"),
    "two real roots": (BLUNT, GENERIC, "two-roots"),
    "cubic, third root above": (EVEN, GENERIC, "cubic"),
    "cubic, third root below": (EVEN, "1/2 1/3 1 1/5 -1/4 -1", "cubic"),
    "no screw coupling": (COUPLED, GENERIC, "four-roots"),
    "q' = q": ("3/2 1 1/5 1/5 4/5 1/2", GENERIC, "two-roots"),
    "from the lower turning point": (SHARP, "1 1 2 1/3 1/3 2", "four-roots"),
    "from the upper turning point": (BLUNT, "1 1 2 1/3 1/3 3", "two-roots"),
    "below a root at the pole": (SHARP, "3/5 0 4/5 1/3 1/7 1", "four-roots"),
    "through the pole": (SHARP, "3/5 0 4/5 1/3 2 1", "four-roots"),
    "through the pole, two roots": (BLUNT, "3/5 0 4/5 1/3 1/7 1", "two-roots"),
    "through the pole, cubic": (EVEN, "3/5 0 4/5 1/3 1/7 1", "cubic"),
    "through the lower pole": (BLUNT, "3/5 0 4/5 3 1/7 -1", "two-roots"),
    # A third is no ball of radius zero: that the pole is a root is then told by rationals alone.
    "to the pole, F = 1/3": (SHARP, "1/5 0 4/15 1/3 1/7 1", "four-roots"),
    "through the lower pole, F = 1/3": (BLUNT, "1/5 0 4/15 -3 1/7 1", "two-roots"),
    "to the pole from a turning point": (SHARP, "1/5 0 4/15 1/3 0 1", "four-roots"),
    "through both poles": (SHARP, "3/5 0 4/5 0 3 0", "four-roots"),
    "through both poles, two roots": (BLUNT, "3/5 0 4/5 0 3 0", "two-roots"),
    "from the axis": (EVEN, "0 0 1 1/3 1/7 2", "cubic"),
    "from the axis, two roots": (BLUNT, "0 0 -2 1/3 1/7 2", "two-roots"),
    "planar, through a pole": (BLUNT, OVER_BOTH, "four-roots"),
    "planar, |x| irrational": (BLUNT, "1 1 2 1 -1 0", "four-roots"),
    "from rest beside the axis": (SHARP, "1/100 0 1 0 0 0", "four-roots"),
    "G = 0": (SHARP, "1/2 1/2 1 -1/2 -1/2 1/2", "four-roots"),
    "near the pole": (BLUNT, "3/5 0 4/5 1/3 1/7 9999999999/10000000000", "two-roots"),
    "near the separatrix": (SHARP, "1e-10 0 1 0 1e-10 1/5", "four-roots"),
    "nearly steady": (BLUNT, "1e-10 0 1 0 1e-10 1/5", "two-roots"),
    "falling from the pole": ("1 287/162 0 0 1 1/2", TO_A_POLE, "hyperbolic"),
    "falling from the pole, screw": ("1 269/162 1/10 3/10 1 1/2", TO_A_POLE, "hyperbolic"),
    "falling from the pole, a cubic": ("1 1 0 25/18 1 9", TO_A_POLE, "hyperbolic"),
    "falling from elsewhere": (
        "6 4417/1089 1/3 6629/4356 1 2",
        "1/3 5/6 -2/3 -1/6 1 -2/3",
        "hyperbolic",
    ),
    "beside a double root": (
        "6 23219/4500 1/3 2374/5625 1 2",
        "1/3 1 1 1/2 -2/3 5/6",
        "trigonometric",
    ),
    "quadratic": (ALIKE, GENERIC, "trigonometric"),
    "quadratic, y3 = 0": (EVEN, "1/2 1/3 1 1/5 -1/4 0", "trigonometric"),
    "quadratic, over both poles": (EVEN, OVER_BOTH, "trigonometric"),
    "quadratic, from the axis": (ALIKE, "0 0 1 1/3 1/7 1", "trigonometric"),
    "quadratic, from the lower pole": (EVEN, "0 0 -1 1/3 1/7 0", "trigonometric"),
    "quadratic, from a turning point": (ALIKE, "1/2 1/3 1/2 1/4 1/6 -1/2", "trigonometric"),
    "border": ("6 -23/72 1/3 943/72 1 2", TO_A_POLE, "algebraic"),
    "heteroclinic": (COUPLED, "3/5 0 4/5 0 3/5 0", "heteroclinic"),
    "heteroclinic, downwards": ("1 2 1/5 -1/3 1 1/2", "1/2 1 1 1 -1/2 0", "heteroclinic"),
    "steady": ("1 92/81 1/10 3/10 1 1/2", "3/5 0 4/5 1/3 0 1", "steady"),
    "steady, about its axis": (SHARP, "0 0 -2 0 0 1", "steady"),
    "steady, without turning": (COUPLED, "0 0 3 0 0 0", "steady"),
    "top": (EVEN, "0 0 0 1/5 -1/4 2/3", "euler-top"),
    "top about its axis": (EVEN, "0 0 0 0 0 2/3", "euler-top"),
    "rest": (SHARP, "0 0 0 0 0 0", "rest"),
}
