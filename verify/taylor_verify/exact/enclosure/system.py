"""The equations of motion as a quadratic system, and the same in balls.

z' = c + q(z, z), with z = omega, or z = (x, y), and last the clock of a manufactured motion. The body's
spin Omega = W z and, for a solid in a fluid, the velocity of its origin U = Y z are linear in z. All of
it is exact; numbers become balls at the precision of the course.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from flint import arb, arb_mat

from taylor_verify.exact import clocks
from taylor_verify.exact.balls import balls
from taylor_verify.exact.equations import Equations
from taylor_verify.exact.registry import kind_of
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Vector


@dataclass(frozen=True)
class System:
    """Equations and the state at time zero, ``start``, exactly.

    ``blocks`` are the ends of the vectors that z is made of.
    """

    equations: Equations
    blocks: tuple[int, ...]
    start: Vector

    @property
    def size(self) -> int:
        return len(self.start)

    @property
    def spans(self) -> list[range]:
        """The places of each block in z."""
        return [range(first, last) for first, last in pairwise((0, *self.blocks))]


def posed(scene: Scene) -> System:
    """The equations of a scene's body, and where its motion begins."""
    body, kind = scene.body, kind_of(scene.body)
    start, motion = kind.state(scene.initial), body.manufactured
    ends = tuple(range(3, len(start) + 1, 3))
    equations = kind.equations(body).driven(motion)
    if len(equations.constant) > len(start):
        start += clocks.start(motion or clocks.standing(len(start)))
        ends += (len(start),)
    return System(equations, ends, start)


@dataclass(frozen=True)
class Balls:
    """A system's coefficients in balls at one precision. ``hessian`` is n x n^2."""

    constant: arb_mat
    hessian: arb_mat
    spin: arb_mat
    velocity: arb_mat

    @classmethod
    def of(cls, system: System) -> Balls:
        """The balls at the ambient precision: of exact numbers."""
        return cls(*_matrices(system.equations))

    @cached_property
    def second(self) -> arb_mat:
        """The second derivatives as n^2 x n."""
        n = self.hessian.nrows()
        return arb_mat(n * n, n, self.hessian.entries())

    def magnitudes(self) -> Balls:
        """Upper bounds of the magnitudes."""
        matrices = (self.constant, self.hessian, self.spin, self.velocity)
        return Balls(*map(magnitudes, matrices))


def magnitudes(matrix: arb_mat) -> arb_mat:
    """Upper bounds of the magnitudes of the entries: exact numbers."""
    return arb_mat(matrix.nrows(), matrix.ncols(), [e.abs_upper() for e in matrix.entries()])


def column(entries: Sequence[arb]) -> arb_mat:
    return arb_mat(len(entries), 1, list(entries))


def _matrices(equations: Equations) -> list[arb_mat]:
    """Constant, Hessian, spin and velocity, each as the rows of a matrix; nothing is linear here."""
    arrays = equations.constant, equations.hessian, equations.spin, equations.velocity
    return [arb_mat([balls(np.ravel(row)) for row in array]) for array in arrays]
