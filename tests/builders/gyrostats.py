"""Free gyrostats in exact numbers: every kind of motion, and the borders between the kinds."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from builders.free_spins import OBLIQUE
from builders.scenes import TENSOR, vector
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Quaternion, Spin
from taylor_verify.scenes.scene import Scene

# Neither of unit length nor with a rational norm.
TILTED: Quaternion = (Fraction(1), Fraction(2), Fraction(-1), Fraction(3))
ROTOR, OMEGA = vector("0.3", "-0.2", "0.5"), vector(1, "0.4", "0.3")
TRIAXIAL = tensors.diagonal(vector(1, 2, 3))


def turned(free: FreeGyrostat, matrix: Matrix = OBLIQUE) -> FreeGyrostat:
    """Return the motion in axes turned by an orthogonal matrix."""
    inertia = tensors.product(tensors.product(matrix, free.inertia), tensors.transpose(matrix))
    rotor, omega = (tensors.apply(matrix, v) for v in (free.rotor, free.omega))
    return FreeGyrostat(inertia, rotor, omega)


def homoclinic(inertia: Matrix, saddle: Vector, direction: Vector) -> FreeGyrostat:
    """A start whose curve has the double point ``saddle``, exactly: the reflection of it.

    With mu = d.K d/d.d and g = (K - mu) G*, G* is a steady spin, and the line from G* along d meets both
    quadrics once more at the start.
    """
    K = tensors.inverse(inertia)
    size = tensors.dot(direction, direction)
    mu = tensors.dot(direction, tensors.apply(K, direction)) / size
    g = tensors.minus(tensors.apply(K, saddle), tensors.scaled(mu, saddle))
    along = 2 * tensors.dot(saddle, direction) / size
    start = tensors.minus(saddle, tensors.scaled(along, direction))
    omega = tensors.minus(tensors.apply(K, start), g)
    return FreeGyrostat(inertia, tensors.apply(inertia, g), omega)


def on_circle(g1: Fraction, g3: Fraction, away: Fraction) -> FreeGyrostat:
    """A start on a pair of planes: I^-1 = (3, 2, 1) and no wheel along the middle axis."""
    K = vector(3, 2, 1)
    momentum, g = (g1 + away, Fraction(1), away - g3), (g1, Fraction(0), g3)
    inertia = tensors.diagonal(tuple(1 / k for k in K))
    omega = tuple(k * G - c for k, G, c in zip(K, momentum, g, strict=True))
    return FreeGyrostat(inertia, tensors.apply(inertia, g), omega)


_CUSPED = tensors.diagonal(vector("1/3", "1/2", 1))
MOTIONS = {
    "one real root": FreeGyrostat(TRIAXIAL, vector(30, 40, -10), OMEGA),
    "three real roots": FreeGyrostat(TRIAXIAL, ROTOR, OMEGA),
    "full tensor": FreeGyrostat(TENSOR, ROTOR, OMEGA),
    "oblique": turned(FreeGyrostat(TRIAXIAL, ROTOR, OMEGA)),
    "no wheels": FreeGyrostat(TRIAXIAL, vector(0, 0, 0), OMEGA),
    "wheels along axis 1": FreeGyrostat(TRIAXIAL, vector(1, 0, 0), OMEGA),
    "wheels along axis 2": FreeGyrostat(TRIAXIAL, vector(0, 1, 0), OMEGA),
    "start on a plane of symmetry": FreeGyrostat(TRIAXIAL, vector(0, 0, 1), vector(1, 0, "0.5")),
    "two equal moments, wheels across": FreeGyrostat(
        tensors.diagonal(vector(1, 1, 3)), ROTOR, OMEGA
    ),
    "two equal moments, wheels along": FreeGyrostat(
        tensors.diagonal(vector(1, 1, 3)), vector(0, 0, 2), OMEGA
    ),
    "the same, oblique": turned(
        FreeGyrostat(tensors.diagonal(vector(2, 5, 2)), vector(0, -1, 0), OMEGA)
    ),
    "three equal moments": FreeGyrostat(tensors.diagonal(vector(2, 2, 2)), ROTOR, OMEGA),
    "steady": FreeGyrostat(TRIAXIAL, vector(0, 0, 2), vector(0, 0, 1)),
    "rest": FreeGyrostat(TRIAXIAL, ROTOR, vector(0, 0, 0)),
    "separatrix": homoclinic(TRIAXIAL, vector(1, 2, 3), vector(1, 1, 1)),
    "separatrix, oblique": turned(homoclinic(TRIAXIAL, vector(1, 2, 3), vector(1, 2, -1))),
    "separatrix, wheels along axis 3": homoclinic(TRIAXIAL, vector(0, 0, 1), vector(1, 1, 1)),
    "trigonometric": homoclinic(TRIAXIAL, vector(2, 1, 0), vector(1, 1, 1)),
    "trigonometric, wheels along axis 1": homoclinic(TRIAXIAL, vector(1, 0, 0), vector(1, 0, 1)),
    "cusp": homoclinic(_CUSPED, vector(1, 0, 0), vector(1, 1, 1)),
    "circle": on_circle(Fraction(1, 2), Fraction(1, 3), Fraction(7)),
    "circle, wheels along axis 1": on_circle(Fraction(1, 2), Fraction(0), Fraction(2)),
    "circle, no wheels": FreeGyrostat(
        tensors.diagonal(vector(9, 8, 4)), vector(0, 0, 0), vector(4, 1, 3)
    ),
}


def scene_of(free: FreeGyrostat, *instants: Fraction | int) -> Scene:
    """The scene of a motion, its attitude tracked."""
    clock = Clock(Fraction(0), tuple(map(Fraction, instants or (1,))))
    body, start = RigidBody(free.inertia, rotor=free.rotor), Spin(free.omega, TILTED)
    return Scene("wheels", "wheels", "euler", frozenset({"attitude"}), body, start, clock)


def paced(free: FreeGyrostat, instants: Sequence[Fraction]) -> list[Fraction]:
    """Return the instants in units of the time in which the motion turns by a radian or so."""
    stiffness = max(abs(entry) for row in free.K for entry in row)
    fastest = stiffness * max(map(abs, free.momentum))
    pace = max(abs(rate) for rate in (fastest, *free.omega, *free.g))
    return [t / pace for t in instants] if pace else list(instants)
