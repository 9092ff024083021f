"""Lagrange's top and the pendulum: bodies whose weight hangs on an axis of revolution.

Legend: e along the forces in space, g = R^T e; w is the sum of their points, each times its force along e.

A weight is a linear term in the energy: H' = H x omega + w x g and g' = g x omega are Kirchhoff's equations
with x = g, y = H and T = y.K y/2 - w.x. With w along an axis of revolution this is Clebsch's body with
p = p', q = q' = 0 and a term s x3, which enters the quartic alone (`Nutation.weight`): Omega = dT/dy
has no s, so the attitude takes the same integrals. A wheel on the axis adds a constant to omega3, and y3
is constant too: so r' = omega3/y3 has both.

A body that turns about a principal axis across w and g moves as a sphere of that moment does: a pendulum.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.exact.carried import Back, carried
from taylor_verify.exact.kirchhoff.axis_of_revolution import (
    Axes,
    at_rest_in_space,
    clebsch_about,
    out_of,
)
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.regime import regime
from taylor_verify.exact.solution import NoClosedForm, Number, Solution, Time
from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import ZERO_MATRIX, ZERO_VECTOR, Matrix, Vector
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.scene import Scene


class TopRegime(StrEnum):
    """The kind of motion of a body whose weight hangs on its axis."""

    NUTATING = "nutating-top"
    STEADY = "steady-top"
    SLEEPING = "sleeping-top"
    UNSTABLE = "unstable-top"
    FALLING = "falling-top"


# The quartic of a top is a cubic.
_ELLIPTIC: Final = "cubic"
# By the word of the cubic: x3 swings, or leaves the unstable spin and comes back to it.
_WORDS: Final = {
    _ELLIPTIC: TopRegime.NUTATING,
    "trigonometric": TopRegime.NUTATING,
    "hyperbolic": TopRegime.FALLING,
    "algebraic": TopRegime.FALLING,
}


@dataclass(frozen=True)
class Top:
    """A top as a motion of Clebsch's body, and that motion's start and word."""

    nutation: Nutation
    start: Impulse
    kind: str

    @property
    def regime(self) -> TopRegime:
        """The word for the motion; 49 (23) to (26) decide whether a spin on the vertical is stable."""
        if self.kind != "steady":
            return _WORDS[self.kind]
        if not self.nutation.is_axial:
            return TopRegime.STEADY
        return TopRegime.UNSTABLE if self.stiffness > 0 else TopRegime.SLEEPING

    @property
    def stiffness(self) -> Fraction:
        """A of 49 (25), 4 s x3/r - y3^2: the spin on the vertical is unstable where it is positive."""
        nutation = self.nutation
        return 4 * nutation.weight * nutation.z / nutation.body.r - nutation.y3**2


def enclosed(scene: Scene) -> Solution:
    """The motion in balls; raises NoClosedForm, with the reason, where it has none."""
    from taylor_verify.exact.kirchhoff.turning import Turning, TurningBody
    from taylor_verify.exact.kirchhoff.weierstrass import NutatingBody

    top = top_of(scene)
    if top.kind == "steady":
        nutation = top.nutation
        turn = Turning(
            top.kind, nutation.solid, top.start, scene.track, nutation.turn_rate, nutation.axes.n
        )
        return carried(TurningBody(turn), _spinning(scene, top), top.regime.value)
    start, back = _in_axes(scene, top)
    return carried(NutatingBody(top.kind, top.nutation, start, scene.track), back, top.regime.value)


def closed_form(scene: Scene) -> Solution | None:
    """The motion in mpmath, None where only balls are made; raises NoClosedForm likewise."""
    from taylor_verify.exact.kirchhoff.jacobi import NutatingBody

    top = top_of(scene)
    if top.kind != _ELLIPTIC:
        return None
    start, back = _in_axes(scene, top)
    return carried(NutatingBody(top.kind, top.nutation, start, scene.track), back, top.regime.value)


def top_of(scene: Scene) -> Top:
    """Return a scene's top; raises NoClosedForm, with the reason, where its body is none."""
    body, start = scene.body, scene.initial
    if body.loads is None or not isinstance(start, Spin) or body.damping:
        raise NoClosedForm("loads that a scene writes down")
    e, w = _weight(body.loads)
    rotor = getattr(body, "rotor", ZERO_VECTOR)
    to_body = tensors.transpose(rotation_matrix(start.attitude))
    x = tensors.apply(to_body, e)
    y = tensors.plus(tensors.apply(body.energy_matrix, start.omega), rotor)
    six, axes = _of_revolution(body.energy_matrix, start.omega, w, x)
    if any(tensors.cross(rotor, axes.n)):
        raise NoClosedForm("wheels beside the axis of a heavy body")
    along = tensors.dot(axes.n, y)
    if any(rotor):
        if not along:
            raise NoClosedForm("wheels that cancel the momentum along the axis of a heavy body")
        six = replace(six, r_prime=tensors.dot(axes.n, start.omega) / along)
    impulse = Impulse(x, y, attitude=start.attitude)
    nutation = Nutation.of(six, impulse, axes, -tensors.dot(w, axes.n))
    kind = regime(nutation)
    if kind not in (_ELLIPTIC, "steady") and _is_flat(nutation):
        raise NoClosedForm("a pendulum that approaches its upright rest")
    return Top(nutation, impulse, kind)


