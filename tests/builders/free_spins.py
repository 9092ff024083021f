"""Free rigid bodies in exact numbers, in axes that are principal or turned."""

from __future__ import annotations

from fractions import Fraction

from builders.scenes import vector
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector


def rotation(*quaternion: int) -> Matrix:
    """The exact rational rotation of an integer quaternion, scalar first."""
    w, x, y, z = (Fraction(entry) for entry in quaternion)
    n = w * w + x * x + y * y + z * z
    rows = (
        (w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z),
    )
    return tuple(tuple(entry / n for entry in row) for row in rows)


def turned(matrix: Matrix, spin: FreeSpin) -> FreeSpin:
    """The same motion in axes turned (or permuted) by an orthogonal matrix Q: (Q I Q^T, Q w)."""
    inertia = tensors.product(tensors.product(matrix, spin.inertia), tensors.transpose(matrix))
    return FreeSpin(inertia, tensors.apply(matrix, spin.omega))


def spinning(moments: Vector, omega: Vector) -> FreeSpin:
    return FreeSpin(tensors.diagonal(moments), omega)


OBLIQUE = rotation(3, 1, -2, 1)
# J_a (J_a - J_b) w_a^2 = J_c (J_b - J_c) w_c^2 with J = 4, 5/2, 1 asks for w_c = 2 w_a.
ON_SEPARATRIX = spinning(vector(4, "5/2", 1), vector("1/3", "-3/5", "2/3"))


def near_separatrix(tiny: Fraction) -> FreeSpin:
    """ON_SEPARATRIX with one component changed, so that m' is a number like ``tiny``."""
    a, b, c = ON_SEPARATRIX.omega
    return FreeSpin(ON_SEPARATRIX.inertia, (a * (1 + tiny), b, c))
