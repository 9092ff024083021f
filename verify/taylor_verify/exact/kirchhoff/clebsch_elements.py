"""The elements of the orbit of a solid in a fluid: for Clebsch's body all that x3 tells.

Legend, Hydromechanics 49: z = x3, z'^2 = f(z); F = |x|, FG = x.y, so that G is y along F;
kappa = (p' - p)/r, lambda = (q' - q)/r. The axial spin is x = (0, 0, F), y = (0, 0, G), and
49 (23)-(25) beside it, with y3 = G and y = z - F, reads

    f = r^2 y^2 (A + 2 B y + C y^2),
    A = 4 kappa F^2 + 4 lambda FG - G^2,  B = 2 kappa F + lambda G,  C = kappa.

G F = FG is rational, so A and B F are, and every sign is final.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Final

from mpmath import mp, mpf

from taylor_verify.exact.element import Element, Elements, settled
from taylor_verify.exact.kirchhoff.conserved import conserved
from taylor_verify.exact.kirchhoff.general import elements_of
from taylor_verify.exact.kirchhoff.jacobi import closed_form
from taylor_verify.exact.kirchhoff.quartic import (
    Nutation,
    Polynomial,
    derivative,
    repeated_root,
    value,
)
from taylor_verify.exact.kirchhoff.regime import regime, turning_points
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.manufactured import MANUFACTURED, REGIME
from taylor_verify.exact.solution import NO_CLOSED_FORM, Orbital
from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

_ELLIPTIC: Final = ("four-roots", "two-roots", "cubic")
_SOURCE: Final = "Hydromechanics 49 (8)"
_AXIAL: Final = "Hydromechanics 49 (25)"
_CONSERVED: Final = (
    "Conserved: the kinetic energy T, F^2 = x.x, FG = x.y and, for Clebsch's body, y3; in space "
    "axes the linear impulse and the moment of the impulses."
)
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
    """Of Clebsch's free body every element; of any other solid what is exact without a solution."""
    body, start = solid(scene)
    if body.manufactured is not None:
        return Elements(REGIME, (), MANUFACTURED)
    if not body.is_free:
        return Elements(
            NO_CLOSED_FORM,
            (),
            (
                "A force or a couple in body axes acts: no closed form is built, and the motion "
                "has neither a period nor a modulus that could be named.",
                "Not conserved: T, F^2 and FG change by the work and the impulse of the loads.",
            ),
        )
    if body.clebsch is None:
        return elements_of(scene, digits)
    nutation = Nutation.of(body.clebsch, start)
    kind = regime(nutation)
    alone = replace(scene, track=frozenset())
    found = settled(
        lambda working: [
            *_of_regime(kind, nutation, alone, start, working),
            *conserved(body, start),
            *_axial(nutation),
        ],
        digits,
    )
    story = [_STORY[kind], *_steady_story(kind, nutation), _CONSERVED]
    return Elements(kind, found, (*story, *_axial_story(nutation)))


def _of_regime(
    kind: str, nutation: Nutation, alone: Scene, start: Impulse, working: int
) -> list[Element]:
    if kind == "rest":
        return []
    if kind == "euler-top":
        return _top(nutation, start)
    if kind == "steady":
        return _steady(nutation)
    found = _recurring(alone, working)
    if kind in ("hyperbolic", "heteroclinic"):
        found.append(_approach(kind, nutation))
    found += _range(kind, nutation, working)
    return [*found, _separation(nutation)] if kind in _ELLIPTIC else found


# Motions with x3 constant.


def _top(nutation: Nutation, start: Impulse) -> list[Element]:
    """x = 0: y goes round axis 3 at (r - r') y3, and the axis goes round y at r |y|."""
    body = nutation.body
    size = mp.sqrt(mp.convert(tensors.dot(start.angular, start.angular)))
    about = mp.convert(body.r) * size
    found = _turning(nutation)
    found.append(
        Element(
            "precession_rate", about, "radians/time", "the axis goes round y, in space axes", "r|y|"
        )
    )
    return found


def _turning(nutation: Nutation) -> list[Element]:
    rate = abs(mp.convert(nutation.turn_rate))
    if not rate:
        return []
    meaning = "x and y recur in body axes: one turn about axis 3"
    return [
        Element("period", 2 * mp.pi / rate, "time", meaning, "2 pi/rate"),
        Element(
            "rate", rate, "radians/time", "x and y turn about axis 3", "Hydromechanics 48 (3), (4)"
        ),
    ]


def curvature(nutation: Nutation) -> Fraction:
    """f''(z)/2 at the start: in a steady motion a disturbance of x3 obeys s^2 = f''(z)/2."""
    return value(derivative(derivative(nutation.f)), nutation.z) / 2


