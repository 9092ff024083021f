"""The elements of a rigid body's orbit, from its exact invariants.

Legend as in regime and orbit: J1 >= J2 >= J3 principal moments, p(x) = det(x - I), 2T = w.I w,
H = I w; (a, b, c) the encircled, the intermediate and the third axis; m = k^2, m' = 1 - m,
lam the rate of the elliptic argument u, K the quarter period.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Final

from mpmath import mp, mpf

from taylor_verify.exact.element import Element, Elements, settled
from taylor_verify.exact.euler.moments.regime import LoadedSpin, MomentRegime
from taylor_verify.exact.euler.orbit import Orbit, Precession, principal_frame
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.exact.euler.top import top
from taylor_verify.exact.manufactured import MANUFACTURED, REGIME
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.scene import Scene

# Up to here the leading law of the flip is off by (1 - 1/L) m'/4 of itself, less than 2 %.
_NEAR: Final = Fraction(1, 16)

_SOURCE: Final = "Heinbockel (2.2.72), M = 0"
_CONSERVED: Final = (
    "Conserved: the kinetic energy T and |H|^2; in space axes the whole vector H = I omega."
)
_STORY: Final[Mapping[Regime, str]] = {
    Regime.REST: "The body is at rest.",
    Regime.SPHERICAL: "All three moments are equal: omega is constant, about any axis.",
    Regime.AXISYMMETRIC: (
        "Two moments are equal: omega goes round the axis of symmetry at a constant rate, and the "
        "axis round H at another; the angle between them does not change (no nutation)."
    ),
    Regime.MAX_AXIS: "omega goes round the axis of greatest inertia: H^2 > 2T J2.",
    Regime.MIN_AXIS: "omega goes round the axis of least inertia: H^2 < 2T J2.",
    Regime.SEPARATRIX: (
        "H^2 = 2T J2 exactly: omega leaves the spin about the middle axis, turns over once, and "
        "approaches the opposite spin for ever; it has no period."
    ),
}
_WORK: Final = "Not conserved: T grows by the work of the moment, H by its impulse."
_LOADED_STORY: Final[Mapping[MomentRegime, str]] = {
    MomentRegime.SPHERICAL: (
        "Three equal moments of inertia and a constant moment in body axes: omega runs along a "
        "straight line at a constant pace."
    ),
    MomentRegime.AXIAL: (
        "Two equal moments of inertia and a constant moment along the axis: the spin grows evenly, "
        "and the transverse omega, of constant size, turns in proportion to it, which is a chirp."
    ),
    MomentRegime.TRANSVERSE: (
        "Two equal moments of inertia and a constant moment across the axis: the spin is constant; "
        "the transverse omega goes round a circle, or, without spin, along a straight line."
    ),
    MomentRegime.OBLIQUE: (
        "Two equal moments of inertia and a constant moment that is neither along the axis nor "
        "across it: the spin grows evenly, and the transverse omega follows Fresnel's integrals."
    ),
}


def elements(scene: Scene, digits: int) -> Elements:
    """Of a free body every element it has; of a body under a moment a period at most, and words."""
    body, start = top(scene)
    if body.manufactured is not None:
        return Elements(REGIME, (), MANUFACTURED)
    if not body.is_free:
        return _loaded(body, start.omega, digits)
    spin = FreeSpin(body.inertia, start.omega)
    found = settled(lambda _: _numbers(spin), digits)
    story = _steady_story(spin) if spin.regime is Regime.STEADY else _STORY[spin.regime]
    return Elements(spin.regime.value, found, (story, _CONSERVED))


def _loaded(body: RigidBody, omega: tensors.Vector, digits: int) -> Elements:
    """Under a constant moment T' = M.omega and nothing of the free orbit is left."""
    try:
        if FreeSpin(body.inertia, omega).discriminant:
            return _washboard(body, omega, digits)
        spin = LoadedSpin(body.inertia, body.moment, omega)
    except NoClosedForm:
        story = (
            "A constant moment in body axes acts: no closed form is built, and the motion has "
            "neither a period nor a modulus that could be named."
        )
        return Elements(NO_CLOSED_FORM, (), (story, _WORK))
    found = settled(lambda _: _circle(spin), digits)
    return Elements(spin.regime.value, found, (_LOADED_STORY[spin.regime], _WORK))


def _washboard(body: RigidBody, omega: tensors.Vector, digits: int) -> Elements:
    """Three different moments; raises NoClosedForm where M is along none of their axes."""
    from taylor_verify.exact.euler.moments.washboard.board import Washboard
    from taylor_verify.exact.euler.moments.washboard.elements import elements

    return elements(Washboard(body.inertia, body.moment, omega), digits)


