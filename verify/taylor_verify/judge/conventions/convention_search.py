"""Search for a file's conventions: hypotheses are compared with the exact motion, the simplest one wins.

A hypothesis about the whole file is a *world*: a body as the file's author may have understood it, a
map of time, and names of axes. In each world every group of columns has several readings. The result is
the world and the readings with the fewest departures among those with the smallest error. They must leave
at most a hundredth of the error of the scene's own conventions, in every group and in every tested row,
the first row included. If two equally simple hypotheses leave equally little, the file cannot decide
between them, and neither is taken.

The first rows decide, because even a poor answer is still correct there. Some conventions show only later,
for example space axes of a body that starts aligned with them, so longer beginnings are tested too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from math import ceil, inf
from operator import attrgetter
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.rates import float_flow
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Solution, Unsettled
from taylor_verify.judge.conventions.axis_orders import AXES, Axes, Frames, renamings
from taylor_verify.judge.conventions.fits import (
    AS_WELL,
    EXPLAINS,
    FLOAT64,
    BestReading,
    Conventions,
    Fit,
    findings_of,
    simplest,
)
from taylor_verify.judge.conventions.meanings import readings, rotations
from taylor_verify.judge.conventions.worlds import World, worlds
from taylor_verify.judge.errors.quick_motion import QuickMotion
from taylor_verify.judge.velocities import velocities
from taylor_verify.models.problem import NotRepresentable, adopt
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.quantities import COLUMNS, GROUPS, TRACKED
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.files.stated_step import step_of_rows

Array = np.ndarray[Any, Any]
Floats = np.ndarray[Any, np.dtype[np.float64]]
# Rows, and the motion there.
_Truth = tuple[list[int], dict[str, Floats]]

# Errors below this many units of roundoff, of the rung or of float64, count as equal.
_NOISE_ROUNDOFFS: Final = 64
# The shortest beginning is the start and one step: an answer without a gyroscopic term is correct to a
# hundredth only there. Then a few steps, and beginnings that are this many times longer each time. The
# longest beginning is half of the file.
_FEWEST_ROWS: Final = 2
_FIRST_ROWS: Final = 5
_LONGER: Final = 8
_FEW_ROWS: Final = 12
# Number of evenly chosen rows that represent a beginning.
_MOST_ROWS: Final = 24
_DIGITS: Final = 20
# The matrices P^T of all renamings, for rows v of which v P^T is P v.
_RENAMING: Final = np.array([axes.vectors(np.eye(3)) for axes in AXES])
# For a hypothesis the Taylor route goes at most this many spans of the scene.
MOST_SPANS: Final = 10


@np.errstate(over="ignore", invalid="ignore")  # an answer may diverge
def conventions(file: TrajectoryFile, scene: Scene, rung: Rung) -> Conventions:
    """Return the conventions of a file whose groups can be compared with the scene.

    Raises Unsettled if there is no exact motion, and NotRepresentable if the rung cannot represent the
    scene.
    """
    parts = beginnings(file)
    every = _Search(file, scene, rung, tuple(sorted({k for rows in parts for k in rows})))
    searches = [_Search(file, scene, rung, rows, every) for rows in parts]
    if not searches or searches[-1].is_explained:
        return Conventions((), World(scene), {})
    # Shorter beginnings come first, and max takes the first of equal ranks.
    return max((search.conventions() for search in searches), key=attrgetter("rank"))


@lru_cache(maxsize=8)
def _solved(scene: Scene, rung: Rung) -> tuple[Scene, Solution]:
    given = adopt(scene, rung, scene.clock.instants).given
    return given, solution(given)


def attitudes_at(file: TrajectoryFile, scene: Scene, rung: Rung, rows: tuple[int, ...]) -> Floats:
    """Return the exact attitudes at some rows of a file, in doubles; NaN where they are out of reach."""
    near, truth = _Search(file, scene, rung, rows).own_truth
    attitudes = np.full((len(rows), 3, 3), np.nan)
    attitudes[near] = truth["attitude"] if near else attitudes[near]
    return attitudes


def beginnings(file: TrajectoryFile) -> list[tuple[int, ...]]:
    """Return the finite rows of longer and longer beginnings of a file, the shortest first."""
    finite = np.flatnonzero(file.finite).tolist()
    longest = min(max(ceil(len(finite) / 2), _FEW_ROWS), len(finite))
    lengths, length = [_FEWEST_ROWS] if longest > _FEWEST_ROWS else [], _FIRST_ROWS
    while length < longest:
        lengths.append(length)
        length *= _LONGER
    counts = [count for count in (*lengths, longest) if count]
    return [tuple(finite[k] for k in evenly(count, _MOST_ROWS)) for count in counts]


@dataclass(frozen=True)
class _Search:
    """Some rows of the file as floats, for comparison with the exact motion in any world.

    In the scene's own world the exact motion is that of ``every`` row of all beginnings.
    """

    file: TrajectoryFile
    scene: Scene
    rung: Rung
    rows: tuple[int, ...]
    every: _Search | None = None

    def conventions(self) -> Conventions:
        """Return the conventions that these rows show."""
        if self.is_explained:
            return Conventions((), World(self.scene), {})
        # Every body and clock that can be tested here, the scene's own first.
        others = [w for w in worlds(self.scene, self.file.times) if self._may_explain(w)]
        own = self._fits(World(self.scene), self.own_truth)
        tried = (*own, *(fit for w in others for fit in self._fits(w, self._truth(w))))
        fits = [self.plain, *(fit for fit in tried if fit.explains(self.plain, self.noise))]
        return findings_of(self.plain, *simplest(fits, self.noise), self.spacing)

    @property
    def noise(self) -> float:
        return _NOISE_ROUNDOFFS * max(float(self.rung.unit_roundoff), FLOAT64)

    @property
    def is_explained(self) -> bool:
        """True if the scene's own conventions leave no error that others could explain."""
        return self.plain.worst <= self.noise / EXPLAINS

    @cached_property
    def spacing(self) -> Fraction | None:
        """The spacing of the rows of the file, unless it is one; None where they are not equally spaced."""
        times, even = self.file.times, step_of_rows(self.file.times)
        mean = (times[-1] - times[0]) / max(len(times) - 1, 1)
        return mean if even and mean not in (0, 1) else None

    @cached_property
    def plain(self) -> Fit:
        """Best readings in the scene's own world."""
        return self._fits(World(self.scene), self.own_truth, (Frames(),))[0]

    @cached_property
    def values(self) -> dict[str, Floats]:
        return {group: rows.doubles(self.rows) for group, rows in self.file.groups.items()}

    @cached_property
    def frames(self) -> tuple[Frames, ...]:
        """Renamings of axes that can be seen in the file; none under written loads, which have axes."""
        if self.scene.body.loads is not None:
            return (Frames(),)
        active: dict[str, set[int]] = {"body": set(), "space": set()}
        vectors = [group for group in self.values if not GROUPS[group].is_frame]
        for group in vectors:
            columns = set(np.flatnonzero(np.any(self.values[group], axis=0)).tolist())
            active["space"] |= columns
            active["body"] |= columns if GROUPS[group].moves_with == "body" else set()
        has_attitude = len(vectors) < len(self.values)
        if has_attitude:
            active = {"body": {0, 1, 2}, "space": {0, 1, 2}}
        is_placed = any(GROUPS[group].moves_with == "space" for group in vectors)
        joined = has_attitude or (is_placed and len(vectors) > 1)
        return tuple(renamings(active["body"], active["space"], joined))

    def solution(self, world: World) -> tuple[Scene, Solution]:
        """Return the rounded scene of a world at the file's rows, and its solution with the attitude."""
        track = {"attitude", *(GROUPS[group].quantity for group in self.file.groups)}
        track &= set(TRACKED[self.scene.model])
        asked = replace(world.scene, track=frozenset(track))
        times = world.times(self.file.times[k] for k in self.rows)
        if asked.body.loads is not None:
            given = adopt(asked, self.rung, times).given
            return given, solution(given)
        # Of a body without written loads one solution serves all times.
        given, exact = _solved(asked, self.rung)
        return replace(given, clock=Clock(given.clock.start, times)), exact

    def _fits(self, world: World, known: _Truth, frames: Sequence[Frames] = ()) -> list[Fit]:
        """Return the best readings in a world whose motion is known, under each of ``frames``.

        Without these, only renamings that leave no group unexplained are used.
        """
        near, truth = known
        only = [group for group in self.values if not GROUPS[group].is_frame]
        columns = COLUMNS[only[0]] if len(only) == len(self.values) == 1 else ()
        fits = []
        for renamed in frames or self._unrefuted(truth, near):
            groups: dict[str, BestReading] = {}
            for group in self.values:
                groups[group] = read = self._best(group, truth, near, renamed)
                if not frames and not read.is_explained(self.plain.groups[group], self.noise):
                    break
            else:
                words = renamed.words(columns)
                fits.append(Fit(replace(world, frames=renamed, axes_words=words), groups))
        return fits

    def _unrefuted(self, truth: Mapping[str, Floats], near: Sequence[int]) -> Iterator[Frames]:
        """Yield the renamings of axes, without most of those that leave a group of vectors unexplained."""
        possible = [
            self._axes(group, truth, near)
            for group in self.values
            if near and not GROUPS[group].is_frame
        ]
        for frames in self.frames:
            if all(frames.body in body or frames.space in space for body, space in possible):
                yield frames

    def _axes(
        self, group: str, truth: Mapping[str, Floats], near: Sequence[int]
    ) -> tuple[set[Axes], set[Axes]]:
        """Return the axes of the body, and those of space, that some reading of vectors may have."""
        columns, right, R = self.values[group][list(near)], truth[group], truth["attitude"]
        enough = self.plain.groups[group].explained(_motion(group, right), self.noise)
        most, size = 2 * enough, _largest(right) or 1.0
        of_body, of_space = set[Axes](), set[Axes]()
        is_placed = GROUPS[group].moves_with == "space"
        for reading in readings(group, Frames(), self.spacing):
            vectors, known = reading.read(columns, R), right
            if reading.in_space:
                vectors, known = (np.einsum("nij,nj->ni", R, rows) for rows in (vectors, right))
            axes = of_space if reading.in_space or is_placed else of_body
            apart = np.max(np.linalg.norm(vectors @ _RENAMING - known, axis=2), axis=1)
            # NaN refutes nothing.
            axes |= {each for each, far in zip(AXES, apart > most * size, strict=True) if not far}
        return of_body, of_space

    @cached_property
    def own_truth(self) -> _Truth:
        """The rows within reach in the scene's own world, and the exact motion there."""
        if self.every is None:
            return self._truth(World(self.scene))
        near, truth = self.every.own_truth
        place = {self.every.rows[k]: i for i, k in enumerate(near)}
        rows = [k for k, row in enumerate(self.rows) if row in place]
        some = [place[self.rows[k]] for k in rows]
        return rows, {name: part[some] for name, part in truth.items()}

    def _may_explain(self, world: World) -> bool:
        """Return False for a world that is not possible, or whose motion in float64 explains nothing."""
        try:
            given, exact = self.solution(world)
        except NotRepresentable:
            return False
        span = max(abs(t) for t in self.scene.clock.elapsed)
        reach = max((abs(t) for t in given.clock.elapsed), default=Fraction(0))
        if reach > MOST_SPANS * span and (world.scale != 1 or exact.route == "taylor"):
            return False
        if exact.route != "taylor":
            return True
        if given.body.loads is not None:
            return True
        flow, first = float_flow(given), exact.evaluate([Fraction(0)], _DIGITS)
        states = QuickMotion(flow, first, np.zeros(1)).at(flow.times(given.clock.elapsed))
        if states is None:
            return True
        quick = flow.quantities(states)
        known = list(range(len(self.rows))), self._with_velocities(given, quick)
        fits = self._fits(world, known)
        return any(fit.explains(self.plain, self.noise) for fit in fits)

    def _with_velocities(self, given: Scene, truth: Mapping[str, Any]) -> dict[str, Floats]:
        """Return the motion in doubles, with the velocities of a body in a fluid."""
        if given.body.has_velocities:
            with mp.workdps(_DIGITS):
                truth = {**truth, **velocities(given.body, truth)}
        return {name: rows.astype(float) for name, rows in truth.items()}

    def _truth(self, world: World) -> _Truth:
        """Return the rows within reach in a world, and the exact motion there."""
        given, exact = self.solution(world)
        reach = MOST_SPANS * max(abs(t) for t in self.scene.clock.elapsed)
        elapsed = given.clock.elapsed
        near = [k for k, t in enumerate(elapsed) if exact.route != "taylor" or abs(t) <= reach]
        try:
            truth = exact.evaluate([elapsed[k] for k in near], _DIGITS) if near else {}
        except Unsettled:
            return [], {}
        return near, self._with_velocities(given, truth) if near else {}

    def _best(
        self, group: str, truth: Mapping[str, Floats], near: Sequence[int], frames: Frames
    ) -> BestReading:
        known = readings(group, frames, self.spacing)
        if not near:
            return BestReading(known[0], error=1.0, plain=1.0, motion=0.0, others=())
        columns = self.values[group][list(near)]
        right = truth["attitude" if GROUPS[group].is_frame else group]
        # A row out of reach of this world cannot be confirmed.
        beyond, errors = 1.0 if len(near) < len(self.rows) else 0.0, []
        for reading in known:
            values = reading.read(columns, truth["attitude"])
            values = rotations(values) if group == "quaternion" else values
            error = max(_distance(group, values, right), beyond)
            if reading.is_factor and error > self.noise and _has_another(values, right, error):
                error = inf
            errors.append(error)
        enough = AS_WELL * max(min(errors), self.noise)
        good = [(r, e) for r, e in zip(known, errors, strict=True) if e <= enough]
        cost = good[0][0].cost
        alike = [reading for reading, _ in good if reading.cost == cost]
        motion = _motion(group, right)
        return BestReading(alike[0], good[0][1], errors[0], motion, tuple(alike[1:]))


# The errors of the groups.


def _distance(group: str, values: Floats, right: Floats) -> float:
    """Return the largest distance over the rows, relative to the largest vector (absolute if all are zero).

    For a frame turned by a small angle this is the angle. Infinite if any value is not finite.
    """
    largest = _largest(values - right)
    if not largest < inf:
        return inf
    size = np.sqrt(2) if GROUPS[group].is_frame else _largest(right) or 1.0
    # Beyond doubles both may be infinite: then no reading is correct.
    return float(largest / size) if size < inf else inf


def _motion(group: str, right: Floats) -> float:
    """Return the distance that the exact motion goes over the rows."""
    return _distance(group, np.broadcast_to(right[0], right.shape), right)


def _has_another(values: Floats, right: Floats, error: float) -> bool:
    """Return True if the values that a unit's factor made are right by a further factor, near 1 or not."""
    factor = np.sum(values * right) / np.sum(values * values)
    left = _largest(factor * values - right) / (_largest(right) or 1.0)
    return bool(left * AS_WELL < error)


def _largest(rows: Floats) -> float:
    """Return the largest norm of a row."""
    flat = rows.reshape(len(rows), -1)
    return float(np.sqrt(np.einsum("ij,ij->i", flat, flat).max()))
