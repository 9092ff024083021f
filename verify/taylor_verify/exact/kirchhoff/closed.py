"""Which closed form answers a solid in a fluid without loads: chosen in exact rationals.

In this order: Weber's motion of a body without symmetry; a motion in one of its planes; the motion of a
body of revolution, solved about axis 3 and the point of it that Clebsch's form is about. Each function
imports what it needs: the two routes load different libraries and share no formula.
"""

from __future__ import annotations

from collections.abc import Callable

from taylor_verify.exact.kirchhoff.carried import carried
from taylor_verify.exact.kirchhoff.displaced import centred, moved_back
from taylor_verify.exact.kirchhoff.plane import in_plane, of_revolution, plane, regime
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.kirchhoff.turned import put_back, upright
from taylor_verify.exact.kirchhoff.weber.curve import curve
from taylor_verify.exact.solution import Solution
from taylor_verify.scenes.scene import Scene


def enclosed(scene: Scene) -> Solution:
    """The motion in balls; raises NoClosedForm, with the reason, where it has none."""
    from taylor_verify.exact.kirchhoff import weierstrass
    from taylor_verify.exact.kirchhoff.weber.enclosure import WeberBalls

    genus_two = curve(scene)
    if genus_two is not None:
        return WeberBalls(genus_two)
    place = plane(scene)
    if place is None:
        return _of_revolution(scene, weierstrass.enclosed)
    alike = _of_revolution(of_revolution(scene, place), weierstrass.enclosed)
    return carried(alike, in_plane(place), regime(place))


def closed_form(scene: Scene) -> Solution:
    """The motion in mpmath; raises NoClosedForm likewise."""
    from taylor_verify.exact.kirchhoff import jacobi
    from taylor_verify.exact.kirchhoff.pendulum import Pendulum
    from taylor_verify.exact.kirchhoff.weber.sums import WeberSums

    genus_two = curve(scene)
    if genus_two is not None:
        return WeberSums(genus_two)
    place = plane(scene)
    if place is not None:
        return Pendulum(regime(place), place, scene)
    return _of_revolution(scene, jacobi.closed_form)


def _of_revolution(scene: Scene, solve: Callable[[Scene], Solution]) -> Solution:
    """The solution of a body of revolution about any body axis, from that of Clebsch's form."""
    named_anew, axis = upright(scene)
    moved, distance = centred(named_anew)
    found = solve(moved)
    if distance:
        found = carried(found, moved_back(distance, solid(named_anew)[1]))
    return found if axis == 3 else carried(found, put_back(axis))
