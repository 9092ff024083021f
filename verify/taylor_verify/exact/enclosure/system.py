"""The equations of motion as a quadratic system, and the same in balls.

z' = c + q(z, z), with z = omega, or z = (x, y), and last the clock of a manufactured motion. The body's
spin Omega = W z and, for a solid in a fluid, the velocity of its origin U = Y z are linear in z. All of
it is exact, but for the coefficients of an ellipsoid, which are irrational: they enter as balls.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise

from flint import arb, arb_mat, ctx

from taylor_verify.exact import clocks
from taylor_verify.exact.balls import balls
from taylor_verify.exact.enclosure import lamb
from taylor_verify.exact.equations import Equations, driven, total
from taylor_verify.exact.registry import kind_of
from taylor_verify.scenes.bodies import Ellipsoid, ImmersedBody
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector


@dataclass(frozen=True)
class Forms:
    """Exact coefficients: ``hessian`` has row i of the second derivatives of rate i by z_a, z_b at a n + b.

    ``spin`` is W, three rows; ``velocity`` is Y, or no rows for a rigid body.
    """

    hessian: Matrix
    spin: Matrix
    velocity: Matrix

    def minus(self, other: Forms) -> Forms:
        """The difference, entry by entry."""
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return Forms(*(_difference(one, two) for one, two in pairs))


@dataclass(frozen=True)
class System:
    """z' = constant + q(z, z), from ``start``; all of it exact but for the coefficients of a ``shape``.

    ``blocks`` are the ends of the vectors that z is made of; ``start`` is the state at time zero. The
    equations are ``forms``, and those in ``shaped`` each times one coefficient of the shape.
    """

    constant: Vector
    forms: Forms
    blocks: tuple[int, ...]
    start: Vector
    shape: Ellipsoid | None = None
    shaped: tuple[Forms, ...] = ()

    @property
    def size(self) -> int:
        return len(self.start)

    @property
    def spans(self) -> list[range]:
        """The places of each block in z."""
        return [range(first, last) for first, last in pairwise((0, *self.blocks))]


def posed(scene: Scene) -> System:
    """The equations of a scene's body, and where its motion begins."""
    system, body = posed_exactly(scene), scene.body
    if not isinstance(body, ImmersedBody) or body.ellipsoid is None:
        return system
    equations = kind_of(body).equations

    def forms(other: ImmersedBody) -> Forms:
        return _forms(equations(other), body.manufactured, system.size - 6)

    without = forms(lamb.without_coefficients(body))
    shaped = [forms(unit).minus(without) for unit in lamb.units(body, body.ellipsoid)]
    return replace(system, forms=without, shape=body.ellipsoid, shaped=tuple(shaped))


def posed_exactly(scene: Scene) -> System:
    """The same, with the rational coefficients of the scene for an ellipsoid as well."""
    body, kind = scene.body, kind_of(scene.body)
    start, motion = kind.state(scene.initial), body.manufactured
    free = kind.equations(body)
    # Linear terms are products with a variable that stays 1.
    one = (Fraction(1),) if free.linear else ()
    clock = one if motion is None else clocks.at(motion, Fraction(0), 0)
    ends = tuple(range(3, len(start) + 1, 3))
    return System(
        constant=free.constant + (Fraction(0),) * len(clock),
        forms=_forms(free, motion, len(clock)),
        blocks=ends if not clock else (*ends, len(start) + len(clock)),
        start=start + clock,
    )


def _forms(free: Equations, motion: Manufactured | None, clock: int) -> Forms:
    """The coefficients of these equations, beside a clock, with the loads of a manufactured motion."""
    size = len(free.rates)
    n, padding = size + clock, (Fraction(0),) * clock
    hessian = [[Fraction(0)] * (n * n) for _ in range(n)]
    rates = driven(free.rates, motion, size)
    if free.linear:
        lines = [{(k, size): c for k, c in enumerate(row) if c} for row in free.linear]
        rates = [*(total(p, q) for p, q in zip(rates, lines, strict=True)), {}]
    for row, polynomial in zip(hessian, rates, strict=True):
        for (a, b), coefficient in polynomial.items():
            row[a * n + b] += coefficient
            row[b * n + a] += coefficient
    spin, velocity = (tuple(row + padding for row in rows) for rows in (free.spin, free.velocity))
    return Forms(tuple(map(tuple, hessian)), spin, velocity)


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
        hessian, spin, velocity = _matrices(system)
        return cls(
            constant=balls(system.constant),
            hessian=hessian,
            second=arb_mat(n * n, n, hessian.entries()),
            spin=spin,
            velocity=velocity if system.forms.velocity else None,
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


def _matrices(system: System) -> list[arb_mat]:
    """Hessian, spin and velocity: exact ones in the smallest balls, and a shape's by its coefficients."""
    matrices = [_matrix(rows) for rows in vars(system.forms).values()]
    if system.shape is None:
        return matrices
    # Differences of nearly equal coefficients are to be as sharp as these.
    with ctx.workprec(ctx.prec + lamb.cancelled_bits(system.shape)):
        for factor, forms in zip(lamb.factors(system.shape), system.shaped, strict=True):
            parts = map(_matrix, vars(forms).values())
            matrices = [whole + part * factor for whole, part in zip(matrices, parts, strict=True)]
    return [_rounded(matrix) for matrix in matrices]


def _matrix(rows: Matrix) -> arb_mat:
    return arb_mat([balls(row) for row in rows])


def _rounded(matrix: arb_mat) -> arb_mat:
    """The matrix at the ambient precision."""
    return arb_mat(matrix.nrows(), matrix.ncols(), [entry + 0 for entry in matrix.entries()])


def _difference(one: Matrix, two: Matrix) -> Matrix:
    return tuple(
        tuple(a - b for a, b in zip(left, right, strict=True))
        for left, right in zip(one, two, strict=True)
    )
