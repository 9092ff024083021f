"""Finding out conventions: hypotheses tried on the exact motion, and the simplest one that explains.

A hypothesis about the whole file is a *world*: a body as the file's author may have understood it, and
a map of time. In each world every group of columns has its readings. What is wanted is the world and
the readings with the fewest departures whose error is as small as any; it is a finding only where it
leaves a hundredth of the error of the scene's own conventions. Where two that are equally simple leave
equally little, the file cannot tell them apart, and neither is taken.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, inf, log10
from typing import Any, Final

import numpy as np
from mpmath import mp

from verify.exact.route import solution
from verify.exact.solution import Quantities, Solution, Unsettled
from verify.judge.angular_shift import angular_shift
from verify.judge.conventions.readings import Reading, readings
from verify.judge.conventions.worlds import World, late, worlds
from verify.judge.errors import state_errors
from verify.judge.inputs import angular_velocity
from verify.judge.shift import Kind, time_shifts
from verify.models.problem import NotRepresentable, adopt
from verify.scenes.bodies import ImmersedBody
from verify.scenes.motion import Motion
from verify.scenes.precision import Rung
from verify.scenes.scene import Scene
from verify.solvers.file import TrajectoryFile
from verify.solvers.values import held

Array = np.ndarray[Any, Any]
Floats = np.ndarray[Any, np.dtype[np.float64]]

# A convention explains an error if it leaves no more than this part of it.
EXPLAINS: Final = 1e-2
# What leaves up to ten times as much as the best explains as well: it may be the solver's own error.
_AS_WELL: Final = 10.0
# Errors of so many units of roundoff, or of float64's, are not told apart.
_NOISE_ROUNDOFFS: Final = 64
_FLOAT64: Final = 2.0**-53
# Conventions show in few rows; of a poor answer the early half is still right.
_MOST_ROWS: Final = 24
_FEW_ROWS: Final = 12
_DIGITS: Final = 20
_GUARD_DIGITS: Final = 3
_SPARE_BITS: Final = 96
# The relative error of a shift that is a double.
_FLOAT_NOISE: Final = 2.0**-50
# The Taylor route is not sent further than this many spans of the scene for a hypothesis.
_MOST_SPANS: Final = 10


@dataclass(frozen=True)
class Finding:
    """One convention of the file that is not the scene's.

    ``subject`` is ``time``, ``body`` or a group of columns; ``before`` and ``after`` are relative
    errors (radians for an attitude) without and with it. With ``alternatives`` it is ambiguous.
    """

    subject: str
    words: str
    before: float
    after: float
    alternatives: tuple[str, ...] = ()

    @property
    def is_certain(self) -> bool:
        return not self.alternatives

    @property
    def sentence(self) -> str:
        figures = f"error {self.before:.2g} without it, {self.after:.2g} with it"
        if self.is_certain:
            return f"{self.words} ({figures})"
        either = "; or ".join(f"[{words}]" for words in (self.words, *self.alternatives))
        return f"{self.subject} is ambiguous, this motion cannot tell {either} ({figures})"


@dataclass(frozen=True)
class Conventions:
    """What was found, and the world and readings that correct the file; only what is certain."""

    findings: tuple[Finding, ...]
    world: World
    readings: Mapping[str, Reading]


def conventions(file: TrajectoryFile, scene: Scene, rung: Rung) -> Conventions:
    """The conventions of a file of groups that the scene can be compared with.

    Raises Unsettled where there is no exact motion, and NotRepresentable where the rung cannot hold
    the scene.
    """
    search = _Search(file, scene, rung)
    if not search.rows:
        return Conventions((), World(scene), {})
    plain = search.fitted(World(scene))
    if plain.worst <= search.noise / EXPLAINS:
        return Conventions((), World(scene), {})
    fits = [plain, *(search.fitted(w) for w in search.worlds())]
    best, others = _simplest(fits, search.noise)
    if max(read.error for read in best.groups.values()) > search.noise:
        starts = [plain] if best is plain else [plain, best]
        fits += [search.fitted(world) for start in starts for world in search.shifted(start)]
        best, others = _simplest(fits, search.noise)
    return _conventions(search, plain, best, others)


# One world, and how well every group can be read in it.


@dataclass(frozen=True)
class _Read:
    """The simplest reading of a group that is as good as any, and others as simple and as good."""

    reading: Reading
    error: float
    plain: float
    others: tuple[Reading, ...]


@dataclass(frozen=True)
class _Fit:
    world: World
    groups: Mapping[str, _Read]

    @property
    def worst(self) -> float:
        """The largest error of all groups in the scene's own conventions."""
        return max(read.plain for read in self.groups.values())

    @property
    def cost(self) -> int:
        return self.world.cost + sum(read.reading.cost for read in self.groups.values())

    def size(self, noise: float) -> float:
        """The sum of the orders of magnitude of all groups' errors."""
        return sum(log10(max(read.error, noise)) for read in self.groups.values())


