"""A body without symmetry that moves in one of its planes: its closed form, by two routes.

They share no formula: in balls it is the motion of a body of revolution that moves alike, by sigma
functions (weierstrass.py); in mpmath a pendulum, by Jacobi's (pendulum.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import final

from mpmath import mpf

from taylor_verify.exact.kirchhoff import turned
from taylor_verify.exact.kirchhoff.pendulum import Pendulum
from taylor_verify.exact.kirchhoff.plane import Plane, plane, regime
from taylor_verify.exact.solution import Quantities, Solution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene


def enclosed(scene: Scene) -> Solution:
    """A closed form in balls of a scene without loads: of Clebsch's body, or of a motion in a plane.

    In its plane a body moves as that body of revolution does whose T has the same p_i, p_j and r,
    with axis a. Raises NoClosedForm, with the reason, for every other scene.
    """
    found = plane(scene)
    if found is None:
        return turned.enclosed(scene)
    return LikeRevolution(found, turned.enclosed(of_revolution(scene, found)))


def closed_form(scene: Scene) -> Solution:
    """The same in mpmath, in a plane by the pendulum's formulas."""
    found = plane(scene)
    if found is None:
        return turned.closed_form(scene)
    return Pendulum(regime(found), found, scene)


def of_revolution(scene: Scene, found: Plane) -> Scene:
    """The scene with the body of revolution about the axis a that moves alike."""
    along, across = found.p
    p = tuple(along if n == found.a else across for n in range(3))
    body = ImmersedBody(
        linear=tensors.diagonal(p),
        coupling=tensors.ZERO_MATRIX,
        angular=tensors.diagonal((found.r,) * 3),
    )
    return replace(scene, body=body)


@final
class LikeRevolution(Solution):
    """The solution of another body that moves alike, under this motion's own word."""

    def __init__(self, found: Plane, inner: Solution) -> None:
        self.regime, self.route = regime(found), inner.route
        self._plane, self._inner = found, inner

    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        found = self._inner.motion(elapsed, digits)
        return replace(found, quantities=self._in_plane(found.quantities))

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        return self._in_plane(self._inner.evaluate(elapsed, digits))

    def _in_plane(self, quantities: Quantities) -> Quantities:
        """With the zeros that the plane makes, exactly: that leaves every radius a bound."""
        place = self._plane
        x, y = quantities["linear_impulse"].copy(), quantities["angular_impulse"].copy()
        x[:, place.k] = mpf(0)
        y[:, [place.a, place.b]] = mpf(0)
        return {**quantities, "linear_impulse": x, "angular_impulse": y}
