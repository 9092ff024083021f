"""The equations of motion as a quadratic system in exact rationals, and the same in balls.

z' = c + q(z, z), with z = omega, or z = (x, y), and last the clock of a manufactured motion. The body's
spin Omega = W z and, for a solid in a fluid, the velocity of its origin U = Y z are linear in z.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

from flint import arb, arb_mat

from taylor_verify.exact import clocks, equations
from taylor_verify.exact.balls import ball, balls
from taylor_verify.exact.clocks import Polynomial
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin, State
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector, diagonal


@dataclass(frozen=True)
class System:
    """z' = constant + rates(z), from ``start``; all of it exact.

    ``blocks`` are the ends of the vectors that z is made of. ``spin`` is W, three rows; ``velocity`` is
    Y, or no rows for a rigid body. ``start`` is the state at time zero.
    """

    constant: Vector
    rates: tuple[Polynomial, ...]
    blocks: tuple[int, ...]
    start: Vector
    spin: Matrix
    velocity: Matrix

    @property
    def size(self) -> int:
        return len(self.start)

    @property
    def spans(self) -> list[range]:
        """The places of each block in z."""
        return [range(first, last) for first, last in pairwise((0, *self.blocks))]

    @cached_property
    def hessian(self) -> tuple[tuple[Fraction, ...], ...]:
        """Row i: the second derivatives of rate i by z_a and z_b, at place a n + b."""
        n = self.size
        rows = [[Fraction(0)] * (n * n) for _ in self.rates]
        for row, polynomial in zip(rows, self.rates, strict=True):
            for (a, b), coefficient in polynomial.items():
                row[a * n + b] += coefficient
                row[b * n + a] += coefficient
        return tuple(map(tuple, rows))


def posed(scene: Scene) -> System:
    """The equations of a scene's body, and where its motion begins."""
    body, initial = scene.body, scene.initial
    motion = body.manufactured
    clock = () if motion is None else clocks.at(motion, Fraction(0), 0)
    forms: tuple[Matrix, Matrix]
    blocks: tuple[int, ...]
    start = moving(initial)
    if isinstance(body, RigidBody):
        forms = diagonal((Fraction(1),) * 3), ()
        constant, free, blocks = equations.euler_drift(body), equations.euler_rates(body), (3,)
    else:
        forms = body.energy_matrix[3:], body.energy_matrix[:3]
        constant, free, blocks = body.force + body.couple, equations.impulse_rates(body), (3, 6)
    padding = (Fraction(0),) * len(clock)
    spin, velocity = (tuple(row + padding for row in rows) for rows in forms)
    return System(
        constant=constant + padding,
        rates=tuple(equations.driven(free, body, len(start))),
        blocks=blocks if motion is None else (*blocks, len(start) + len(clock)),
        start=start + clock,
        spin=spin,
        velocity=velocity,
    )


def moving(state: State) -> Vector:
    """The state that enters its own equations: omega, or x and y."""
    return state.omega if isinstance(state, Spin) else state.linear + state.angular


@dataclass(frozen=True)
class Balls:
    """A system's coefficients in balls at one precision. ``hessian`` is n x n^2, ``second`` n^2 x n."""

    constant: list[arb]
    hessian: arb_mat
    second: arb_mat
    spin: arb_mat
    velocity: arb_mat | None

    @classmethod
    def of(cls, system: System) -> Balls:
        """The balls at the ambient precision."""
        n = system.size
        entries = [ball(c) if c else arb(0) for row in system.hessian for c in row]
        return cls(
            constant=balls(system.constant),
            hessian=arb_mat(n, n * n, entries),
            second=arb_mat(n * n, n, entries),
            spin=_matrix(system.spin),
            velocity=_matrix(system.velocity) if system.velocity else None,
        )


@dataclass(frozen=True)
class Bounds:
    """Upper bounds of the magnitudes of a system's coefficients."""

    hessian: arb_mat
    second: arb_mat
    spin: arb_mat
    velocity: arb_mat | None

    @classmethod
    def of(cls, system: Balls) -> Bounds:
        return cls(
            hessian=magnitudes(system.hessian),
            second=magnitudes(system.second),
            spin=magnitudes(system.spin),
            velocity=None if system.velocity is None else magnitudes(system.velocity),
        )


def magnitudes(matrix: arb_mat) -> arb_mat:
    """Upper bounds of the magnitudes of the entries: exact numbers."""
    return arb_mat(matrix.nrows(), matrix.ncols(), [e.abs_upper() for e in matrix.entries()])


def column(entries: Sequence[arb]) -> arb_mat:
    return arb_mat(len(entries), 1, list(entries))


def _matrix(rows: Matrix) -> arb_mat:
    return arb_mat([balls(row) for row in rows])
