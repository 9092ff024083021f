"""How errors travel along an orbit, by its variational equations in float64.

The state is z = H, or z = (x, y), and the equations are quadratic: z' = c + J(z) z/2 with J linear in z,
so that a small error obeys dz' = J(z) dz. It turns the attitude by theta, a rotation vector in space
axes, and moves the centre c,

    theta' = R dOmega,        dc' = theta x R U + R dU,

with Omega and U linear in z. These are integrated from one node to the next along a motion that starts
at the truth, and that has to arrive at it: where float64 cannot follow the orbit that far there is no
answer. Of a manufactured motion z* = S w, with w the clock of exact.clocks and w' = N w, the loads are
S w' - J(z*) z*/2; they do not depend on z, and so are no part of J. A product of such steps leads
from any node to any later one; nothing is inverted.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np
from mpmath import mp

from verify.exact import clocks
from verify.exact.looks import refined
from verify.exact.solution import Solution
from verify.scenes.bodies import ImmersedBody, RigidBody
from verify.scenes.motion import Motion
from verify.scenes.precision import floor_log2, power_of_two
from verify.scenes.scene import Scene
from verify.scenes.tensors import Matrix, Vector

Floats = np.ndarray[Any, np.dtype[np.float64]]
Table = dict[tuple[str, str], Floats]

# Norms are wanted to a digit or two: a motion that misses the truth by this part of its size, or a
# step that changes volume by it, is not what was asked about.
_TOLERANCE: Final = 1e-4
# The classical Runge-Kutta step errs by (h rate)^5/120 of the state, 3e-6.
_STEP: Final = 0.2
# Between two nodes the motion is set back to the truth this often.
_PARTS: Final = 4
_MOST_STEPS: Final = 100_000
# A ten-thousandth of the tolerance. The better of the two evaluations that agree to these digits has
# a dozen more, if the orbit leaves them, and so starts the motion with what float64 holds.
_TRUTH_DIGITS: Final = 8
_FLOAT_DIGITS: Final = 20


def transition_table(
    scene: Scene, exact: Solution, units: Vector, elapsed: Sequence[Fraction]
) -> Table | None:
    """The norms of condition.Transition, or None where float64 does not follow the orbit.

    ``units`` are powers of two near the size of each component of the momentum.
    """
    flow = _Flow.of(scene, units)
    found = _integrated(scene, exact, flow, units, elapsed)
    if found is None:
        return None
    with np.errstate(all="ignore"):
        return _table(scene, flow, units, _wholes(flow, *found))


class Stepped(NamedTuple):
    """The steps from each time to the next, and the motion at the times, in units.

    ``steps`` act on (z, theta, c); ``momentum`` (n, d) is z, ``centre`` (n, 3) counts from its start
    and has no rows if it is not tracked; ``omega`` (3, d) makes Omega of z. ``time`` and ``length`` are
    the units that are not given.
    """

    steps: tuple[Floats, ...]
    momentum: Floats
    centre: Floats
    omega: Floats
    time: Fraction
    length: Fraction


def stepped(
    scene: Scene, exact: Solution, units: Vector, elapsed: Sequence[Fraction], more_digits: int = 0
) -> Stepped | None:
    """The steps between these times, or None; ``more_digits`` of the truth keep its small components."""
    flow = _Flow.of(scene, units)
    found = _integrated(scene, exact, flow, units, elapsed, more_digits)
    if found is None:
        return None
    wholes, samples = _wholes(flow, *found), found[1]
    momentum, centre = samples.momentum[::_PARTS], samples.centre[::_PARTS]
    return Stepped(tuple(wholes), momentum, centre, flow.omega, flow.time, flow.length)


def fastest(scene: Scene, units: Vector, momenta: Floats) -> float:
    """The largest norm of J along a motion (n, d; in units), per unit of the scene's time."""
    flow = _Flow.of(scene, units)
    norms = [np.linalg.norm(flow.jacobian(z), 2) for z in momenta]
    return float(max(norms)) / float(flow.time)