def _steady(nutation: Nutation) -> list[Element]:
    found, s2 = _turning(nutation), curvature(nutation)
    if nutation.F2 == nutation.z**2:
        return found  # the axial spin, of which A says more
    size, source = mp.sqrt(mp.convert(abs(s2))), "s^2 = f''(x3)/2"
    if s2 > 0:
        meaning = "rate at which a disturbance of x3 grows, as e^{s t}"
        found.append(Element("growth_rate", size, "1/time", meaning, source))
    elif s2 < 0:
        period = 2 * mp.pi / size
        meaning = "period of small nutations about this motion"
        found.append(Element("nutation_period", period, "time", meaning, source))
    return found


def _steady_story(kind: str, nutation: Nutation) -> list[str]:
    """Of a steady motion: by the curvature, or on the axis itself by A, B and C."""
    if kind != "steady" or nutation.F2 == nutation.z**2:
        return []
    s2 = curvature(nutation)
    if s2 > 0:
        return ["This steady motion is unstable: a disturbance of x3 grows exponentially."]
    if s2 < 0:
        return ["This steady motion is stable: a disturbance of x3 swings about it."]
    return ["Whether this steady motion is stable is not decided to the first order."]


# Motions with x3 variable.


def _recurring(alone: Scene, working: int) -> list[Element]:
    """Period, rate and parameters of the closed form, with the modulus."""
    exact = closed_form(alone)
    known = exact.elements(working) if isinstance(exact, Orbital) else {}
    words = {
        "period": ("time", "period of nutation: x3 and the shape of (x, y) recur"),
        "rate": ("radians/time", "of the elliptic argument"),
        "m": ("", "parameter k^2; 0 for sines, 1 on the separatrix"),
        "m_prime": ("", "1 - m, one measure of the separatrix's distance"),
    }
    found = []
    for name, (unit, meaning) in words.items():
        if name in known:
            found.append(Element(name, known[name], unit, meaning, _SOURCE))
        if name == "period" and "period" in known:
            frequency, meaning = 2 * mp.pi / known["period"], "frequency of nutation"
            found.append(
                Element("nutation_frequency", frequency, "radians/time", meaning, "2 pi/period")
            )
        if name == "rate" and "m" in known:
            meaning = "modulus of the elliptic functions"
            found.append(Element("k", mp.sqrt(known["m"]), "", meaning, _SOURCE))
    return found


def _approach(kind: str, nutation: Nutation) -> Element:
    """sqrt(f''(d)/2) at the repeated root d, where f = c^2 (F^2 - z^2)^2 at d = +-F."""
    if kind == "heteroclinic":
        rate = 2 * mp.sqrt(mp.convert(nutation.F2 * nutation.f[0]))
    else:
        d = repeated_root(nutation.f)
        assert d is not None
        rate = mp.sqrt(mp.convert(value(derivative(derivative(nutation.f)), d) / 2))
    meaning = "x3 leaves and approaches its steady value as e^{-s t}"
    return Element("approach_rate", rate, "1/time", meaning, "s^2 = f''(d)/2")


def _range(kind: str, nutation: Nutation, working: int) -> list[Element]:
    """The values between which x3 moves."""
    F = mp.sqrt(mp.convert(nutation.F2))
    if kind == "heteroclinic":
        ends = [-F, F]
    elif kind in _ELLIPTIC:
        points = turning_points(nutation, working)
        ends = [mp.convert(points.z1), mp.convert(points.z2)]
    else:
        ends = _between_elementary(nutation)
    low, high = (_exact_zero(nutation, F, end) for end in sorted(ends))
    return [
        Element("x3_low", low, "impulse", "x3 is never less", "root of f", F),
        Element("x3_high", high, "impulse", "x3 is never more", "root of f", F),
    ]


