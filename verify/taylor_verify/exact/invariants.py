"""What a free motion conserves: each quantity with its value, its scale and its sensitivity.

Written from the texts' definitions and independent of the equations of motion. Everything works at
the ambient precision, on the truth and on a solver's motion alike, whether their numbers are mpmath's
or MPFR's (exact.mpfr), and answers in the same.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from taylor_verify.exact.kirchhoff.integrable import Fourth, fourth_integral
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import real, sqrt
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Invariant:
    """A quantity Q that a free motion conserves, for one body.

    ``value`` gives Q at every row of a motion, an object array (n,), or (n, 3) in space axes.
    ``scale`` gives a size of Q that vanishes with the motion only, and 1 there (then drift is
    absolute). ``sensitivity`` gives dQ/d(block) at every row, block by block: (n, 3) by component where
    a component that is zero adds nothing to Q, whoever disturbs it, and else its spectral norm (n,);
    blocks ``momentum`` (H, body axes) or ``linear_impulse`` and ``angular_impulse`` (body axes),
    ``attitude`` (a rotation vector in space axes, radians) and ``centre`` (space axes); a block
    that Q does not contain is absent.
    """

    name: str
    value: Callable[[Motion], Array]
    scale: Callable[[Motion], Any]
    sensitivity: Callable[[Motion], Mapping[str, Array]]


def invariants(scene: Scene) -> tuple[Invariant, ...]:
    """The conserved quantities that the tracked quantities of a scene determine.

    Euler: ``T``, ``H2``, and ``H_space`` with attitude. Kirchhoff: ``T``, ``F2``, ``FG``, ``y3``
    for a body of Clebsch's form (``y1`` or ``y2`` where that is its axis) or the fourth integral of
    another family, by its word (without loads alone), ``x_space`` with attitude, ``y_space`` with
    centre. Under loads they change, by the work and impulse of the loads; their values are defined
    all the same.
    """
    if isinstance(scene.body, RigidBody):
        found = [_euler_energy(scene.body), _euler_momentum(scene.body)]
        if "attitude" in scene.track:
            found.append(_euler_space_momentum(scene.body))
        return tuple(found)
    found = [_energy(scene.body), _F2, _FG]
    if scene.body.axis_of_symmetry is not None:
        found.append(_axial(scene.body.axis_of_symmetry))
    fourth = fourth_integral(scene)
    if fourth is not None:
        found.append(_fourth(fourth))
    if "attitude" in scene.track:
        found.append(_x_space)
    if "centre" in scene.track:
        found.append(_y_space)
    return tuple(found)


def decisive(scene: Scene, motion: Motion) -> list[int]:
    """Rows of a motion that have the scales of all its invariants: any scale is that of these rows alone.

    Each scale is made of the largest T, |H|, |x|, |y| and |y| + |c| |x|. Rows that are not finite are
    passed over, if there are others.
    """
    body = scene.body
    if isinstance(body, RigidBody):
        T, H = _euler_energy(body), _applied(body.inertia, motion["omega"])
        sizes = [abs(T.value(motion)), _norms(H)]
    else:
        x, y = _norms(motion["linear_impulse"]), _norms(motion["angular_impulse"])
        sizes = [abs(_energy(body).value(motion)), x, y]
        if "centre" in scene.track:
            sizes.append(y + _norms(motion["centre"]) * x)
    return sorted({max(range(len(rows)), key=lambda k: _finite_first(rows[k])) for rows in sizes})


def _finite_first(size: Any) -> Any:
    return size if size == size else -1


# Euler: H = I omega.


def _euler_energy(body: RigidBody) -> Invariant:
    """T = omega . I omega / 2, so that dT/dH = omega."""

    def value(motion: Motion) -> Array:
        return _dot(motion["omega"], _applied(body.inertia, motion["omega"])) / 2

    return Invariant(
        "T",
        value,
        lambda motion: _largest(value(motion)),
        lambda motion: {"momentum": motion["omega"]},
    )


def _euler_momentum(body: RigidBody) -> Invariant:
    """H2 = |I omega|^2."""

    def value(motion: Motion) -> Array:
        return _squares(_applied(body.inertia, motion["omega"]))

    return Invariant(
        "H2",
        value,
        lambda motion: _largest(value(motion)),
        lambda motion: {"momentum": 2 * _applied(body.inertia, motion["omega"])},
    )


def _euler_space_momentum(body: RigidBody) -> Invariant:
    """R I omega; a small rotation d of the attitude adds d x (R I omega)."""

    def momentum(motion: Motion) -> Array:
        return _applied(body.inertia, motion["omega"])

    return Invariant(
        "H_space",
        lambda motion: _turned(motion["attitude"], momentum(motion)),
        lambda motion: _largest(_norms(momentum(motion))),
        lambda motion: {
            "momentum": _ones(motion["omega"]),
            "attitude": _norms(momentum(motion)),
        },
    )


# Kirchhoff: x, y are the impulses, U = A x + B y and Omega = B^T x + C y the velocities.


def _energy(body: ImmersedBody) -> Invariant:
    """T = x.A x/2 + x.B y + y.C y/2 = (x.U + y.Omega)/2, with dT/dx = U and dT/dy = Omega."""

    def velocities(motion: Motion) -> Array:
        return _applied(body.energy_matrix, _impulses(motion))

    def value(motion: Motion) -> Array:
        return _dot(_impulses(motion), velocities(motion)) / 2

    def sensitivity(motion: Motion) -> Mapping[str, Array]:
        both = velocities(motion)
        return {"linear_impulse": both[:, :3], "angular_impulse": both[:, 3:]}

    return Invariant("T", value, lambda motion: _largest(value(motion)), sensitivity)


_F2 = Invariant(
    "F2",
    lambda motion: _squares(motion["linear_impulse"]),
    lambda motion: _largest(_squares(motion["linear_impulse"])),
    lambda motion: {"linear_impulse": 2 * motion["linear_impulse"]},
)

# x.y may vanish while x and y do not: its scale is the product of theirs.
_FG = Invariant(
    "FG",
    lambda motion: _dot(motion["linear_impulse"], motion["angular_impulse"]),
    lambda motion: _nonzero(_size(motion["linear_impulse"]) * _size(motion["angular_impulse"])),
    lambda motion: {
        "linear_impulse": _norms(motion["angular_impulse"]),
        "angular_impulse": _norms(motion["linear_impulse"]),
    },
)


def _axial(axis: int) -> Invariant:
    """y3, or the y of whatever body axis it is about which T is Clebsch's."""
    return Invariant(
        f"y{axis}",
        lambda motion: motion["angular_impulse"][:, axis - 1],
        lambda motion: _nonzero(_size(motion["angular_impulse"])),
        lambda motion: {"angular_impulse": _ones(motion["angular_impulse"])},
    )