def _is_flat(nutation: Nutation) -> bool:
    return nutation.touches_pole(1) and nutation.touches_pole(-1)


def _weight(loads: Loads) -> tuple[Vector, Vector]:
    """Return e and w; raises NoClosedForm where anything else acts, or forces of several directions."""
    if loads.rung is not None:
        raise NoClosedForm("a weight whose numbers were rounded one by one")
    others = [entry for _, entries in loads.vectors for entry in entries]
    if any(others) or any(loads.rotor) or loads.states:
        raise NoClosedForm("loads that a scene writes down")
    forces = [hung.force for hung in loads.hung if any(hung.force)]
    if not forces or any(any(tensors.cross(force, forces[0])) for force in forces):
        raise NoClosedForm("weights along several directions")
    e, w = forces[0], ZERO_VECTOR
    for hung in loads.hung:
        share = tensors.dot(hung.force, e) / tensors.dot(e, e)
        w = tensors.plus(w, tensors.scaled(share, hung.at))
    if not any(w):
        raise NoClosedForm("a weight at the fixed point")
    return e, w


def _of_revolution(inertia: Matrix, omega: Vector, w: Vector, x: Vector) -> tuple[Clebsch, Axes]:
    """Return the six coefficients of a top or a pendulum, and axes about w; else raises NoClosedForm."""
    K = tensors.inverse(inertia)
    symmetric = clebsch_about(
        ImmersedBody(linear=tensors.identity(3), coupling=ZERO_MATRIX, angular=K)
    )
    if symmetric is not None:
        six, axes = symmetric
        if six.r == six.r_prime:
            return six, Axes.about(w)
        if not any(tensors.cross(axes.n, w)):
            return six, axes
    n = omega if any(omega) else tensors.cross(w, x)
    turned = tensors.apply(K, n)
    if any(tensors.cross(turned, n)) or tensors.dot(n, w) or tensors.dot(n, x):
        raise NoClosedForm("a heavy body that is no body of revolution about its weight")
    r = tensors.dot(turned, n) / tensors.dot(n, n)
    one, zero = Fraction(1), Fraction(0)
    return Clebsch(one, one, zero, zero, r, r), Axes.about(w)


def _in_axes(scene: Scene, top: Top) -> tuple[Impulse, Back]:
    """Return the start in the axes of the nutation, and the way back to the scene."""
    axes, spinning = top.nutation.axes, _spinning(scene, top)
    if axes.is_upright:
        return top.start, spinning
    upright = out_of(axes, top.start)

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        upright(rows, elapsed, number)
        spinning(rows, elapsed, number)

    return at_rest_in_space(top.start), back


def _spinning(scene: Scene, top: Top) -> Back:
    """Return the way from H and g to omega; it is exact at the start."""
    K, start = top.nutation.solid.angular, scene.initial
    assert isinstance(start, Spin)
    omega = start.omega

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        exactly = np.vectorize(number, otypes=[object])
        momenta, frames = rows["angular_impulse"], rows.get("attitude")
        rows.clear()
        rows["omega"] = momenta @ exactly(np.array(K, dtype=object))
        rows["omega"][[t == 0 for t in elapsed]] = exactly(np.array(omega, dtype=object))
        if frames is not None:
            rows["attitude"] = frames

    return back
