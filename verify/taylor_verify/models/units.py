"""Units in which a problem has size one: exact powers of two, so that changing them rounds nothing.

heyoka's error control is absolute below one and relative above; in these units it is relative to
the motion itself, whatever units the scene uses.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.precision import floor_log2, power_of_two
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector

_AXES = tensors.diagonal((Fraction(1),) * 3)


@dataclass(frozen=True)
class Units:
    """scaled value x unit = physical value; each unit is a power of two.

    ``momentum`` is that of H (Euler) or y (Kirchhoff), ``impulse`` that of x.
    """

    time: Fraction
    momentum: Fraction
    impulse: Fraction = Fraction(1)

    @property
    def inverse_inertia(self) -> Fraction:
        """Unit of K and C: Omega = C y is measured in 1/time."""
        return 1 / (self.momentum * self.time)

    @property
    def coupling(self) -> Fraction:
        """Unit of B: Omega = B^T x."""
        return 1 / (self.impulse * self.time)

    @property
    def inverse_mass(self) -> Fraction:
        """Unit of A: x x A x is a couple, measured in momentum/time."""
        return self.momentum / (self.impulse**2 * self.time)

    @property
    def length(self) -> Fraction:
        """Unit of the centre: U = B y, times time."""
        return self.momentum / self.impulse


def natural_units(scene: Scene) -> Units:
    """The units in which the initial state and the fastest rate are of order one."""
    if isinstance(scene.body, RigidBody):
        assert isinstance(scene.initial, Spin)
        return _euler_units(scene.body, scene.initial, _span(scene))
    assert isinstance(scene.initial, Impulse)
    return _kirchhoff_units(scene.body, scene.initial, _span(scene))


def _euler_units(body: RigidBody, initial: Spin, span: Fraction) -> Units:
    momentum, motion = tensors.apply(body.inertia, initial.omega), body.manufactured
    if motion is not None:
        # Not where the motion begins counts, but how far it goes, and how fast its waves are.
        reached = _size(motion.mapped(body.inertia).reach) or Fraction(1)
        rate = max(_size(motion.reach), motion.highest) or Fraction(1)
        return Units(time=1 / _binary(rate), momentum=reached)
    unit = _size(momentum) or _binary(_size(body.moment) * span) or Fraction(1)
    rate = _size(initial.omega) or _largest(body.inverse_inertia) * unit
    # Where the moments differ by many orders of magnitude H may turn far faster than the body does.
    rate = max(rate, _nutation(body.inverse_inertia, momentum))
    return Units(time=1 / _binary(rate), momentum=unit)


def _nutation(K: Matrix, H: Vector) -> Fraction:
    """A power of two near the fastest rate of H' = H x K H linearised at H; 0 where nothing changes.

    The trace of J = [H]x K - [K H]x vanishes, so that its eigenvalues are the roots of
    z^3 + s z - d with s = -tr(J^2)/2, d = det J: not above twice the larger of |s|^(1/2), |d|^(1/3).
    """
    omega = tensors.apply(K, H)
    columns = (
        tensors.plus(
            tensors.cross(H, column), tensors.scaled(Fraction(-1), tensors.cross(omega, e))
        )
        for column, e in zip(K, _AXES, strict=True)
    )
    J = tensors.transpose(tuple(columns))
    square = tensors.product(J, J)
    s = (square[0][0] + square[1][1] + square[2][2]) / 2
    d = tensors.dot(J[0], tensors.cross(J[1], J[2]))
    by_s = _root(abs(s)) if s else Fraction(0)
    by_d = power_of_two(floor_log2(abs(d)) // 3) if d else Fraction(0)
    return max(by_s, by_d)


def _kirchhoff_units(body: ImmersedBody, initial: Impulse, span: Fraction) -> Units:
    """x keeps its norm without a force; y may start at zero and take up all the energy."""
    state, motion = initial.linear + initial.angular, body.manufactured
    if motion is not None:
        state = motion.reach
    doubled_energy = tensors.dot(state, tensors.apply(body.energy_matrix, state))
    spun_up = _root(doubled_energy / _largest(body.angular)) if doubled_energy else Fraction(0)
    impulse = _size(state[:3]) or _binary(_size(body.force) * span)
    momentum = max(_size(state[3:]), spun_up) or _binary(_size(body.couple) * span)
    impulse, momentum = impulse or momentum or Fraction(1), momentum or impulse or Fraction(1)
    rate = max(
        _largest(body.linear) * impulse**2 / momentum,
        _largest(body.coupling) * impulse,
        _largest(body.angular) * momentum,
        Fraction(0) if motion is None else motion.highest,
    )
    return Units(time=1 / _binary(rate), momentum=momentum, impulse=impulse)


def _span(scene: Scene) -> Fraction:
    # The instants are monotonic: one of the two ends is farthest from the start.
    clock = scene.clock
    return max(abs(clock.instants[end] - clock.start) for end in (0, -1))


def _largest(matrix: Iterable[Vector]) -> Fraction:
    return max(abs(entry) for row in matrix for entry in row)


def _size(vector: Vector) -> Fraction:
    """A power of two within a factor of two of the norm; 0 for the zero vector."""
    squared = tensors.dot(vector, vector)
    return _root(squared) if squared else Fraction(0)


def _root(squared: Fraction) -> Fraction:
    """A power of two within a factor of two of the square root."""
    return power_of_two(floor_log2(squared) // 2)


def _binary(value: Fraction) -> Fraction:
    """The power of two just below the value; 0 for 0."""
    return power_of_two(floor_log2(value)) if value else Fraction(0)
