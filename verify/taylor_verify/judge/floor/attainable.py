"""The roundoff floor: the error that perfect rounding would leave, for every solver on a rung.

A solver that rounds each component separately makes an error of about +-u r_i(s) in component i in the step
at time s. Here r_i = |x_i| + h S_i(x): the state itself plus the change in a step of length h, where S_i is
the rate with all terms in magnitude (judge.floor.magnitude). The transition matrix Phi of the orbit carries
the error on, so that after N steps

    attainable(t) = u [ sum over steps s and components i of |Phi(t, s) e_i|^2 r_i(s)^2 ]^(1/2).

For a conserved quantity its gradient replaces Phi, because the motion does not change an error of it. This
is a model of independent roundings, not a bound; gates allow a factor for that.

Where steps add nearly the same amount, their roundings are alike and not independent: the k-th step of
such a run counts as 2k - 1 steps, so that k steps count as k^2 (judge.floor.repeats).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from math import log2
from typing import Any, NamedTuple

import numpy as np
from mpmath import mp

from taylor_verify.exact.conditioning.condition import Path, path, transition
from taylor_verify.exact.conditioning.loaded import DIGITS, is_of_run
from taylor_verify.exact.damping import growths, without_damping
from taylor_verify.exact.invariants import Invariant
from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.judge.floor.magnitude import roundings
from taylor_verify.judge.floor.quaternion_length import with_length, with_rounded_length
from taylor_verify.judge.floor.repeats import with_repeats
from taylor_verify.judge.velocities import velocity_forms
from taylor_verify.records.quantities import ROTATION_MATRIX, UNIT_QUATERNION
from taylor_verify.records.reason import Carried, Reason, RoundoffFloor, shown
from taylor_verify.scenes.instants import chosen, evenly
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import precision, to_mpfr
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# The gradient of a conserved quantity is as smooth as the motion: more nodes than this do not change two
# digits of the sum over the steps.
_MOST_NODES = 41
# Below this floor the rounding of the scene's data does not change the orbit's condition noticeably.
_SAME_ORBIT = 1e-3
# A length is written in full if six digits show that it is not 1.
_SHOWN = 1e-4


class _Arcs(NamedTuple):
    """The effects on the momenta at the end of each arc, by time and component.

    They are ``squares`` of rounded samples. A length of q that wanders stays as it is from arc to arc, so
    that its effects add up, and not their squares: ``lengths``.
    """

    squares: Floats
    lengths: Floats


@dataclass(frozen=True)
class Floor:
    """The terms of the roundoff floor of one run.

    The roundings of the steps between two times of the path count at the later time: ``steps_at[k]``
    roundings of size u ``rounded[k]``, by component, in the path's units. ``single`` is this size where
    no rounding is like the one before it. ``carried`` is their accumulated effect, by quantity, without the
    factor u. ``times`` are the times of the samples. With ``velocities`` the solver rounds U and Omega.
    ``longer`` is the orbit with the length of the quaternion, where loads depend on it.
    """

    unit_roundoff: float
    times: Floats
    orbit: Path
    longer: Path
    steps_at: Floats
    rounded: Floats
    single: Floats
    carried: Mapping[str, Floats]
    velocities: bool = False

    def of_state(self, errors: Errors) -> Floats:
        """Return the attainable error at every sample, for the larger part, in the unit of the errors."""
        parts = [
            self.carried[part] * float(mp.convert(self.orbit.units[part]) / scale)
            for part, scale in errors.parts.items()
        ]
        attainable: Floats = self.unit_roundoff * np.max(parts, axis=0)
        return larger_neighbour(attainable, self.orbit.durations, self.times) / errors.sizes

    def of_velocity(self, group: str, errors: Errors, sizes: Floats) -> Floats:
        """Return the error of a velocity that the rounding of x and y, and of the velocity itself, leaves.

        ``sizes`` are those of the velocity over its largest, and ``group`` has its columns.
        """
        (scale,) = errors.parts.values()
        squares = (self.unit_roundoff * sizes) ** 2
        for part, matrix in velocity_forms(self.orbit.scene.body)[group].items():
            norm = np.linalg.norm(np.array(matrix, dtype=float), 2)
            alone = replace(errors, parts={part: scale})
            squares = squares + (norm * self.of_state(alone)) ** 2
        attainable: Floats = np.sqrt(squares)
        return attainable

    @property
    def nodes(self) -> list[int]:
        """Samples at which the gradients of conserved quantities are evaluated."""
        return evenly(len(self.times), _MOST_NODES)

    def of_gradients(self, invariant: Invariant, at_nodes: Motion, scale: Any) -> Floats:
        """Return the attainable drift at every sample, over the ``scale`` of the invariant.

        The motion ``at_nodes`` is in numbers of MPFR.
        """
        nodes = self.nodes
        ends = np.searchsorted(self.orbit.durations, self.times[nodes], side="right")
        injected, steady = np.zeros((2, len(nodes)))
        for block, relative in self._relative(invariant, at_nodes, scale):
            has_arcs = self._has_arcs(block, invariant)
            squares = self._squares(block, has_arcs)
            rounded = np.sqrt(np.diff(squares[ends - 1], axis=0, prepend=0.0))
            # The square of a gradient alone may be beyond the doubles.
            injected += np.sum((np.broadcast_to(relative, rounded.shape) * rounded) ** 2, axis=1)
            if has_arcs:
                sums = np.cumsum(self._arcs.lengths[:, self.orbit.span(block)], axis=0)
                moved = np.diff(sums[ends - 1], axis=0, prepend=0.0)
                steady += np.linalg.norm(np.broadcast_to(relative, moved.shape) * moved, axis=1)
        drift: Floats = self.unit_roundoff * np.hypot(
            np.sqrt(np.cumsum(injected)), np.cumsum(steady)
        )
        return larger_neighbour(drift, self.times[nodes], self.times)

    def of_values(self, invariant: Invariant, at_nodes: Motion, scale: Any) -> Floats:
        """Return the attainable error of the value of an invariant, over the ``scale`` of it.

        The errors of the state reach it; the motion ``at_nodes`` is in numbers of MPFR.
        """
        times, squares = self.times[self.nodes], np.zeros(len(self.nodes))
        for block, relative in self._relative(invariant, at_nodes, scale):
            carried = larger_neighbour(self.carried[block], self.orbit.durations, times)
            squares += (np.linalg.norm(relative, axis=1) * carried) ** 2
        error: Floats = self.unit_roundoff * np.sqrt(squares)
        return larger_neighbour(error, times, self.times)

    def _relative(
        self, invariant: Invariant, at_nodes: Motion, scale: Any
    ) -> Iterator[tuple[str, Floats]]:
        """Yield the gradient of an invariant at the nodes by each block in its unit, over the scale."""
        scene = self.orbit.scene
        elapsed = [scene.clock.elapsed[k] for k in self.nodes]
        with precision():
            (whole,) = to_mpfr(np.array([mp.convert(scale)], dtype=object))
            gradients = invariant.sensitivity(without_damping(scene, at_nodes, elapsed))
            for block, gradient in gradients.items():
                (unit,) = to_mpfr(np.array([mp.convert(self.orbit.units[block])], dtype=object))
                # Divided before conversion to float: the square of a small motion would underflow.
                relative = (gradient * unit / whole).astype(float)
                yield block, relative.reshape(len(self.nodes), -1)

    def terms(self, attainable: Floats, errors: Errors, carried: Carried) -> RoundoffFloor:
        """Return the terms of the floor at the sample of the largest error."""
        worst = int(np.argmax(errors.values))
        reached = self.orbit.durations <= self.times[worst]
        steps = max(1, round(float(np.sum(self.steps_at[reached]))))
        value = float(attainable[worst])
        alike = min(self._alike(reached), steps)
        growth = shown(value / (self.unit_roundoff * (steps * alike) ** 0.5))
        bits = round(-log2(self.unit_roundoff))
        return RoundoffFloor(
            carried, shown(value), bits, steps, growth, alike=alike, velocities=self.velocities
        )

    def lengths(self, excess: Floats, of_matrices: bool) -> tuple[Errors, Floats, Reason]:
        """Return the errors of the length of quaternions or matrices, the attainable error, and its terms.

        ``excess`` (n,) is |q| - 1, or (R^T R - 1)/2. An attitude is read from a quaternion of any length,
        so no other gate depends on the length. A solver that rounds q in every step and never normalises it
        leaves | |q| - 1 | <= u N after N steps, even if all roundings have the same sign.
        """
        name = ROTATION_MATRIX if of_matrices else UNIT_QUATERNION
        errors = Errors(name, "1", np.abs(excess), np.zeros(len(excess)), {})
        elapsed = self.times / (np.max(self.times) or 1.0)
        steps = 1 + float(np.sum(self.steps_at)) * elapsed
        attainable = self.unit_roundoff * steps
        worst = int(np.argmax(errors.values))
        value, count = float(attainable[worst]), round(steps[worst])
        ends = (float(np.min(excess)), float(np.max(excess)))
        extent = " to ".join(dict.fromkeys(_length(end, value) for end in ends))
        bits = round(-log2(self.unit_roundoff))
        carried = Carried.MATRIX if of_matrices else Carried.LENGTH
        terms = RoundoffFloor(carried, shown(value), bits, count, lengths=extent)
        return errors, attainable, Reason(floor=terms)

    def worst(self) -> float:
        """Return the largest attainable error of a momentum, relative to its own size."""
        shares = []
        for k, block in enumerate(self.orbit.blocks):
            if block not in ("attitude", "centre"):
                rows = self.orbit.momentum[:, 3 * k : 3 * k + 3]
                size = float(np.max(np.linalg.norm(rows, axis=1)))
                shares.append(float(np.max(self.carried[block])) / (size or 1.0))
        return self.unit_roundoff * max(shares)

    def _alike(self, reached: Any) -> int:
        """Return the mean number of steps in a row with like roundings, in the component with most."""
        both, single = (
            np.sum(self.steps_at[reached, None] * rows[reached] ** 2, axis=0)
            for rows in (self.rounded, self.single)
        )
        return max(1, round(float(np.max(both[single > 0] / single[single > 0], initial=1.0))))

    def _squares(self, block: str, has_arcs: bool) -> Floats:
        """Return the sums of squared roundings of a block over the steps so far, by component.

        ``has_arcs`` says that it is for a balance, to which the rounded samples at the beginnings of its
        arcs add.
        """
        span = self.orbit.span(block)
        rows = self.rounded[:, span]
        factors = growths(self.orbit.scene, self.orbit.elapsed)
        if factors is not None and block in self.orbit.flow.momenta:
            # With damping, conserved quantities use e^{ct} times the momenta.
            rows = rows * factors.astype(float)[:, None]
        squares = self.steps_at[:, None] * rows**2
        if has_arcs:
            squares = squares + self._arcs.squares[:, span]
        return np.cumsum(squares, axis=0)

    def _has_arcs(self, block: str, invariant: Invariant) -> bool:
        """Return True where a balance of written loads has arcs, and the block is a momentum."""
        has_loads = self.orbit.scene.body.loads is not None
        return has_loads and not invariant.is_conserved and block in self.orbit.flow.momenta

    @cached_property
    def _arcs(self) -> _Arcs:
        """The arcs of a balance: each begins at a sample, and written loads act along it by its errors."""
        orbit, longer = self.orbit, self.longer
        d, own, size = orbit.momentum.shape[1], len(orbit.places), len(longer.places)
        samples, among = set(orbit.scene.clock.elapsed), np.ix_(longer.places, longer.places)
        every = with_rounded_length(self.rounded, longer)
        wander = np.sqrt(np.cumsum(self.steps_at[:, None] * every[:, own:] ** 2, axis=0))
        squares, lengths = np.zeros((2, len(orbit.elapsed), own))
        begin, arc = 0, np.eye(size)
        for k, step in enumerate(longer.carried.steps, start=1):
            arc = step[among] @ arc
            if orbit.elapsed[k] in samples:
                squares[k, :d] = np.sum((arc[:d, :own] * self.single[begin]) ** 2, axis=1)
                lengths[k, :d] = np.abs(arc[:d, own:]) @ wander[begin]
                begin, arc = k, np.eye(size)
        return _Arcs(squares, lengths)


def _length(excess: float, roundings: float) -> str:
    """Return the length 1 + excess as text, with the digits that distinguish it from 1."""
    if abs(excess) <= roundings:
        return "1"
    return f"{1 + excess:.6g}" if abs(excess) > _SHOWN else f"1{excess:+.2g}"


def larger_neighbour(values: Floats, nodes: Floats, places: Floats) -> Floats:
    """Return a value for each place: between two nodes the larger of their values."""
    later = np.searchsorted(nodes, places)
    earlier = np.searchsorted(nodes, places, side="right") - 1
    last = len(nodes) - 1
    return np.maximum(values[np.minimum(later, last)], values[np.maximum(earlier, 0)])


def floor(
    given: Scene, asked: Scene, unit_roundoff: Fraction, steps: int, velocities: bool = False
) -> Floor:
    """Return the floor for a run of ``steps`` steps on the rounded scene ``given``.

    With ``velocities`` each step rounds U and Omega of a solid in a fluid, and not its impulses.

    The condition of the orbit is computed once for all rungs, from the scene ``asked``. Only if the
    rounding of the data moves the orbit too much, or where it comes with the exact motion, is it computed
    from the rounded scene.
    """
    # Every row has at least one rounding.
    count = max(steps, len(given.clock.instants))
    bits = unit_roundoff.denominator.bit_length() - 1
    for orbit in _orbits(given, asked, bits):
        steps_at = _steps_at(orbit.elapsed, count)
        single = roundings(given, orbit, bits, count, velocities)
        rounded = with_repeats(single, orbit, steps_at, count, bits)
        rounded = _at_instants(rounded, orbit, steps_at)
        longer = with_length(orbit)
        every = with_rounded_length(rounded, longer)
        result = Floor(
            unit_roundoff=float(unit_roundoff),
            times=np.array([abs(float(t)) for t in orbit.scene.clock.elapsed]),
            orbit=orbit,
            longer=longer,
            steps_at=steps_at,
            rounded=rounded,
            single=single,
            carried=longer.gathered(every * np.sqrt(steps_at)[:, None]),
            velocities=velocities,
        )
        if result.worst() <= _SAME_ORBIT:
            break
    return result


def _orbits(given: Scene, asked: Scene, bits: int) -> Iterator[Path]:
    yield orbit_of_run(given, asked, bits)
    if not is_of_run(given):
        yield orbit_of(given)


def orbit_of_run(given: Scene, asked: Scene, bits: int) -> Path:
    """Return the orbit of a run on a rung of ``bits`` bits, of the rounded scene ``given``.

    Without closed form it comes with the exact motion of this scene. Elsewhere it is that of the scene
    ``asked``, which all rungs share.
    """
    return orbit_of(given, truth_digits(bits)) if is_of_run(given) else orbit_of(asked)


@lru_cache(maxsize=32)
def orbit_of(scene: Scene, digits: int = DIGITS) -> Path:
    """Return the orbit of a scene and its condition, computed once for all that ask."""
    return path(scene, digits)


def radians(orbit: Path) -> float:
    """Return the angle that the fastest rate of an orbit covers by its end."""
    rates = orbit.flow.rate(orbit.momentum) / float(orbit.flow.time)
    times = orbit.durations
    if orbit.scene.body.loads is not None and len(times) > 1:
        # What the loads do to the momenta, over their largest size.
        size = np.max(np.linalg.norm(orbit.momentum, axis=1)) or 1.0
        pushed = np.linalg.norm(np.gradient(orbit.momentum, times, axis=0), axis=1) / size
        rates = np.maximum(rates, pushed)
    return float(np.sum(np.maximum(rates[1:], rates[:-1]) * np.diff(times)))


def looked_at(orbit: Path) -> list[int]:
    """Return the samples at which the floor is computed: many or all if the orbit has short passages."""
    points = set(orbit.elapsed)
    return [k for k, t in enumerate(orbit.scene.clock.elapsed) if t in points]


@lru_cache(maxsize=8)
def condition(scene: Scene) -> Path:
    """Return the transition matrices along the scene's orbit, between evenly chosen samples."""
    return transition(scene, chosen(scene.clock.elapsed, _MOST_NODES))


