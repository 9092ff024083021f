"""Methods replayed from row to row of an answer, alone or beside a fault: which one, in how many steps.

The error of fine steps is fitted to the defects, linearly in h^p, beside each fault and each family. It
gives the number of steps, with which the arcs are stepped again as the simulator's were.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from itertools import chain
from typing import Final

import numpy as np

from taylor_verify.judge.causes import held_loads
from taylor_verify.judge.causes.arcs import FEW, Arcs, some_arcs
from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.changed_equations import Changes
from taylor_verify.judge.causes.fit import across, orthonormal
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.methods_with_memory import never_of_unit_length, with_memory
from taylor_verify.judge.causes.replayed_methods import (
    METHODS,
    OF_MOMENTUM,
    OF_PUSHED_MOMENTUM,
    Method,
    as_it_is,
    with_frames,
    with_updates,
)
from taylor_verify.judge.causes.stepped_arcs import (
    Steps,
    in_steps,
    moved_by,
)

# A replay leaves at most this part of the defects, or so many roundings; they are this many at least.
LEAVES: Final = 0.02
ROUNDINGS: Final = 5.0
# One that is only nearly right over an arc leaves more.
_NEARLY: Final = 0.2
_CLEAR: Final = 10.0
# An answer has the length of so many arcs at least.
_FEWEST: Final = 2
# The steps of an arc by which the error of a method is measured, fewer where they are dear, and how many
# times finer ones are measured again; of explicit and dear ones the most.
_FINE: Final = 16
_FINE_OF_DEAR: Final = 4
_MUCH_FINER: Final = 2
_FEWER: Final = 4
_MOST: Final = 200
_MOST_OF_DEAR: Final = 128
# What a method leaves of the defects to first order, alone and beside a fault, and how small its part is.
_ALONE: Final = 0.6
_BESIDE: Final = 0.2
_SLIGHT: Final = 1e-3
# Of each method the best fits beside a fault give its numbers of steps; some methods are tried.
_FITS: Final = 4
_METHODS: Final = 3
# As many steps from row to row, by the size of their error alone, are perhaps one step.
_AS_ROWS: Final = 1.5
# Numbers of steps that are tried where the arcs without a switch are too exact to tell any.
_COUNTS: Final = (1, 2, 4, 10)
# This part of the work is for replays, and the rest for proofs.
_TO_REPLAY: Final = 0.75
# The proof of a method that is exact on the arcs may cost so much, whatever is left.
_TO_PROVE: Final = 300_000.0
# Of so many rows from the start.
_FIRST: Final = 12
# Words that programs look for.
_WORDS: Final = {
    "explicit Euler": "explicit gyroscopic step: explicit Euler",
    "backward Euler": "implicit gyroscopic step: backward Euler",
    "one Newton step of backward Euler": "implicit gyroscopic step: one Newton step of backward Euler",
}


def replays(answer: Answer, stride: int) -> Iterator[Candidate]:
    """Yield the methods whose steps lead from row to row."""
    replayed = _clear(answer, stride)
    if replayed is None:
        return
    known = {**METHODS, **({} if answer.n == 6 else OF_MOMENTUM)}
    if answer.n == 3 and answer.right.has_loads:
        known |= OF_PUSHED_MOMENTUM
    if answer.right.coupled > answer.n:
        known = {**METHODS, **dict(with_updates(answer.n)), **dict(with_frames())}
    acting = answer.right.acting
    of_loads = [*replayed.steps(held_loads.methods(acting) if acting else {}, _ALONE)]
    is_exact = any(steps.left < ROUNDINGS * replayed.floor for steps in of_loads)
    tried = [iter(of_loads), replayed.steps(known, _ALONE)]
    if answer.count > 2 * FEW and not is_exact:
        tried.append(_of_memory(answer, stride))
    every = list[Steps]()
    with answer.budget.share(_TO_REPLAY):
        for steps in chain(*tried):
            every.append(steps)
    for steps in _with_drift(answer, _each_best(every), replayed.floor):
        near = LEAVES if steps.method.run is None else _NEARLY
        if steps.left < ROUNDINGS * replayed.floor:
            answer.budget.at_least(_TO_PROVE)
        if steps.left < max(near, ROUNDINGS * replayed.floor):
            h = steps.step(answer)
            changes = steps.method.held.changes(answer, h) if steps.method.held else {}
            yield steps.candidate(name_of_steps(steps, answer), near, changes)


def _of_memory(answer: Answer, stride: int) -> Iterator[Steps]:
    """Yield the steps of methods with memory, whose first step is of another kind."""
    replayed, acting = _clear(answer.at(np.s_[1:]), stride), answer.right.acting
    late = held_loads.late_methods(acting) if acting else {}
    if replayed is not None:
        yield from replayed.steps({**late, **with_memory(answer.right)}, _ALONE)


def _with_drift(answer: Answer, best: list[Steps], floor: float) -> Iterator[Steps]:
    """Yield steps, and those whose stages read q as it is with a length that drifts, if none are exact.

    A drift is seen from the start alone; the arcs tell the number of steps nearly.
    """
    yield from best
    reads_q = answer.right.coupled > answer.n
    if not (best and reads_q) or best[0].left < ROUNDINGS * floor:
        return
    few, drifting = answer.at(np.s_[:_FIRST]), list[Steps]()
    ways = [(each, *way) for each in best[:_METHODS] for way in as_it_is(each.name, each.method)]
    for steps, own, framed in ways:
        name, method = (
            f"{own}, never restored to unit length within the run",
            never_of_unit_length(framed),
        )
        for count in range(max(1, steps.count - 1), steps.count + 2):
            motion = moved_by(replace(steps, method=method), answer.spacing / count, few, few.right)
            if motion is not None:
                left = max(few.leaves(motion).values())
                drifting.append(Steps(name, method, count, left))
    yield from sorted(drifting, key=lambda steps: steps.left)[:1]


def _clear(answer: Answer, stride: int) -> _Replays | None:
    """Return the replays of arcs so long that their defects stand out of the rounding, if any do."""
    while answer.count >= _FEWEST * stride:
        replayed = _Replays(some_arcs(answer, stride), stride, [{}])
        if replayed.floor * _CLEAR < 1:
            return replayed
        stride *= 2
    return None


def name_of_steps(steps: Steps, answer: Answer) -> str:
    """Return the name of the steps of an answer."""
    long = steps.words(answer)
    if steps.method.held:
        when = f"every {long.removeprefix('h = ')}" if "h = " in long else f"at each of {long}"
        return f"{steps.method.held.words} taken {when}{steps.method.held.late} and held in between"
    name, whose, frame = steps.name.partition(" whose ")
    words = (_WORDS.get(name, name) if answer.n == 3 else name) + whose + frame
    if steps.method.order > 1:
        words = f"truncation of order {steps.method.order}: {steps.name}"
    return f"{words}, {long}"


def steps_beside(
    arcs: Arcs, stride: int, slopes: Sequence[Floats], faults: Sequence[Changes]
) -> list[Steps]:
    """Return the steps of a few methods that explain most of the defects beside a fault, best first.

    ``slopes`` are those of families, (entries, numbers).
    """
    # Momenta are compared beside the start or the attitude, which no step of v leads to.
    n, count = arcs.answer.n, len(arcs.first)
    of_v = [each.reshape(*arcs.of_right.shape, -1)[:n, :count] for each in slopes]
    columns = [each.reshape(n * count, -1) for each in of_v]
    sizes = [np.linalg.norm(each, axis=0) for each in columns]
    bases = [orthonormal(c / s, 1e-9) for c, s in zip(columns, sizes, strict=True) if np.all(s > 0)]
    explicit = {name: method for name, method in METHODS.items() if not method.is_dear}
    steps = _Replays(arcs, stride, [{}, *faults], bases).steps(explicit, _BESIDE)
    return [each for each in _each_best(steps) if each.left < _BESIDE][:_METHODS]


def nearest_count(
    left: Callable[[int], float], count: int, most: int, walk: float = _NEARLY
) -> int:
    """Return the number of steps that leaves the least, of those around one, and on from there.

    Below ``walk`` what is left is asked as long as it falls: a first estimate may be far off where the
    error of a method does not end with its steps.
    """
    best = min((k for k in (count - 1, count, count + 1) if 1 <= k <= most), key=left, default=most)
    onward = best - count
    while onward and left(best) < walk and 1 <= best + onward <= most:
        if left(best + onward) >= left(best):
            break
        best += onward
    return best


def _each_best(steps: Iterable[Steps]) -> list[Steps]:
    """Return the best steps of each method, the best of all first."""
    best = dict[str, Steps]()
    for each in sorted(steps, key=lambda each: each.left):
        best.setdefault(each.name, each)
    return [*best.values()]


@dataclass(frozen=True)
class _Replays:
    """Arcs of an answer beside ``sets`` of changes, of which the first has none, or one of the bases.

    No method of v leads the attitude on, which is not compared.
    """

    arcs: Arcs
    stride: int
    sets: Sequence[Changes]
    bases: Sequence[Floats] = ()

    @cached_property
    def size(self) -> float:
        return float(np.linalg.norm(self._compared(self.arcs.of_right[None])))

    @cached_property
    def floor(self) -> float:
        """The rounding of the file as a part of the defects of v."""
        noise = float(np.linalg.norm(self.arcs.answer.rounding)) * len(self.arcs.first) ** 0.5
        return noise / self.size if self.size > 0 else np.inf

    def steps(self, methods: Mapping[str, Method], near: float) -> Iterator[Steps]:
        """Yield each method with numbers of steps, if its error is near to the defects."""
        defects = self._compared(self.arcs.defects(self.sets))
        for name, method in sorted(methods.items(), key=lambda each: each[1].is_dear):
            fine = self._stepped(method, _fine(method), self.sets)
            for place, counts in self._near(method, defects, fine, near):
                left = cache(partial(self._left, method, place))
                # Beside families many numbers of steps leave about as much.
                walk = 0.0 if self.bases else _NEARLY
                some = [nearest_count(left, count, self._most(method), walk) for count in counts]
                best = min(some, key=left)
                yield Steps(name, method, best, left(best))

    def _left(self, method: Method, place: int, count: int) -> float:
        """Return the part of the defects that so many steps from row to row leave."""
        (rest,) = self._stepped(method, count * self.stride, [self.sets[place]])
        if not np.all(np.isfinite(rest)):
            return np.inf
        rests = (across(basis, rest) for basis in self._beside(place))
        return min(float(np.linalg.norm(each)) for each in rests) / self.size

    def _most(self, method: Method) -> int:
        return max(1, _MOST_OF_DEAR // self.stride) if method.is_dear else _MOST

    def _near(
        self, method: Method, defects: Floats, rests: Floats, near: float
    ) -> Iterator[tuple[int, list[int]]]:
        """Yield each place with numbers of steps by which the error of the method is about the defects.

        Much finer steps than those measured are measured once more: the first-order term alone misses them.
        So are fewer steps, where the error of those measured is lost in the rounding.
        """
        for place, (own, rest) in enumerate(zip(defects, rests, strict=True)):
            fine, error = _fine(method), own - rest
            while self._is_rounding(error) and fine > self.stride:
                fine = max(self.stride, fine // _FEWER)
                error = own - self._stepped(method, fine, [self.sets[place]])[0]
            counts = self._counts(method, place, own, error, near, fine)
            steps = counts[0] * self.stride if counts else 0
            if _MUCH_FINER * fine < steps <= self._most(method):
                (finer,) = self._stepped(method, steps, [self.sets[place]])
                counts = self._counts(method, place, own, own - finer, near, steps) or counts
            if some := [max(1, count) for count in counts if count <= self._most(method) + 1]:
                yield place, some

    def _counts(
        self, method: Method, place: int, defects: Floats, error: Floats, near: float, steps: int
    ) -> list[int]:
        """Return the numbers of steps from row to row, best first, by the error of so many in an arc."""
        smooth, parts = self._smooth, list[tuple[float, float]]()
        of_right = self._compared(self.arcs.of_right[None])[0]
        if self._is_rounding(of_right):
            return [*_COUNTS]
        whole = float(np.linalg.norm(smooth * of_right))
        for basis in self._beside(place):
            beyond = across(basis, smooth * error)
            size = float(beyond @ beyond)
            if not 0 < size < np.inf:
                continue
            part = float(beyond @ (smooth * defects)) / size
            left = float(np.linalg.norm(across(basis, smooth * defects) - part * beyond)) / whole
            if part > 0 and left < near and part * size**0.5 > _SLIGHT * whole:
                parts.append((left, part))
        fine, power = steps / self.stride, -1 / method.order
        counts = [fine * part**power for _, part in sorted(parts)]
        if not (counts or self.bases or method.is_dear):
            # The error of steps as long as the rows may be far from that of finer ones.
            size = float(np.linalg.norm(smooth * error))
            part = whole / size if size > 0 else 0.0
            about = fine * part**power if part > 0 else np.inf
            counts = [about] if about < _AS_ROWS else []
        return [*map(round, counts)][:_FITS]

    def _is_rounding(self, defects: Floats) -> bool:
        """Return True if the defects of the smooth arcs are no more than some roundings of the file."""
        return float(np.linalg.norm(self._smooth * defects)) < _CLEAR * self.floor * self.size

    @cached_property
    def _smooth(self) -> Floats:
        """1 for each entry of an arc in which no load switches, and else 0; beside families all are 1.

        Steps over a switch, or up to it, leave an error that does not end as h^p.
        """
        is_smooth = ~self.arcs.have_switch | bool(self.bases)
        return np.tile(is_smooth.astype(float), self.arcs.answer.n)

    def _beside(self, place: int) -> Sequence[Floats]:
        none = np.zeros((self.arcs.answer.n * len(self.arcs.first), 0))
        return [none, *self.bases] if place == 0 else [none]

    def _stepped(self, method: Method, steps: int, sets: Sequence[Changes]) -> Floats:
        """Return what so many steps of an arc leave, (sets, entries)."""
        return self._compared(in_steps(self.arcs, method, steps).defects(sets))

    def _compared(self, defects: Floats) -> Floats:
        n, arcs = self.arcs.answer.n, len(self.arcs.first)
        return defects[:, :n, :arcs].reshape(len(defects), -1)


def _fine(method: Method) -> int:
    return _FINE_OF_DEAR if method.is_dear else _FINE