@dataclass(frozen=True)
class _Flow:
    """The equations in units of their size: d = 3 or 6 components of momentum.

    ``twice`` (d, d, d) gives J = twice @ z; ``omega`` and ``velocity`` (3, d) give Omega and, for a
    solid in a fluid, U. Time is measured in ``time``, lengths in ``length``. ``swing`` is S and N.
    """

    constant: Floats
    swing: clocks.Swing
    twice: Floats
    omega: Floats
    velocity: Floats | None
    time: Fraction
    length: Fraction

    @classmethod
    def of(cls, scene: Scene, units: Vector) -> _Flow:
        constant, products, omega, velocity = _equations(scene)
        d = len(units)
        scaled = {
            (i, j, k): c * units[j] * units[k] / units[i] for (i, j, k), c in products.items()
        }
        rates = [abs(c) for c in scaled.values() if c]
        rates += [abs(c / unit) for c, unit in zip(constant, units, strict=True) if c]
        time = 1 / power_of_two(floor_log2(max(rates))) if rates else Fraction(1)
        twice = np.zeros((d, d, d))
        for (i, j, k), c in scaled.items():
            # Both orders of a product, so that J is the Jacobian; a square counts twice so.
            twice[i, j, k] += float(c * time)
            twice[i, k, j] += float(c * time)
        speeds = [c * u for row in velocity for c, u in zip(row, units, strict=True) if c]
        fastest = max((abs(s) for s in speeds), default=Fraction(0))
        length = power_of_two(floor_log2(fastest * time)) if fastest else Fraction(1)
        return cls(
            constant=np.array([float(c * time / u) for c, u in zip(constant, units, strict=True)]),
            swing=clocks.swing(scene.body, units, time),
            twice=twice,
            omega=_floats(omega, units, time),
            velocity=_floats(velocity, units, time / length) if velocity else None,
            time=time,
            length=length,
        )

    def jacobian(self, z: Floats) -> Floats:
        found: Floats = self.twice @ z
        return found

    def load(self, clock: Floats) -> Floats:
        """What is constant, and what the manufactured motion takes."""
        there, rate = self.swing.at(clock)
        found: Floats = self.constant + rate - self.jacobian(there) @ there / 2
        return found


@dataclass(frozen=True)
class _Samples:
    """The truth at the points: momentum in units (n, d), R (n, 3, 3) and the centre in lengths (n, 3).

    What is not tracked has no rows. ``clock`` (n, m) is w.
    """

    clock: Floats
    momentum: Floats
    attitude: Floats
    centre: Floats


def _samples(
    scene: Scene, points: Sequence[Fraction], truth: Motion, units: Vector, length: Fraction
) -> _Samples:
    with mp.workdps(_FLOAT_DIGITS):
        if isinstance(scene.body, RigidBody):
            inertia = np.array([[mp.convert(c) for c in row] for row in scene.body.inertia])
            z = truth["omega"] @ inertia.T
        else:
            z = np.concatenate([truth["linear_impulse"], truth["angular_impulse"]], axis=1)
        nothing = np.empty((0, 3), dtype=object)
        path = truth.quantities.get("centre", nothing) / mp.convert(length)
        path = path - path[:1]
        return _Samples(
            clocks.floats(scene.body.manufactured, points),
            (z / np.array([mp.convert(unit) for unit in units])).astype(float),
            truth.quantities.get("attitude", np.empty((0, 3, 3))).astype(float),
            path.astype(float),
        )


@dataclass
class _Errors:
    """w, z, R and the derivatives by the momentum at the last point: of z (d, d), theta, c (3, d)."""

    clock: Floats
    momentum: Floats
    attitude: Floats
    by_momentum: Floats
    turn: Floats
    shift: Floats

    def moved(self, rates: tuple[Floats, ...], h: float) -> _Errors:
        parts = zip(self._parts(), rates, strict=True)
        return _Errors(*(part + h * rate for part, rate in parts))

    def _parts(self) -> tuple[Floats, ...]:
        return self.clock, self.momentum, self.attitude, self.by_momentum, self.turn, self.shift


def _rates(flow: _Flow, at: _Errors) -> tuple[Floats, ...]:
    jacobian, R = flow.jacobian(at.momentum), at.attitude
    change = jacobian @ at.by_momentum
    omega = flow.omega @ at.momentum
    turning = R @ _cross_matrix(omega)
    turn = R @ (flow.omega @ at.by_momentum)
    if flow.velocity is None:
        shift = np.zeros_like(turn)
    else:
        speed = R @ (flow.velocity @ at.momentum)
        shift = R @ (flow.velocity @ at.by_momentum) - _cross_matrix(speed) @ at.turn
    moved = flow.load(at.clock) + jacobian @ at.momentum / 2
    return flow.swing.turning @ at.clock, moved, turning, change, turn, shift


