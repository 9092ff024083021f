"""The elements of the orbit of a free solid without an axis of symmetry, and those of every free solid.

Three numbers at least, T, F and G; a fourth integral where the body is of an integrable family; a
period where the motion stays in a plane of the body, two rates in Weber's case; and of the steady
screws beside it, which of them are stable.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from mpmath import mp, mpf

from taylor_verify.exact.element import Element, Elements, settled
from taylor_verify.exact.kirchhoff.integrable import fourth_integral
from taylor_verify.exact.kirchhoff.pendulum import Pendulum
from taylor_verify.exact.kirchhoff.plane import plane, regime
from taylor_verify.exact.kirchhoff.screws import Screw, Stability, is_steady, screws_beside
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.kirchhoff.weber.curve import REGIME as WEBER
from taylor_verify.exact.kirchhoff.weber.curve import Curve, curve
from taylor_verify.exact.kirchhoff.weber.enclosure import rates
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.precision import float_text
from taylor_verify.scenes.scene import Scene

_PENDULUM: Final = "(2 alpha)'' = -omega0^2 sin 2 alpha"
_CURVE: Final = "H. Weber, Math. Ann. 14 (1878) 173"
_THREE: Final = (
    "Conserved: the kinetic energy T, F^2 = x.x and FG = x.y; in space axes the linear impulse and "
    "the moment of the impulses."
)
_FAMILIES: Final[Mapping[str, str]] = {
    "clebsch2": "Clebsch's second case",
    "neumann": "the family r_1 = r_2 = r_3 with b_1 = b_2 = b_3 (Neumann's, where FG = 0)",
    "steklov": "Steklov's family",
    "lyapunov": "Lyapunov's family",
    "chaplygin": "Chaplygin's family, where FG = 0",
    "sokolov": "Sokolov's family",
}
_NOT_THREE: Final = (
    "Of the steady screws that turn as the start does two have the same mu: every axis of a plane "
    "is one."
)
_UNBUILT: Final = "The energy is not of Clebsch's form about any axis: no closed form is built."
_UNSOLVED: Final = (
    "The energy is not of Clebsch's form about any axis: no closed form is built, and for a body "
    "with three invariants alone none is known."
)
_SWING: Final = ("period", "rate", "m", "k", "m_prime")
# Unit and meaning of the elements of a closed form.
_WORDS: Final[Mapping[str, tuple[str, str]]] = {
    "nutation_frequency": ("radians/time", "frequency of nutation"),
    "rate": ("radians/time", "of the elliptic argument"),
    "m": ("", "parameter k^2; 0 for sines, 1 on the separatrix"),
    "k": ("", "modulus of the elliptic functions"),
    "m_prime": ("", "1 - m, one measure of the separatrix's distance"),
}
_STORY: Final[Mapping[str, str]] = {
    "planar-steady": "x and y are constant: the body moves straight on, or not at all.",
    "planar-uniform": "The body turns in a plane at a constant rate.",
    "planar-swing": "The body swings in a plane about the position broadside on, as a pendulum.",
    "planar-turn": "The body turns over and over in a plane, as a pendulum with enough speed.",
    "planar-front": (
        "The body turns over once in a plane, from end on to end on (heteroclinic); there is no "
        "period."
    ),
    WEBER: (
        "x and y are functions of two angles that grow evenly, by theta functions of two variables "
        "(Weber's case): there is no period. Attitude and path are integrals of such functions."
    ),
}


def elements(scene: Scene, digits: int) -> Elements:
    """The elements of a free body without an axis of symmetry."""
    body, start = solid(scene)
    place, weber, fourth = plane(scene), _weber_curve(scene), fourth_integral(scene)
    kind = NO_CLOSED_FORM if place is None else regime(place)
    if weber is not None:
        kind = WEBER

    def numbers(working: int) -> list[Element]:
        swing = {} if place is None else Pendulum(kind, place, scene).elements(working)
        angles = [] if weber is None else _weber_rates(weber, working)
        own = recurring(swing, _SWING, "x and y recur in body axes", _PENDULUM)
        return [*own, *angles, *conserved(body, start)]

    told = [_STORY.get(kind, _UNSOLVED if fourth is None else _UNBUILT), _THREE]
    if fourth is not None:
        told.append(
            f"Conserved too: {fourth.name}, the fourth integral of {_FAMILIES[fourth.name]}."
        )
    return Elements(kind, settled(numbers, digits), (*told, *_screw_story(scene)))


def recurring(
    known: Mapping[str, mpf], names: Sequence[str], period: str, source: str
) -> Iterator[Element]:
    """Yield these elements of a closed form, as far as it has them; ``period`` says what recurs."""
    values, words = dict(known), {"period": ("time", period), **_WORDS}
    if "period" in known:
        values["nutation_frequency"] = 2 * mp.pi / known["period"]
    if "m" in known:
        values["k"] = mp.sqrt(known["m"])
    for name in (name for name in names if name in values):
        by = "2 pi/period" if name == "nutation_frequency" else source
        yield Element(name, values[name], *words[name], by)


def conserved(body: ImmersedBody, start: Impulse) -> Iterator[Element]:
    """Yield T, F and G, which every free motion keeps; G only where there is an F."""
    x, y = start.linear, start.angular
    T = mp.convert(tensors.dot(x + y, tensors.apply(body.energy_matrix, x + y)) / 2)
    yield Element("T", T, "energy", "kinetic energy, conserved", "Hydromechanics 48 (i)")
    F = mp.sqrt(mp.convert(tensors.dot(x, x)))
    yield Element("F", F, "impulse", "linear impulse |x|, conserved", "Hydromechanics 48 (ii)")
    if F:
        G = mp.convert(tensors.dot(x, y)) / F
        meaning = "angular impulse along F, x.y/F, conserved"
        yield Element("G", G, "angular impulse", meaning, "Hydromechanics 48 (iii)")


def _weber_curve(scene: Scene) -> Curve | None:
    """Weber's curve of the motion, where it has one that is not degenerate."""
    try:
        return curve(scene)
    except NoClosedForm:
        return None


