"""Reader of a free solid in an ideal fluid for physics engines, and writer of its motion.

An engine takes the mass matrix M of body and fluid together and the velocities: (x, y) = M (U, Omega).
Both are formed of the coefficients of the question in doubles; the impulses of a row are formed of the
velocities of the engine. All else is as for a rigid body in free_body.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from axes import Matrix, Quaternion, Vector, to_body, to_space
from free_body import Body, pushed_body
from question import Row, Unsuited, floats, read, unit

ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Ellipsoid:
    """A homogeneous ellipsoid, its semi-axes along body axes 1, 2, 3."""

    semi_axes: Vector
    density: float
    fluid_density: float


@dataclass(frozen=True)
class ImmersedBody(Body):
    """Mass matrix (linear before angular), velocities in body axes, attitude and centre, as doubles.

    ``energy`` is the inverse of the mass matrix, by the coefficients of the question. ``ellipsoid`` is
    there for a solid that was given as one; its coefficients are the exact ones, rounded.
    A motion backwards in time is the motion forwards with the velocities reversed.
    """

    mass: Matrix
    energy: Matrix
    velocity: Vector
    omega: Vector
    attitude: Quaternion
    centre: Vector = ORIGIN
    ellipsoid: Ellipsoid | None = None

    @property
    def velocity_in_space(self) -> Vector:
        return to_space(self.attitude, self.velocity)

    def row(self, velocity: Vector, omega: Vector, attitude: Quaternion, centre: Vector) -> Row:
        """Return a row of the answer, of velocities in body axes and a centre in space axes."""
        moving = [*map(float, velocity), *map(float, omega)]
        sign = self.question.sign
        impulses = [
            sign * sum(m * v for m, v in zip(row, moving, strict=True)) for row in self.mass
        ]
        row = [*impulses, *map(float, attitude), *map(float, centre)]
        return row[: len(self.question.columns)]

    def row_from_space(
        self, velocity: Vector, omega: Vector, attitude: Quaternion, centre: Vector
    ) -> Row:
        """Return a row of the answer, of velocities in space axes."""
        return self.row(to_body(attitude, velocity), to_body(attitude, omega), attitude, centre)


def immersed_body(scene: Any) -> ImmersedBody:
    """Return the solid of a question; raises Unsuited where it is not free or not in a fluid."""
    import numpy

    question = read(scene)
    body, initial = scene["body"], scene["initial"]
    loads = [*floats(body.get("force", [])), *floats(body.get("couple", []))]
    if scene["model"] != "kirchhoff" or any(loads) or "damping" in body:
        raise Unsuited("expected a free solid in a fluid, got loads, damping or no fluid @ body")
    A, B, C = (numpy.array(floats(body[key])) for key in ("linear", "coupling", "angular"))
    energy = numpy.block([[A, B], [B.T, C]])
    impulses = floats(initial["linear_impulse"]) + floats(initial["angular_impulse"])
    shape = [floats(body[key]) for key in ("semi_axes", "density", "fluid_density") if key in body]
    ellipsoid = Ellipsoid(*shape) if shape else None
    moving = (question.sign * energy @ impulses).tolist()
    return ImmersedBody(
        question=question,
        mass=numpy.linalg.inv(energy).tolist(),
        energy=energy.tolist(),
        velocity=moving[:3],
        omega=moving[3:],
        attitude=unit(floats(initial["attitude"])),
        centre=floats(initial["centre"]),
        ellipsoid=ellipsoid,
    )


def any_body(scene: Any) -> Body:
    """Return the body of a question of either model; a rigid one with what acts on it."""
    return immersed_body(scene) if scene["model"] == "kirchhoff" else pushed_body(scene)
