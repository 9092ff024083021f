"""The elements of the orbit of Clebsch's free body: the swing of x3, and the spin beside it.

Legend, Hydromechanics 49: z = x3, z'^2 = f(z); F = |x|, FG = x.y, so that G is y along F;
kappa = (p' - p)/r, lambda = (q' - q)/r. The axial spin is x = (0, 0, F), y = (0, 0, G), and
49 (23)-(25) beside it, with y3 = G and y = z - F, reads

    f = r^2 y^2 (A + 2 B y + C y^2),
    A = 4 kappa F^2 + 4 lambda FG - G^2,  B = 2 kappa F + lambda G,  C = kappa.

G F = FG is rational, so A and B F are, and every sign is final.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Final

from mpmath import mp, mpf

from taylor_verify.exact.element import Element, Elements, settled
from taylor_verify.exact.kirchhoff.any_solid import conserved, recurring
from taylor_verify.exact.kirchhoff.carrier import Carrier
from taylor_verify.exact.kirchhoff.jacobi import NutatingBody
from taylor_verify.exact.kirchhoff.quartic import (
    Nutation,
    derivative,
    value,
)
from taylor_verify.exact.kirchhoff.regime import ELLIPTIC, nutation_of, regime, turning_points
from taylor_verify.numbers import tensors
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

_SOURCE: Final = "Hydromechanics 49 (8)"
_AXIAL: Final = "Hydromechanics 49 (25)"
_CONSERVED: Final = (
    "Conserved: the kinetic energy T, F^2 = x.x, FG = x.y and, for Clebsch's body, y3; in space "
    "axes the linear impulse and the moment of the impulses."
)
_WAVE: Final = ("period", "nutation_frequency", "rate", "k", "m", "m_prime")
# By the place of the first of A, B, C that is not zero, and its sign.
_SPIN: Final[Mapping[tuple[int, int], str]] = {
    (0, -1): "stable: A < 0 in 49 (25)",
    (0, 1): "unstable: A > 0 in 49 (25); the axis falls away, and returns (homoclinic)",
    (1, 1): "stable: A = 0 and B > 0; the axis strays by the square root of a tilt",
    (1, -1): "unstable: A = 0 and B < 0 in 49 (25); the axis falls away",
    (2, -1): "stable: A = B = 0 and C < 0",
    (2, 0): "neutral: A = B = C = 0; a tilt drifts in proportion to time",
}
_STEADY: Final[Mapping[int, str]] = {
    1: "This steady motion is unstable: a disturbance of x3 grows exponentially.",
    -1: "This steady motion is stable: a disturbance of x3 swings about it.",
    0: "Whether this steady motion is stable is not decided to the first order.",
}
_STORY: Final[Mapping[str, str]] = {
    "rest": "Both impulses are zero: the body is at rest.",
    "euler-top": (
        "The linear impulse is zero: the body turns as in a vacuum, and y goes round the axis at a "
        "constant rate."
    ),
    "steady": "x3 is constant: x and y keep their shape and turn about the axis together.",
    "trigonometric": "x3 swings between two values, as a function of sines and cosines.",
    "hyperbolic": (
        "x3 leaves a steady motion, turns once and approaches it again for ever (homoclinic); "
        "there is no period."
    ),
    "algebraic": (
        "x3 leaves a steady motion, turns once and approaches it again like 1/t^2; there is no "
        "period."
    ),
    "heteroclinic": "The axis turns over once, from one pole x3 = -+F towards the other.",
    "four-roots": "x3 swings between two roots of the quartic f, which has four real ones.",
    "two-roots": "x3 swings between the two real roots of the quartic f.",
    "cubic": "x3 swings between two roots of f, which is a cubic because p = p'.",
}


def elements(scene: Scene, digits: int) -> Elements:
    """The elements of a free body of Clebsch's form."""
    nutation, start = nutation_of(scene)
    body, kind = nutation.solid, regime(nutation)

    def numbers(working: int) -> list[Element]:
        own = _orbit(kind, nutation, start, working)
        return [*own, *conserved(body, start), *_axial(nutation)]

    story = [_STORY[kind], _CONSERVED, *_axial_story(nutation)]
    if kind == "steady" and not nutation.is_axial:
        story.insert(1, _STEADY[_sign(_curvature(nutation))])
    return Elements(kind, settled(numbers, digits), tuple(story))


