"""The body, the start and the loads of a scene, read from its text.

Legend: I ``inertia``; A, B, C the blocks of the energy T = x.A x/2 + x.B y + y.C y/2, whose matrix
[[A, B], [B^T, C]] is the inverse of the mass matrix of (x, y) = mass (U, W).

A number of the text is an exact fraction. An angle in degrees and an ellipsoid are irrational: these
numbers have the precision of the ambient gmpy2 context.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any, NamedTuple

from gmpy2 import const_pi

from referee.lamb import ellipsoid_masses

Vector = list[Any]
Matrix = list[list[Any]]

ZERO = [Fraction(0)] * 3
QUANTITY = re.compile(r"(\S+)\s+(rad/s|deg/s|rpm)")


class Scene(NamedTuple):
    """A body, what moves it, and where it starts. Momenta of a rigid body are about its origin."""

    model: str
    tracked: list[str]
    start: Fraction
    inverse: Matrix
    state: dict[str, Vector]
    attitude: Matrix
    centre: Vector
    rotor: Vector
    loads: dict[str, Vector]
    damping: Any


def parse(text: str) -> dict[str, Any]:
    """Return the tables of a scene, its decimals exact."""
    return tomllib.loads(text, parse_float=Decimal)


def read_scene(text: str) -> Scene:
    """Return the scene of a text, its irrational numbers at the ambient precision."""
    tables = parse(text)
    body, initial = tables["body"], tables["initial"]
    read = _rigid if tables["model"] == "euler" else _immersed
    inverse, state, loads = read(body, initial)
    return Scene(
        model=tables["model"],
        tracked=_tracked(tables),
        start=number(tables["time"].get("start", 0)),
        inverse=inverse,
        state=state,
        attitude=rotation(vector(initial.get("attitude", [1, 0, 0, 0]))),
        centre=vector(initial.get("centre", ZERO)),
        rotor=vector(body.get("rotor", ZERO)),
        loads=loads,
        damping=number(body.get("damping", 0)),
    )


def _tracked(tables: Mapping[str, Any]) -> list[str]:
    """Return the quantities that an answer has; the centre brings the attitude."""
    is_rigid = tables["model"] == "euler"
    main = ["omega"] if is_rigid else ["linear_impulse", "angular_impulse"]
    words = set(tables.get("track", []))
    attitude = ["attitude"] if words & {"attitude", "centre"} else []
    return main + attitude + ["centre"] * ("centre" in words)


def _rigid(
    body: Mapping[str, Any], initial: Mapping[str, Any]
) -> tuple[Matrix, dict[str, Vector], dict[str, Vector]]:
    """Return the inverse tensor, the momentum p = I w and the moment of a rigid body."""
    inertia = tensor(body["inertia"])
    state = {"p": apply(inertia, vector(initial["omega"]))}
    return inverse_of(inertia), state, {"p": vector(body.get("moment", ZERO))}


def _immersed(
    body: Mapping[str, Any], initial: Mapping[str, Any]
) -> tuple[Matrix, dict[str, Vector], dict[str, Vector]]:
    """Return the energy matrix, the impulses and the force and couple of a solid in a fluid."""
    mass, energy = _mass_and_energy(body)
    if "linear_velocity" in initial:
        velocities = vector(initial["linear_velocity"]) + vector(initial["angular_velocity"])
        impulses = apply(mass, velocities)
    else:
        impulses = vector(initial["linear_impulse"]) + vector(initial["angular_impulse"])
    state = {"x": impulses[:3], "y": impulses[3:]}
    loads = {"x": vector(body.get("force", ZERO)), "y": vector(body.get("couple", ZERO))}
    return energy, state, loads


def _mass_and_energy(body: Mapping[str, Any]) -> tuple[Matrix, Matrix]:
    """Return the mass matrix and the energy matrix: each is the inverse of the other."""
    if "mass_matrix" in body:
        mass = [vector(row) for row in body["mass_matrix"]]
        return mass, inverse_of(mass)
    if "ellipsoid" in body:
        shape = body["ellipsoid"]
        densities = number(shape["density"]), number(shape["fluid_density"])
        mass = diagonal(ellipsoid_masses(vector(shape["semi_axes"]), *densities))
        return mass, inverse_of(mass)
    energy = _clebsch(body["clebsch"]) if "clebsch" in body else _energy(body["energy"])
    return inverse_of(energy), energy


def _clebsch(table: Mapping[str, Any]) -> Matrix:
    """Return the energy matrix of the six coefficients: axis 3 is the axis of symmetry."""
    p, q, r = (number(table[key]) for key in ("p", "q", "r"))
    a, b, c = (number(table[key]) for key in ("p_prime", "q_prime", "r_prime"))
    return _blocks(diagonal([p, p, a]), diagonal([q, q, b]), diagonal([r, r, c]))


def _energy(table: Mapping[str, Any]) -> Matrix:
    """Return the energy matrix of the 21 coefficients."""
    return _blocks(*(tensor(table[key]) for key in ("linear", "coupling", "angular")))


def _blocks(a: Matrix, b: Matrix, c: Matrix) -> Matrix:
    """Return [[A, B], [B^T, C]]."""
    upper = [p + q for p, q in zip(a, b, strict=True)]
    return upper + [[*p, *q] for p, q in zip(zip(*b, strict=True), c, strict=True)]


# Numbers, vectors and matrices of the text


def number(value: Any) -> Any:
    """Return the number of an integer, a decimal, a text "a/b" or a rate with a unit."""
    parts = QUANTITY.fullmatch(value.strip()) if isinstance(value, str) else None
    if parts is None:
        return Fraction(value)
    # A turn is 2 pi; a turn a minute is 6 degrees a second.
    return (
        Fraction(parts[1])
        * {
            "rad/s": Fraction(1),
            "deg/s": const_pi() / 180,
            "rpm": const_pi() / 30,
        }[parts[2]]
    )


def vector(values: Sequence[Any]) -> Vector:
    """Return the numbers of an array."""
    return [number(value) for value in values]


def tensor(value: Sequence[Any]) -> Matrix:
    """Return the matrix of three rows, or of the three numbers of its diagonal."""
    is_matrix = isinstance(value[0], list)
    return [vector(row) for row in value] if is_matrix else diagonal(vector(value))


def diagonal(values: Sequence[Any]) -> Matrix:
    """Return the matrix of this diagonal."""
    size = range(len(values))
    return [[values[i] if i == j else Fraction(0) for j in size] for i in size]


def apply(matrix: Matrix, values: Vector) -> Vector:
    """Return the product of a matrix and a vector."""
    return [sum(a * v for a, v in zip(row, values, strict=True)) for row in matrix]


def inverse_of(matrix: Matrix) -> Matrix:
    """Return the inverse by elimination. A positive definite matrix needs no exchange of rows."""
    size = len(matrix)
    rows = [[*row, *unit] for row, unit in zip(matrix, diagonal([1] * size), strict=True)]
    for k in range(size):
        rows[k] = [entry / rows[k][k] for entry in rows[k]]
        for i in set(range(size)) - {k}:
            factor = rows[i][k]
            rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    return [row[size:] for row in rows]


def rotation(quaternion: Vector) -> Matrix:
    """Return R of v_space = R v_body: v -> q v q* / |q|^2, scalar first."""
    s, *v = quaternion
    square = s * s + sum(c * c for c in v)
    skew = [[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]]
    return [
        [
            ((s * s - sum(c * c for c in v)) * (i == j) + 2 * v[i] * v[j] + 2 * s * skew[i][j])
            / square
            for j in range(3)
        ]
        for i in range(3)
    ]
