"""The tangent flow in float64: many arcs of one body at once, and what each makes of a small error.

The equations are quadratic in the momentum z = H, or z = (x, y): z' = c + J(z) z/2 with J linear in z,
so that a small error obeys dz' = J(z) dz. It turns the attitude by theta, a rotation vector in space
axes, and moves the centre c,

    theta' = R dOmega,        dc' = theta x R U + R dU,

with Omega and U linear in z. Of a manufactured motion z* = S w, with w the clock of exact.clocks and
w' = N w, the loads are S w' - J(z*) z*/2; they do not depend on z, and so are no part of J.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.exact import clocks
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.precision import floor_log2, power_of_two
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector

Floats = np.ndarray[Any, np.dtype[np.float64]]

# The classical Runge-Kutta step errs by (h rate)^5/120 of the state, 3e-6.
_STEP: Final = 0.2
_MOST_STEPS: Final = 100_000


@dataclass(frozen=True)
class Flow:
    """The equations in units of their size: d = 3 or 6 components of momentum.

    ``twice`` (d, d, d) gives J = twice @ z; ``omega`` and ``velocity`` (3, d) give Omega and, for a
    solid in a fluid, U. Time is measured in ``time``, lengths in ``length``. ``swing`` is S and N.
    """

    constant: Floats
    swing: clocks.Swing
    twice: Floats
    omega: Floats
    velocity: Floats | None
    time: Fraction
    length: Fraction

    @classmethod
    def of(cls, scene: Scene, units: Vector) -> Flow:
        constant, products, omega, velocity = _equations(scene)
        d = len(units)
        scaled = {
            (i, j, k): c * units[j] * units[k] / units[i] for (i, j, k), c in products.items()
        }
        rates = [abs(c) for c in scaled.values() if c]
        rates += [abs(c / unit) for c, unit in zip(constant, units, strict=True) if c]
        time = 1 / power_of_two(floor_log2(max(rates))) if rates else Fraction(1)
        twice = np.zeros((d, d, d))
        for (i, j, k), c in scaled.items():
            # Both orders of a product, so that J is the Jacobian; a square counts twice so.
            twice[i, j, k] += float(c * time)
            twice[i, k, j] += float(c * time)
        speeds = [c * u for row in velocity for c, u in zip(row, units, strict=True) if c]
        fastest = max((abs(s) for s in speeds), default=Fraction(0))
        length = power_of_two(floor_log2(fastest * time)) if fastest else Fraction(1)
        return cls(
            constant=np.array([float(c * time / u) for c, u in zip(constant, units, strict=True)]),
            swing=clocks.swing(scene.body, units, time),
            twice=twice,
            omega=_floats(omega, units, time),
            velocity=_floats(velocity, units, time / length) if velocity else None,
            time=time,
            length=length,
        )

    def jacobian(self, z: Floats) -> Floats:
        """J (..., d, d) at z (..., d)."""
        d = z.shape[-1]
        found: Floats = z @ self.twice.reshape(d * d, d).T
        return found.reshape(*z.shape, d)

    def load(self, clock: Floats) -> Floats:
        """What is constant, and what the manufactured motion takes."""
        there, rate = self.swing.at(clock)
        found: Floats = self.constant + rate - applied(self.jacobian(there), there) / 2
        return found

    def rate(self, z: Floats) -> Floats:
        """What a step has to resolve: it errs by (h J)^5/120, and by h J (h rate)^4 of what J becomes.

        Where the moments of inertia lie far apart J is far from normal: |J| is then much larger than
        what any power of it makes of a step.
        """
        jacobian = self.jacobian(z)
        square = jacobian @ jacobian
        fifth = _norm(square @ square @ jacobian) ** 0.2
        spin = np.linalg.norm(z @ self.omega.T, axis=-1)
        own = np.maximum(np.maximum(fifth, spin), self.swing.fastest)
        found: Floats = np.maximum(own, (_norm(jacobian) * own**4) ** 0.2)
        return found


@dataclass(frozen=True)
class Arcs:
    """Where n arcs are: w (n, m), z (n, d), R (n, 3, 3), and what errors of z at their starts became.

    ``by_momentum`` (n, d, d) are the derivatives of z, ``turn`` and ``shift`` (n, 3, d) those of theta
    and c.
    """

    clock: Floats
    momentum: Floats
    attitude: Floats
    by_momentum: Floats
    turn: Floats
    shift: Floats

    @classmethod
    def begun(cls, clock: Floats, momentum: Floats, attitude: Floats) -> Arcs:
        n, d = momentum.shape
        nothing = np.zeros((n, 3, d))
        return cls(clock, momentum, attitude, np.tile(np.eye(d), (n, 1, 1)), nothing, nothing)

    def only(self, places: Any) -> Arcs:
        """The arcs at these places, an array of indices: always a copy."""
        return Arcs(*(part[places] for part in self._parts()))

    def moved(self, rates: Arcs, h: Floats) -> Arcs:
        """Each arc by its own h times its rates."""
        pairs = zip(self._parts(), rates._parts(), strict=True)
        return Arcs(*(part + h.reshape(-1, *[1] * (part.ndim - 1)) * rate for part, rate in pairs))

    def put(self, places: Any, others: Arcs) -> None:
        for part, other in zip(self._parts(), others._parts(), strict=True):
            part[places] = other

    def _parts(self) -> tuple[Floats, ...]:
        return tuple(vars(self).values())


def followed(flow: Flow, arcs: Arcs, spans: Floats) -> Arcs | None:
    """Each arc after its own time (n), or None if one is lost.

    By the classical Runge-Kutta method, each in steps that resolve its own Jacobian.
    """
    left, active = spans.copy(), np.arange(len(spans))
    # A copy, which what follows is written into.
    reached = arcs.only(active)
    for _ in range(_MOST_STEPS):
        here = reached.only(active)
        rate = flow.rate(here.momentum)
        if not np.isfinite(rate).all():
            return None
        whole = abs(left[active]) * rate <= _STEP
        h = np.where(whole, left[active], np.copysign(_STEP / rate, left[active]))
        reached.put(active, _step(flow, here, h))
        left[active] -= h
        active = active[~whole]
        if not active.size:
            return reached
    return None


def _step(flow: Flow, at: Arcs, h: Floats) -> Arcs:
    first = _rates(flow, at)
    second = _rates(flow, at.moved(first, h / 2))
    third = _rates(flow, at.moved(second, h / 2))
    fourth = _rates(flow, at.moved(third, h))
    slopes = zip(*(rates._parts() for rates in (first, second, third, fourth)), strict=True)
    return at.moved(Arcs(*((a + 2 * b + 2 * c + d) / 6 for a, b, c, d in slopes)), h)


def _rates(flow: Flow, at: Arcs) -> Arcs:
    jacobian, R = flow.jacobian(at.momentum), at.attitude
    turn = R @ (flow.omega @ at.by_momentum)
    if flow.velocity is None:
        shift = np.zeros_like(turn)
    else:
        speed = applied(R, at.momentum @ flow.velocity.T)
        shift = R @ (flow.velocity @ at.by_momentum) - cross_matrix(speed) @ at.turn
    return Arcs(
        clock=at.clock @ flow.swing.turning.T,
        momentum=flow.load(at.clock) + applied(jacobian, at.momentum) / 2,
        attitude=R @ cross_matrix(at.momentum @ flow.omega.T),
        by_momentum=jacobian @ at.by_momentum,
        turn=turn,
        shift=shift,
    )


def applied(matrices: Floats, vectors: Floats) -> Floats:
    """Each matrix (..., m, n) times its own vector (..., n)."""
    return (matrices @ vectors[..., None])[..., 0]


def cross_matrix(v: Floats) -> Floats:
    """[v]x (..., 3, 3) of v (..., 3)."""
    found = np.zeros((*v.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[..., j, i], found[..., i, j] = v[..., k], -v[..., k]
    return found


def _norm(matrices: Floats) -> Floats:
    found: Floats = np.linalg.norm(matrices, axis=(-2, -1))
    return found


# The equations, in exact rationals.


def _equations(scene: Scene) -> tuple[Vector, dict[tuple[int, int, int], Fraction], Matrix, Matrix]:
    """z' = constant + the sum of products (i, j, k): c z_j z_k; and Omega, U as rows over z."""
    body = scene.body
    if isinstance(body, RigidBody):
        K = body.inverse_inertia
        return body.moment, _collected(_cross(0, 0, K)), K, ()
    assert isinstance(body, ImmersedBody)
    velocity, omega = body.energy_matrix[:3], body.energy_matrix[3:]
    terms = [*_cross(0, 0, omega), *_cross(3, 3, omega), *_cross(3, 0, velocity)]
    return body.force + body.couple, _collected(terms), omega, velocity


Term = tuple[tuple[int, int, int], Fraction]


def _cross(out: int, left: int, right: Matrix) -> Iterator[Term]:
    """The terms of z_left x (right z), in the rows ``out``, ``out`` + 1, ``out`` + 2."""
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        for column in range(len(right[0])):
            yield (out + i, left + j, column), right[k][column]
            yield (out + i, left + k, column), -right[j][column]


def _collected(terms: Iterable[Term]) -> dict[tuple[int, int, int], Fraction]:
    """One coefficient for z_j z_k and z_k z_j: what cancels is gone before anything is rounded."""
    found: dict[tuple[int, int, int], Fraction] = {}
    for (i, j, k), c in terms:
        key = (i, min(j, k), max(j, k))
        found[key] = found.get(key, Fraction(0)) + c
    return {key: c for key, c in found.items() if c}


def _floats(matrix: Matrix, units: Vector, factor: Fraction) -> Floats:
    scaled = np.array([[c * u * factor for c, u in zip(row, units, strict=True)] for row in matrix])
    return scaled.astype(float)