def _at_instants(rounded: Floats, orbit: Path, steps_at: Floats) -> Floats:
    """Return the roundings with those of held values at their instants alone, and not in each step."""
    loads = orbit.scene.body.loads
    if loads is None or not loads.held_states:
        return rounded
    result, times = rounded.copy(), orbit.durations
    counts = {state.name: np.zeros(len(times)) for state in loads.held_states}
    for instant in loads.instants(orbit.elapsed[-1]):
        # Two times that are one in float64 have no step between them.
        later = np.flatnonzero((times >= float(instant.time)) & (steps_at > 0))
        # The derivative leads on from what was there before a value is taken at the start.
        places = later[: 1 + (instant.time == 0)] if len(later) else np.flatnonzero(steps_at)[-1:]
        for name in instant.names:
            counts[name][places] += 1
    for name, count in counts.items():
        in_step = count / np.where(steps_at > 0, steps_at, 1.0)
        result[:, orbit.span(name)] *= np.sqrt(in_step)[:, None]
    return result


def _steps_at(elapsed: Sequence[Fraction], steps: int) -> Floats:
    """Return the number of steps between consecutive times, in proportion to time; one at the start."""
    span = elapsed[-1] or Fraction(1)
    shares = np.diff([float(t / span) for t in elapsed], prepend=0.0)
    steps_at: Floats = shares * steps
    steps_at[0] = 1.0
    return steps_at
