"""Conserved quantities of a solid's free motion in a fluid: T, F^2, FG, y3, the impulses in space.

Legend: x, y are the impulses, U = A x + B y and Omega = B^T x + C y the velocities. Written from the
definitions and independent of the equations of motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.row_arithmetic import (
    applied,
    cross,
    cross_matrices,
    dot,
    largest,
    nonzero,
    norms,
    ones,
    size,
    spectral_norms,
    squares,
    turned,
)
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import real

_BLOCKS: Final = ("linear_impulse", "angular_impulse")


def energy(body: ImmersedBody) -> Invariant:
    """T = x.A x/2 + x.B y + y.C y/2 = (x.U + y.Omega)/2, with dT/dx = U and dT/dy = Omega."""

    def velocities(motion: Motion) -> Array:
        return applied(body.energy_matrix, _impulses(motion))

    def value(motion: Motion) -> Array:
        return dot(_impulses(motion), velocities(motion)) / 2

    return Invariant(
        "T",
        value,
        lambda motion: largest(value(motion)),
        lambda motion: dict(zip(_BLOCKS, np.hsplit(velocities(motion), 2), strict=True)),
    )


F2: Final = Invariant(
    "F2",
    lambda motion: squares(motion["linear_impulse"]),
    lambda motion: largest(squares(motion["linear_impulse"])),
    lambda motion: {"linear_impulse": 2 * motion["linear_impulse"]},
)

# x.y may vanish while x and y do not: its scale is the product of theirs.
FG: Final = Invariant(
    "FG",
    lambda motion: dot(motion["linear_impulse"], motion["angular_impulse"]),
    lambda motion: nonzero(size(motion["linear_impulse"]) * size(motion["angular_impulse"])),
    lambda motion: {
        "linear_impulse": norms(motion["angular_impulse"]),
        "angular_impulse": norms(motion["linear_impulse"]),
    },
)


def axial(axis: int) -> Invariant:
    """y3, or the y of whatever body axis it is about which T is Clebsch's."""
    return Invariant(
        f"y{axis}",
        lambda motion: motion["angular_impulse"][:, axis - 1],
        lambda motion: nonzero(size(motion["angular_impulse"])),
        lambda motion: {"angular_impulse": ones(motion["angular_impulse"])},
    )


def along(n: Vector) -> Invariant:
    """n.y, where T is Clebsch's about a direction that is no body axis."""

    def length(rows: Array) -> Any:
        return norms(real([n], rows))[0]

    def sensitivity(motion: Motion) -> Mapping[str, Array]:
        y = motion["angular_impulse"]
        return {"angular_impulse": ones(y) * length(y)}

    def scale(motion: Motion) -> Any:
        y = motion["angular_impulse"]
        return nonzero(size(y) * length(y))

    return Invariant(
        "y_axis",
        lambda motion: applied((n,), motion["angular_impulse"])[:, 0],
        scale,
        sensitivity,
    )


X_SPACE: Final = Invariant(
    "x_space",
    lambda motion: turned(motion["attitude"], motion["linear_impulse"]),
    lambda motion: nonzero(size(motion["linear_impulse"])),
    lambda motion: {
        "linear_impulse": ones(motion["linear_impulse"]),
        "attitude": norms(motion["linear_impulse"]),
    },
)


def _y_space_value(motion: Motion) -> Array:
    """R y + c x R x: the moment of the impulse about the origin of space."""
    x = turned(motion["attitude"], motion["linear_impulse"])
    y = turned(motion["attitude"], motion["angular_impulse"])
    return y + cross(motion["centre"], x)


def _y_space_scale(motion: Motion) -> Any:
    arm = norms(motion["centre"]) * norms(motion["linear_impulse"])
    return largest(norms(motion["angular_impulse"]) + arm)


def _y_space_sensitivity(motion: Motion) -> Mapping[str, Array]:
    """A small rotation d adds d x (R y) + c x (d x R x) = (c.Rx - Rx c^T - [R y]x) d.

    With c.Rx for the multiple of the unit matrix; the sign of the cross-product matrix follows
    from d x v = -[v]x d.
    """
    c = motion["centre"]
    x = turned(motion["attitude"], motion["linear_impulse"])
    y = turned(motion["attitude"], motion["angular_impulse"])
    by_rotation = cross_matrices(-y) - cross_matrices(c) @ cross_matrices(x)
    return {
        "linear_impulse": norms(c),
        "angular_impulse": ones(c),
        "attitude": spectral_norms(by_rotation),
        "centre": norms(x),
    }


Y_SPACE: Final = Invariant("y_space", _y_space_value, _y_space_scale, _y_space_sensitivity)


def _impulses(motion: Motion) -> Array:
    return np.concatenate([motion[name] for name in _BLOCKS], axis=1)
