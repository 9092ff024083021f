"""The search among candidates: fitted to the evidence, fewest numbers first, and then proven."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from itertools import chain
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.actuator_limits import new_limits
from taylor_verify.judge.causes.arc_response import sketched_rests
from taylor_verify.judge.causes.arcs import Arcs, Evidence
from taylor_verify.judge.causes.blind_motions import Shape
from taylor_verify.judge.causes.candidate import Candidate, Cause, has_few_digits
from taylor_verify.judge.causes.changed_equations import Changes
from taylor_verify.judge.causes.damped_steps import damped_steps
from taylor_verify.judge.causes.engine_steps import capped_speed, cleared_loads
from taylor_verify.judge.causes.fit import (
    DIFFERENCE,
    Family,
    Fitted,
    across,
    by_factor,
    gauss_newton,
    orthonormal,
)
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.held_definitions import likely_held
from taylor_verify.judge.causes.kinks import has_kinks
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.pairs import Linear, likely_pairs, pairs_with_a_fault
from taylor_verify.judge.causes.proof import BETTER, LEAVES, ROUNDINGS, whole
from taylor_verify.judge.causes.replays import replays
from taylor_verify.judge.causes.settled import FAIR, NOTHING, PAIR, Choice
from taylor_verify.judge.causes.written_numbers import KIND as WRITTEN

# Defects of so many roundings are needed to look for two families at once.
_PAIR_ROUNDINGS: Final = 100.0
# Without an attitude in the file a load in space axes is only nearly right on the arcs, and one number on
# arcs that go over kinks.
_LOOSE: Final = 0.1
# A fault, or the linear fit of a family, that leaves more than this is not tried.
_FAULT: Final = 0.3
_LINEAR: Final = 0.6
# Where another is exact, a family is tried that may be so as well.
_ALIKE: Final = 0.3
_NEARLY: Final = 0.02
# One number whose linear fit is nearly exact may cost so much, whatever is left.
_FOR_ONE: Final = 1_500_000.0
# Families of which not all are fitted by a part of the work are left to methods, which have no number.
_TO_FIT: Final = 2 / 3
# Of the numbers that a fit may begin at, so many are tried: the best one may fit these arcs alone.
_BEGINS: Final = 2
# Methods are replayed over so many rows at most.
_LONGEST: Final = 8
# What a fit from far may leave of the defects: its kinks are others than those that arcs are stepped to.
_FAR: Final = 0.01
# A fit that leaves less is no fit of these arcs alone.
_ALONE: Final = 1e-4
# Fits that end so near to each other, as a part of the scale, are one.
_APART: Final = 0.01


def search_by(answer: Answer, arcs: Arcs) -> Search:
    right = answer.right
    return Search(
        answer, arcs, lambda answer, other: whole(answer, right.changed(other)), answer.moving
    )


class Search:
    """Candidates for the errors of some ``groups``, by some ``evidence`` and the ``motion`` of changes."""

    def __init__(
        self,
        answer: Answer,
        evidence: Evidence,
        motion: Callable[[Answer, Changes], Motion | None],
        groups: Sequence[str],
        motion_of_faults: Callable[[Answer, Changes], Motion | None] | None = None,
    ) -> None:
        self.answer, self.evidence, self.motion = answer, evidence, motion
        self.motion_of_faults = motion_of_faults or motion
        self.floor = evidence.floor
        self.choice = Choice(answer, groups, self.floor)
        self._shape = Shape(answer, self.floor)
        # A fault without numbers that leaves nothing of the whole answer, whatever it leaves of the arcs.
        self.proven = ""
        # The families by which no cause is found.
        self.linear = list[Linear]()
        # What each fault without numbers leaves of the defects, nearly.
        self._left_by = list[tuple[Family, Floats]]()

    def cause(self, candidates: Iterable[Candidate], leaves: float = LEAVES) -> Cause | None:
        """Return the proven cause, with all others that explain as well."""
        return self.choice.cause(candidates, leaves)

    @cached_property
    def _has_kinks(self) -> bool:
        return has_kinks(self.answer.right)

    @property
    def is_clear(self) -> bool:
        """True if the defects are more than the rounding of the file."""
        return self.evidence.size > 0 and self.floor * 2 < 1

    def by_arcs(
        self, faults: Sequence[Candidate], families: Sequence[Family], stride: int
    ) -> Cause | None:
        """Return the cause by faults, methods and families, or by two families."""
        if not self.is_clear:
            return None
        is_stepped = self.answer.stepping is not None
        candidates, linear = [*faults], list[Linear]()
        has_methods, is_blind = is_stepped, False
        for group in self._groups(families, candidates):
            of_group = self._linear(group)
            linear += of_group
            are_all = False
            with self.answer.budget.share(_TO_FIT):
                candidates += [*self._families(of_group, candidates)]
                are_all = True
            # Methods cost as much as many families of one number, which may be exact.
            is_exact = any(map(self._is_exact, candidates))
            if not is_exact and (cause := self._over_kinks(of_group, candidates)):
                return cause
            is_blind = self._shape.is_on_a_line or any(map(self._is_pace, candidates))
            if not has_methods and (is_blind or not is_exact):
                candidates += replays(self.answer, min(stride, _LONGEST))
            has_methods = True
            if not (are_all or any(map(self._is_exact, candidates))):
                return self.cause([each for each in candidates if not each.count])
        if is_blind:
            candidates = self._written(candidates)
        elif not is_stepped and not any(map(self._is_exact, candidates)):
            candidates += self._of_simulators(min(stride, _LONGEST))
        cause = self.cause(candidates, PAIR if is_stepped else LEAVES)
        if is_stepped or cause:
            return cause
        is_method = any(candidate.kind == "method" for candidate in candidates)
        if not is_method and self.floor * _PAIR_ROUNDINGS < 1:
            with self.answer.budget.share(1 / 2):
                cause = self.cause(self._telling([*self._pairs(linear)], is_blind), PAIR)
        self.linear = linear
        return cause

    def _written(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """Return the candidates of a motion that any number explains: written, or as exact."""
        some = [each for each in candidates if has_few_digits(each, self.floor)]
        has_number = any(each.count and self._is_exact(each) for each in some)
        return [*candidates] if has_number else some

    def _of_simulators(self, stride: int) -> Iterator[Candidate]:
        """Yield what simulators do in a step, or to their actuators, each for a part of the budget."""
        answer = self.answer
        for part, some in (
            (4, capped_speed(answer)),
            (4, cleared_loads(answer)),
            (2, damped_steps(answer, stride)),
            (2, self._held()),
            (2, self.from_far(new_limits(answer))),
        ):
            made = list[Candidate]()
            with answer.budget.share(1 / part):
                made = [*some]
            yield from made

    def _held(self) -> Iterator[Candidate]:
        """Yield definitions that are held in between."""
        if isinstance(self.evidence, Arcs):
            yield from self.without_numbers(likely_held(self.evidence))

    def _over_kinks(self, group: list[Linear], candidates: list[Candidate]) -> Cause | None:
        """Return a cause that is exact on the whole answer, which goes through kinks, as arcs do not."""
        if not group or not self._has_kinks:
            return None
        cause = self.cause(candidates)
        least = max(FAIR, ROUNDINGS * self.answer.floor(self.choice.groups))
        is_exact = cause is not None and max(cause.leaves[n] for n in self.choice.groups) < least
        return cause if is_exact else None

    def _is_exact(self, candidate: Candidate) -> bool:
        """Return True if a candidate leaves the rounding, fair steps, or the error of arcs."""
        least = max(3 * self.floor + NOTHING, FAIR, 3 * self.evidence.blur)
        return candidate.defects < least or candidate.family.name == self.proven

    def _is_pace(self, candidate: Candidate) -> bool:
        """Return True for another pace of a motion of one pace that is exact.

        Such a motion, as a decay, does not tell the error of a method from a number that sets the pace.
        """
        is_clock = candidate.kind == "clock" and self._is_exact(candidate)
        return is_clock and self._shape.has_one_pace

    def _telling(self, pairs: list[Candidate], is_blind: bool) -> list[Candidate]:
        """Return the pairs that a method does not imitate: it changes the pace, and damps, at once."""
        kinds = ({part.kind for part in pair.family.parts} for pair in pairs)
        has_pace = is_blind or any(
            "clock" in own or own == {"damping", "gyroscopic term"} for own in kinds
        )
        return [p for p in pairs if has_few_digits(p, self.floor)] if has_pace else pairs

    def _candidate(self, family: Family, fit: Fitted) -> Candidate:
        answer, right = self.answer, self.answer.right
        coupled = right.changed(family.changes(fit.numbers)).coupled
        has_other_arcs = family.count == 1 and self._has_kinks
        is_loose = has_other_arcs or (answer.file.q is None and coupled > answer.n)
        near = _LOOSE if is_loose else LEAVES
        motion = self.motion if family.count else self.motion_of_faults
        left, of = fit.size / self.evidence.size, (fit.errors, fit.are_seen)
        return Candidate(family, fit.numbers, left, motion, near, None, *of)

    def without_numbers(self, faults: Sequence[Family]) -> Iterator[Candidate]:
        """Yield the faults that leave little of the defects."""
        near = [*self._near(faults)]
        sets = [fault.changes(fault.right) for fault in near]
        every: Any = self.evidence.defects(sets) if near else []
        for fault, defects in zip(near, every, strict=True):
            left = float(np.linalg.norm(defects))
            if left < _FAULT * self.evidence.size:
                left = self.evidence.left_by(fault.changes(fault.right), defects)
                yield self._candidate(fault, Fitted(fault.right, left))

    def _near(self, faults: Sequence[Family]) -> Iterator[Family]:
        """Yield the faults that leave little by few steps, whose error the right scene has too."""
        rests = sketched_rests(self.evidence, [fault.changes(fault.right) for fault in faults])
        for fault, rest in zip(faults, rests, strict=True):
            self._left_by.append((fault, rest))
            if np.linalg.norm(rest) < 2 * _FAULT * self.evidence.size:
                yield fault

    def fitted(self, families: Sequence[Family]) -> Iterator[Candidate]:
        """Yield families with the numbers that fit best."""
        return self._families(self._linear(families), ())

    def from_far(self, families: Iterable[tuple[Family, Floats]]) -> Iterator[Candidate]:
        """Yield families of one number, fitted from the best of some far numbers.

        After one that is exact, others are tried that may be so as well.
        """
        has_exact = False
        for family, begins in families:
            tried = [number for number in begins if self._has_motion(family, number)]
            sizes = np.linalg.norm(
                self.evidence.coarse([family.changes(np.array([x])) for x in tried]), axis=(1, 2)
            )
            if has_exact and min(sizes) > _LINEAR * self.evidence.size:
                continue
            ends = list[Floats]()
            for k in np.argsort(sizes)[:_BEGINS]:
                with suppress(ValueError):
                    fit = gauss_newton(self.evidence, family, np.array([tried[k]]))
                    is_new = all(abs(fit.numbers - end) > _APART * family.scale for end in ends)
                    if np.isfinite(fit.size) and is_new:
                        ends.append(fit.numbers)
                        candidate = replace(self._candidate(family, fit), near=_FAR)
                        yield candidate
                        if candidate.defects < _ALONE or self._is_exact(candidate):
                            has_exact = True
                            break

    def _has_motion(self, family: Family, number: float) -> bool:
        with suppress(ValueError):
            self.answer.right.changed(family.changes(np.array([number])))
            return True
        return False

    def _groups(
        self, families: Sequence[Family], candidates: list[Candidate]
    ) -> Iterator[list[Family]]:
        """Yield the families of one number, of few and of many, while no candidate is exact.

        What the scene writes, even if it is a vector, is asked with those of one number.
        """
        for least, most in ((1, 1), (2, 3), (4, self.answer.n**2)):
            if least == 1 or not any(self._is_exact(candidate) for candidate in candidates):
                yield [
                    family
                    for family in families
                    if least <= (1 if family.kind == WRITTEN else family.count) <= most
                ]

    def _linear(self, families: Sequence[Family]) -> list[Linear]:
        """Return families with the slopes of their numbers, few numbers and a good linear fit first."""
        sets = [changes for family in families for changes in family.ahead]
        defects, first = self.evidence.coarse([{}, *sets]), 1
        linear = list[Linear]()
        for family in families:
            change = defects[first : first + family.count] - defects[0]
            first += family.count
            slopes = (change.reshape(family.count, -1) / (DIFFERENCE * family.scale[:, None])).T
            if np.all(np.isfinite(slopes)) and np.any(slopes):
                basis = orthonormal(slopes * family.scale, 1e-6)
                rest = across(basis, self.evidence.of_right.ravel())
                left = float(np.linalg.norm(rest)) / self.evidence.size
                linear.append(Linear(family, slopes, left))
        return sorted(linear, key=lambda each: (each.family.count, each.left))

    def _families(
        self, linear: Sequence[Linear], simple: Sequence[Candidate]
    ) -> Iterator[Candidate]:
        """Yield fitted families; with more numbers than one that reached the rounding, none is tried."""
        counts = [c.count for c in simple if self._is_exact(c)]
        limit = _ALIKE if counts else _LINEAR
        for each in linear:
            family = each.family
            # A clock may be so wrong that it is no linear fit.
            is_far_clock = family.kind == "clock" and not each.is_beyond(self.evidence.size)
            if each.left > limit and (counts or not is_far_clock):
                continue
            if family.count > 1 and counts and family.count > max(1, min(counts)):
                continue
            if family.count == 1 and each.left < _NEARLY:
                self.answer.budget.at_least(_FOR_ONE)
            # A step may lead to a number that no scene has.
            with suppress(ValueError):
                fit = gauss_newton(self.evidence, family, each.begin(self.evidence))
                if is_far_clock and isinstance(self.evidence, Arcs) and not counts:
                    fit = by_factor(self.evidence, family, fit)
                if np.isfinite(fit.size):
                    candidate = self._candidate(family, fit)
                    if self._is_exact(candidate):
                        counts.append(family.count)
                        limit = min(limit, max(BETTER * each.left, _NEARLY))
                    yield candidate

    def _pairs(self, linear: Sequence[Linear]) -> Iterator[Candidate]:
        """Yield two families at once, or a fault without numbers and a family, fitted."""
        right = self.answer.right
        pairs = likely_pairs(linear, self.evidence, right)
        with_fault = pairs_with_a_fault(self._left_by, linear, self.evidence, right)
        for family in chain(pairs, with_fault):
            fit = gauss_newton(self.evidence, family)
            if fit.size / self.evidence.size < max(PAIR, 3 * self.floor):
                yield self._candidate(family, fit)
