"""The equations of the momentum in float64, linearised along any motion, and one step of their flow.

The equations are quadratic in the momentum z = H, or z = (x, y): z' = c + J(z) z/2 with J linear in z,
so that a small error obeys dz' = J(z) dz. It turns the attitude by theta, a rotation vector in space
axes, and moves the centre c,

    theta' = R dOmega,        dc' = theta x R U + R dU,

with Omega and U linear in z.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import inf
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np

from taylor_verify.exact.conditioning.momentum import block_units
from taylor_verify.exact.quadratic_forms import Floats, Scaled, exact, in_units
from taylor_verify.exact.registry import kind_of
from taylor_verify.numbers.precision import floor_log2, power_of_two
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.scene import Scene

# Powers of two between a unit and the size of a motion.
_FAR: Final = 40


class Steps(NamedTuple):
    """The derivative of a motion between n times, and the motion there, counted in a flow's units.

    ``steps`` (n - 1, d + 6, d + 6) lead an error of (z, theta, c) from each time to the next,
    ``since_first`` (n, d + 6, d + 6) from the first time to each. ``momentum`` (n, d) is z; ``centre``
    (n, 3) counts from its start and has no rows where it is not tracked. ``attitude`` (n, 3, 3) is there
    for bodies under written loads that depend on it or whose scene tracks it.

    States of a scene's own stand behind (z, theta, c), and are ``own`` by name (n, components), in the
    scene's units; they are counted in ``own_units``. ``flow`` is there where its units are not those of the
    start.
    """

    steps: Floats
    since_first: Floats
    momentum: Floats
    centre: Floats
    attitude: Floats | None = None
    own: Mapping[str, Floats] = MappingProxyType({})
    own_units: Mapping[str, Fraction] = MappingProxyType({})
    flow: Flow | None = None


def products(steps: Floats) -> Floats:
    """The products of the first 0, 1, 2, ... of these matrices (n, m, m), the later ones to the left."""
    matrices = [np.eye(steps.shape[1])]
    for step in steps:
        matrices.append(step @ matrices[-1])
    return np.array(matrices)


@dataclass(frozen=True)
class Flow:
    """The equations in units of their size: d = 3 or 6 components of momentum.

    J is linear + hessian @ z. ``momenta`` are the units of each block of the momentum by name; time is
    measured in ``time``, lengths in ``length``: powers of two.
    """

    momenta: Mapping[str, Fraction]
    equations: Scaled
    time: Fraction
    length: Fraction

    @staticmethod
    def of(scene: Scene) -> Flow:
        """Return the equations of a scene's body, in units of its start."""
        return _flow(scene.body, block_units(scene))

    @staticmethod
    def along(scene: Scene, momenta: Floats) -> Flow:
        """Return the equations in units of a motion (n, d), where it is far from the size of its start."""
        sizes = np.abs(momenta).max(axis=0).reshape(-1, 3).max(axis=1)
        units = block_units(scene)
        pairs = zip(units, np.repeat(sizes, 3).tolist(), strict=True)
        nearer = tuple(_nearer(unit, size) for unit, size in pairs)
        # Loads change it within the span, though it may turn more slowly.
        return _flow(scene.body, nearer, 0 if nearer == units else abs(scene.clock.elapsed[-1]))

    @property
    def units(self) -> dict[str, Fraction]:
        """The unit of every quantity by name: of each block of the state, and of omega."""
        others = {"omega": 1 / self.time, "attitude": Fraction(1), "centre": self.length}
        return {**self.momenta, **others}

    @property
    def components(self) -> Vector:
        """The unit of every component of the momentum."""
        return tuple(unit for unit in self.momenta.values() for _ in range(3))

    def jacobian(self, z: Floats) -> Floats:
        """J (..., d, d) at z (..., d)."""
        d = z.shape[-1]
        quadratic: Floats = z @ self.equations.hessian.reshape(d * d, d).T
        return quadratic.reshape(*z.shape, d) + self.equations.linear

    @property
    def expansion(self) -> float:
        """The rate at which volume grows: the trace of J, to which the quadratic terms add nothing."""
        return float(np.trace(self.equations.linear))

    def rates(self, z: Floats, jacobian: Floats | None = None) -> Floats:
        """z' (..., d) at z (..., d) under constant loads: J counts half, and its linear part whole.

        ``jacobian`` is J at z, where it is known.
        """
        J = self.jacobian(z) if jacobian is None else jacobian
        return self.equations.constant + applied(J + self.equations.linear, z) / 2

    def rate(self, z: Floats) -> Floats:
        """Return the rate that a step must resolve: a step of length h covers h times this rate.

        A step errs by (h J)^5/120, and by h J (h rate)^4 of what J becomes. Where the moments of inertia
        lie far apart J is far from normal: |J| is then much larger than any power of it makes a step.
        """
        jacobian = self.jacobian(z)
        square = jacobian @ jacobian
        fifth = _norm(square @ square @ jacobian) ** 0.2
        spin = np.linalg.norm(z @ self.equations.spin.T, axis=-1)
        own = np.maximum(fifth, spin)
        rate: Floats = np.maximum(own, (_norm(jacobian) * own**4) ** 0.2)
        return rate


def _nearer(unit: Fraction, size: float) -> Fraction:
    """Return a unit, or the power of two near a size that is far from it."""
    is_far = 0 < size < inf and abs(floor_log2(Fraction(size)) - floor_log2(unit)) > _FAR
    return power_of_two(floor_log2(Fraction(size))) if is_far else unit


@lru_cache(maxsize=16)
def _flow(body: Body, units: Vector, span: Fraction | int = 0) -> Flow:
    kind = kind_of(body)
    equations = kind.momentum_equations(body)
    unit = exact(units)
    scaled = in_units(equations.hessian, 1 / unit, unit, unit)
    linear = in_units(equations.linear, 1 / unit, unit)
    every = (*scaled.flat, *linear.flat, *(equations.constant / unit))
    rates = [abs(rate) for rate in every if rate] + ([1 / span] if span else [])
    time = 1 / power_of_two(floor_log2(max(rates))) if rates else Fraction(1)
    fastest = max((abs(s) for s in (equations.velocity * unit).flat), default=Fraction(0))
    length = power_of_two(floor_log2(fastest * time)) if fastest else Fraction(1)
    return Flow(
        momenta=dict(zip(kind.momenta, units[::3], strict=True)),
        equations=equations.scaled(units, time, length),
        time=time,
        length=length,
    )


def applied(matrices: Floats, vectors: Floats) -> Floats:
    """Return the products of matrices (..., m, n) and vectors (..., n), entry by entry."""
    return (matrices @ vectors[..., None])[..., 0]


def _norm(matrices: Floats) -> Floats:
    norm: Floats = np.linalg.norm(matrices, axis=(-2, -1))
    return norm
