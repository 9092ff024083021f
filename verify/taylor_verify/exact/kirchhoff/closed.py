"""The choice of the closed form for a solid in a fluid, in exact rationals.

A free motion is reduced first: to the origin where B is symmetric, and by multiples of 1 in B and in A
where the case has them. Then it is the first of the cases below that fits. The reductions, the ways back
and the decisions are shared; the two routes of a case share no formula.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from taylor_verify.exact.carried import carried
from taylor_verify.exact.euler import jacobi as tops
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.gyrostat.sigma import top_rotation
from taylor_verify.exact.kirchhoff import jacobi, weierstrass
from taylor_verify.exact.kirchhoff.axis_of_revolution import at_rest_in_space, clebsch_about, out_of
from taylor_verify.exact.kirchhoff.displaced import centred
from taylor_verify.exact.kirchhoff.isotropic import less_coupling, multiple
from taylor_verify.exact.kirchhoff.plane import Plane, in_plane, of_revolution, planar
from taylor_verify.exact.kirchhoff.plane import regime as regime_in_plane
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.kirchhoff.regime import ELLIPTIC, nutation_of, regime
from taylor_verify.exact.kirchhoff.solid import is_steady, solid
from taylor_verify.exact.kirchhoff.top import top, with_impulses
from taylor_verify.exact.kirchhoff.turning import Turning, TurningBody
from taylor_verify.exact.kirchhoff.weber.curve import REGIME as WEBER
from taylor_verify.exact.kirchhoff.weber.curve import Curve, curve
from taylor_verify.exact.kirchhoff.weber.quotients import WeberBalls
from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

Subject = Nutation | Plane | Impulse | FreeSpin | Curve
"""The exact numbers of a case: of a body of revolution, a plane, a steady motion, a top, Weber's curve."""


@dataclass(frozen=True)
class Case:
    """A motion that has a closed form: what is left after the reductions, and its routes.

    ``floats`` is that of 49 (12) to (17), or of Euler's top. Where it is None, the second is Taylor.
    """

    regime: str
    reduced: Reduced
    subject: Subject
    balls: Callable[[], Solution]
    floats: Callable[[], Solution] | None = None


def enclosed(scene: Scene) -> Solution:
    """The motion in balls; raises NoClosedForm, with the reason, where it has none."""
    solved = case(scene)
    return solved.reduced.carried_back(solved.balls())


def closed_form(scene: Scene) -> Solution | None:
    """The motion in mpmath, None where it has none; raises NoClosedForm likewise."""
    solved = case(scene)
    return None if solved.floats is None else solved.reduced.carried_back(solved.floats())


def case(scene: Scene) -> Case:
    """The case of a motion; raises NoClosedForm, with the reason, where there is none."""
    body, _ = solid(scene)
    whole = Reduced(scene)
    if not body.is_free:
        solved = steady(whole)
        if solved is None:
            raise NoClosedForm("a force or a couple acts on the body")
        return solved
    for find in CASES:
        solved = find(whole)
        if solved is not None:
            return solved
    raise NoClosedForm(
        "the energy is not of Clebsch's form about any axis, and the motion is of no other family "
        "that is solved"
    )


def revolution(whole: Reduced) -> Case | None:
    """A body of revolution about any direction: Clebsch's, in axes of which the third is that one."""
    reduced = centred(whole)
    scene = reduced.scene
    if clebsch_about(solid(scene)[0]) is None:
        return None
    nutation, start = nutation_of(scene)
    kind, axes, track = regime(nutation), nutation.axes, scene.track
    if kind in ("rest", "steady", "euler-top"):
        turn = Turning(kind, nutation.solid, start, track, nutation.turn_rate, axes.n)
        return Case(kind, reduced, nutation, lambda: TurningBody(turn))
    if not axes.is_upright:
        reduced, start = reduced.then(scene, out_of(axes, start)), at_rest_in_space(start)
    return Case(
        kind,
        reduced,
        nutation,
        lambda: weierstrass.NutatingBody(kind, nutation, start, track),
        (lambda: jacobi.NutatingBody(kind, nutation, start, track)) if kind in ELLIPTIC else None,
    )


def flat(whole: Reduced) -> Case | None:
    """A motion in a plane of the body: that of the body of revolution that moves alike."""
    reduced_plane = planar(whole)
    if reduced_plane is None:
        return None
    reduced, place = reduced_plane
    kind, back = regime_in_plane(place), in_plane(place)
    alike = case(of_revolution(reduced.scene, place))
    balls, floats = alike.balls, alike.floats

    def made(route: Callable[[], Solution]) -> Solution:
        return carried(alike.reduced.carried_back(route()), back, kind)

    return Case(
        kind,
        reduced,
        place,
        lambda: made(balls),
        None if floats is None else lambda: made(floats),
    )


def steady(whole: Reduced) -> Case | None:
    """A motion with constant x and y, of any body and under any constant loads: a screw."""
    body, start = solid(whole.scene)
    if not is_steady(body, start):
        return None
    kind = "steady" if any(start.moving) else "rest"
    turn = Turning(kind, body, start, whole.scene.track)
    return Case(kind, whole, start, lambda: TurningBody(turn))


def turning(whole: Reduced) -> Case | None:
    """Euler's top: a body with A = p 1 and B = b 1 about some origin, or without linear impulse."""
    reduced_top = top(whole)
    if reduced_top is None:
        return None
    reduced, spin = reduced_top
    _, start = solid(reduced.scene)
    back = with_impulses(start, reduced.scene.track)
    return Case(
        spin.regime.value,
        reduced,
        spin,
        lambda: carried(top_rotation(spin, start.attitude), back),
        lambda: carried(tops.free_rotation(spin, start.attitude), back),
    )


def weber(whole: Reduced) -> Case | None:
    """The impulses of Weber's motion, less the common b.

    Raises NoClosedForm for what is degenerate in his family, and where the attitude is tracked.
    """
    reduced = centred(whole)
    body, _ = solid(reduced.scene)
    b = multiple(body.coupling)
    if b is None:
        return None
    reduced = less_coupling(reduced, b)
    genus_two = curve(reduced.scene)
    if genus_two is None:
        return None
    if whole.scene.track:
        raise NoClosedForm("attitude and centre of Weber's motion have no closed form")
    return Case(WEBER, reduced, genus_two, lambda: WeberBalls(genus_two))


# Bodies of revolution and planes have words of their own for their steady motions.
CASES: Final = (revolution, flat, steady, turning, weber)
