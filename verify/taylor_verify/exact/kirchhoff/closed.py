"""The choice of the closed form for a solid in a fluid without loads, in exact rationals.

In this order: Weber's motion of a body without symmetry; a motion in one of its planes; the motion of a
body of revolution, solved in axes about its own and about the point of it that Clebsch's form is about.
The two routes share no formula.
"""

from __future__ import annotations

from collections.abc import Callable

from taylor_verify.exact.kirchhoff import jacobi, weierstrass
from taylor_verify.exact.kirchhoff.axes import at_rest_in_space, out_of
from taylor_verify.exact.kirchhoff.carried import carried
from taylor_verify.exact.kirchhoff.displaced import centred, moved_back
from taylor_verify.exact.kirchhoff.pendulum import Pendulum
from taylor_verify.exact.kirchhoff.plane import in_plane, of_revolution, plane
from taylor_verify.exact.kirchhoff.plane import regime as regime_in_plane
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.regime import nutation_of, regime
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.kirchhoff.turned import put_back, upright
from taylor_verify.exact.kirchhoff.turning import TurningBody
from taylor_verify.exact.kirchhoff.weber.course import WeberBalls
from taylor_verify.exact.kirchhoff.weber.curve import curve
from taylor_verify.exact.kirchhoff.weber.sums import WeberSums
from taylor_verify.exact.solution import Solution
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

Maker = Callable[[str, Nutation, Impulse, frozenset[str]], Solution]
"""A solution of Clebsch's body, from its regime, its constants, its start and what is tracked."""


def enclosed(scene: Scene) -> Solution:
    """The motion in balls; raises NoClosedForm, with the reason, where it has none."""
    genus_two = curve(scene)
    if genus_two is not None:
        return WeberBalls(genus_two, solid(scene)[0], scene.track)
    place = plane(scene)
    alike = scene if place is None else of_revolution(scene, place)
    found = _of_revolution(alike, TurningBody, weierstrass.NutatingBody)
    return found if place is None else carried(found, in_plane(place), regime_in_plane(place))


def closed_form(scene: Scene) -> Solution:
    """The motion in mpmath; raises NoClosedForm likewise."""
    genus_two = curve(scene)
    if genus_two is not None:
        return WeberSums(genus_two, solid(scene)[0], scene.track)
    place = plane(scene)
    if place is not None:
        return Pendulum(regime_in_plane(place), place, scene)
    return _of_revolution(scene, jacobi.Screw, jacobi.NutatingBody)


def _of_revolution(scene: Scene, turning: Maker, nutating: Maker) -> Solution:
    """The solution of a body of revolution about any direction, from that of Clebsch's form."""
    named_anew, axis = upright(scene)
    moved, distance = centred(named_anew)
    nutation, start = nutation_of(moved)
    kind = regime(nutation)
    if kind in ("rest", "steady", "euler-top"):
        found = turning(kind, nutation, start, moved.track)
    elif nutation.axes.is_upright:
        found = nutating(kind, nutation, start, moved.track)
    else:
        found = nutating(kind, nutation, at_rest_in_space(start), moved.track)
        found = carried(found, out_of(nutation.axes, start))
    if distance:
        found = carried(found, moved_back(distance, solid(named_anew)[1]))
    return found if axis == 3 else carried(found, put_back(axis))
