"""The elements of a rigid body's orbit, from its exact invariants.

Legend as in regime and orbit: J1 >= J2 >= J3 principal moments, p(x) = det(x - I), 2T = w.I w,
H = I w; (a, b, c) the encircled, the intermediate and the third axis; m = k^2, m' = 1 - m,
lam the rate of the elliptic argument u, K the quarter period.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Final

from mpmath import mp, mpf

from taylor_verify.exact.element import Element, Elements, described, settled
from taylor_verify.exact.euler.closed import top
from taylor_verify.exact.euler.fixed_axis import FixedAxisRegime, axis_under
from taylor_verify.exact.euler.orbit import Orbit, principal_frame
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.exact.solution import NO_CLOSED_FORM
from taylor_verify.numbers import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.scene import Scene

# Up to here the leading law of the flip is off by (1 - 1/L) m'/4 of itself: 1 %.
_NEAR: Final = Fraction(1, 16)

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
_FIXED_AXIS_STORY: Final[Mapping[FixedAxisRegime, tuple[str, ...]]] = {
    FixedAxisRegime.STEADY: (
        "The gyroscopic moment of a steady rotation balances the constant moment: omega is constant.",
    ),
    FixedAxisRegime.STRAIGHT: (
        "A constant moment along a principal axis: omega lies along it too, and grows evenly for ever.",
        _WORK,
    ),
}


def elements(scene: Scene, digits: int) -> Elements:
    """Return the elements of a free body; for a body under a moment sentences alone."""
    body, start = top(scene)
    if any(body.rotor):
        from taylor_verify.exact.gyrostat import elements as gyrostat

        return gyrostat.elements(scene, digits)
    if not body.is_free:
        return _loaded(body, start.omega)
    spin = FreeSpin(body.inertia, start.omega)
    conserved = spin.twice_energy / 2, spin.momentum_squared

    def numbers(_: int) -> list[Element]:
        return [*orbit(spin), *described(_KEPT, map(mp.convert, conserved))]

    return Elements(spin.regime.value, settled(numbers, digits), (story(spin), _CONSERVED))


def story(spin: FreeSpin) -> str:
    """Return a sentence on the motion of a free body."""
    return _steady_story(spin) if spin.regime is Regime.STEADY else _STORY[spin.regime]


def _loaded(body: RigidBody, omega: tensors.Vector) -> Elements:
    """Return the elements of a body under a constant moment; T' = M.omega, so T is not conserved."""
    steady_axis = axis_under(FreeSpin(body.inertia, omega), body.moment)
    if steady_axis is not None:
        regime, _ = steady_axis
        return Elements(regime.value, (), _FIXED_AXIS_STORY[regime])
    story = (
        "A constant moment in body axes acts: no closed form is built, and the motion has neither a "
        "period nor a modulus that could be named."
    )
    return Elements(NO_CLOSED_FORM, (), (story, _WORK))


_KEPT: Final = """
    T :: energy :: kinetic energy, conserved :: omega.I omega/2
    H2 :: angular momentum^2 :: |H|^2, conserved :: |I omega|^2
"""


def orbit(spin: FreeSpin) -> list[Element]:
    """The numbers of a free orbit at the ambient precision, without what is conserved."""
    own: Mapping[Regime, Callable[[FreeSpin], list[Element]]] = {
        Regime.SPHERICAL: _turn,
        Regime.STEADY: _steady,
        Regime.AXISYMMETRIC: _axisymmetric,
        Regime.SEPARATRIX: _separatrix,
        Regime.MAX_AXIS: _triaxial,
        Regime.MIN_AXIS: _triaxial,
    }
    return own[spin.regime](spin) if spin.regime in own else []


_TURN: Final = "turn_period :: time :: one turn about the constant omega ::"


def _turn(spin: FreeSpin) -> list[Element]:
    size = mp.sqrt(mp.convert(tensors.dot(spin.omega, spin.omega)))
    return described(_TURN, [2 * mp.pi / size])


def disturbance(spin: FreeSpin) -> Fraction:
    """s^2, rational, where a disturbance of a steady rotation about the axis of J goes as e^{s t}.

    s^2 = -w^2 (J - J_p)(J - J_q)/(J_p J_q) with the other two moments J_p and J_q; here
    J = H^2/2T, (J - J_p)(J - J_q) = p'(J), J_p J_q = det I/J and w^2 J = 2T.
    """
    J = spin.momentum_squared / spin.twice_energy
    slope = 3 * J**2 - 2 * spin.trace * J + spin.cubic.minors
    return -spin.twice_energy * slope / spin.determinant


_LINEAR: Final = "equations (2.2.72) linearised about the spin"
_GROWTH: Final = f"""
    growth_rate :: 1/time :: rate s at which a disturbance of the spin grows, as e^{{s t}} :: {_LINEAR}
"""
_WOBBLE: Final = f"""
    wobble_rate :: radians/time :: angular frequency at which a disturbance of the spin \
goes round its axis :: {_LINEAR}
    wobble_period :: time :: 2 pi/wobble_rate :: {_LINEAR}
"""


def _steady(spin: FreeSpin) -> list[Element]:
    s2, numbers = disturbance(spin), _turn(spin)
    size = mp.sqrt(mp.convert(abs(s2)))
    if s2 > 0:
        numbers += described(_GROWTH, [size])
    elif s2 < 0:
        numbers += described(_WOBBLE, [size, 2 * mp.pi / size])
    return numbers


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


