"""A body without symmetry that moves in one of its planes as a body of revolution does.

That is the route in balls, by sigma functions (weierstrass.py). The route in mpmath shares no formula with
it: there the motion is a pendulum's, by Jacobi's functions (pendulum.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import final

from mpmath import mpf

from taylor_verify.exact.kirchhoff.plane import Plane, regime
from taylor_verify.exact.solution import Quantities, Solution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene


def of_revolution(scene: Scene, found: Plane) -> Scene:
    """The scene with the body of revolution about the axis a that moves alike in the plane.

    Its T has the same p_i, p_j and r.
    """
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
