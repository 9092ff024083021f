"""Evidence: the defects of exact arcs from row to row of an answer, for one or many sets of equations."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.float_answer import Answer, Places
from taylor_verify.judge.causes.many_flows import STAGES, Floats, Rates, flow
from taylor_verify.scenes.instants import evenly

# Arcs for a fit, and the defects, in roundings of the file, that their median shall reach.
_ARCS: Final = 48
# Arcs that are enough to tell methods apart.
FEW: Final = 16
_CLEAR: Final = 300.0
# An arc is right up to so many.
_RIGHT: Final = 3.0
_FEWEST: Final = 16
# Most steps of an arc, and the accuracy that derivatives need.
_STEPS: Final = 32
_COARSE: Final = 1e-6
# Of faults without numbers the nearest are asked again if the defects are wrong by no more than this part.
_SKETCH: Final = 0.01
# Nor need an arc be nearer than this part of the defects, which tells any two causes apart.
_TELLING: Final = 1e-9
_FINEST: Final = 2e-14
_ORDER: Final = 2.0**8
# The error of a smooth arc falls by more than this if its steps are halved.
_SMOOTH: Final = 2.0**4
# Times so far from a switch, relative to the time, are on one side of it whatever rounds.
_INSIDE: Final = 2.0**-50
# A switch at the end of an arc is no farther from it than by this part.
_AT_END: Final = 1e-9
# Sets of parameters in one flow, and states: more do not fit the caches.
_SETS: Final = 48
_STATES: Final = 2400


def moved(
    answer: Answer, equations: Equations, begin: Floats, since: Floats, spans: Floats, steps: int
) -> Floats:
    """Return the states after the spans, each arc in pieces between the switches of the loads.

    The longest arc has so many steps; the pieces of others have as few as are no longer.
    """
    sets = max(len(begin), equations.sets)
    begin = np.broadcast_to(begin, (sets, *begin.shape[1:]))
    if answer.stepping is not None:
        return answer.stepping(equations, begin, since, spans)
    switches = equations.switches
    parts = _parted(since, spans, switches) if len(switches) else [(since, spans)]
    longest = float(np.max(np.abs(spans), initial=0.0))
    for at, span in parts:
        some = np.flatnonzero(span)
        part = float(np.max(np.abs(span), initial=0.0))
        count = max(1, ceil(steps * part / longest * (1 - _INSIDE))) if longest else steps
        has_loads_of_arcs = np.ndim(equations.load) == len(("sets", "components", "arcs"))
        if len(some) == len(span) or has_loads_of_arcs:
            begin = _in_blocks(answer, equations, begin, at, span, count)
        elif len(some):
            ends = _in_blocks(answer, equations, begin[:, :, some], at[some], span[some], count)
            begin = begin.copy()
            begin[:, :, some] = ends
    return begin


def _in_blocks(
    answer: Answer, equations: Equations, begin: Floats, since: Floats, spans: Floats, steps: int
) -> Floats:
    """Return the states after spans without a switch, of some of the arcs at once."""
    sets, components, arcs = begin.shape
    every = -(-arcs // max(1, sets * arcs // _STATES))
    ends = []
    for k in range(0, arcs, every):
        some = np.s_[k : k + every]
        at, span = since[some], spans[some]
        answer.budget.spend(STAGES * steps * equations.price(components, sets * len(at)))
        rates = _within(equations, at, span) if len(equations.switches) else equations.rates
        ends.append(flow(rates, begin[:, :, some], at, span, steps))
    return ends[0] if len(ends) == 1 else np.concatenate(ends, axis=2)


def _parted(since: Floats, spans: Floats, switches: Floats) -> list[tuple[Floats, Floats]]:
    """Return begins and spans of the pieces of each arc; arcs with fewer pieces have empty ones."""
    low, high = np.minimum(since, since + spans), np.maximum(since, since + spans)
    inside = [switches[(switches > a) & (switches < b)] for a, b in zip(low, high, strict=True)]
    most = max(len(own) for own in inside)
    edges = np.empty((most + 2, len(since)))
    for k, own in enumerate(inside):
        edges[:, k] = np.sort([low[k], *own, *[high[k]] * (most + 1 - len(own))])
    backward = spans < 0
    edges[:, backward] = edges[::-1, backward]
    return [(a, b - a) for a, b in itertools.pairwise(edges)]


def _within(equations: Equations, since: Floats, spans: Floats) -> Rates:
    """Return the rates at times on the inner side of the ends, where a load may jump."""
    low, high = np.minimum(since, since + spans), np.maximum(since, since + spans)
    inside = np.minimum(_INSIDE * np.maximum(np.abs(low), np.abs(high)), (high - low) / 2)
    low, high = low + inside, high - inside
    return lambda time, z: equations.rates(np.clip(time, low, high), z)


def enough_steps(ends: Callable[[int], Floats], goal: Floats, is_patient: bool = True) -> int:
    """Return the fewest steps of an arc whose ends are right to the goal, but at most 32.

    A few arcs with a kink of a load, as in abs(u)*u, take no more steps than the others. Unless it
    ``is_patient``, neither do many: where two doublings gain little, a third one gains no more.
    """
    steps, before, last, slow = 1, ends(1), np.inf, 0
    while steps < _STEPS:
        after = ends(2 * steps)
        apart = np.max(np.abs(after - before) / goal, axis=0)
        apart = np.where(np.isfinite(apart), apart, np.inf)
        largest = float(np.max(apart))
        if largest < 1:
            return steps
        steps, before = 2 * steps, after
        slow = slow + 1 if largest > last / _SMOOTH else 0
        has_kinks = slow > 0 and (np.median(apart) < 1 or (slow > 1 and not is_patient))
        if largest < _ORDER or has_kinks:
            return steps
        last = largest
    return steps


def parts_of(sets: Sequence[Changes]) -> Iterator[Sequence[Changes]]:
    """Yield sets that one flow may have; other texts have a flow each."""
    for _, alike in itertools.groupby(sets, lambda changes: id(changes.get("acting"))):
        part = [*alike]
        yield from (part[k : k + _SETS] for k in range(0, len(part), _SETS))


@dataclass(frozen=True)
class Evidence:
    """The defects of changed scenes beside an answer, by which candidates are compared."""

    answer: Answer

    def defects(self, sets: Sequence[Changes]) -> Floats:
        """Return what each set of changed parameters leaves, (sets, n, rows), relative to the motion."""
        raise NotImplementedError

    @property
    def is_coarse(self) -> bool:
        """True if derivatives need fewer steps than the defects themselves."""
        return False

    def coarse(self, sets: Sequence[Changes]) -> Floats:
        """Return the defects as well as derivatives need them."""
        return self.defects(sets)

    def sketched(self, sets: Sequence[Changes]) -> Floats:
        """Return the defects to a small part of themselves."""
        return self.coarse(sets)

    def left_by(self, changes: Changes, defects: Floats) -> float:
        """Return the size of the defects of changes without numbers, computed as well as a proof needs."""
        return float(np.linalg.norm(defects))

    @cached_property
    def rounding(self) -> Floats:
        """The rounding of the file in each component that is compared."""
        return self.answer.rounding

    @cached_property
    def of_right(self) -> Floats:
        """The defects of the right equations, (n, rows)."""
        return np.asarray(self.defects([{}])[0])

    @cached_property
    def size(self) -> float:
        return float(np.linalg.norm(self.of_right))

    @property
    def blur(self) -> float:
        """The error of the evidence itself, as a part of the defects."""
        return 0.0

    @cached_property
    def floor(self) -> float:
        """The rounding of the file as a part of the defects."""
        noise = np.linalg.norm(np.broadcast_to(self.rounding[:, None], self.of_right.shape))
        return float(noise) / self.size if self.size > 0 else np.inf


@dataclass(frozen=True)
class Arcs(Evidence):
    """Arcs of an answer from the rows ``first`` to the rows ``last``.

    With ``steps_given`` each arc has so many steps, for whatever it is computed.
    """

    first: Places
    last: Places
    steps_given: int = 0

    @property
    def since(self) -> Floats:
        return self.answer.times[self.first]

    @cached_property
    def spans(self) -> Floats:
        return self.answer.times[self.last] - self.since

    @cached_property
    def have_switch(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """True for each arc in which a load switches, or at whose end."""
        begin, end = np.sort([self.since, self.since + self.spans], axis=0)
        at_end, switches = _AT_END * (end - begin), self.answer.right.switches
        before, until = (np.searchsorted(switches, time + at_end) for time in (begin, end))
        return np.asarray(before != until)

    @cached_property
    def end(self) -> Floats:
        return self.answer.file.v[self.last].T

    def begin(self, count: int) -> Floats:
        """Return the first rows with so many components, (1, components, arcs)."""
        return self.answer.states(count, self.first).T[None]

    @cached_property
    def steps(self) -> int:
        """The fewest steps of an arc whose error is below a tenth of the file's rounding, or no cause."""
        if self.steps_given:
            return self.steps_given
        (coarse,) = self.coarse([{}])
        telling = _TELLING * np.sqrt(np.mean(coarse**2)) if np.all(np.isfinite(coarse)) else 0.0
        goal = np.maximum(0.1 * self.answer.rounding, max(_FINEST, telling))[:, None]
        return max(self.few_steps, self._steps(goal))

    @cached_property
    def blur(self) -> float:
        """The change by twice the steps, as a part of the defects: of arcs with a kink it may be large."""
        finer = self.defects([{}], 2 * self.steps)[0]
        return float(np.linalg.norm(finer - self.of_right)) / self.size if self.size > 0 else 0.0

    @cached_property
    def few_steps(self) -> int:
        """The steps of an arc for derivatives."""
        return self.steps_given or self._steps(np.full((self.answer.n, 1), _COARSE))

    def _steps(self, goal: Floats) -> int:
        n = self.answer.n
        return enough_steps(
            lambda steps: self._ends_of_right(steps)[0, :n] / self.answer.sizes[:, None],
            goal,
            is_patient=False,
        )

    def ends(self, equations: Equations, steps: int, count: int = 0) -> Floats:
        """Return the ends of the arcs by the equations, with at least the components they depend on."""
        return self.moved(equations, self.begin(max(count, equations.coupled)), steps)

    @cached_property
    def _known_ends(self) -> dict[int, Floats]:
        return {}

    def _ends_of_right(self, steps: int) -> Floats:
        """Return the ends of the arcs by the scene's equations; they are computed once."""
        if steps not in self._known_ends:
            self._known_ends[steps] = self.ends(self.answer.right, steps, self.compared)
        return self._known_ends[steps]

    def moved(self, equations: Equations, begin: Floats, steps: int) -> Floats:
        """Return the ends of the arcs from other states at their begins."""
        return moved(self.answer, equations, begin, self.since, self.spans, steps)

    def defects(self, sets: Sequence[Changes], steps: int = 0) -> Floats:
        """Return what each set of changed parameters leaves, (sets, n, arcs), relative to the motion.

        Where it depends on the body there is a further column: the first row, against that of the body.
        """
        parts = [self._defects(part, steps) for part in parts_of(sets)]
        return np.concatenate(parts)

    @cached_property
    def compared(self) -> int:
        """Number of components that are compared: v, and q and c where momenta do not tell the velocities.

        No step of v leads q on.
        """
        answer = self.answer
        is_told = not (
            answer.right.has_momenta and answer.keeps_momenta and answer.stepping is None
        )
        if is_told or answer.file.q is None:
            return answer.n
        return answer.n + (4 if answer.file.c is None else 7)

    @property
    def is_coarse(self) -> bool:
        return self.few_steps < self.steps

    def coarse(self, sets: Sequence[Changes]) -> Floats:
        return self.defects(sets, self.few_steps)

    def sketched(self, sets: Sequence[Changes]) -> Floats:
        return self.defects(sets, self._sketching_steps)

    @cached_property
    def _sketching_steps(self) -> int:
        """The steps of an arc for defects that are wrong by a small part of themselves."""
        steps = 1
        while steps < self.few_steps:
            apart = self.defects([{}], steps)[0] - self.of_right
            if np.linalg.norm(apart) < _SKETCH * self.size:
                break
            steps *= 2
        return steps

    def _defects(self, sets: Sequence[Changes], steps: int) -> Floats:
        answer, n = self.answer, self.answer.n
        steps = steps or self.steps
        ends = (
            self.ends(answer.right.copies(sets), steps, self.compared)
            if any(sets)
            else self._ends_of_right(steps)
        )
        defects = (self.end - ends[:, :n]) / answer.sizes[:, None]
        if self.compared > n:
            frame = answer.states(self.compared, self.last).T[n:] - ends[:, n : self.compared]
            frame[:, 4:] /= answer.reach
            defects = np.concatenate([defects, frame], axis=1)
        defects = np.broadcast_to(defects, (len(sets), *defects.shape[1:]))
        if not answer.is_shown_at_start:
            return defects
        starts = [answer.first(changes.get("mass", answer.right.mass)) for changes in sets]
        first = (answer.file.v[0] - np.array(starts)) / answer.sizes
        return np.concatenate([defects, first[:, :, None]], axis=2)

    @cached_property
    def rounding(self) -> Floats:
        """The rounding of the file in each component that is compared."""
        answer = self.answer
        of_frame = np.repeat([answer.noise[1], answer.noise[2] / answer.reach], [4, 3])
        frame = np.maximum(of_frame, 2.0**-50)[: self.compared - answer.n]
        return np.concatenate([answer.rounding, frame])


def row_to_row(answer: Answer) -> Arcs:
    """Return the arcs from each row of an answer to the next."""
    rows = np.arange(answer.count - 1)
    return Arcs(answer, rows, rows + 1)


def some_arcs(answer: Answer, stride: int = 1, most: int = FEW) -> Arcs:
    """Return arcs over so many rows, evenly spread over an answer."""
    rows = np.array(evenly(answer.count - stride, most))
    return Arcs(answer, rows, rows + stride)


def telling_arcs(answer: Answer) -> tuple[Arcs, int]:
    """Return arcs whose defects stand out of the rounding: over as many rows as needed, and that number."""
    stride = 1
    while True:
        arcs = some_arcs(answer, stride, _ARCS)
        ratio = np.max(np.abs(arcs.of_right) / (2 * arcs.rounding[:, None]), axis=0)
        ratio = np.where(np.isfinite(ratio), ratio, np.inf)
        middle = np.median(ratio)
        # A fault in a part of the run stands out of arcs that are right: longer ones would tell no more.
        is_clear = middle >= _CLEAR or (middle <= _RIGHT and np.max(ratio) >= _CLEAR)
        if is_clear or 4 * stride > answer.count or answer.count - stride < _FEWEST:
            return arcs, stride
        stride *= 2
