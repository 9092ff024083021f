"""Free rigid bodies in exact numbers, in axes that are principal or turned."""

from __future__ import annotations

from fractions import Fraction

from builders.scenes import vector
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Matrix, Vector


def rotation(*quaternion: int) -> Matrix:
    """The exact rational rotation of an integer quaternion, scalar first."""
    return rotation_matrix(tuple(map(Fraction, quaternion)))


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


# Every regime, about every axis and in either sense, and the borders between them.
SPINS = {
    "max-axis": spinning(vector(1, 2, 3), vector("0.3", "0.2", 1)),
    "max-axis, backward": spinning(vector(3, 2, 1), vector("-1.3", "0.2", "-0.4")),
    "max-axis, w_c < 0 at the start": spinning(vector(2, 1, 3), vector("0.2", "-0.5", -1)),
    "max-axis, oblique": turned(OBLIQUE, spinning(vector(2, 3, 5), vector("0.2", "-0.3", "-0.9"))),
    "min-axis": spinning(vector(1, 3, 2), vector("0.9", "0.1", "-0.5")),
    "min-axis, backward": spinning(vector(3, 1, 2), vector("0.3", "-1", "0.4")),
    "min-axis, oblique": turned(OBLIQUE, spinning(vector(5, 3, 2), vector("0.2", "-0.3", "-0.9"))),
    "max-axis, w_b = 0": spinning(vector(3, 2, 1), vector(-1, 0, "-0.5")),
    "max-axis, w_c = 0": spinning(vector(3, 2, 1), vector(1, "-0.7", 0)),
    "min-axis, w_c = 0": spinning(vector(3, 2, 1), vector(0, "0.7", -1)),
    "min-axis, w_c = 0, oblique": turned(OBLIQUE, spinning(vector(3, 2, 1), vector(0, "-0.7", -1))),
    "separatrix": ON_SEPARATRIX,
    "separatrix, backward": FreeSpin(
        ON_SEPARATRIX.inertia, tensors.scaled(Fraction(-1), ON_SEPARATRIX.omega)
    ),
    "separatrix, oblique": turned(OBLIQUE, ON_SEPARATRIX),
    "axisymmetric, oblate": spinning(vector(2, 5, 2), vector(1, "-0.4", "0.2")),
    "axisymmetric, oblique": turned(OBLIQUE, spinning(vector(1, 4, 4), vector(1, "0.3", "0.2"))),
    "spherical": spinning(vector(2, 2, 2), vector(1, 2, -3)),
    "steady": spinning(vector(1, 2, 3), vector(0, "-0.8", 0)),
    "rest": spinning(vector(1, 2, 3), vector(0, 0, 0)),
    "max-axis, full tensor": FreeSpin(
        (vector(3, "0.1", "0.2"), vector("0.1", 2, "-1/3"), vector("0.2", "-1/3", 4)),
        vector("0.3", "0.1", "-0.7"),
    ),
    # J = 2, 2, 9 about an axis along (1, 2, 3), whose length is irrational.
    "axisymmetric, irrational axis": FreeSpin(
        (vector("5/2", 1, "3/2"), vector(1, 4, 3), vector("3/2", 3, "13/2")),
        vector("0.1", "0.7", "-0.4"),
    ),
}

TINY = Fraction(1, 10**30)
# Beside the separatrix, the axes and symmetric bodies, and thin rods.
EXTREMES = {
    "m' ~ 1e-60": near_separatrix(Fraction(-1, 10**60)),
    "m' ~ 1e-60, oblique": turned(OBLIQUE, near_separatrix(Fraction(1, 10**60))),
    "on the separatrix, beside its saddle": spinning(
        vector(4, "5/2", 1), vector(TINY, "-3/5", 2 * TINY)
    ),
    "beside the unstable axis": spinning(vector(3, 2, 1), vector(TINY, 1, 2 * TINY)),
    "beside the unstable axis, w_c = 0, oblique": turned(
        OBLIQUE, spinning(vector(1, 2, 3), vector(0, 1, -TINY))
    ),
    "beside the stable axis": spinning(vector(3, 2, 1), vector(-1, 0, -TINY)),
    "beside the stable axis, oblique": turned(
        OBLIQUE, spinning(vector(1, 2, 3), vector(1, TINY, -TINY))
    ),
    "upper gap 1e-30": spinning(vector(2, 2 + TINY, 1), vector("0.6", -1, "0.3")),
    "upper gap 1e-30, oblique": turned(
        OBLIQUE, spinning(vector(2, 2 + TINY, 1), vector("0.6", -1, "0.3"))
    ),
    "lower gap 1e-30, oblique": turned(
        OBLIQUE, spinning(vector(1, 1 + TINY, 2), vector("0.3", "-0.4", "0.2"))
    ),
    "both gaps 1e-30, oblique": turned(
        OBLIQUE, spinning(vector(1, 1 + TINY, 1 - 2 * TINY), vector("0.3", "-0.4", "0.2"))
    ),
    "ratio 1e12": spinning(vector(1, 10**6, 10**12), vector("0.3", "-0.4", "0.2")),
    "ratio 1e12, oblique": turned(
        OBLIQUE, spinning(vector("1e12", 3, 1), vector("1e-6", 2, "0.3"))
    ),
}
