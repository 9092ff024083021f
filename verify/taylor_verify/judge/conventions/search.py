"""Finding out conventions: hypotheses tried on the exact motion, and the simplest one that explains.

A hypothesis about the whole file is a *world*: a body as the file's author may have understood it, a
map of time, and names of axes. In each world every group of columns has its readings. The finding is
the world and the readings with the fewest departures whose error is as small as any. They leave a
hundredth of the error of the scene's own conventions, in every group and in every row that is looked
at, the first among them. Where two that are equally simple leave equally little, the file cannot tell
them apart, and neither is taken.

The first rows decide, for there even a poor answer is still right. A convention that shows only after
a while, such as space axes of a body that starts in line with them, is tried on longer beginnings too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, inf
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Solution, Unsettled
from taylor_verify.judge.conventions.axes import Frames, renamings
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
from taylor_verify.judge.conventions.readings import readings, rotations
from taylor_verify.judge.conventions.worlds import World, worlds
from taylor_verify.judge.velocities import has_velocities, velocities
from taylor_verify.models.problem import NotRepresentable, adopt
from taylor_verify.records.quantities import COLUMNS, GROUPS, TRACKED
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile

Array = np.ndarray[Any, Any]
Floats = np.ndarray[Any, np.dtype[np.float64]]

# Errors of so many units of roundoff, or of float64's, are not told apart.
_NOISE_ROUNDOFFS: Final = 64
# The start and one step, which is all that is right to a hundredth without a gyroscopic term; then a few
# steps, and beginnings so many times as long each. The longest one is half of the file.
_FEWEST_ROWS: Final = 2
_FIRST_ROWS: Final = 5
_LONGER: Final = 8
_FEW_ROWS: Final = 12
# So many rows, evenly chosen, stand for a beginning.
_MOST_ROWS: Final = 24
_DIGITS: Final = 20
# The Taylor route is not sent further than this many spans of the scene for a hypothesis.
_MOST_SPANS: Final = 10


@np.errstate(over="ignore", invalid="ignore")  # an answer may run away
def conventions(file: TrajectoryFile, scene: Scene, rung: Rung) -> Conventions:
    """Return the conventions of a file of groups that the scene can be compared with.

    Raises Unsettled where there is no exact motion, and NotRepresentable where the rung cannot hold
    the scene.
    """
    searches = [_Search(file, scene, rung, rows) for rows in _beginnings(file)]
    if not searches or searches[-1].is_explained:
        return Conventions((), World(scene), {})
    # Of two beginnings that tell as much the shorter one comes first, and max takes the first.
    return max((search.conventions() for search in searches), key=lambda found: found.rank)


def _beginnings(file: TrajectoryFile) -> list[tuple[int, ...]]:
    """Finite rows of ever longer beginnings of a file, the shortest first."""
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
    """Some rows of the file as floats, beside the exact motion in any world."""

    file: TrajectoryFile
    scene: Scene
    rung: Rung
    rows: tuple[int, ...]

    def conventions(self) -> Conventions:
        """Return the conventions that these rows tell."""
        if self.is_explained:
            return Conventions((), World(self.scene), {})
        # Every body and clock that can be tried here, the scene's own first.
        others = [w for w in worlds(self.scene, self.file.times) if self._is_possible(w)]
        tried = (fit for world in (World(self.scene), *others) for fit in self.fits(world))
        fits = [self.plain, *(fit for fit in tried if fit.explains(self.plain, self.noise))]
        return findings_of(self.plain, *simplest(fits, self.noise))

    @property
    def noise(self) -> float:
        return _NOISE_ROUNDOFFS * max(float(self.rung.unit_roundoff), FLOAT64)

    @property
    def is_explained(self) -> bool:
        """True if the scene's own conventions leave no error that another could explain."""
        return self.plain.worst <= self.noise / EXPLAINS

    @cached_property
    def plain(self) -> Fit:
        """The best readings in the scene's own world."""
        return self.fits(World(self.scene), (Frames(),))[0]

    @cached_property
    def values(self) -> dict[str, Floats]:
        return {group: rows.doubles(self.rows) for group, rows in self.file.groups.items()}

    @cached_property
    def frames(self) -> tuple[Frames, ...]:
        """The renamings of axes that show in the file."""
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
        """Return the rounded scene of a world at the file's rows, with the attitude for space axes."""
        track = {"attitude", *(GROUPS[group].quantity for group in self.file.groups)}
        track &= set(TRACKED[self.scene.model])
        given = adopt(
            world.scene, self.rung, world.times(self.file.times[k] for k in self.rows)
        ).given
        tracked = replace(given, track=frozenset(track))
        return tracked, solution(tracked)

    def fits(self, world: World, frames: Sequence[Frames] = ()) -> list[Fit]:
        """Return the best readings in a world under each renaming of axes.

        Without ``frames``, under those that leave no group unexplained: no other one is the finding.
        """
        near, truth = self._truth(world)
        only = [group for group in self.values if not GROUPS[group].is_frame]
        columns = COLUMNS[only[0]] if len(only) == len(self.values) == 1 else ()
        fits = []
        for renamed in frames or self.frames:
            groups: dict[str, BestReading] = {}
            for group in self.values:
                groups[group] = read = self._best(group, truth, near, renamed)
                if not frames and not read.is_explained(self.plain.groups[group], self.noise):
                    break
            else:
                words = renamed.words(columns)
                fits.append(Fit(replace(world, frames=renamed, axes_words=words), groups))
        return fits

    def _truth(self, world: World) -> tuple[list[int], dict[str, Floats]]:
        """The rows that are within reach in a world, and the exact motion there."""
        given, exact = self.solution(world)
        reach = _MOST_SPANS * max(abs(t) for t in self.scene.clock.elapsed)
        elapsed = given.clock.elapsed
        near = [k for k, t in enumerate(elapsed) if exact.route != "taylor" or abs(t) <= reach]
        try:
            truth = exact.evaluate([elapsed[k] for k in near], _DIGITS) if near else {}
        except Unsettled:
            return [], {}
        if near and has_velocities(given.body):
            with mp.workdps(_DIGITS):
                truth = {**truth, **velocities(given.body, truth)}
        return near, {name: rows.astype(float) for name, rows in truth.items()}

    def _best(
        self, group: str, truth: Mapping[str, Floats], near: Sequence[int], frames: Frames
    ) -> BestReading:
        known = readings(group, frames)
        if not near:
            return BestReading(known[0], 1.0, 1.0, 0.0, ())
        columns = self.values[group][list(near)]
        right = truth["attitude" if GROUPS[group].is_frame else group]
        # A row out of reach of this world is not known to be right.
        beyond, errors = 1.0 if len(near) < len(self.rows) else 0.0, []
        for reading in known:
            got = reading.read(columns, truth["attitude"])
            got = rotations(got) if group == "quaternion" else got
            errors.append(max(_distance(group, got, right), beyond))
        enough = AS_WELL * max(min(errors), self.noise)
        good = [(r, e) for r, e in zip(known, errors, strict=True) if e <= enough]
        cost = good[0][0].cost
        alike = [reading for reading, _ in good if reading.cost == cost]
        motion = _distance(group, np.broadcast_to(right[0], right.shape), right)
        return BestReading(alike[0], good[0][1], errors[0], motion, tuple(alike[1:]))

    def _is_possible(self, world: World) -> bool:
        try:
            given, exact = self.solution(world)
        except NotRepresentable:
            return False
        span = max(abs(t) for t in self.scene.clock.elapsed)
        reach = max((abs(t) for t in given.clock.elapsed), default=Fraction(0))
        return reach <= _MOST_SPANS * span or (world.scale == 1 and exact.route != "taylor")


def is_far(scene: Scene, times: Sequence[Fraction], spans: int = _MOST_SPANS) -> bool:
    """Return True if the Taylor route would have to go so many spans for these times in order."""
    span = max(abs(t) for t in scene.clock.elapsed)
    reach = max(abs(t - scene.clock.start) for t in (times[0], times[-1]))
    return reach > spans * span and solution(scene).route == "taylor"


# The errors of the groups.


def _distance(group: str, got: Floats, right: Floats) -> float:
    """The largest distance over the rows, relative to the largest vector (absolute where all are zero).

    Of a frame turned by a small angle, that angle. Infinite where anything is not finite.
    """
    largest = _largest(got - right)
    if not largest < inf:
        return inf
    size = np.sqrt(2) if GROUPS[group].is_frame else _largest(right) or 1.0
    # Beyond doubles both may be infinite: no reading is right then.
    return float(largest / size) if size < inf else inf


def _largest(rows: Floats) -> float:
    """The largest norm of a row."""
    flat = rows.reshape(len(rows), -1)
    return float(np.sqrt(np.einsum("ij,ij->i", flat, flat).max()))
