"""Reader of a free solid in an ideal fluid for physics engines, and writer of its motion.

An engine takes the mass matrix M of body and fluid together and the velocities: (x, y) = M (U, Omega).
Both are formed of the coefficients of the question in doubles; the impulses of a row are formed of the
velocities of the engine. All else is as for a rigid body in free_body.py.

A script with ``loads = "written"`` ends with ``answer(solve, pushed_solid)``. Where ``body.is_pushed`` it
hands ``body.wrench`` to its engine. In a current the engine moves the body in the frame that drifts with
the fluid: its velocities are those through the water, and a row adds the drift to the centre.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from acting import Piece, continued, inputs
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


class SolidPush:
    """The loads of a question on a solid, and the time ``t`` since the start, of the question's sign."""

    def __init__(self, scene: Any) -> None:
        loads = scene.get("loads", {})
        self._sign = math.copysign(1.0, floats(scene["time"]["elapsed"])[-1])
        self._constant = floats(scene["body"]["force"]) + floats(scene["body"]["couple"])
        self._pieces = list(map(Piece, loads.get("pieces", [])))
        self._current = floats(loads.get("current", [])) or [0.0, 0.0, 0.0]
        self._start: Vector = floats(scene["initial"]["attitude"])
        self.begin()

    def begin(self) -> None:
        """Go back to the start."""
        # A quaternion and its negative are one attitude; loads read the one that goes on from the start.
        self.t, self._attitude = 0.0, self._start

    def move_to(self, t: float) -> None:
        """Go on to a time."""
        self.t = t

    @property
    def drift(self) -> Vector:
        """The way of the fluid since the start, in space axes."""
        return [self.t * v for v in self._current]

    def wrench(self, t: float, moving: Vector, attitude: Quaternion, place: Vector) -> Vector:
        """Return force and couple in body axes at a time, for the velocities (6) and a centre."""
        if not self._pieces:
            return self._constant
        self._attitude = continued(attitude, self._attitude)
        known = {"t": t, **inputs([*moving[3:], *self._attitude])}
        known |= zip(("u1", "u2", "u3"), moving[:3], strict=True)
        known |= zip(("c1", "c2", "c3"), place, strict=True)
        piece = self._piece(t)
        loads = piece.values(piece.wrench, known)
        return [a + b for a, b in zip(self._constant, loads, strict=True)]

    def _piece(self, t: float) -> Piece:
        here = self._sign * t
        for piece in self._pieces:
            first, last = sorted((piece.begin * self._sign, piece.end * self._sign))
            if first <= here < last:
                return piece
        return self._pieces[-1]


@dataclass(frozen=True, kw_only=True)
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
    centre: Vector = ORIGIN
    ellipsoid: Ellipsoid | None = None

    def wrench(
        self,
        velocity: Vector,
        omega: Vector,
        attitude: Quaternion,
        centre: Vector,
        time: float | None = None,
    ) -> Vector:
        """Return force and couple in body axes, at a state and a time of the engine.

        Without a time it is that of the last step.
        """
        sign, push = self.question.sign, self.push
        t = push.t if time is None else sign * time
        moving = [sign * float(v) for v in (*velocity, *omega)]
        place = [float(c) + d for c, d in zip(centre, push.drift, strict=True)]
        return push.wrench(t, moving, unit(attitude), place)

    def rates(self, velocity: Vector, omega: Vector, wrench: Vector) -> Vector:
        """Return the rates of the impulses in body axes under force and couple: Kirchhoff's equations."""
        moving = [*velocity, *omega]
        x1, x2, x3, y1, y2, y3 = (
            sum(m * v for m, v in zip(row, moving, strict=True)) for row in self.mass
        )
        (u1, u2, u3), (w1, w2, w3) = velocity, omega
        own = [
            x2 * w3 - x3 * w2,
            x3 * w1 - x1 * w3,
            x1 * w2 - x2 * w1,
            y2 * w3 - y3 * w2 + x2 * u3 - x3 * u2,
            y3 * w1 - y1 * w3 + x3 * u1 - x1 * u3,
            y1 * w2 - y2 * w1 + x1 * u2 - x2 * u1,
        ]
        return [a + b for a, b in zip(own, wrench, strict=True)]

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
        place = [float(entry) for entry in centre]
        if self.is_pushed:
            place = [entry + d for entry, d in zip(place, self.push.drift, strict=True)]
        row = [*impulses, *map(float, attitude), *place]
        return row[: len(self.question.columns)]

    def row_from_space(
        self, velocity: Vector, omega: Vector, attitude: Quaternion, centre: Vector
    ) -> Row:
        """Return a row of the answer, of velocities in space axes."""
        return self.row(to_body(attitude, velocity), to_body(attitude, omega), attitude, centre)


def immersed_body(scene: Any) -> ImmersedBody:
    """Return the solid of a question; raises Unsuited where it is not free or not in a fluid."""
    body = pushed_solid(scene) if "loads" not in scene else None
    if body is None or body.is_pushed:
        raise Unsuited("expected a free solid in a fluid, got loads, damping or no fluid @ body")
    return body


def pushed_solid(scene: Any) -> ImmersedBody:
    """Return the solid of a question, with what acts on it; raises Unsuited for states and damping."""
    import numpy

    body, initial = scene["body"], scene["initial"]
    if scene["model"] != "kirchhoff" or "damping" in body or "states" in scene:
        raise Unsuited("expected a free solid in a fluid, got loads, damping or no fluid @ body")
    question = read(scene, takes_loads=True)
    acts = "loads" in scene or any((*floats(body["force"]), *floats(body["couple"])))
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
        push=SolidPush(scene) if acts else None,
    )


def any_body(scene: Any) -> Body:
    """Return the body of a question of either model; a rigid one with what acts on it."""
    return pushed_solid(scene) if scene["model"] == "kirchhoff" else pushed_body(scene)