def _integrated(
    scene: Scene,
    exact: Solution,
    flow: _Flow,
    units: Vector,
    elapsed: Sequence[Fraction],
    more_digits: int = 0,
) -> tuple[list[Floats], _Samples] | None:
    """The steps between the points of ``looks.refined``, and the truth there."""
    points = refined(elapsed, _PARTS)
    truth = exact.motion(points, _TRUTH_DIGITS + more_digits)
    with np.errstate(all="ignore"):  # what overflows is not finite, and then there is no answer
        samples = _samples(scene, points, truth, units, flow.length)
        steps = _steps(flow, samples, [float(t / flow.time) for t in points])
    return None if steps is None else (steps, samples)


def _wholes(flow: _Flow, steps: Sequence[Floats], samples: _Samples) -> list[Floats]:
    """The steps on (z, theta, c) from one of the times asked for to the next."""
    d = len(flow.constant)
    parts = [_whole(step, samples.centre[k : k + 2], d) for k, step in enumerate(steps)]
    firsts = range(0, len(parts), _PARTS)
    return [reduce(lambda done, part: part @ done, parts[k : k + _PARTS]) for k in firsts]


def _steps(flow: _Flow, samples: _Samples, times: Sequence[float]) -> list[Floats] | None:
    """From point to point the derivatives of (z, theta, c) by z."""
    found: list[Floats] = []
    for k, (begin, end) in enumerate(pairwise(times)):
        d = len(flow.constant)
        R = samples.attitude[k] if len(samples.attitude) else np.eye(3)
        nothing = np.zeros((3, d))
        start = _Errors(samples.clock[k], samples.momentum[k], R, np.eye(d), nothing, nothing)
        reached = _followed(flow, start, end - begin)
        if reached is None or not _arrives(reached, samples.momentum[k + 1]):
            return None
        found.append(np.vstack([reached.by_momentum, reached.turn, reached.shift]))
    return found


def _rate(flow: _Flow, momentum: Floats) -> float:
    """What a step has to resolve: it errs by (h J)^5/120, and by h J (h rate)^4 of what J becomes.

    Where the moments of inertia lie far apart J is far from normal: |J| is then much larger than what
    any power of it makes of a step.
    """
    jacobian = flow.jacobian(momentum)
    square = jacobian @ jacobian
    fifth = float(np.linalg.norm(square @ square @ jacobian)) ** 0.2
    own = max(fifth, float(np.linalg.norm(flow.omega @ momentum)), float(flow.swing.fastest))
    return float(max(own, (np.linalg.norm(jacobian) * own**4) ** 0.2))


def _followed(flow: _Flow, at: _Errors, span: float) -> _Errors | None:
    """The classical Runge-Kutta method with steps that resolve the Jacobian."""
    left = span
    for _ in range(_MOST_STEPS):
        rate = _rate(flow, at.momentum)
        if not np.isfinite(rate):
            return None
        whole = abs(left) * rate <= _STEP
        h = left if whole else np.copysign(_STEP / rate, left)
        first = _rates(flow, at)
        second = _rates(flow, at.moved(first, h / 2))
        third = _rates(flow, at.moved(second, h / 2))
        fourth = _rates(flow, at.moved(third, h))
        mean = tuple(
            (a + 2 * b + 2 * c + d) / 6
            for a, b, c, d in zip(first, second, third, fourth, strict=True)
        )
        at = at.moved(mean, h)
        if whole:
            return at
        left -= h
    return None


def _arrives(reached: _Errors, truth: Floats) -> bool:
    """Whether the motion came to the truth, and the step conserves volume as the flow does."""
    missed = np.linalg.norm(reached.momentum - truth)
    volume = np.linalg.det(reached.by_momentum)
    return bool(missed <= _TOLERANCE * np.linalg.norm(truth) and abs(volume - 1) <= _TOLERANCE * 10)