_PRECESSION: Final = """
    period :: time :: omega recurs in body axes :: Om = (Js - Jd)(e.omega)/Jd
    rate :: radians/time :: omega goes round the axis, in body axes :: Om = (Js - Jd)(e.omega)/Jd
    precession_rate :: radians/time :: the axis goes round H, in space axes :: |H|/Jd
    precession_period :: time :: 2 pi/precession_rate :: |H|/Jd
    precession_angle :: radians :: between the axis and H :: |H|/Jd
"""


def _axisymmetric(spin: FreeSpin) -> list[Element]:
    rate = mp.convert(abs(spin.turning)) / mp.sqrt(mp.convert(spin.axis_squared))
    about = mp.sqrt(mp.convert(spin.momentum_squared)) / mp.convert(spin.double_moment)
    along, across = (
        mp.sqrt(mp.convert(tensors.dot(part, part)))
        for part in (spin.along(spin.momentum), spin.across(spin.momentum))
    )
    angle = mp.atan2(across, along)
    return described(_PRECESSION, (2 * mp.pi / rate, rate, about, 2 * mp.pi / about, angle))


# Three different moments.

_MODULUS: Final = """
    k :: :: modulus of the elliptic functions :: Heinbockel (2.2.72), M = 0
    m :: :: parameter k^2; 0 at a steady spin, 1 on the separatrix :: Heinbockel (2.2.72), M = 0
    m_prime :: :: 1 - m, one measure of the separatrix's distance :: Heinbockel (2.2.72), M = 0
    separation :: :: distance to the separatrix, relative to H^2 :: |H^2 - 2T J2|/H^2
"""
_TRIAXIAL: Final = f"""
    period :: time :: omega recurs in body axes :: 4K/lam
    rate :: radians/time :: lam, of the elliptic argument :: Heinbockel (2.2.72), M = 0
    {_MODULUS.strip()}
    flip_time :: time :: from one turn-over to the next: omega's middle component is zero \
this often :: 2K/lam
    nutation_frequency :: radians/time :: frequency at which the encircled axis nods to H, \
in space axes :: pi lam/K
"""
_WAVES: Final = """
    amplitude_dn :: radians/time :: omega about the encircled axis is this times dn(rate t + phase) :: \
Heinbockel (2.2.72), M = 0
    amplitude_sn :: radians/time :: likewise about the middle axis, times sn :: Heinbockel (2.2.72), M = 0
    amplitude_cn :: radians/time :: likewise about the third axis, times cn :: Heinbockel (2.2.72), M = 0
    phase :: radians :: of the elliptic argument, at the start :: Heinbockel (2.2.72), M = 0
"""
_FLIPS: Final = """
    flip_law :: time :: flip_time by its leading law near the separatrix :: ln(16/m')/lam
    flip_law_2 :: time :: the same with the next term :: (2/lam)(L + (L - 1) m'/4), L = ln(16/m')/2
"""


def _triaxial(spin: FreeSpin) -> list[Element]:
    orbit = Orbit(spin)
    period = orbit.period
    values = (period, orbit.rate, *_modulus(spin, orbit), period / 2, 4 * mp.pi / period)
    numbers = described(_TRIAXIAL, values)
    if orbit.m_prime * _NEAR.denominator <= _NEAR.numerator:
        # K = L + (L - 1) m'/4 + O(m'^2 L) with L = ln(4/sqrt m') (DLMF 19.12.1).
        L = mp.log(16 / orbit.m_prime) / 2
        laws = L, L + (L - 1) * orbit.m_prime / 4
        numbers += described(_FLIPS, (2 * law / orbit.rate for law in laws))
    # The phase may be zero, and a quarter period is its size.
    *amplitudes, phase = described(_WAVES, (*orbit.amplitudes, orbit.phase))
    waves = [*amplitudes, replace(phase, size=orbit.quarter_period)]
    return [*numbers, *waves, *_saddle(spin)]


_SEPARATRIX: Final = """
    rate :: 1/time :: lam, of the hyperbolic argument :: Heinbockel (2.2.72), M = 0
    k :: :: modulus: the elliptic functions are hyperbolic :: Heinbockel (2.2.72), M = 0
    m :: :: parameter k^2 :: Heinbockel (2.2.72), M = 0
    m_prime :: :: 1 - m: on the separatrix itself :: Heinbockel (2.2.72), M = 0
    separation :: :: distance to the separatrix, relative to H^2 :: |H^2 - 2T J2|/H^2
"""


def _separatrix(spin: FreeSpin) -> list[Element]:
    orbit = Orbit(spin)
    return [*described(_SEPARATRIX, (orbit.rate, *_modulus(spin, orbit))), *_saddle(spin)]


def _modulus(spin: FreeSpin, orbit: Orbit) -> tuple[mpf, ...]:
    """k, m, m' and |H^2 - 2T J2|/H^2 by m' = |J_a - J_c| D/(|J_a - J_b| A): nothing cancels."""
    D = orbit.m_prime * orbit.rate**2 * mp.convert(spin.determinant) / abs(orbit.gap)
    separation = D / mp.convert(spin.momentum_squared)
    return mp.sqrt(orbit.m), orbit.m, orbit.m_prime, separation


_SADDLE: Final = """
    saddle_rate :: 1/time :: growth rate of the spin about the middle axis with this energy \
:: lam^2 = 2T (J1 - J2)(J2 - J3)/(J1 J2 J3)
"""


def _saddle(spin: FreeSpin) -> list[Element]:
    """The growth rate of the unstable spin with the same energy, where w_b^2 = 2T/J2."""
    frame = principal_frame(spin)
    product = frame.upper_gap * frame.lower_gap
    square = mp.convert(spin.twice_energy / spin.determinant) * product
    return described(_SADDLE, [mp.sqrt(square)])
