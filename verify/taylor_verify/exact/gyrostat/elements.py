"""The elements of a gyrostat's motion, from its exact invariants; legend as in pencil."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Final

from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.as_written import as_rationals
from taylor_verify.exact.balls import Undecidable, midpoint
from taylor_verify.exact.element import Element, Elements, settled
from taylor_verify.exact.euler.closed import top
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat, Regime
from taylor_verify.exact.gyrostat.sigma import best_azimuth
from taylor_verify.exact.gyrostat.spins import steady_spins
from taylor_verify.exact.lattice import lattice
from taylor_verify.exact.solution import NO_CLOSED_FORM, Unsettled
from taylor_verify.scenes.scene import Scene

_CONSERVED: Final = (
    "Conserved: T = omega.I omega/2 and |H|^2 with H = I omega + h; in space axes the vector H."
)
_STORY: Final[Mapping[Regime, str]] = {
    Regime.REST: "The body is at rest; its wheels turn.",
    Regime.STEADY: "H is along omega: a steady spin, which the wheels do not disturb.",
    Regime.SPHERICAL: "All three moments are equal: omega turns about h at the constant rate |h|/J.",
    Regime.AXISYMMETRIC: (
        "Two moments are equal and h is along the third axis: omega goes round that axis at a constant "
        "rate, and the axis round H at another."
    ),
    Regime.PERIODIC: "omega recurs in the body: elliptic functions of the time.",
    Regime.TRIGONOMETRIC: "omega recurs in the body: trigonometric functions of the time.",
    Regime.SEPARATRIX: (
        "omega leaves an unstable steady spin and returns to a steady spin for ever: hyperbolic functions "
        "of the time, and no period."
    ),
    Regime.CUSP: (
        "omega leaves a steady spin that is at the border of stability, and returns to it for ever as "
        "1/t^2: rational functions of the time."
    ),
}
_CANCELLED: Final = (
    "The wheels cancel the momentum of the body, H = 0: omega is constant, about any axis.",
    "With H = 0 there is one steady spin, this motion. It is stable: |H| stays as small as a disturbance "
    "makes it.",
)
_PENCIL: Final = "invariants of the pencil of |H|^2 and T"
_GUARD_BITS: Final = 40
_ATTEMPTS: Final = 8


def elements(scene: Scene, digits: int) -> Elements:
    """Return every element of a free gyrostat; under a moment none, and a sentence."""
    if not scene.body.is_free:
        story = "A constant moment acts on a body with wheels: no closed form is built."
        return Elements(NO_CLOSED_FORM, (), (story,))
    # Spins beside the motion: a start in degrees is rational there, rounded to 120 digits.
    free, beside = map(_free, (scene, as_rationals(scene)))
    numbers = settled(lambda _: [*_numbers(free), *_conserved(free), *_spins(beside)], digits)
    sentences = (_STORY[free.regime], _count(beside)) if free.n else _CANCELLED
    return Elements(free.regime.value, numbers, (*sentences, _CONSERVED))


def _free(scene: Scene) -> FreeGyrostat:
    body, start = top(scene)
    return FreeGyrostat(body.inertia, body.rotor, start.omega)


def _numbers(free: FreeGyrostat) -> list[Element]:
    """The elements of the orbit itself, at the ambient precision."""
    if free.outer is not None:
        return _turning(free)
    if free.regime is Regime.SEPARATRIX:
        meaning = "rate at which omega leaves the steady spin and returns to it, as e^{s t}"
        rate = 2 * mp.sqrt(3 * mp.convert(free.double_root))
        return [Element("saddle_rate", rate, "1/time", meaning, _PENCIL)]
    if free.regime is Regime.CUSP:
        return []
    # R recurs but for a turn about H: phi of any body axis, which differ by whole turns.
    turned, period, *parameters = _recurring(free)
    angle = turned - 2 * mp.pi * mp.floor(turned / (2 * mp.pi))
    meaning = "angle about H by which the attitude differs after a period, less whole turns"
    elements = [
        Element("period", period, "time", "omega recurs in body axes", _PENCIL),
        Element("precession", angle, "radians", meaning, "", size=2 * mp.pi),
    ]
    meanings = ("parameter k^2 of the elliptic functions", "1 - m")
    for name, value, words in zip(("m", "m_prime"), parameters, meanings, strict=False):
        elements.append(Element(name, value, "", words, _PENCIL))
    return elements


def _recurring(free: FreeGyrostat) -> list[mpf]:
    """The turn about H in a period, the period, m and m' where they are, to mpmath's precision."""
    bits = mp.prec + _GUARD_BITS
    for _ in range(_ATTEMPTS):
        with ctx.workprec(bits), suppress(Undecidable):
            curve = lattice(*free.invariants)
            azimuth = best_azimuth(free, curve)
            sizes = [curve.period, *(curve.parameters or ())]
            turned = azimuth.per_period
            is_sharp = all(number.rel_accuracy_bits() >= mp.prec for number in sizes)
            if is_sharp and turned.rad() <= arb(2) ** -mp.prec:
                return [midpoint(number) for number in (turned, *sizes)]
        bits *= 2
    raise Unsettled(f"the period is not known with {bits // 2} bits")


def _turning(free: FreeGyrostat) -> list[Element]:
    """The rates of a uniform turning."""
    elements = []
    for name, rate, meaning in (
        ("rate", free.inner, "omega turns in body axes"),
        ("precession_rate", free.outer, "the body turns about H, or about a steady omega"),
    ):
        if rate is not None and any(rate):
            size = mp.norm([mp.convert(c) for c in rate])
            elements.append(Element(name, size, "radians/time", meaning))
    return elements


def _conserved(free: FreeGyrostat) -> list[Element]:
    T, H2 = mp.convert(free.twice_energy / 2), mp.convert(free.n)
    return [
        Element("T", T, "energy", "kinetic energy, conserved", "omega.I omega/2"),
        Element("H2", H2, "angular momentum^2", "|H|^2, conserved", "|I omega + h|^2"),
    ]


def _spins(free: FreeGyrostat) -> list[Element]:
    """The steady spins with this |H|, and the growth or the frequency of a disturbance of each."""
    elements: list[Element] = []
    # Without momentum a spin has no axis H about which its rate could be counted.
    for k, spin in enumerate(steady_spins(free) if free.n else (), start=1):
        name, source = f"spin_{k}", "(I^-1 - mu) H = I^-1 h with |H| given"
        meaning = f"omega along H in steady spin number {k} with this |H|"
        elements.append(
            Element(name, spin.rate, "radians/time", meaning, source, mp.sqrt(mp.convert(free.n)))
        )
        size = mp.sqrt(abs(spin.square))
        if spin.square > 0:
            meaning = f"rate at which a disturbance of spin {k} grows: it is unstable"
            elements.append(Element(f"{name}_growth", size, "1/time", meaning))
        elif spin.square < 0:
            meaning = f"frequency of a disturbance of spin {k}: it is stable"
            elements.append(Element(f"{name}_wobble", size, "radians/time", meaning))
    return elements


def _count(free: FreeGyrostat) -> str:
    """The number of steady spins in words."""
    with mp.workdps(30):
        spins = steady_spins(free)
    unstable = sum(spin.square > 0 for spin in spins)
    return f"With this |H| there are {len(spins)} steady spins, {unstable} of them unstable."
