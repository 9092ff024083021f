"""Powers of two in which a motion is of size one, from the body and the state alone."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.exact import clocks
from taylor_verify.exact.enclosure.system import moving
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.precision import floor_log2
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Vector


@dataclass(frozen=True)
class Units:
    """log2 of a unit for each block of the state, for the centre and for time."""

    blocks: tuple[int, ...]
    centre: int
    time: int


def units(scene: Scene) -> Units:
    """The units of a scene's motion."""
    body, start = scene.body, moving(scene.initial)
    if isinstance(body, RigidBody):
        return _euler_units(body, start)
    # What a manufactured motion reaches, not where it begins, is the size of its impulses.
    reached = start if body.manufactured is None else body.manufactured.reach
    return _kirchhoff_units(body, reached)


def _euler_units(body: RigidBody, start: Vector) -> Units:
    """omega by its size, or what the moment makes of it; time by omega, or the fastest of its waves."""
    spun, motion = tensors.apply(body.inverse_inertia, body.moment), body.manufactured
    if motion is None:
        omega = _largest(exponent(start), _halved(exponent(spun)), default=0)
        return Units((omega,), 0, -omega)
    omega = _largest(exponent(motion.reach), default=0)
    rate = _largest(omega, clocks.exponent(motion), default=0)
    return Units((omega,), 0, -rate)


def _kirchhoff_units(body: ImmersedBody, start: Vector) -> Units:
    """Each block by its size, or by what the loads, and x x U, make of it in the unit of time."""
    x, y, force, couple = start[:3], start[3:], body.force, body.couple
    a, b, c = body.linear, body.coupling, body.angular
    spun = tensors.plus(tensors.apply(tensors.transpose(b), force), tensors.apply(c, couple))
    pushed = tensors.plus(tensors.apply(a, force), tensors.apply(b, couple))
    omega = _largest(
        exponent(tensors.apply(tensors.transpose(b), x)),
        exponent(tensors.apply(c, y)),
        _halved(exponent(spun)),
        default=0,
    )
    time = -omega
    velocity = _largest(
        exponent(tensors.apply(a, x)),
        exponent(tensors.apply(b, y)),
        _later(exponent(pushed), time),
        default=omega,
    )
    if body.manufactured is not None:
        time = -_largest(omega, clocks.exponent(body.manufactured), default=0)
    linear = _largest(exponent(x), _later(exponent(force), time), default=0)
    angular = _largest(
        exponent(y), _later(exponent(couple), time), default=linear + velocity + time
    )
    angular = max(angular, linear + velocity + time)
    return Units((linear, angular), velocity + time, time)


def exponent(vector: Vector) -> int | None:
    """log2 of the length, rounded; None for zero."""
    square = tensors.dot(vector, vector)
    return floor_log2(square) // 2 if square else None


def _halved(exponent: int | None) -> int | None:
    return None if exponent is None else exponent // 2


def _later(exponent: int | None, time: int) -> int | None:
    """The size of what grows at this rate, after one unit of time."""
    return None if exponent is None else exponent + time


def _largest(*exponents: int | None, default: int) -> int:
    return max((e for e in exponents if e is not None), default=default)