def _circle(spin: LoadedSpin) -> list[Element]:
    """Of the one motion under a moment that recurs: the spin is constant, the rest turns evenly."""
    if spin.regime is not MomentRegime.TRANSVERSE or not spin.free.turning:
        return []
    rate = mp.convert(abs(spin.free.turning)) / mp.sqrt(mp.convert(spin.free.axis_squared))
    body = "(Js - Jd)(e.omega)/Jd"
    return [
        Element("period", 2 * mp.pi / rate, "time", "omega recurs in body axes", body),
        Element("rate", rate, "radians/time", "the transverse omega turns, in body axes", body),
    ]


def _numbers(spin: FreeSpin) -> list[Element]:
    """At the ambient precision."""
    own: Mapping[Regime, Callable[[FreeSpin], list[Element]]] = {
        Regime.SPHERICAL: _turn,
        Regime.STEADY: _steady,
        Regime.AXISYMMETRIC: _axisymmetric,
        Regime.SEPARATRIX: _separatrix,
        Regime.MAX_AXIS: _triaxial,
        Regime.MIN_AXIS: _triaxial,
    }
    found = own[spin.regime](spin) if spin.regime in own else []
    return [*found, *_conserved(spin)]


def _conserved(spin: FreeSpin) -> list[Element]:
    T, H2 = mp.convert(spin.twice_energy / 2), mp.convert(spin.momentum_squared)
    return [
        Element("T", T, "energy", "kinetic energy, conserved", "omega.I omega/2"),
        Element("H2", H2, "angular momentum^2", "|H|^2, conserved", "|I omega|^2"),
    ]


# One turn of a constant omega, and what a small disturbance of it does.


def _turn(spin: FreeSpin) -> list[Element]:
    squared = sum((w * w for w in spin.omega), Fraction(0))
    turn = 2 * mp.pi / mp.sqrt(mp.convert(squared))
    return [Element("turn_period", turn, "time", "one turn about the constant omega")]


def disturbance(spin: FreeSpin) -> Fraction:
    """s^2, rational, where a disturbance of a steady rotation about the axis of J goes as e^{s t}.

    s^2 = -w^2 (J - J_p)(J - J_q)/(J_p J_q) with the other two moments J_p and J_q; here
    J = H^2/2T, (J - J_p)(J - J_q) = p'(J), J_p J_q = det I/J and w^2 J = 2T.
    """
    J = spin.momentum_squared / spin.twice_energy
    slope = 3 * J**2 - 2 * spin.trace * J + spin.minors
    return -spin.twice_energy * slope / spin.determinant


def _steady(spin: FreeSpin) -> list[Element]:
    s2, source = disturbance(spin), "equations (2.2.72) linearised about the spin"
    found = _turn(spin)
    size = mp.sqrt(mp.convert(abs(s2)))
    if s2 > 0:
        meaning = "rate s at which a disturbance of the spin grows, as e^{s t}"
        found.append(Element("growth_rate", size, "1/time", meaning, source))
    elif s2 < 0:
        meaning = "angular frequency at which a disturbance of the spin goes round its axis"
        found += [
            Element("wobble_rate", size, "radians/time", meaning, source),
            Element("wobble_period", 2 * mp.pi / size, "time", "2 pi/wobble_rate", source),
        ]
    return found


def _steady_story(spin: FreeSpin) -> str:
    s2, permanent = disturbance(spin), "A permanent rotation about a principal axis: "
    if s2 > 0:
        return permanent + "the middle one, unstable; a disturbance grows exponentially."
    if s2 < 0:
        return permanent + "of greatest or least inertia, stable; a disturbance goes round it."
    return permanent + (
        "one of those with equal moments; a disturbance along the axis of symmetry makes omega "
        "drift away in proportion to time."
    )


def _axisymmetric(spin: FreeSpin) -> list[Element]:
    precession = Precession(spin)
    rate = abs(precession.rate)
    H = mp.sqrt(mp.convert(spin.momentum_squared))
    about = H / mp.convert(spin.double_moment)
    along = mp.convert(spin.simple_moment) * abs(mp.fdot(precession.axis, _real(spin.omega)))
    across = mp.convert(spin.double_moment) * _distance_from_axis(spin, precession)
    body, space = "Om = (Js - Jd)(e.omega)/Jd", "|H|/Jd"
    return [
        Element("period", 2 * mp.pi / rate, "time", "omega recurs in body axes", body),
        Element("rate", rate, "radians/time", "omega goes round the axis, in body axes", body),
        Element(
            "precession_rate", about, "radians/time", "the axis goes round H, in space axes", space
        ),
        Element("precession_period", 2 * mp.pi / about, "time", "2 pi/precession_rate", space),
        Element(
            "precession_angle", mp.atan2(across, along), "radians", "between the axis and H", space
        ),
    ]