def _exact_zero(nutation: Nutation, F: mpf, end: mpf) -> mpf:
    """Zero for a root that is zero exactly, and was found as a number of the last digits."""
    is_root = value(nutation.f, Fraction(0)) == 0
    return mpf(0) if is_root and abs(end) <= F * mp.ldexp(1, -mp.prec // 2) else end


def _between_elementary(nutation: Nutation) -> list[mpf]:
    """The ends of x3 where f is a quadratic, or has the repeated root d: f = (z - d)^2 q(z).

    On one side of an isolated d both ends are roots of q; on the way from d to d one is d itself,
    and the other the first root of q beyond the start.
    """
    f = nutation.f
    if len(f) == 3:
        return _quadratic_roots(f)
    d = repeated_root(f)
    assert d is not None
    roots = _quadratic_roots(_divided(_divided(f, d), d))
    if value(derivative(derivative(f)), d) < 0:
        return roots
    centre, side = mp.convert(d), 1 if nutation.z > d else -1
    beyond = [root for root in roots if side * (root - centre) > 0]
    return [centre, min(beyond, key=lambda root: abs(root - centre))]


def _divided(polynomial: Polynomial, root: Fraction) -> Polynomial:
    """By z - root, the remainder left out (Horner)."""
    quotient, carried = [], Fraction(0)
    for coefficient in polynomial[:-1]:
        carried = carried * root + coefficient
        quotient.append(carried)
    return tuple(quotient)


def _quadratic_roots(polynomial: Polynomial) -> list[mpf]:
    """The real roots of degree one or two; the smaller of two from their product."""
    if len(polynomial) == 2:
        return [mp.convert(-polynomial[1] / polynomial[0])]
    a, half, c = polynomial[0], polynomial[1] / 2, polynomial[2]
    root = mp.sqrt(mp.convert(half**2 - a * c))
    larger = -mp.convert(half) - (root if half >= 0 else -root)
    if larger == 0:
        return [mpf(0), mpf(0)]
    return [larger / mp.convert(a), mp.convert(c) / larger]


def discriminant(nutation: Nutation) -> Fraction:
    """(g2^3 - 27 g3^2)/(|g2|^3 + 27 g3^2) of f, exactly: zero if and only if a root is repeated.

    Between -1 and 1, unchanged by scaling z or t; above zero four roots of f are real (or three of
    a cubic), below zero two.
    """
    a0, a1, a2, a3, a4 = (Fraction(0),) * (5 - len(nutation.f)) + nutation.f
    a1, a2, a3 = a1 / 4, a2 / 6, a3 / 4
    g2 = a0 * a4 - 4 * a1 * a3 + 3 * a2**2
    g3 = a0 * a2 * a4 + 2 * a1 * a2 * a3 - a2**3 - a0 * a3**2 - a1**2 * a4
    return (g2**3 - 27 * g3**2) / (abs(g2) ** 3 + 27 * g3**2)


def _separation(nutation: Nutation) -> Element:
    return Element(
        "discriminant",
        mp.convert(discriminant(nutation)),
        "",
        "of f, exact, between -1 and 1: 0 where two roots agree, as on the separatrix",
        "(g2^3 - 27 g3^2)/(|g2|^3 + 27 g3^2)",
    )


# The spin along the axis with the same F and G.


def stability(nutation: Nutation) -> tuple[Fraction, Fraction, Fraction]:
    """(A, B F, C) of 49 (25), rational, for F != 0.

    The spin at the other pole, x3 = -F and y3 = -G, has the same: only F^2 and FG enter.
    """
    body, F2, FG = nutation.body, nutation.F2, nutation.FG
    kappa = (body.p_prime - body.p) / body.r
    lam = (body.q_prime - body.q) / body.r
    return 4 * kappa * F2 + 4 * lam * FG - FG**2 / F2, 2 * kappa * F2 + lam * FG, kappa


def _axial(nutation: Nutation) -> list[Element]:
    if nutation.F2 == 0:
        return []
    A, BF, _ = stability(nutation)
    size = mp.convert(nutation.body.r) * mp.sqrt(mp.convert(abs(A)))
    found = [
        Element(
            "A",
            mp.convert(A),
            "angular impulse^2",
            "stability number of the axial spin with these F and G: stable below 0",
            _AXIAL,
        )
    ]
    if A < 0:
        found.append(
            Element(
                "axial_nutations",
                size / (2 * mp.pi),
                "1/time",
                "its small nutations in a unit of time, whole ones (49 counts half-swings)",
                "r sqrt(-A)/(2 pi); the text's r sqrt(-A)/pi counts half-swings",
            )
        )
    elif A > 0:
        meaning = "rate at which a small tilt of that spin grows"
        found.append(Element("axial_growth", size / 2, "1/time", meaning, "r sqrt(A)/2"))
    else:
        meaning = "B F of that spin, which decides where A = 0: stable above 0"
        found.append(
            Element("BF", mp.convert(BF), "angular impulse^2", meaning, "2 kappa F^2 + lambda FG")
        )
    return found


def _axial_story(nutation: Nutation) -> list[str]:
    """What the signs of A, B and C say, at either pole."""
    if nutation.F2 == 0:
        return []
    A, BF, C = stability(nutation)
    if nutation.touches_pole(1) or nutation.touches_pole(-1):
        which = "The spin along the axis with these F and G, which shares y3 with this orbit,"
    else:
        which = (
            "The spin along the axis with these F and G (another orbit: its y3 is not this one's)"
        )
    return [f"{which} is {_axial_words(A, BF, C)}."]


def _axial_words(A: Fraction, BF: Fraction, C: Fraction) -> str:
    """C > 0 cannot be where A = B = 0: G^2 (kappa + lambda^2) = B^2 - A C = 0 leaves C <= 0."""
    if A < 0:
        return "stable: A < 0 in 49 (25)"
    if A > 0:
        return "unstable: A > 0 in 49 (25); the axis falls away, and returns (homoclinic)"
    if BF > 0:
        return "stable: A = 0 and B > 0; the axis strays by the square root of a tilt"
    if BF < 0:
        return "unstable: A = 0 and B < 0 in 49 (25); the axis falls away"
    if C < 0:
        return "stable: A = B = 0 and C < 0"
    return "neutral: A = B = C = 0; a tilt drifts in proportion to time"