def _fourth(found: Fourth) -> Invariant:
    return Invariant(found.name, found.value, found.scale, found.sensitivity)


_x_space = Invariant(
    "x_space",
    lambda motion: _turned(motion["attitude"], motion["linear_impulse"]),
    lambda motion: _nonzero(_size(motion["linear_impulse"])),
    lambda motion: {
        "linear_impulse": _ones(motion["linear_impulse"]),
        "attitude": _norms(motion["linear_impulse"]),
    },
)


def _y_space_value(motion: Motion) -> Array:
    """R y + c x R x: the moment of the impulse about the origin of space."""
    x = _turned(motion["attitude"], motion["linear_impulse"])
    y = _turned(motion["attitude"], motion["angular_impulse"])
    return y + _cross(motion["centre"], x)


def _y_space_scale(motion: Motion) -> Any:
    arm = _norms(motion["centre"]) * _norms(motion["linear_impulse"])
    return _largest(_norms(motion["angular_impulse"]) + arm)


def _y_space_sensitivity(motion: Motion) -> Mapping[str, Array]:
    """A small rotation d adds d x (R y) + c x (d x R x) = (c.Rx - Rx c^T - [R y]x) d.

    With c.Rx for the multiple of the unit matrix; the sign of the cross-product matrix follows
    from d x v = -[v]x d.
    """
    c = motion["centre"]
    x = _turned(motion["attitude"], motion["linear_impulse"])
    y = _turned(motion["attitude"], motion["angular_impulse"])
    by_rotation = _cross_matrices(-y) - _cross_matrices(c) @ _cross_matrices(x)
    return {
        "linear_impulse": _norms(c),
        "angular_impulse": _ones(c),
        "attitude": _spectral_norms(by_rotation),
        "centre": _norms(x),
    }


_y_space = Invariant("y_space", _y_space_value, _y_space_scale, _y_space_sensitivity)


# Rows of vectors.


def _impulses(motion: Motion) -> Array:
    return np.concatenate([motion["linear_impulse"], motion["angular_impulse"]], axis=1)


def _applied(matrix: Matrix, rows: Array) -> Array:
    """The matrix times every row, its exact entries taken at the ambient precision."""
    image: Array = rows @ real(matrix, rows).T
    return image


def _turned(attitude: Array, rows: Array) -> Array:
    """R v, row by row: body axes to space axes."""
    turned: Array = np.matmul(attitude, rows[:, :, None])[:, :, 0]
    return turned


def _dot(a: Array, b: Array) -> Array:
    sums: Array = np.sum(a * b, axis=1)
    return sums


def _squares(rows: Array) -> Array:
    return _dot(rows, rows)


def _cross(a: Array, b: Array) -> Array:
    j, k = [1, 2, 0], [2, 0, 1]
    product: Array = a[:, j] * b[:, k] - a[:, k] * b[:, j]
    return product


def _cross_matrices(rows: Array) -> Array:
    """[v]x for every row v, (n, 3, 3): [v]x d = v x d."""
    found = np.full((len(rows), 3, 3), real([0], rows)[0])
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[:, i, j], found[:, j, i] = -rows[:, k], rows[:, k]
    return found


def _norms(rows: Array) -> Array:
    return sqrt(_squares(rows))


def _spectral_norms(matrices: Array) -> Array:
    """The largest singular value of every matrix, to float64 accuracy but in the numbers' own range."""
    largest = [max(abs(entry) for entry in matrix.flat) for matrix in matrices]
    sizes = np.array([_nonzero(size) for size in largest], dtype=object)
    moderate = (matrices / sizes[:, None, None]).astype(np.float64)
    singular = np.linalg.norm(moderate, 2, axis=(1, 2))
    norms: Array = np.array(singular.tolist(), dtype=object) * sizes
    return norms


def _ones(rows: Array) -> Array:
    """One 1 for every row, in the rows' own numbers."""
    return real([1] * len(rows), rows)


def _size(rows: Array) -> Any:
    return max(_norms(rows))


def _largest(values: Array) -> Any:
    return _nonzero(max(abs(value) for value in values))


def _nonzero(scale: Any) -> Any:
    """The scale, or 1 where it vanishes: what is measured is then absolute."""
    return scale if scale != 0 else 0 * scale + 1
