"""The choice among candidates: fewest numbers first, each proven on the whole answer."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import product
from typing import Final

import numpy as np

from taylor_verify.judge.causes.budget import Spent
from taylor_verify.judge.causes.candidate import (
    Candidate,
    Cause,
    are_same,
    is_short,
    may_explain,
    short,
)
from taylor_verify.judge.causes.distance_of_causes import distance
from taylor_verify.judge.causes.fit import least_rest
from taylor_verify.judge.causes.fitted_bodies import described
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import BETTER, CAPS, LEAVES, ROUNDINGS
from taylor_verify.judge.causes.written_numbers import KIND as WRITTEN

# Error of float64 over a whole answer, and of the attitude, which adds up the errors of all arcs.
_FLOAT64: Final = 5e-13
_FLOAT64_ADDED: Final = 1e-11
# Defects of so many roundings of the file may be left.
_DEFECT_ROUNDINGS: Final = 30.0
_EXACT_ROUNDINGS: Final = 5.0
# Each number after the first has to leave so much less: many fit nearly whatever is wrong.
_OF_EACH_NUMBER: Final = 0.1
# Two families at once leave at most this.
PAIR: Final = 1e-4
# A row is no further off than by so many roundings if a fault explains it.
_ROUNDED: Final = 1.0
# What leaves so little leaves nothing.
NOTHING: Final = 1e-9
# A fault with numbers leaves no more than a fair simulator does, or noise, or its numbers, or what they
# differ by, have so few digits: a law of another form fits nearly, and with numbers of no short form. Two
# families with numbers fit it to one order more, as a damping and a load do where a body grows.
FAIR: Final = 1e-6
_FAIR_PAIR: Final = 1e-8
# Short numbers leave no more than those that fit best, but for the error of the search, and not by chance.
_AS_LITTLE: Final = 1.01
_OF_SHORT: Final = 1e-4
_DRAGS: Final = {"linear drag", "quadratic drag", "drag by the speed", "damping"}
# Defects that noise may make, and how many candidates are tried that leave no more.
_NOISY: Final = 0.1
_TRIED: Final = 3
_SHARE_OF_NOISE: Final = 0.1
# Of noise this part is left in the next row, by chance in some tens of rows.
_MEMORY: Final = 0.4
# Numbers are fitted once more on so many rows, of so many candidates.
FIT_ROWS: Final = 160
_POLISHED: Final = 4
# Changes for a derivative; a motion that magnifies them too far to be reached gets the smaller one.
_SHIFTS: Final = (1e-5, 1e-8)
_PROVEN: Final = 6
# So few numbers are printed with as few digits as explain as much.
FEW: Final = 3
_DIGITS: Final = (2, 3, 4, 6, 17)
_DIGITS_OF_MANY: Final = (3, 5)
# A number so small beside the scale of its family is none, if the motion is as near without it.
_NO_NUMBER: Final = (1e-3, 1e-8)


@dataclass(frozen=True)
class _Proven:
    candidate: Candidate
    leaves: dict[str, float]
    worst: float


class Choice:
    """Proofs that candidates explain the errors of some ``groups``.

    ``floor`` is the rounding of the file as a part of the defects.
    """

    def __init__(self, answer: Answer, groups: Sequence[str], floor: float) -> None:
        self.answer, self.groups, self.floor = answer, groups, floor
        self._polished = 0

    @property
    def _least(self) -> float:
        """The roundings of the file and of the search, as a part of the error."""
        least = min(self.answer.worst[name] for name in self.groups)
        return max(ROUNDINGS * self.answer.floor(self.groups), _FLOAT64 / least)

    def cause(self, candidates: Iterable[Candidate], leaves: float = LEAVES) -> Cause | None:
        """Return the proven cause, with all others that explain as well."""
        proven: list[_Proven] = []
        for candidate in sorted(self._worth_a_proof([*candidates]), key=self._order):
            if proven and candidate.count > proven[0].candidate.count:
                decided = self._is_decided(proven[0].candidate, candidate, proven)
                if decided and candidate.count > 1:
                    break
                if decided:
                    continue
            if proven and self._is_far_behind(proven[0], candidate):
                continue
            prove = self._proof if self._is_near(candidate) else self._in_noise
            try:
                proof = prove(candidate, leaves)
            except Spent:
                if not proven:
                    raise
                break  # what is proven is said
            if proof is None:
                continue
            if proven and candidate.count > max(1, proven[0].candidate.count):
                if not proven[0].worst > max(BETTER * proof.worst, self._least):
                    continue
                proven = []
            proven.append(proof)
            if len(proven) > _PROVEN:
                break
        return self._cause(proven)

    def _order(self, candidate: Candidate) -> tuple[int, float, bool, float]:
        """Return the place of a candidate among proofs: of the exact ones what is written comes first."""
        defects = max(candidate.defects, _EXACT_ROUNDINGS * self.floor, FAIR)
        return candidate.count, defects, candidate.kind != WRITTEN, candidate.defects

    def _worth_a_proof(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """Return the candidates whose defects allow a proof; without one, the best that noise may hide.

        Noise in the rows is more of an arc from row to row than of the motion over all rows.
        """
        # Equal rows count once, and as many numbers as there are in the others explain whatever they are.
        known = np.unique(self.answer.file.v, axis=0).size
        near = [each for each in candidates if self._is_near(each) and each.count < known]
        some = [c for c in candidates if c.count <= 1 and c.defects < _NOISY and not c.is_nothing]
        return near or sorted(some, key=lambda each: each.defects)[:_TRIED]

    def _is_near(self, candidate: Candidate) -> bool:
        """Return True if the defects that are left allow a proof."""
        return candidate.defects < max(candidate.near, _DEFECT_ROUNDINGS * self.floor)

    def _in_noise(self, candidate: Candidate, most: float) -> _Proven | None:
        """Return the proof of a candidate that leaves noise; it may cost little, as there are others."""
        with self.answer.budget.share(_SHARE_OF_NOISE):
            proof = self._proof(candidate, most)
            return proof if proof is not None and self._leaves_noise(proof) else None
        return None

    def _leaves_noise(self, proven: _Proven) -> bool:
        """Return True if what is left has no memory from row to row, as the error of a method has."""
        motion = proven.candidate.motion(self.answer, proven.candidate.changes)
        assert motion is not None
        rests = (self._rest(motion, name) for name in self.groups)
        return all(np.sum(r[1:] * r[:-1]) < _MEMORY * np.sum(r * r) for r in rests)

    def _rest(self, motion: Motion, name: str) -> Floats:
        """Return what a motion leaves of a group, row by row."""
        rows, exact = (self.answer.rows(each, name) for each in (self.answer.file, motion))
        signs = np.sign(np.sum(rows * exact, axis=1, keepdims=True)) if name == "attitude" else 1.0
        return np.asarray(signs * rows - exact)

    def _is_decided(self, simple: Candidate, other: Candidate, proven: Sequence[_Proven]) -> bool:
        """Return True if a proven candidate with fewer numbers makes another one needless."""
        if simple.defects > max(BETTER * other.defects, _EXACT_ROUNDINGS * self.floor, NOTHING):
            return False
        kinds = {each.candidate.kind for each in proven}
        is_worse = other.defects > BETTER * max(simple.defects, self.floor)
        return other.count > 1 or other.kind in kinds or is_worse

    def _is_far_behind(self, first: _Proven, other: Candidate) -> bool:
        """Return True if another candidate with as many numbers would not be said beside a proven one."""
        is_whole = self._explains_frame(first)
        is_alike = other.defects <= self._as_well(first.candidate)
        return is_whole and not is_alike and other.count == first.candidate.count

    def _as_well(self, best: Candidate) -> float:
        """The defects that a candidate may leave which does as well as the best."""
        return max(BETTER * best.defects, _EXACT_ROUNDINGS * self.floor, NOTHING)

    def _proof(self, candidate: Candidate, most: float) -> _Proven | None:
        proof = self._left(candidate)
        if proof is None or candidate.is_nothing:
            return None
        is_pair, count = candidate.kind == "pair", candidate.count
        if candidate.kind == "method" and candidate.method is not None:
            # One of many steps fits the size of an error whose form is another method's.
            most /= candidate.method.count
        most = max(most * _OF_EACH_NUMBER ** max(0, count - 1), NOTHING)
        can_be_better = count > 0 and self._polished < _POLISHED
        # One number costs no more to fit once more than to be tried with fewer digits, unless it has them.
        tries_short = count > 1 or not can_be_better or is_short(candidate)
        if proof.worst <= min(PAIR, most) and self._is_evident(proof, tries_short):
            return proof
        if can_be_better:
            self._polished += 1
            better = self._refitted(candidate)
            if better is not None and better.worst < proof.worst:
                proof = better
        # The rounding of a file allows two faults nothing: near to it a pair fits what one fault does not.
        cap = PAIR if is_pair else CAPS[min(candidate.count, 1)]
        allowed = min(max(most, self._least), cap)
        is_proven = proof.worst <= allowed and not proof.candidate.is_nothing
        return proof if is_proven and self._is_evident(proof) else None

    def _is_evident(self, proven: _Proven, tries_short: bool = True) -> bool:
        """Return True if what a candidate leaves is none of another law, which its numbers imitate.

        It is the rounding, or what a fair simulator or a sensor leaves, or the numbers are short. Two drags
        imitate any drag, so nearly that the rounding of a file may hide it: they leave nothing.
        """
        candidate, family = proven.candidate, proven.candidate.family
        are_drags = candidate.kind == "pair" and _DRAGS.issuperset(p.kind for p in family.parts)
        fair = _FAIR_PAIR if candidate.kind == "pair" and candidate.count > 1 else FAIR
        if not candidate.count or proven.worst <= (NOTHING if are_drags else fair):
            return True
        if not are_drags and (
            self._leaves_rounding(proven, self.groups) or self._leaves_noise(proven)
        ):
            return True
        if not tries_short or proven.worst > _OF_SHORT:
            return False
        differences = family.right + short(candidate.numbers - family.right)
        enough, both = (
            max(_AS_LITTLE * proven.worst, self._least),
            (short(candidate.numbers), differences),
        )
        near = [numbers for numbers in both if may_explain(candidate, numbers, enough)]
        some = (self._left(replace(candidate, numbers=numbers)) for numbers in near)
        return any(each is not None and each.worst <= enough for each in some)

    def _leaves_rounding(self, proven: _Proven, groups: Sequence[str]) -> bool:
        """Return True if what is left of groups is no more than the file, and the search, round off."""
        answer = self.answer
        own = {name: _FLOAT64 if name in answer.groups else _FLOAT64_ADDED for name in groups}
        return all(
            proven.leaves.get(name, np.inf)
            <= max(_ROUNDED * answer.floor([name]), least / answer.worst[name])
            for name, least in own.items()
        )

    def _left(self, candidate: Candidate) -> _Proven | None:
        """Return what a candidate leaves of the whole answer; None where it has no motion, or no path."""
        motion = candidate.motion(self.answer, candidate.changes)
        if motion is None:
            return None
        errors = self.answer.errors(motion)
        if "mass" in candidate.changes and candidate.count and not self.answer.is_path(errors):
            return None
        leaves = self.answer.parts(errors)
        # Two faults at once explain whatever the motion has, or nothing.
        names = {*self.groups, *(leaves if candidate.kind == "pair" else ())}
        worst = max(self._weighed(name, leaves.get(name, np.inf)) for name in names)
        return _Proven(candidate, leaves, worst)

    def _weighed(self, name: str, left: float) -> float:
        """Return what is left as a part of the error, or of the file's own motion where that is smaller.

        Beside the motion of an unstable scene a file that hardly moves is explained by anything.
        """
        if name not in self.answer.groups or left <= self._least:
            return left
        rows = self.answer.rows(self.answer.file, name)
        unit = self.answer.sizes[self.answer.groups[name]][0]
        size = float(np.max(np.linalg.norm(rows, axis=1)) / unit)
        return left * max(1.0, self.answer.worst[name] / size) if size > 0 else left

    def _is_whole(self, proven: _Proven) -> bool:
        """Return True if the attitude has the numbers of the motion, to the rounding of both.

        The attitude adds up what a law of another form does, and the rounding of the motion hides.
        """
        candidate, name = proven.candidate, "attitude"
        left = proven.leaves.get(name, 0.0)
        is_coarse = proven.worst > self._least
        if not candidate.count or left <= FAIR or left > CAPS[0] or is_coarse:
            return True
        if self._leaves_rounding(proven, [name]):
            return True
        with suppress(Spent):
            both = self._refitted(candidate, has_attitude=True)
            return both is not None and self._leaves_rounding(both, [*self.groups, name])
        return False

    def _refitted(self, candidate: Candidate, has_attitude: bool = False) -> _Proven | None:
        """Return a candidate whose numbers are fitted once more, on the whole answer.

        With the attitude both are fitted, by their roundings.
        """
        few, family = self.answer.thinned(FIT_ROWS), candidate.family
        rounding = float(np.max(few.rounding))

        def rest(numbers: Floats) -> Floats:
            motion = candidate.motion(few, family.changes(numbers))
            if motion is None:
                raise ValueError(numbers)
            off = np.asarray((few.file.v - motion.v) / few.sizes).ravel()
            if not has_attitude:
                return off
            assert few.file.q is not None
            assert motion.q is not None
            signs = np.sign(np.sum(few.file.q * motion.q, axis=1, keepdims=True))
            turned = (few.file.q * signs - motion.q).ravel() / max(few.noise[1], _FLOAT64)
            return np.concatenate([off, turned * rounding])

        enough = 0.0 if has_attitude else 2 * rounding
        for shift in _SHIFTS:
            with suppress(ValueError):
                numbers = least_rest(rest, candidate.numbers, family.scale, shift, enough)
                return self._left(replace(candidate, numbers=numbers))
        return None

    def _cause(self, proven: list[_Proven]) -> Cause | None:
        if not proven:
            return None
        proven = [*filter(self._explains_frame, proven)] or proven
        # Some say nothing of the path, and others say a wrong one.
        proven = [p for p in proven if max(p.leaves.values()) <= CAPS[0]] or proven
        proven.sort(key=lambda each: (each.candidate.count, each.candidate.defects))
        as_well = self._as_well(proven[0].candidate)
        alike = [p for p in proven if p.candidate.defects <= as_well]
        alike = self._by_frame(alike)
        # What the scene writes is nearer to its user than a term of the equations.
        alike.sort(key=lambda each: distance(self.answer, each.candidate))
        first, shortened = alike[0], self._shortened(alike[0])
        best = shortened.candidate
        text, changes = described(self.answer, best)
        others = dict.fromkeys(
            described(self.answer, each.candidate)[0]
            for each in alike[1:]
            if not are_same(each.candidate.changes, first.candidate.changes)
        )
        others.pop(text, None)
        return Cause(
            best.family.name,
            best.kind,
            shortened.leaves,
            text,
            tuple(others),
            changes,
            best.method,
            is_whole=self._is_whole(first),
        )

    @property
    def _frame(self) -> list[str]:
        return [name for name in ("attitude", "centre") if name in self.answer.failed]

    def _by_frame(self, alike: list[_Proven]) -> list[_Proven]:
        """Return those that explain attitude and centre as well as the best, where these fail."""
        if not self._frame:
            return alike
        left = [max(proven.leaves.get(name, 1.0) for name in self._frame) for proven in alike]
        most = max(BETTER * min(left), ROUNDINGS * self.answer.floor(self._frame), NOTHING)
        return [proven for proven, part in zip(alike, left, strict=True) if part <= most]

    def _explains_frame(self, proven: _Proven) -> bool:
        """Return True if what is proven of the motion explains attitude and centre too, where they fail."""
        return all(proven.leaves.get(name, 1.0) <= CAPS[0] for name in self._frame)

    def _shortened(self, proven: _Proven) -> _Proven:
        """Return a candidate with the fewest digits of its numbers that explain as much."""
        candidate = proven.candidate
        family, numbers = candidate.family, candidate.numbers
        # A number that is none is one number less.
        is_none = np.all(np.abs(numbers) <= _NO_NUMBER[1] * family.scale)
        as_much = proven.worst / BETTER if is_none else 2 * proven.worst
        allowed = max(as_much, self._least / ROUNDINGS, NOTHING)
        is_own = np.abs(numbers - family.right) <= _NO_NUMBER[1] * family.scale
        few = (_DIGITS, _NO_NUMBER) if family.count <= FEW else (_DIGITS_OF_MANY, _NO_NUMBER[1:])
        for digits, least in product(*few) if family.count else ():
            large = np.where(np.abs(numbers) > least * family.scale, numbers, 0.0)
            rounded = np.array([float(f"{x:.{digits}g}") for x in large])
            shorter = np.where(is_own, family.right, rounded)
            if not may_explain(candidate, shorter, allowed):
                continue
            with suppress(Spent, ValueError):
                left = self._left(replace(candidate, numbers=shorter))
                if left is not None and left.worst <= allowed:
                    return left
            if np.all(np.abs(shorter - numbers) <= NOTHING * np.abs(numbers)):
                return replace(proven, candidate=replace(candidate, numbers=shorter))
        return proven