def _orbit(kind: str, nutation: Nutation, start: Impulse, working: int) -> Iterator[Element]:
    """Yield the elements of the motion itself."""
    if kind in ("euler-top", "steady"):
        yield from _turning(nutation)
    if kind == "euler-top":
        rate = mp.convert(nutation.body.r) * mp.sqrt(
            mp.convert(tensors.dot(start.angular, start.angular))
        )
        meaning = "the axis goes round y, in space axes"
        yield Element("precession_rate", rate, "radians/time", meaning, "r|y|")
    elif kind == "steady":
        yield from _disturbance(nutation)
    elif kind != "rest":
        values = _wave(kind, nutation, start, working)
        period = "period of nutation: x3 and the shape of (x, y) recur"
        yield from recurring(values, _WAVE, period, _SOURCE)
        if kind in ("hyperbolic", "heteroclinic"):
            yield _approach(kind, nutation)
        yield from _range(kind, nutation, working)
        if kind in ELLIPTIC:
            meaning = "of f, exact, between -1 and 1: 0 where two roots agree, as on the separatrix"
            formula = "(g2^3 - 27 g3^2)/(|g2|^3 + 27 g3^2)"
            number = mp.convert(discriminant(nutation))
            yield Element("discriminant", number, "", meaning, formula)


def _wave(kind: str, nutation: Nutation, start: Impulse, working: int) -> Mapping[str, mpf]:
    """The period of nutation where x3 recurs, and the rate and the parameters of elliptic functions."""
    if kind in ELLIPTIC:
        return NutatingBody(kind, nutation, start).elements(working)
    if kind == "trigonometric":
        return {"period": 2 * mp.pi / mp.sqrt(mp.convert(-Carrier.of(nutation).A))}
    return {}


# Motions with x3 constant.


def _turning(nutation: Nutation) -> Iterator[Element]:
    """Yield period and rate of x and y about axis 3."""
    rate = abs(mp.convert(nutation.turn_rate)) * mp.sqrt(mp.convert(nutation.axes.nu))
    if rate:
        meaning = "x and y recur in body axes: one turn about axis 3"
        yield Element("period", 2 * mp.pi / rate, "time", meaning, "2 pi/rate")
        source = "Hydromechanics 48 (3), (4)"
        yield Element("rate", rate, "radians/time", "x and y turn about axis 3", source)


def _curvature(nutation: Nutation) -> Fraction:
    """f''(z)/2 at the start: in a steady motion a disturbance of x3 obeys s^2 = f''(z)/2."""
    return value(derivative(derivative(nutation.f)), nutation.z) / 2


def _disturbance(nutation: Nutation) -> Iterator[Element]:
    """Yield the rate or the period of a small disturbance of x3; of the axial spin A says more."""
    if nutation.is_axial:
        return
    s2, source = _curvature(nutation), "s^2 = f''(x3)/2"
    size = mp.sqrt(mp.convert(abs(s2)))
    if s2 > 0:
        meaning = "rate at which a disturbance of x3 grows, as e^{s t}"
        yield Element("growth_rate", size, "1/time", meaning, source)
    elif s2 < 0:
        meaning = "period of small nutations about this motion"
        yield Element("nutation_period", 2 * mp.pi / size, "time", meaning, source)


# Motions with x3 variable.


def _approach(kind: str, nutation: Nutation) -> Element:
    """sqrt(f''(d)/2) at the repeated root d, where f = c^2 (F^2 - z^2)^2 at d = +-F."""
    front = kind == "heteroclinic"
    square = 4 * nutation.F2 * nutation.f[0] if front else Carrier.of(nutation).A
    meaning = "x3 leaves and approaches its steady value as e^{-s t}"
    rate = mp.sqrt(mp.convert(square))
    return Element("approach_rate", rate, "1/time", meaning, "s^2 = f''(d)/2")


def _range(kind: str, nutation: Nutation, working: int) -> Iterator[Element]:
    """Yield the values between which x3 moves."""
    F = mp.sqrt(mp.convert(nutation.F2))
    if kind == "heteroclinic":
        ends = [-F, F]
    elif kind in ELLIPTIC:
        points = turning_points(nutation, working)
        ends = [mp.convert(points.z1), mp.convert(points.z2)]
    else:
        ends = _elementary_ends(Carrier.of(nutation))
    unit = mp.sqrt(mp.convert(nutation.axes.nu))
    low, high = (_exact_zero(nutation, F, end) / unit for end in sorted(ends))
    F /= unit
    yield Element("x3_low", low, "impulse", "x3 is never less", "root of f", F)
    yield Element("x3_high", high, "impulse", "x3 is never more", "root of f", F)


