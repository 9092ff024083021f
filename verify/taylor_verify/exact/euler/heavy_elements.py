"""The elements of a heavy top (its nutation, the stability of its spin upright), and of pitch on an orbit.

Legend, Hydromechanics 49 (23)-(25), beside the spin with x along the axis, y3 = G and z = x3: with the
term s x3 of a weight f = r^2 (z - F)^2 (A + 2 B (z - F)) where A = 4 s F/r - y3^2 and B = s/r. The body
is upright where s x3 is largest.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

from mpmath import mp

from taylor_verify.exact.element import Element, Elements, settled
from taylor_verify.exact.euler.heavy import Top, TopRegime, top_of
from taylor_verify.exact.euler.libration import Pitch, pitch_of
from taylor_verify.exact.kirchhoff.any_solid import own_elements, recurring
from taylor_verify.exact.kirchhoff.closed import case
from taylor_verify.exact.kirchhoff.jacobi import NutatingBody
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.scenes.scene import Scene

_WRITTEN: Final = "Loads that the scene writes down act: no closed form is built."
_TOP: Final = (
    "The weight hangs on an axis of revolution, or turns the body about a principal axis: with x = R^T e "
    "and y = H these are Kirchhoff's equations, T with a term s x3."
)
_PITCH: Final = (
    "The moment turns at a constant rate n about a principal axis, and so does the body: in the frame that "
    "turns with it, twice the angle is that of a pendulum, as of a solid in a plane of a fluid."
)
_WAVE: Final = ("period", "nutation_frequency", "rate", "k", "m", "m_prime")
_STORY: Final[Mapping[TopRegime, str]] = {
    TopRegime.NUTATING: "The height of the axis swings between two roots of a cubic.",
    TopRegime.STEADY: "The height of the axis is constant: the top precesses at a constant rate.",
    TopRegime.SLEEPING: "The axis is vertical, and this spin is stable: a tilt stays small.",
    TopRegime.UNSTABLE: "The axis is vertical, and this spin is unstable: a tilt grows exponentially.",
    TopRegime.FALLING: "The axis leaves the vertical, turns once and approaches it again for ever.",
}


def elements(scene: Scene, digits: int) -> Elements:
    """Return the elements of a scene with written loads: none unless its body is a top."""
    pitch = pitch_of(scene)
    if pitch is not None:
        return _of_pitch(pitch, digits)
    try:
        top = top_of(scene)
    except NoClosedForm:
        return Elements(NO_CLOSED_FORM, (), (_WRITTEN,))
    numbers = settled(lambda working: list(_numbers(top, working)), digits)
    return Elements(top.regime.value, numbers, (_STORY[top.regime], _TOP))


def _of_pitch(pitch: Pitch, digits: int) -> Elements:
    solved = case(pitch.scene)
    numbers = settled(lambda working: own_elements(solved, working), digits)
    return Elements(solved.regime, numbers, (_PITCH,))


def _numbers(top: Top, working: int) -> Iterator[Element]:
    nutation = top.nutation
    if top.kind == "cubic":
        values = NutatingBody(top.kind, nutation, top.start).elements(working)
        period = "period of nutation: the height of the axis recurs"
        yield from recurring(values, _WAVE, period, "Hydromechanics 49 (8)")
    # In axes about n vectors are sqrt(n.n) times as long.
    nu, F = mp.convert(nutation.axes.nu), mp.sqrt(mp.convert(nutation.F2))
    pull = 4 * abs(mp.convert(nutation.weight)) * F / mp.convert(nutation.body.r) / nu
    A = pull - mp.convert(nutation.y3) ** 2 / nu
    meaning = (
        "stability number of the upright spin with this momentum along the axis: stable below 0"
    )
    yield Element("A", A, "angular momentum^2", meaning, "4 I1 m g l - y3^2, as 49 (25)", pull)
