"""How errors travel along an orbit, by steps of its tangent flow in float64.

The flow is integrated from one node to the next along a motion that starts at the truth, and that has
to arrive at it: where float64 cannot follow the orbit that far there is no answer. A product of such
steps leads from any node to any later one; nothing is inverted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from typing import Final, NamedTuple

import numpy as np
from mpmath import mp

from taylor_verify.exact import clocks
from taylor_verify.exact.conditioning.looks import refined
from taylor_verify.exact.conditioning.tangent import Arcs, Floats, Flow, cross_matrix, followed
from taylor_verify.exact.solution import Solution
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.precision import floor_log2, power_of_two
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Vector

Table = dict[tuple[str, str], Floats]

# Norms are wanted to a digit or two: a motion that misses the truth by this part of its size, or a
# step that changes volume by it, is not what was asked about.
_TOLERANCE: Final = 1e-4
# Between two nodes the motion is set back to the truth this often, where once is not enough.
_PARTS: Final = 4
# A ten-thousandth of the tolerance. The better of the two evaluations that agree to these digits has
# some more, if the orbit leaves them, and so starts the motion with what float64 holds.
_TRUTH_DIGITS: Final = 8
_FLOAT_DIGITS: Final = 20


def transition_table(
    scene: Scene, exact: Solution, units: Vector, elapsed: Sequence[Fraction]
) -> Table | None:
    """The norms of condition.Transition, or None where float64 does not follow the orbit.

    ``units`` are powers of two near the size of each component of the momentum.
    """
    flow = Flow.of(scene, units)
    found = _integrated(scene, exact, flow, units, elapsed)
    if found is None:
        return None
    with np.errstate(all="ignore"):
        return _table(scene, flow, units, found[0])


class Stepped(NamedTuple):
    """The steps from each time to the next, and the motion at the times, in units.

    ``steps`` (n - 1, d + 6, d + 6) act on (z, theta, c); ``momentum`` (n, d) is z, ``centre`` (n, 3)
    counts from its start and has no rows if it is not tracked; ``omega`` (3, d) makes Omega of z.
    ``time`` and ``length`` are the units that are not given.
    """

    steps: Floats
    momentum: Floats
    centre: Floats
    omega: Floats
    time: Fraction
    length: Fraction


def stepped(
    scene: Scene, exact: Solution, units: Vector, elapsed: Sequence[Fraction], more_digits: int = 0
) -> Stepped | None:
    """The steps between these times, or None; ``more_digits`` of the truth keep its small components."""
    flow = Flow.of(scene, units)
    found = _integrated(scene, exact, flow, units, elapsed, more_digits)
    if found is None:
        return None
    steps, samples = found
    return Stepped(steps, samples.momentum, samples.centre, flow.omega, flow.time, flow.length)


def resolved(scene: Scene, units: Vector, momentum: Floats) -> float:
    """The rate that a step from this momentum (d; in units) resolves, per unit of the scene's time."""
    flow = Flow.of(scene, units)
    return float(flow.rate(momentum)) / float(flow.time)


def fastest(scene: Scene, units: Vector, momenta: Floats) -> float:
    """The largest norm of J along a motion (n, d; in units), per unit of the scene's time."""
    flow = Flow.of(scene, units)
    norms = np.linalg.norm(flow.jacobian(momenta), 2, axis=(-2, -1))
    return float(max(norms)) / float(flow.time)


@dataclass(frozen=True)
class _Samples:
    """The truth at the points: momentum in units (n, d), R (n, 3, 3) and the centre in lengths (n, 3).

    What is not tracked has no rows. ``clock`` (n, m) is w.
    """

    clock: Floats
    momentum: Floats
    attitude: Floats
    centre: Floats

    def every(self, step: int) -> _Samples:
        return _Samples(*(rows[::step] for rows in vars(self).values()))


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


def _integrated(
    scene: Scene,
    exact: Solution,
    flow: Flow,
    units: Vector,
    elapsed: Sequence[Fraction],
    more_digits: int = 0,
) -> tuple[Floats, _Samples] | None:
    """The steps on (z, theta, c) from each of these times to the next, and the truth there.

    The motion is set back to the truth at these times, and where it misses it so, between them too.
    """
    for parts in (1, _PARTS):
        points = refined(elapsed, parts)
        truth = exact.motion(points, _TRUTH_DIGITS + more_digits)
        with np.errstate(all="ignore"):  # what overflows is not finite, and then there is no answer
            samples = _samples(scene, points, truth, units, flow.length)
            steps = _steps(flow, samples, np.array([float(t / flow.time) for t in points]))
        if steps is not None:
            return _wholes(steps, parts), samples.every(parts)
    return None


def _steps(flow: Flow, samples: _Samples, times: Floats) -> Floats | None:
    """The steps on (z, theta, c) from point to point: a turn of the body moves its later path too."""
    R = samples.attitude if len(samples.attitude) else np.tile(np.eye(3), (len(times), 1, 1))
    arcs = Arcs.begun(samples.clock[:-1], samples.momentum[:-1], R[:-1])
    reached = followed(flow, arcs, np.diff(times))
    if reached is None or not _arrive(reached, samples.momentum[1:]):
        return None
    d = len(flow.constant)
    steps = np.tile(np.eye(d + 6), (len(times) - 1, 1, 1))
    parts = (reached.by_momentum, reached.turn, reached.shift)
    steps[:, :, :d] = np.concatenate(parts, axis=1)
    if len(samples.centre):
        steps[:, d + 3 :, d : d + 3] = -cross_matrix(np.diff(samples.centre, axis=0))
    return steps


def _wholes(steps: Floats, parts: int) -> Floats:
    """Products of so many steps each."""
    return reduce(lambda done, part: part @ done, (steps[k::parts] for k in range(parts)))


def _arrive(reached: Arcs, truth: Floats) -> bool:
    """Whether the arcs came to the truth, and their steps conserve volume as the flow does."""
    missed = np.linalg.norm(reached.momentum - truth, axis=1)
    volume = np.linalg.det(reached.by_momentum)
    close = missed <= _TOLERANCE * np.linalg.norm(truth, axis=1)
    return bool((close & (abs(volume - 1) <= _TOLERANCE * 10)).all())


def _table(scene: Scene, flow: Flow, units: Vector, wholes: Floats) -> Table:
    """Products of the steps, and the norms of their blocks in the scene's units."""
    nodes, size = len(wholes) + 1, len(flow.constant) + 6
    carried = np.zeros((nodes, nodes, size, size))
    carried[0, 0] = np.eye(size)
    for i, step in enumerate(wholes, start=1):
        carried[i, :i] = step @ carried[i - 1, :i]
        carried[i, i] = np.eye(size)
    return dict(_norms(scene, flow, units, carried))


def _norms(
    scene: Scene, flow: Flow, units: Vector, carried: Floats
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