def _table(scene: Scene, flow: _Flow, units: Vector, wholes: Sequence[Floats]) -> Table:
    """Products of the steps, and the norms of their blocks in the scene's units."""
    nodes, size = len(wholes) + 1, len(flow.constant) + 6
    carried = np.zeros((nodes, nodes, size, size))
    carried[0, 0] = np.eye(size)
    for i, step in enumerate(wholes, start=1):
        carried[i, :i] = step @ carried[i - 1, :i]
        carried[i, i] = np.eye(size)
    return dict(_norms(scene, flow, units, carried))


def _whole(by_momentum: Floats, ends: Floats, d: int) -> Floats:
    """The step on (z, theta, c): a turn of the body moves its later path as a whole."""
    step = np.eye(d + 6)
    step[:, :d] = by_momentum
    if len(ends):
        step[d + 3 :, d : d + 3] = -_cross_matrix(ends[1] - ends[0])
    return step


def _norms(
    scene: Scene, flow: _Flow, units: Vector, carried: Floats
) -> Iterator[tuple[tuple[str, str], Floats]]:
    d = len(flow.constant)
    blocks = ("momentum",) if d == 3 else ("linear_impulse", "angular_impulse")
    places = {name: (slice(3 * j, 3 * j + 3), units[3 * j]) for j, name in enumerate(blocks)}
    if "attitude" in scene.track:
        places["attitude"] = slice(d, d + 3), Fraction(1)
    if "centre" in scene.track:
        places["centre"] = slice(d + 3, d + 6), flow.length
    for into, (columns, unit_in) in places.items():
        for out, (rows, unit_out) in places.items():
            yield (out, into), _spectral(carried[:, :, rows, columns], unit_out / unit_in)
        if d == 3:
            turned = flow.omega @ carried[:, :, :3, columns]
            yield ("omega", into), _spectral(turned, 1 / (flow.time * unit_in))


def _spectral(matrices: Floats, unit: Fraction) -> Floats:
    """The largest singular values, times the unit; inf where an entry is not finite."""
    size = np.abs(matrices).max(axis=(-2, -1), keepdims=True)
    moderate = np.where(np.isfinite(size), matrices, 0.0) / np.where(size > 0, size, 1.0)
    norms = np.linalg.norm(moderate, 2, axis=(-2, -1)) * size[..., 0, 0]
    found = np.ldexp(norms * float(unit / power_of_two(floor_log2(unit))), floor_log2(unit))
    return np.where(np.isfinite(size[..., 0, 0]), found, np.inf)


# The equations, in exact rationals.


def _equations(scene: Scene) -> tuple[Vector, dict[tuple[int, int, int], Fraction], Matrix, Matrix]:
    """z' = constant + the sum of products (i, j, k): c z_j z_k; and Omega, U as rows over z."""
    body = scene.body
    if isinstance(body, RigidBody):
        K = body.inverse_inertia
        return body.moment, _collected(_cross(0, 0, K)), K, ()
    assert isinstance(body, ImmersedBody)
    velocity, omega = body.energy_matrix[:3], body.energy_matrix[3:]
    terms = [*_cross(0, 0, omega), *_cross(3, 3, omega), *_cross(3, 0, velocity)]
    return body.force + body.couple, _collected(terms), omega, velocity


Term = tuple[tuple[int, int, int], Fraction]


def _cross(out: int, left: int, right: Matrix) -> Iterator[Term]:
    """The terms of z_left x (right z), in the rows ``out``, ``out`` + 1, ``out`` + 2."""
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        for column in range(len(right[0])):
            yield (out + i, left + j, column), right[k][column]
            yield (out + i, left + k, column), -right[j][column]


def _collected(terms: Iterable[Term]) -> dict[tuple[int, int, int], Fraction]:
    """One coefficient for z_j z_k and z_k z_j: what cancels is gone before anything is rounded."""
    found: dict[tuple[int, int, int], Fraction] = {}
    for (i, j, k), c in terms:
        key = (i, min(j, k), max(j, k))
        found[key] = found.get(key, Fraction(0)) + c
    return {key: c for key, c in found.items() if c}


def _floats(matrix: Matrix, units: Vector, factor: Fraction) -> Floats:
    scaled = np.array([[c * u * factor for c, u in zip(row, units, strict=True)] for row in matrix])
    return scaled.astype(float)


def _cross_matrix(v: Floats) -> Floats:
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