def _weber_rates(found: Curve, working: int) -> list[Element]:
    """The rates of the two angles."""
    meaning = "of the {} of two angles of which x and y are functions, of period 2 pi in each"
    return [
        Element(f"{which}_rate", rate, "radians/time", meaning.format(which), _CURVE)
        for which, rate in zip(("first", "second"), rates(found, working), strict=True)
    ]


def _screw_story(scene: Scene) -> list[str]:
    """The stability of the three screws beside the motion, and whether the start is one of them."""
    body, start = solid(scene)
    if not any(start.linear):
        return []
    told = ["The start is itself a steady screw."] if is_steady(body, start) else []
    found = screws_beside(scene)
    if not found:
        return [*told, _NOT_THREE]
    told.append(
        "Steady screws with this F that turn about it as the start does, lambda = Omega.x/F^2 = "
        f"{float_text(found[0].turn)}: three, by rising mu."
    )
    for number, screw in enumerate(found, 1):
        axis = ", ".join(f"{float(entry.mid()):.3g}" for entry in screw.axis())
        told.append(
            f"Screw {number}, along ({axis}), advancing at {float(screw.speed.mid()):.3g}, is "
            f"{screw.stability.value}{_pace(screw)}."
        )
    return told


def _pace(screw: Screw) -> str:
    """The rates that go with the statement."""
    if screw.stability is Stability.UNDECIDED:
        return ""
    if screw.stability is Stability.UNSTABLE:
        return f", by e in {1 / float(screw.growth().mid()):.3g} units of time"
    slow, fast = (float(rate.mid()) for rate in screw.swings())
    return f" (swings at {slow:.3g} and {fast:.3g} radians per unit of time)"