def _distance_from_axis(spin: FreeSpin, precession: Precession) -> mpf:
    """|omega - (e.omega) e|."""
    omega = _real(spin.omega)
    along = mp.fdot(precession.axis, omega)
    return mp.norm([w - along * e for w, e in zip(omega, precession.axis, strict=True)])


# Three different moments.


def _triaxial(spin: FreeSpin) -> list[Element]:
    orbit = Orbit(spin)
    m, m_prime = orbit.m, orbit.m_prime
    found = [
        Element("period", orbit.period, "time", "omega recurs in body axes", "4K/lam"),
        Element("rate", orbit.rate, "radians/time", "lam, of the elliptic argument", _SOURCE),
        Element("k", mp.sqrt(m), "", "modulus of the elliptic functions", _SOURCE),
        Element("m", m, "", "parameter k^2; 0 at a steady spin, 1 on the separatrix", _SOURCE),
        Element("m_prime", m_prime, "", "1 - m, one measure of the separatrix's distance", _SOURCE),
        _separation(spin, orbit),
        Element(
            "flip_time",
            orbit.period / 2,
            "time",
            "from one turn-over to the next: omega's middle component is zero this often",
            "2K/lam",
        ),
        Element(
            "nutation_frequency",
            4 * mp.pi / orbit.period,
            "radians/time",
            "frequency at which the encircled axis nods to H, in space axes",
            "pi lam/K",
        ),
    ]
    if m_prime * _NEAR.denominator <= _NEAR.numerator:
        found += _flip_laws(orbit)
    return [*found, _saddle(spin)]


def _separatrix(spin: FreeSpin) -> list[Element]:
    orbit = Orbit(spin)
    return [
        Element("rate", orbit.rate, "1/time", "lam, of the hyperbolic argument", _SOURCE),
        Element("k", mpf(1), "", "modulus: the elliptic functions are hyperbolic", _SOURCE),
        Element("m", orbit.m, "", "parameter k^2", _SOURCE),
        Element("m_prime", orbit.m_prime, "", "1 - m: on the separatrix itself", _SOURCE),
        _separation(spin, orbit),
        _saddle(spin),
    ]


def _separation(spin: FreeSpin, orbit: Orbit) -> Element:
    """|H^2 - 2T J2|/H^2, by m' = |J_a - J_c| D/(|J_a - J_b| A): nothing cancels."""
    D = orbit.m_prime * orbit.rate**2 * mp.convert(spin.determinant) / abs(orbit.gap)
    relative = D / mp.convert(spin.momentum_squared)
    meaning = "distance to the separatrix, relative to H^2"
    return Element("separation", relative, "", meaning, "|H^2 - 2T J2|/H^2")


def _flip_laws(orbit: Orbit) -> Sequence[Element]:
    """K = L + (L - 1) m'/4 + O(m'^2 L) with L = ln(4/sqrt m') (DLMF 19.12.1)."""
    L = mp.log(16 / orbit.m_prime) / 2
    next_term = L + (L - 1) * orbit.m_prime / 4
    return [
        Element(
            "flip_law",
            2 * L / orbit.rate,
            "time",
            "flip_time by its leading law near the separatrix",
            "ln(16/m')/lam",
        ),
        Element(
            "flip_law_2",
            2 * next_term / orbit.rate,
            "time",
            "the same with the next term",
            "(2/lam)(L + (L - 1) m'/4), L = ln(16/m')/2",
        ),
    ]


def _saddle(spin: FreeSpin) -> Element:
    """The growth rate of the unstable spin with the same energy, where w_b^2 = 2T/J2."""
    frame = principal_frame(spin)
    product = frame.upper_gap * frame.lower_gap
    square = mp.convert(spin.twice_energy / spin.determinant) * product
    return Element(
        "saddle_rate",
        mp.sqrt(square),
        "1/time",
        "growth rate of the spin about the middle axis with this energy",
        "lam^2 = 2T (J1 - J2)(J2 - J3)/(J1 J2 J3)",
    )


def _real(vector: Sequence[Fraction]) -> list[mpf]:
    return [mp.convert(entry) for entry in vector]