def _simplest(fits: Sequence[_Fit], noise: float) -> tuple[_Fit, list[_Fit]]:
    """The world of least cost among those as good as the best; and others, as good and as simple."""
    best = min(fit.size(noise) for fit in fits)
    good = [fit for fit in fits if fit.size(noise) <= best + log10(_AS_WELL)]
    cost = min(fit.cost for fit in good)
    simple = sorted((f for f in good if f.cost == cost), key=lambda fit: fit.size(noise))
    first = simple[0]
    return first, [fit for fit in simple if not fit.world.is_nearly(first.world)]


@dataclass(frozen=True)
class _Search:
    """Some rows of the file as floats, beside the exact motion in any world."""

    file: TrajectoryFile
    scene: Scene
    rung: Rung

    @property
    def noise(self) -> float:
        return _NOISE_ROUNDOFFS * max(float(self.rung.unit_roundoff), _FLOAT64)

    @cached_property
    def rows(self) -> list[int]:
        """Finite rows, evenly chosen from the early half."""
        count = len(self.file.times)
        finite = [k for k in range(count) if self._is_finite(k)]
        early = finite[: max(ceil(len(finite) / 2), _FEW_ROWS)]
        chosen = np.linspace(0, len(early) - 1, min(len(early), _MOST_ROWS))
        return sorted({early[round(k)] for k in chosen}) if early else []

    def _is_finite(self, row: int) -> bool:
        return all(isinstance(v, Fraction) for rows in self.file.groups.values() for v in rows[row])

    @cached_property
    def instants(self) -> tuple[Fraction, ...]:
        return tuple(self.file.times[k] for k in self.rows)

    @cached_property
    def values(self) -> dict[str, Floats]:
        return {
            group: np.array([[_float(v) for v in rows[k]] for k in self.rows])
            for group, rows in self.file.groups.items()
        }

    def solution(self, world: World) -> tuple[Scene, Solution]:
        """The rounded scene of a world at the file's rows, with the attitude for space axes."""
        track = {"attitude"} | ({"centre"} if "centre" in self.file.groups else set())
        given = adopt(world.scene, self.rung, world.times(self.instants)).given
        tracked = replace(given, track=frozenset(track))
        return tracked, solution(tracked)

    def fitted(self, world: World) -> _Fit:
        """The best readings in a world; all errors are infinite where there is no exact motion."""
        given, exact = self.solution(world)
        near = [k for k, t in enumerate(given.clock.elapsed) if self._is_near(exact, t)]
        found = {}
        if near:
            try:
                truth = exact.evaluate([given.clock.elapsed[k] for k in near], _DIGITS)
            except Unsettled:
                near = []
            else:
                found = _as_floats(_with_omega(given, truth))
        return _Fit(world, {group: self._best(group, found, near) for group in self.values})

    def _is_near(self, exact: Solution, elapsed: Fraction) -> bool:
        span = max(abs(t) for t in self.scene.clock.elapsed)
        return exact.route != "taylor" or abs(elapsed) <= _MOST_SPANS * span

    def _best(self, group: str, truth: Mapping[str, Floats], near: Sequence[int]) -> _Read:
        columns = self.values[group]
        known = [reading for reading in readings(group) if reading.is_plain(columns)]
        if not near:
            return _Read(known[0], 1.0, 1.0, ())
        values, right = columns[list(near)], truth[_QUANTITY.get(group, group)]
        # A row out of reach of this world is not known to be right.
        beyond = 1.0 if len(near) < len(self.rows) else 0.0
        errors = [
            max(_error(group, reading.read(values, truth["attitude"]), right), beyond)
            for reading in known
        ]
        enough = _AS_WELL * max(min(errors), self.noise)
        good = [(r, e) for r, e in zip(known, errors, strict=True) if e <= enough]
        cost = good[0][0].cost
        alike = [reading for reading, _ in good if reading.cost == cost]
        return _Read(alike[0], good[0][1], errors[0], tuple(alike[1:]))

    # Worlds.

    def worlds(self) -> list[World]:
        """Every hypothesis but the scene's own that can be tried here."""
        return [w for w in worlds(self.scene, self.file.times[0]) if self._is_possible(w)]

    def _is_possible(self, world: World) -> bool:
        try:
            given, exact = self.solution(world)
        except NotRepresentable:
            return False
        span = max(abs(t) for t in self.scene.clock.elapsed)
        reach = max((abs(t) for t in given.clock.elapsed), default=Fraction(0))
        return reach <= _MOST_SPANS * span or (world.scale == 1 and exact.route != "taylor")

    def shifted(self, fit: _Fit) -> list[World]:
        """The same world with the constant shift of time that explains one of its groups."""
        given, exact = self.solution(fit.world)
        if not self.rows or not all(self._is_near(exact, t) for t in given.clock.elapsed):
            return []
        digits = ceil(self.rung.bits * log10(2)) + _GUARD_DIGITS
        try:
            with mp.workprec(self.rung.bits + _SPARE_BITS):
                shifts = set(self._shifts(fit, given, exact, digits))
        except Unsettled:
            return []
        scale_words = fit.world.time_words[: int(fit.world.scale != 1)]
        totals = {fit.world.shift + shift for shift in shifts}
        return [
            replace(fit.world, shift=total, time_words=(*scale_words, late(total)))
            for total in totals
            if total
        ]

    def _shifts(self, fit: _Fit, given: Scene, exact: Solution, digits: int) -> Iterator[Fraction]:
        """The shift of every group, in its tentative reading, that is constant and explains it."""
        truth = exact.motion(given.clock.elapsed, digits)
        # What the file lacks is taken from the truth: it has no error, and no shift.
        quantities = dict(truth.quantities)
        for group, read in fit.groups.items():
            if _QUANTITY.get(group, group) in quantities:
                values = held([self.file.groups[group][k] for k in self.rows], mp.prec)
                reading = read.reading.read(values, truth["attitude"])
                quantities[_QUANTITY.get(group, group)] = reading
        if "omega" in fit.groups and "omega" not in quantities:
            yield from self._angular_shifts(given, fit.groups["omega"].reading, truth, digits)
        answer = Motion(quantities, truth.radius)
        states = state_errors(given, truth, answer)
        shifts = time_shifts(given, exact, truth, answer, digits, states)
        for errors, shift in zip(states, shifts, strict=True):
            largest = float(max(errors.values))
            if not largest > self.noise:
                continue
            if shift is None or shift.kind is not Kind.CONSTANT:
                continue
            if shift.residual <= EXPLAINS * largest:
                # |error| = |velocity| |shift|, so that this is how sharply the error tells it.
                width = shift.residual / largest + _FLOAT_NOISE
                yield _short(shift.time_shift, width * abs(shift.time_shift))

    def _angular_shifts(
        self, given: Scene, reading: Reading, truth: Motion, digits: int
    ) -> Iterator[Fraction]:
        """That of an angular velocity beside, or instead of, the impulses."""
        values = held([self.file.groups["omega"][k] for k in self.rows], mp.prec)
        shift = angular_shift(given, reading.read(values, truth["attitude"]), digits)
        if shift is not None and shift.kind is Kind.CONSTANT:
            late, width = float(shift.time_shift), shift.residual / shift.before + _FLOAT_NOISE
            yield _short(late, width * abs(late))


