"""Scenes with other states of their own, or with loads that are held: the causes of their answers.

No file has all states of its own, so that no arc can begin at a row: each candidate moves from the start,
as far as the first wrong rows for a look, and over the whole answer for the proof.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import Final

import numpy as np

from taylor_verify.judge.causes.answer import Answer
from taylor_verify.judge.causes.bodies import families_of_bodies, faults_of_bodies
from taylor_verify.judge.causes.budget import Budget, Spent
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.course import courses
from taylor_verify.judge.causes.equations import Changes
from taylor_verify.judge.causes.fault import Fault, Sizes
from taylor_verify.judge.causes.fit import DIFFERENCE, Family
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.misread_states import misread_states, numbers_of_sampling
from taylor_verify.judge.causes.proof import may_leave
from taylor_verify.judge.causes.short_numbers import shortened
from taylor_verify.judge.causes.terms import families_of_terms, faults_of_terms
from taylor_verify.judge.causes.written_numbers import faults_of_angles, numbers
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Held
from taylor_verify.words.causes import with_numbers

# What a candidate leaves of the error at the first wrong rows, at most; that is so many roundings large.
_NEAR: Final = 0.02
_CLEAR: Final = 300.0
_ROWS: Final = 6
_SPREAD: Final = 8
# A linear fit that leaves more is not tried; a fit has so many rounds.
_LINEAR: Final = 0.5
_ROUNDS: Final = 5
_GAIN: Final = 0.5
_SETTLED: Final = 1e-10
_MOST_STEPS: Final = 8
_ACCURATE: Final = 1e-5


def cause_in_states(answer: Answer) -> list[Cause]:
    """Return the change of states, of held loads or of the body whose scene moves as the answer does.

    Other changes with the same motion stand beside it.
    """
    if answer.right.loads is None or not answer.moving:
        return []
    with suppress(Spent):
        return _Search(answer).causes()
    return []


def cause_in_numbers(answer: Answer) -> list[Cause]:
    """Return the one number of the loads' texts with which the scene moves as the answer does.

    At most half of the work that may be done is done for it.
    """
    part = replace(answer, budget=Budget(answer.budget.left / 2))
    with suppress(Spent):
        search = _Search(part)
        return _beside([*search.fitted(search.families())])
    return []


def _beside(proven: list[Cause]) -> list[Cause]:
    """Return the first of some causes, with the others beside it."""
    others = tuple(cause.text or cause.name for cause in proven[1:])
    return [replace(cause, alike=others) for cause in proven[:1]]


class _Search:
    def __init__(self, answer: Answer) -> None:
        self.answer = answer
        loads = answer.right.loads
        is_held = loads is not None and loads.held_states
        # Each instant costs as much as a row.
        self.few = (
            answer.at(np.s_[: _first_wrong(answer) + _ROWS]) if is_held else answer.thinned(_SPREAD)
        )
        self.steps = 1
        while self.steps < _MOST_STEPS and not self._is_accurate():
            self.steps *= 2

    def causes(self) -> list[Cause]:
        """Return the proven cause with the fewest numbers, and the others beside it."""
        for tried in (
            (self._without_numbers, self._with_one) if self.answer.has_states else (self._held,)
        ):
            proven = list[Cause]()
            with suppress(Spent):
                proven.extend(tried())
            if proven:
                return _beside(proven)
        return []

    def _is_accurate(self) -> bool:
        (motion,) = courses(self.few, [{}], self.steps)
        apart = np.max(np.abs(motion.v - self.few.truth.v) / self.few.sizes)
        return bool(apart < max(_ACCURATE * self.few.off, float(np.min(self.few.rounding))))

    def _held(self) -> Iterator[Cause]:
        loads = self.answer.right.loads
        assert loads is not None
        yield from self._proven_faults(held_loads(loads, self.answer))

    def _without_numbers(self) -> Iterator[Cause]:
        right, loads = self.answer.right, self.answer.right.loads
        assert loads is not None
        yield from self._proven_faults(misread_states(loads))
        yield from self._proven(
            [*faults_of_terms(right), *faults_of_bodies(right), *faults_of_angles(right)]
        )

    def _proven_faults(self, misread: Iterator[tuple[str, Loads]]) -> Iterator[Cause]:
        """Yield the proven causes among other loads; what no scene may have is none."""
        acting = self.answer.right.acting
        assert acting is not None
        with suppress(ValueError):
            for name, loads in misread:
                if next(loads.faults(), None) is None:
                    yield from self._proven([Fault(name, "states", {"acting": acting.of(loads)})])

    def _proven(self, faults: Sequence[Fault]) -> Iterator[Cause]:
        sizes = [float(np.linalg.norm(rest)) for rest in self._rests([f.changes for f in faults])]
        for fault, size in zip(faults, sizes, strict=True):
            if size < _NEAR * self._size and (leaves := self._leaves(fault.changes, 0)):
                yield Cause(fault.name, fault.kind, leaves, changes=fault.changes)

    def _with_one(self) -> Iterator[Cause]:
        """Yield the proven causes with one number."""
        right, sizes = self.answer.right, Sizes.of(self.answer)
        families = [*families_of_terms(self.few, sizes), *families_of_bodies(right, sizes)]
        one = [each for each in families if each.count == 1 and each.kind != "clock"]
        is_found = False
        for cause in self.fitted(self.families()):
            is_found = True
            yield cause
        if not is_found:
            yield from self.fitted(one)

    def fitted(self, families: Sequence[Family]) -> Iterator[Cause]:
        """Yield the proven causes among families of one number."""
        for family in self._near_linear(families):
            # A step may lead to a number that no scene has.
            with suppress(ValueError):
                yield from self._fitted(family)

    def families(self) -> list[Family]:
        """Return the families of the numbers of the texts and of sampling."""
        right, loads = self.answer.right, self.answer.right.loads
        assert loads is not None
        return [each.family(right) for each in (*numbers_of_sampling(loads), *numbers(loads))]

    def _near_linear(self, families: Sequence[Family]) -> list[Family]:
        """Return the families whose linear fit explains the first wrong rows, the best first."""
        base, *shifted = self._rests([{}, *(family.ahead[0] for family in families)])
        lefts = []
        for rest in shifted:
            slope = rest - base
            size = float(slope @ slope)
            left = base - slope * (float(slope @ base) / size) if size > 0 else base
            lefts.append(float(np.linalg.norm(left)) / self._size)
        order = sorted(range(len(families)), key=lambda k: lefts[k])
        return [families[k] for k in order if lefts[k] < _LINEAR]

    def _fitted(self, family: Family) -> Iterator[Cause]:
        values = self._fit(family, family.right, self.few)
        if values is None:
            return
        leaves = self._leaves(family.changes(values), 1)
        if not leaves and (values := self._fit(family, values, self.answer)) is not None:
            leaves = self._leaves(family.changes(values), 1)
        if leaves and values is not None:
            worst = max(leaves.values())
            values = shortened(
                values, family.scale, worst, lambda short: self._worst_left(family, short)
            )
            leaves = self._leaves(family.changes(values), 1)
            text = with_numbers(family.name, family.labels, family.right, values)
            yield Cause(family.name, family.kind, leaves, text, changes=family.changes(values))

    def _worst_left(self, family: Family, values: Floats) -> float:
        """Return the largest part of an error that a family leaves; infinite where it is not proven."""
        try:
            return max(self._leaves(family.changes(values), 1).values(), default=float("inf"))
        except ValueError:
            return float("inf")

    def _fit(self, family: Family, begin: Floats, rows: Answer) -> Floats | None:
        """Return the number that fits some rows best by Newton's method; None where none fits."""
        value, shift, size, before = begin, DIFFERENCE * family.scale, 0.0, np.inf
        for _ in range(_ROUNDS):
            sets = [family.changes(value), family.changes(value + shift)]
            base, ahead = self._rests(sets, rows)
            size = float(np.linalg.norm(base))
            slope = (ahead - base) / shift[0]
            if not size < _GAIN * before or size < _SETTLED or not np.any(slope):
                break
            value, before = value - float(slope @ base) / float(slope @ slope), size
        return value if size < _NEAR * self._size or rows is self.answer else None

    @property
    def _size(self) -> float:
        return float(np.linalg.norm((self.few.file.v - self.few.truth.v) / self.few.sizes))

    def _rests(self, sets: Sequence[Changes], rows: Answer | None = None) -> list[Floats]:
        """Return what each set of changes leaves of the rows, by default of the first wrong ones."""
        answer = rows or self.few
        motions = courses(answer, sets, self.steps)
        rests = [((answer.file.v - motion.v) / self.answer.sizes).ravel() for motion in motions]
        return [rest if np.all(np.isfinite(rest)) else np.full_like(rest, 1e100) for rest in rests]

    def _leaves(self, changes: Changes, count: int) -> dict[str, float]:
        """Return what a changed scene leaves of each error; empty where it is not proven."""
        (motion,) = courses(self.answer, [changes], self.steps)
        leaves = self.answer.leaves(motion.signed_as(self.answer.file.first_attitude))
        worst = max(leaves.values())
        return leaves if worst <= may_leave(self.answer, self.answer.failed, count) else {}


def _first_wrong(answer: Answer) -> int:
    """Return the first row whose error is clear, or that of the largest error."""
    clear = [
        np.flatnonzero(answer.error[name] > _CLEAR * answer.roundings[name])
        for name in answer.moving
    ]
    return min((int(rows[0]) for rows in clear if len(rows)), default=answer.count - 1)


def held_loads(loads: Loads, answer: Answer) -> Iterator[tuple[str, Loads]]:
    """Yield loads that are taken once in a row, or several times, and held in between."""
    spacing = Fraction(float(np.median(np.diff(answer.times)))).limit_denominator(10**6)
    if not spacing > 0:
        return
    names = {name: f"{name}_held" for name, _ in loads.vectors}
    vectors = tuple(
        (name, tuple(f"{names[name]}{i}" for i in (1, 2, 3))) for name, _ in loads.vectors
    )
    for steps in (1, 2, 4, 5, 10):
        every = spacing / steps
        states = tuple(
            Held(names[name], None, entries, every, Fraction(0), is_vector=True)
            for name, entries in loads.vectors
        )
        name = f"loads taken every {float(every):.6g} and held in between"
        yield name, replace(loads, vectors=vectors, states=states)