def _exact_zero(nutation: Nutation, F: mpf, end: mpf) -> mpf:
    """Zero for a root that is zero exactly, and was found as a number of the last digits."""
    is_root = value(nutation.f, Fraction(0)) == 0
    return mpf(0) if is_root and abs(end) <= F * mp.ldexp(1, -mp.prec // 2) else end


def _elementary_ends(carrier: Carrier) -> list[mpf]:
    """The ends of x3 = v, or x3 = d + 1/v, where v'^2 = A v^2 + 2 B v + C.

    For A < 0, v swings between two roots. Else x3 leaves d, where v is infinite, and v turns at the
    first root that it meets.
    """
    A, B, C = carrier.A, carrier.B, carrier.C
    middle, spread = mp.convert(-B), mp.sqrt(mp.convert(B**2 - A * C))
    larger = middle + (spread if B <= 0 else -spread)
    # The smaller root from the product of both.
    roots = [mp.convert(C) / larger]
    if A:
        roots.append(larger / mp.convert(A))
    if carrier.d is None:
        return roots
    d = mp.convert(carrier.d)
    if A < 0:
        return [d + 1 / v for v in roots]
    return [d, d + 1 / max((v for v in roots if v * carrier.v > 0), key=abs)]


def discriminant(nutation: Nutation) -> Fraction:
    """(g2^3 - 27 g3^2)/(|g2|^3 + 27 g3^2) of f, exactly: zero if and only if a root is repeated.

    Between -1 and 1, unchanged by scaling z or t; above zero four roots of f are real (or three of
    a cubic), below zero two.
    """
    g2, g3 = nutation.invariants
    return (g2**3 - 27 * g3**2) / (abs(g2) ** 3 + 27 * g3**2)


# The spin along the axis with the same F and G.


def stability(nutation: Nutation) -> tuple[Fraction, Fraction, Fraction]:
    """(A, B F, C) of 49 (25), rational, for F != 0.

    The spin at the other pole, x3 = -F and y3 = -G, has the same: only F^2 and FG enter.
    """
    body, nu = nutation.body, nutation.axes.nu
    F2, FG = nutation.F2 / nu, nutation.FG / nu
    kappa = (body.p_prime - body.p) / body.r
    lam = (body.q_prime - body.q) / body.r
    return 4 * kappa * F2 + 4 * lam * FG - FG**2 / F2, 2 * kappa * F2 + lam * FG, kappa


def _axial(nutation: Nutation) -> Iterator[Element]:
    """Yield A, and what a small tilt of that spin does."""
    if nutation.F2 == 0:
        return
    A, BF, _ = stability(nutation)
    size = mp.convert(nutation.body.r) * mp.sqrt(mp.convert(abs(A)))
    meaning = "stability number of the axial spin with these F and G: stable below 0"
    yield Element("A", mp.convert(A), "angular impulse^2", meaning, _AXIAL)
    if A < 0:
        meaning = "its small nutations in a unit of time, whole ones (49 counts half-swings)"
        source = "r sqrt(-A)/(2 pi); the text's r sqrt(-A)/pi counts half-swings"
        yield Element("axial_nutations", size / (2 * mp.pi), "1/time", meaning, source)
    elif A > 0:
        meaning = "rate at which a small tilt of that spin grows"
        yield Element("axial_growth", size / 2, "1/time", meaning, "r sqrt(A)/2")
    else:
        meaning = "B F of that spin, which decides where A = 0: stable above 0"
        number, source = mp.convert(BF), "2 kappa F^2 + lambda FG"
        yield Element("BF", number, "angular impulse^2", meaning, source)


def _axial_story(nutation: Nutation) -> list[str]:
    """The stability of that spin, at either pole, by the signs of A, B and C.

    C > 0 cannot be where A = B = 0: G^2 (kappa + lambda^2) = B^2 - A C = 0 leaves C <= 0.
    """
    if nutation.F2 == 0:
        return []
    shares = ", which shares y3 with this orbit,"
    if not (nutation.touches_pole(1) or nutation.touches_pole(-1)):
        shares = " (another orbit: its y3 is not this one's)"
    signs = [_sign(number) for number in stability(nutation)]
    first, leading = next(((k, sign) for k, sign in enumerate(signs) if sign), (2, 0))
    words = _SPIN[first, leading]
    return [f"The spin along the axis with these F and G{shares} is {words}."]


def _sign(number: Fraction) -> int:
    return (number > 0) - (number < 0)