def is_far(scene: Scene, times: Iterable[Fraction], spans: int = _MOST_SPANS) -> bool:
    """Return True if the Taylor route would have to go so many spans of the scene."""
    span = max(abs(t) for t in scene.clock.elapsed)
    reach = max(abs(t - scene.clock.start) for t in times)
    return reach > spans * span and solution(scene).route == "taylor"


# What the groups are compared with.


_QUANTITY: Final = {"quaternion": "attitude"}


def _with_omega(given: Scene, truth: Quantities) -> Quantities:
    if isinstance(given.body, ImmersedBody):
        with mp.workdps(_DIGITS):
            return {**truth, "omega": angular_velocity(given.body, truth)}
    return truth


def _as_floats(truth: Quantities) -> dict[str, Floats]:
    return {name: rows.astype(float) for name, rows in truth.items()}


def _error(group: str, got: Floats, right: Floats) -> float:
    """The largest error over the rows, relative to the largest vector (absolute where all are zero).

    Of a frame turned by a small angle, that angle. Infinite where anything is not finite.
    """
    flat = (got - right).reshape(len(right), -1)
    if not np.all(np.isfinite(flat)):
        return inf
    size = np.max(np.linalg.norm(right.reshape(len(right), -1), axis=1)) or 1.0
    if _QUANTITY.get(group, group) == "attitude":
        size = np.sqrt(2)
    return float(np.max(np.linalg.norm(flat, axis=1)) / size)


def _float(value: Fraction | float) -> float:
    try:
        return float(value)
    except OverflowError:
        return inf


def _short(value: float, width: float) -> Fraction:
    """The shortest decimal that is within ``width`` of the value."""
    texts = (f"{value:.{digits}e}" for digits in range(17))
    near = (Fraction(text) for text in texts if abs(Fraction(text) - Fraction(value)) <= width)
    return next(near, Fraction(value))


# What is said of it.


def _conventions(search: _Search, plain: _Fit, best: _Fit, others: Sequence[_Fit]) -> Conventions:
    gained = max(
        plain.groups, key=lambda g: plain.groups[g].error / _positive(best.groups[g].error)
    )
    before, after = plain.groups[gained].error, best.groups[gained].error
    findings: list[Finding] = []
    if best.world.cost and not after <= EXPLAINS * before:
        best, others = plain, ()
    alternatives = tuple(o.world.words or "the scene's own" for o in others)
    subjects = {"time": "; ".join(best.world.time_words), "body": best.world.body_words}
    for subject, words in subjects.items():
        if words:
            findings.append(Finding(subject, words, before, after, alternatives))
    certain = {}
    for group, read in best.groups.items():
        if read.reading.cost and read.error <= EXPLAINS * read.plain:
            unlike = tuple(reading.sentence for reading in read.others)
            words = read.reading.sentence
            findings.append(Finding(group, words, read.plain, read.error, unlike))
            if not unlike:
                certain[group] = read.reading
    world = World(search.scene) if others else best.world
    return Conventions(tuple(findings), world, certain)


def _positive(error: float) -> float:
    return error or _FLOAT64
