"""The elements of the orbit of a solid that is not Clebsch's body, and those of every free solid.

Three numbers at least, T, F and G; a fourth integral where the body is of an integrable family; and the
numbers of the case that the motion is, such as a period, two rates or a pitch.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

from mpmath import mp, mpf

from taylor_verify.exact.element import Element, Elements, described, settled
from taylor_verify.exact.euler import elements as tops
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.kirchhoff.closed import Case
from taylor_verify.exact.kirchhoff.displaced import centred, symmetric_origin
from taylor_verify.exact.kirchhoff.integrable import family_of
from taylor_verify.exact.kirchhoff.plane import Plane, swing
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.kirchhoff.solid import solid, velocities
from taylor_verify.exact.kirchhoff.weber.curve import REGIME as WEBER
from taylor_verify.exact.kirchhoff.weber.curve import Curve
from taylor_verify.exact.kirchhoff.weber.quotients import rates
from taylor_verify.exact.solution import NO_CLOSED_FORM
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
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
_UNBUILT: Final = "The energy is not of Clebsch's form about any axis: no closed form is built."
_UNSOLVED: Final = (
    "The energy is not of Clebsch's form about any axis: no closed form is built, and for a body "
    "with three invariants alone none is known of its general motion."
)
_BALANCED: Final = (
    "The loads balance the gyroscopic terms. Not conserved: the linear impulse in space axes and the "
    "moment of the impulses turn with the body."
)
_TOP: Final = (
    "What is left is Euler's top of the inertia C^-1: {y} moves as its angular momentum H, {Cy} as its "
    "omega, and x stands still in the space of the top."
)
_TURNED: Final = "x turns in the body as the space of the top does: {named} need not recur."
_STRAIGHT: Final = "speed :: length/time :: of the origin, along a straight line :: |U|"
_SCREW: Final = """
    turn_period :: time :: one turn about the axis of the screw :: 2 pi/|Omega|
    advance :: length/time :: velocity along the axis of the screw :: U.Omega/|Omega|
    pitch :: length :: the advance in one turn :: 2 pi U.Omega/Omega^2
"""
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
    "rest": "Both impulses are zero: the body is at rest.",
    "steady": (
        "x and y are constant: the body turns about one line, fixed in it and in space, and advances "
        "along it, as a screw."
    ),
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
        "(Weber's case): there is no period. Attitude and path have no closed form."
    ),
}


def elements(scene: Scene, solved: Case | None, kind: str, digits: int) -> Elements:
    """The elements of a body that is not Clebsch's; ``solved`` is the case of x and y, if they have one."""
    body, start = solid(scene)
    family = family_of(scene)

    def numbers(working: int) -> list[Element]:
        own = [] if solved is None else own_elements(solved, working)
        return [*own, *conserved(body, start)]

    unsolved = _UNSOLVED if family is None else _UNBUILT
    known = kind if solved is None else solved.regime
    sentences = [*(_top_story(scene, solved, kind) or [_STORY.get(known, unsolved)])]
    sentences.append(_THREE if body.is_free else _BALANCED)
    if family is not None:
        name, _ = family
        sentences.append(f"Conserved too: {name}, the fourth integral of {_FAMILIES[name]}.")
    return Elements(kind, settled(numbers, digits), tuple(sentences))


def own_elements(solved: Case, working: int) -> list[Element]:
    """The elements of x and y in one of the cases."""
    match solved.subject:
        case Plane() as place:
            return [*recurring(swing(place), _SWING, "x and y recur in body axes", _PENDULUM)]
        case Curve() as curve:
            return _weber_rates(curve, working)
        case FreeSpin() as spin:
            return [*map(_of_top, tops.orbit(spin))]
        case Impulse() as start:
            body, _ = solid(solved.reduced.scene)
            return _screw(*velocities(body, start))
    return []


def _screw(U: Vector, Omega: Vector) -> list[Element]:
    """The numbers of a steady motion: one turn, and the way of the origin along the axis of the screw."""
    if not any(Omega):
        speed = mp.sqrt(mp.convert(tensors.dot(U, U)))
        return described(_STRAIGHT, [speed]) if speed else []
    rate = mp.sqrt(mp.convert(tensors.dot(Omega, Omega)))
    advance, period = mp.convert(tensors.dot(U, Omega)) / rate, 2 * mp.pi / rate
    return described(_SCREW, (period, advance, advance * period))


def _of_top(element: Element) -> Element:
    """Return an element of the top in words that leave Omega and the space axes of the solid alone."""
    meaning = element.meaning.replace("in space axes", "in its space")
    return replace(element, meaning=f"of the top: {meaning}")


def _top_story(scene: Scene, solved: Case | None, kind: str) -> list[str]:
    """Sentences on a motion in which y is that of Euler's top; none on another."""
    if solved is None or not isinstance(solved.subject, FreeSpin):
        return []
    body, start = solid(scene)
    has_x = any(start.linear)
    y = "y about that origin" if has_x and any(symmetric_origin(body)) else "y"
    # B is b 1 about that origin, and Omega = b x + C y.
    has_b = any(map(any, solid(centred(Reduced(scene)).scene)[0].coupling))
    Cy, named = ("C y", "x and Omega = b x + C y") if has_x and has_b else ("Omega = C y", "x")
    sentences = [_TOP.format(y=y, Cy=Cy)]
    sentences += [_TURNED.format(named=named)] if has_x else []
    pathless = [] if kind != NO_CLOSED_FORM else ["The path of the origin has no closed form."]
    return [*sentences, f"Of the top: {tops.story(solved.subject)}", *pathless]


def recurring(
    values_of_form: Mapping[str, mpf], names: Sequence[str], period: str, source: str
) -> Iterator[Element]:
    """Yield these elements of a closed form, as far as it has them; ``period`` says what recurs."""
    values, words = dict(values_of_form), {"period": ("time", period), **_WORDS}
    if "period" in values_of_form:
        values["nutation_frequency"] = 2 * mp.pi / values_of_form["period"]
    if "m" in values_of_form:
        values["k"] = mp.sqrt(values_of_form["m"])
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


def _weber_rates(curve: Curve, working: int) -> list[Element]:
    """The rates of the two angles."""
    meaning = "of the {} of two angles of which x and y are functions, of period 2 pi in each"
    return [
        Element(f"{which}_rate", rate, "radians/time", meaning.format(which), _CURVE)
        for which, rate in zip(("first", "second"), rates(curve, working), strict=True)
    ]
