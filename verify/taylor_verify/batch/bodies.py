"""Verdicts on many bodies at once, the same for each body as those of `run`.

On float64, free rigid bodies in their principal axes are posed, solved and judged together. All other
scenes, and bodies that come near a bound, go through `run` one by one.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from time import perf_counter
from typing import Any, Final

import numpy as np

from taylor_verify.exact.euler.tops import Tops
from taylor_verify.judge.bodies.floor import floors
from taylor_verify.judge.bodies.measured import measured
from taylor_verify.judge.bodies.verdicts import Run, are_unit, gates, verdicts
from taylor_verify.models.bodies import Bodies, Numbers, is_of_kind, numbers
from taylor_verify.models.times import TypedTimes, rounded_times
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.instants import EquallySpaced
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.pairs import Pairs
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify.solvers.taylor.lanes import propagate
from taylor_verify.solvers.taylor.numbers import unavailable
from taylor_verify.solvers.trajectory import Outcome

_RUNG: Final = "f64"
# This many samples at once fit into the caches of a processor.
_SAMPLES: Final = 2**15
_MOST_SAMPLES: Final = 4096

Floats = np.ndarray[Any, np.dtype[np.float64]]


def judges_together(solver: str, rung: str) -> bool:
    """Return True if some bodies of this solver and rung are judged together, with other roundings."""
    return solver == TAYLOR and rung == _RUNG and not unavailable(rung_named(rung))


def judged(scenes: Sequence[Scene], solver: str = TAYLOR, rung: str = _RUNG) -> list[list[Verdict]]:
    """Return the verdicts of each scene by a solver on a rung, in the order of the scenes.

    Statuses and quantities equal those of `run`; numbers that depend on roundings may differ.
    Raises ValueError for a name that is no solver or no rung.
    """
    together: dict[int, list[Verdict]] = {}
    if judges_together(solver, rung):
        for group in _alike(scenes):
            for places, bodies in group.pieces():
                # Values that are not finite stay within their body, and enter no verdict.
                with np.errstate(all="ignore"):
                    together |= _judged_together(scenes, places, bodies)
    return [
        together[k] if k in together else list(run(scene, solver, rung).verdicts)
        for k, scene in enumerate(scenes)
    ]


def _alike(scenes: Sequence[Scene]) -> Iterator[_Group]:
    """Yield the scenes that can be judged together, with samples at the same parts of the time."""
    groups: defaultdict[Any, _Group] = defaultdict(_Group)
    known: dict[int, tuple[Floats, Any]] = {}
    for place, scene in enumerate(scenes):
        clock = scene.clock
        if not is_of_kind(scene) or not 1 < len(clock.instants) <= _MOST_SAMPLES:
            continue
        if id(clock) not in known:
            known[id(clock)] = _times(clock), _rhythm(clock)
        times, rhythm = known[id(clock)]
        try:
            rounded = numbers(scene)
        except OverflowError:
            continue
        if len(times):
            group = groups[rhythm, times[-1] > 0, scene.track]
            group.places.append(place)
            group.numbers.append(rounded)
            group.times.append(times)
            group.is_turned = bool(scene.track)
    yield from groups.values()


def _times(clock: Clock) -> Floats:
    """Return the times since the start, each rounded once; none if they do not lead away from it."""
    try:
        rounded = rounded_times(clock, Fraction(1), rung_named(_RUNG))
    except OverflowError:
        return np.empty(0)
    times = rounded.typed if isinstance(rounded, TypedTimes) else np.array(rounded, dtype=float)
    leads_away = times[0] * times[-1] >= 0 and (np.diff(abs(times)) > 0).all()
    return times if leads_away else np.empty(0)


def _rhythm(clock: Clock) -> Any:
    """Return a key that is equal for clocks with samples at the same fractions of their last times."""
    if isinstance(clock.instants, EquallySpaced) and clock.instants.first == clock.start:
        return len(clock.instants)
    return tuple(elapsed / clock.elapsed[-1] for elapsed in clock.elapsed)


@dataclass
class _Group:
    """Scenes by their places, with the numbers and the times of each."""

    places: list[int] = field(default_factory=list)
    numbers: list[Numbers] = field(default_factory=list)
    times: list[Floats] = field(default_factory=list)
    is_turned: bool = False

    def pieces(self) -> Iterator[tuple[list[int], Bodies]]:
        """Yield the bodies with their places, as many at once as fit into the caches."""
        most = max(1, _SAMPLES // len(self.times[0]))
        for begin in range(0, len(self.places), most):
            piece = slice(begin, begin + most)
            rows = zip(*self.numbers[piece], strict=True)
            inverse, momentum, attitude = (np.array(values).T for values in rows)
            times = np.array(self.times[piece])
            bodies = Bodies(inverse, momentum, times, attitude if self.is_turned else None)
            chosen = np.flatnonzero(bodies.are_moderate)
            yield [self.places[begin + k] for k in chosen], bodies.at(chosen)


def _judged_together(
    scenes: Sequence[Scene], places: Sequence[int], bodies: Bodies
) -> dict[int, list[Verdict]]:
    """Return the verdicts of scenes, by place, that are far from every bound."""
    began = perf_counter()
    lanes = propagate(bodies)
    seconds = (perf_counter() - began) / max(len(bodies), 1)
    ended = [k for k, outcome in enumerate(lanes.outcomes) if outcome is Outcome.FINISHED]
    if not ended:
        return {}
    bodies, answer, steps = bodies.at(ended), lanes.rows[:, ended], lanes.steps[ended]
    places_of_finished = [places[k] for k in ended]
    elapsed = scenes[places_of_finished[0]].clock.elapsed
    samples, rung = tuple(time / elapsed[-1] for time in elapsed), rung_named(_RUNG)
    roundoff = float(rung.unit_roundoff)
    tops = Tops(bodies.scaled_inverse, Pairs(bodies.starts[:3]), bodies.quaternion)
    compared = measured(tops, answer, bodies.grid)
    base = floors(tops, bodies.grid[:, -1], steps, samples)
    all_gates = gates(compared, base, tops.inverse, roundoff)
    conditions = [base.is_known, *(shifts.is_first_order for shifts in compared.shifts)]
    conditions += [gate.is_far for gate in all_gates]
    if compared.excess is not None:
        conditions.append(are_unit(compared.excess, base, roundoff))
    stands = np.logical_and.reduce(conditions)
    what = Run(TAYLOR, rung, bodies.times, bodies.time, steps, lanes.order, seconds)
    asked = {k: scenes[places_of_finished[k]] for k in np.flatnonzero(stands).tolist()}
    rows = verdicts(what, asked, all_gates, compared, base)
    return {places_of_finished[k]: row for k, row in rows.items()}
