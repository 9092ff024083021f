"""Causes in the equations of motion: evidence from arcs, fewest numbers first, and the proof."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Final

import numpy as np

from taylor_verify.judge.causes.added_mass import faults_of_added_mass
from taylor_verify.judge.causes.answer import Answer, Motion
from taylor_verify.judge.causes.arcs import telling_arcs
from taylor_verify.judge.causes.beside_steps import stepped, steps_beside
from taylor_verify.judge.causes.bodies import (
    entries,
    families_of_bodies,
    faults_of_bodies,
    nearest_factor,
    structure,
)
from taylor_verify.judge.causes.budget import Spent
from taylor_verify.judge.causes.candidate import Candidate, Cause
from taylor_verify.judge.causes.clock_factor import by_factor
from taylor_verify.judge.causes.equations import Changes
from taylor_verify.judge.causes.fault import Fault, Sizes, both
from taylor_verify.judge.causes.fit import DIFFERENCE, Family, across, gauss_newton, orthonormal
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.proof import BETTER, CAPS, LEAVES, ROUNDINGS, whole
from taylor_verify.judge.causes.replays import replays
from taylor_verify.judge.causes.short_numbers import shortened
from taylor_verify.judge.causes.terms import families_of_terms, faults_of_terms
from taylor_verify.judge.causes.written_numbers import KIND as WRITTEN
from taylor_verify.judge.causes.written_numbers import faults_of_angles, numbers
from taylor_verify.words.causes import with_numbers

# Error of float64 over a whole answer.
_FLOAT64: Final = 5e-13
# Defects of so many roundings of the file may be left.
_DEFECT_ROUNDINGS: Final = 30.0
# Many numbers fit the error of a method nearly: with two numbers and more, this part of that is allowed.
_STRICTER: Final = {0: 1.0, 1: 1.0, 2: 0.1, 3: 0.1}
_STRICTEST: Final = 1e-4
# Two families at once leave at most this, and defects of so many roundings are needed to look for them.
_PAIR: Final = 1e-4
_PAIR_ROUNDINGS: Final = 100.0
_PAIR_NUMBERS: Final = 6
# Beside the steps of a method a family has so many numbers.
_FEW: Final = 3
_BESIDE: Final = 300_000.0
# Kinds that are one class: no two of them make a pair.
_OF_INERTIA: Final = dict.fromkeys(
    ("body", "Coriolis matrix", "gyroscopic term", "Coriolis terms"), "inertia"
)
_NOTHING: Final = 1e-9
# What the steps of a fair simulator leave; a near family leaves a hundred times as much.
_FAIR: Final = 1e-6
# Without an attitude in the file a load in space axes is only nearly right on the arcs.
_LOOSE: Final = 0.1
# A fault, or the linear fit of a family, that leaves more than this is not tried.
_FAULT: Final = 0.3
_LINEAR: Final = 0.6
# Where another is exact, a family is tried that may be so as well.
_ALIKE: Final = 0.3
_NEARLY: Final = 0.02
_FIT_ROWS: Final = 160
_POLISHED: Final = 4
_PROVEN: Final = 6


@dataclass(frozen=True)
class _Linear:
    """A family with its slopes at the right numbers, and the part that its linear fit leaves."""

    family: Family
    slopes: Floats
    left: float


@dataclass(frozen=True)
class _Proven:
    candidate: Candidate
    leaves: dict[str, float]
    worst: float


def dynamics(answer: Answer) -> Cause | None:
    """Return the proven cause of the errors of the moving part, with all others that explain as well."""
    return _Dynamics(answer).cause()


class _Dynamics:
    def __init__(self, answer: Answer) -> None:
        self.answer = answer
        self.few = answer.thinned(_FIT_ROWS)
        self.arcs, self.stride = telling_arcs(self.few)
        self.floor = self.arcs.floor
        self.polished = 0

    def cause(self) -> Cause | None:
        if not self.arcs.size > 0 or not self.floor * 2 < 1:
            return None
        candidates = [*self._faults()]
        is_stepped = self.answer.stepping is not None
        if not is_stepped and not any(map(self._is_exact, candidates)):
            stride = min(self.stride, 8) if self.few is self.answer else 1
            candidates += replays(self.answer, stride)
        linear: list[_Linear] = []
        for group in self._groups(candidates):
            of_group = self._linear(group)
            linear += of_group
            candidates += self._families(of_group, candidates)
        cause = self._settled(candidates, _PAIR if is_stepped else LEAVES)
        if is_stepped:
            return cause
        is_method = any(candidate.kind == "method" for candidate in candidates)
        if cause is None and not is_method and self.floor * _PAIR_ROUNDINGS < 1:
            cause = self._settled([*self._pairs(linear)], _PAIR)
        return cause or self._beside_steps(linear)

    def _beside_steps(self, linear: list[_Linear]) -> Cause | None:
        """Return a cause beside the steps of a coarse method."""
        few = [each.slopes for each in linear if each.family.count <= _FEW]
        faults = [fault.changes for fault in faults_of_terms(self.answer.right)]
        budget = self.answer.budget
        with budget.of_its_own(_BESIDE), suppress(Spent):
            for steps in steps_beside(self.arcs, self.stride, few, faults):
                cause = _Dynamics(stepped(self.answer, steps)).cause()
                if cause is not None:
                    method = (steps.method, steps.count)
                    text = f"{cause.text or cause.name}, {steps.words(self.answer)}"
                    return replace(cause, text=text, method=method)
        return None

    def _is_exact(self, candidate: Candidate) -> bool:
        """Return True if a candidate leaves the rounding of the file, or the steps of a fair simulator."""
        return candidate.defects < max(3 * self.floor + _NOTHING, _FAIR)

    @property
    def _floor(self) -> float:
        """The roundings of the file and of the search, as a part of the error."""
        answer = self.answer
        least = min(answer.worst[name] for name in answer.moving)
        return max(ROUNDINGS * answer.floor(answer.moving), _FLOAT64 / least)

    # Evidence.

    def _candidate(
        self,
        of: Fault | Family,
        left: float,
        changes: Changes,
        numbers: Floats | None = None,
    ) -> Candidate:
        answer = self.answer
        return Candidate(
            of.name,
            of.kind,
            left / self.arcs.size,
            lambda: whole(answer, answer.right.changed(changes)),
            changes=changes,
            numbers=numbers,
            family=of if isinstance(of, Family) else None,
        )

    def _faults(self) -> Iterator[Candidate]:
        right = self.answer.right
        faults = [*faults_of_terms(right), *faults_of_added_mass(right), *faults_of_bodies(right)]
        faults += faults_of_angles(right)
        every = self.arcs.defects([fault.changes for fault in faults])
        for fault, defects in zip(faults, every, strict=True):
            left = float(np.linalg.norm(defects))
            if left < _FAULT * self.arcs.size:
                yield self._candidate(fault, left, fault.changes)

    def _groups(self, candidates: list[Candidate]) -> Iterator[list[Family]]:
        """Yield the families of one number, of few and of many, while no candidate is exact."""
        sizes, right = Sizes.of(self.answer), self.few.right
        families = [*families_of_terms(self.few, sizes), *families_of_bodies(right, sizes)]
        families += [] if right.loads is None else [n.family(right) for n in numbers(right.loads)]
        for least, most in ((1, 1), (2, 3), (4, len(right.mass) ** 2)):
            if least == 1 or not any(self._is_exact(candidate) for candidate in candidates):
                yield [family for family in families if least <= family.count <= most]

    def _linear(self, families: Sequence[Family]) -> list[_Linear]:
        """Return families with the slopes of their numbers, few numbers and a good linear fit first."""
        sets = [changes for family in families for changes in family.ahead]
        defects, first = self.arcs.defects([{}, *sets], self.arcs.few_steps), 1
        linear = list[_Linear]()
        for family in families:
            change = defects[first : first + family.count] - defects[0]
            first += family.count
            slopes = (change.reshape(family.count, -1) / (DIFFERENCE * family.scale[:, None])).T
            if np.all(np.isfinite(slopes)) and np.any(slopes):
                basis = orthonormal(slopes * family.scale, 1e-6)
                rest = across(basis, self.arcs.of_right.ravel())
                linear.append(_Linear(family, slopes, float(np.linalg.norm(rest)) / self.arcs.size))
        return sorted(linear, key=lambda each: (each.family.count, each.left))

    def _families(
        self, linear: Sequence[_Linear], simple: Sequence[Candidate]
    ) -> Iterator[Candidate]:
        """Yield fitted families; with more numbers than one that reached the rounding, none is tried."""
        counts = [c.count for c in simple if self._is_exact(c)]
        limit = _ALIKE if counts else _LINEAR
        for each in linear:
            family = each.family
            if each.left > limit and family.kind != "clock":
                continue
            if family.count > 1 and counts and family.count > max(1, min(counts)):
                continue
            fit = gauss_newton(self.arcs, family)
            if family.kind == "clock" and not fit.size < CAPS[1] * self.arcs.size:
                fit = by_factor(self.arcs, family, fit)
            if np.isfinite(fit.size):
                candidate = self._fitted(family, fit.numbers, fit.size)
                if self._is_exact(candidate):
                    counts.append(family.count)
                    limit = min(limit, max(BETTER * each.left, _NEARLY))
                yield candidate

    def _fitted(self, family: Family, numbers: Floats, size: float) -> Candidate:
        return self._candidate(family, size, family.changes(numbers), numbers)

    def _pairs(self, linear: Sequence[_Linear]) -> Iterator[Candidate]:
        """Yield the best pairs of families with at most six numbers together."""
        few = [each for each in linear if each.family.count <= 3]
        defects, size = self.arcs.of_right.ravel(), self.arcs.size
        bases = [orthonormal(each.slopes * each.family.scale, 1e-6) for each in few]
        classes = [_OF_INERTIA.get(each.family.kind, each.family.kind) for each in few]
        tried = []
        rests = [across(basis, defects) for basis in bases]
        for i, k in combinations(range(len(few)), 2):
            count = few[i].family.count + few[k].family.count
            if (
                classes[i] == classes[k]
                or count > _PAIR_NUMBERS
                or min(few[i].left, few[k].left) > 0.97
            ):
                continue
            basis = orthonormal(bases[k] - bases[i] @ (bases[i].T @ bases[k]), 1e-9)
            left = float(np.linalg.norm(across(basis, rests[i]))) / size
            if left < 0.15:
                tried.append((left * 3.0**count, i, k))
        for _, i, k in sorted(tried)[:8]:
            family = both(self.answer.right, few[i].family, few[k].family)
            fit = gauss_newton(self.arcs, family)
            if fit.size / size < max(_PAIR, 3 * self.floor):
                yield self._fitted(family, fit.numbers, fit.size)

    # Proof.

    def _settled(self, candidates: list[Candidate], leaves: float) -> Cause | None:
        proven: list[_Proven] = []
        for candidate in sorted(filter(self._is_near, candidates), key=_simplest):
            if proven and candidate.count > proven[0].candidate.count:
                decided = self._is_decided(proven[0].candidate, candidate, proven)
                if decided and candidate.count > 1:
                    break
                if decided:
                    continue
            proof = self._proof(candidate, leaves)
            if proof is None:
                continue
            if proven and candidate.count > max(1, proven[0].candidate.count):
                before = proven[0].worst
                if not before > max(BETTER * proof.worst, self._floor):
                    continue
                proven = []
            proven.append(proof)
            if len(proven) > _PROVEN:
                break
        return self._cause(proven)

    def _is_near(self, candidate: Candidate) -> bool:
        """Return True if the defects that are left allow a proof."""
        right = self.answer.right
        is_loose = (
            self.answer.file.q is None and right.changed(candidate.changes).coupled > right.coupled
        )
        most = _LOOSE if is_loose else max(LEAVES, _DEFECT_ROUNDINGS * self.floor)
        if candidate.kind == "method":
            most = 0.02
        return bool(candidate.defects < most)

    def _is_decided(self, simple: Candidate, other: Candidate, proven: Sequence[_Proven]) -> bool:
        """Return True if a proven candidate with fewer numbers makes another one needless."""
        if simple.defects > max(BETTER * other.defects, 5 * self.floor, _NOTHING):
            return False
        kinds = {each.candidate.kind for each in proven}
        is_worse = other.defects > BETTER * max(simple.defects, self.floor)
        return other.count > 1 or other.kind in kinds or is_worse

    def _proof(self, candidate: Candidate, most: float) -> _Proven | None:
        answer, moving = self.answer, self.answer.moving
        motion = candidate.prove()
        if motion is None:
            return None
        leaves = answer.leaves(motion)
        worst = max(leaves[name] for name in moving)
        if candidate.family is not None and worst > _PAIR and self.polished < _POLISHED:
            self.polished += 1
            better = self._refitted(candidate)
            if better is not None and max(better.leaves[name] for name in moving) < worst:
                candidate, leaves, worst = better.candidate, better.leaves, better.worst
        part = 1.0 if candidate.kind == "pair" else _STRICTER.get(candidate.count, _STRICTEST)
        allowed = max(most * part, self._floor)
        if worst > min(allowed, CAPS[min(candidate.count, 1)]) or candidate.is_nothing:
            return None
        return _Proven(candidate, leaves, worst)

    def _refitted(self, candidate: Candidate) -> _Proven | None:
        """Return a candidate whose numbers are fitted once more, on the whole answer."""
        family, numbers, few = candidate.family, candidate.numbers, self.few
        assert family is not None
        assert numbers is not None
        last = np.inf
        for _ in range(5):
            base = whole(few, few.right.changed(family.changes(numbers)), has_frame=False)
            if base is None:
                return None
            rest = ((few.file.v - base.v) / few.sizes).ravel()
            largest = float(np.max(np.abs(rest)))
            if largest > 0.5 * last or largest < 1e-11:
                break
            last, slopes = largest, []
            for i, step in enumerate(1e-5 * family.scale):
                shifted = numbers + step * np.eye(family.count)[i]
                other = whole(few, few.right.changed(family.changes(shifted)), has_frame=False)
                if other is None:
                    return None
                slopes.append(((other.v - base.v) / few.sizes).ravel() / step)
            matrix = np.transpose(slopes) * family.scale
            numbers = numbers + family.scale * np.linalg.lstsq(matrix, rest, rcond=1e-9)[0]
        refitted = self._fitted(family, numbers, candidate.defects * self.arcs.size)
        motion: Motion | None = refitted.prove()
        if motion is None:
            return None
        leaves = self.answer.leaves(motion)
        return _Proven(refitted, leaves, max(leaves[name] for name in self.answer.moving))

    def _cause(self, proven: list[_Proven]) -> Cause | None:
        if not proven:
            return None
        if "attitude" in self.answer.failed:
            with_attitude = [p for p in proven if p.leaves.get("attitude", 1.0) <= CAPS[0]]
            proven = with_attitude or proven
        proven.sort(key=lambda each: _simplest(each.candidate))
        best = proven[0].candidate
        as_well = max(BETTER * best.defects, 5 * self.floor, _NOTHING)
        alike = [p for p in proven if p.candidate.defects <= as_well]
        # What the scene writes is nearer to its user than a term of the equations.
        alike.sort(key=lambda each: self._nearness(each.candidate))
        first, best = alike[0], self._shortened(alike[0])
        text, changes = self._described(best)
        others = tuple(self._described(each.candidate)[0] for each in alike[1:])
        return Cause(best.name, best.kind, first.leaves, text, others, changes, best.method)

    def _shortened(self, proven: _Proven) -> Candidate:
        """Return a candidate whose numbers print with few digits, if these explain as much."""
        candidate = proven.candidate
        family, numbers = candidate.family, candidate.numbers
        if family is None or numbers is None or family.count > _FEW:
            return candidate
        size, moving = candidate.defects * self.arcs.size, self.answer.moving

        def leaves(short: Floats) -> float:
            with suppress(Spent, ValueError):
                motion = self._fitted(family, short, size).prove()
                if motion is not None:
                    left = self.answer.leaves(motion)
                    return max(left[name] for name in moving)
            return float("inf")

        worst = max(proven.worst, self._floor / ROUNDINGS)
        return self._fitted(family, shortened(numbers, family.scale, worst, leaves), size)

    def _nearness(self, candidate: Candidate) -> tuple[int, bool, bool]:
        """Return how far a candidate is from the text of the scene: one without a number is nearer."""
        has_number = " = " in self._described(candidate)[0]
        return candidate.count, candidate.kind != WRITTEN, has_number

    def _described(self, candidate: Candidate) -> tuple[str, Changes]:
        """Return a candidate in words, with its changes; a body has the factor that changes the least."""
        right, changes = self.answer.right, candidate.changes
        if candidate.kind == "body" and candidate.count > 1:
            mass = nearest_factor(right, changes["mass"])
            words = with_numbers(candidate.name, *entries(right.mass, mass))
            return words, {"mass": mass}
        family, numbers = candidate.family, candidate.numbers
        words = "" if family is None or numbers is None else structure(family, numbers)
        return ": ".join(filter(None, (words, candidate.text))), changes


def _simplest(candidate: Candidate) -> tuple[int, float]:
    return candidate.count, candidate.defects
