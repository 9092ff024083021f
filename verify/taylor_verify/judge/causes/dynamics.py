"""Causes in the equations of motion, by the arcs of an answer."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

from taylor_verify.judge.causes.arcs import Arcs, telling_arcs
from taylor_verify.judge.causes.budget import Spent
from taylor_verify.judge.causes.candidate import Candidate, Cause
from taylor_verify.judge.causes.coriolis_entries import faults_of_added_mass
from taylor_verify.judge.causes.energies import families_of_energies
from taylor_verify.judge.causes.fit import Family, Sizes
from taylor_verify.judge.causes.fitted_search import Search, search_by
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.other_bodies import families_of_bodies, faults_of_bodies
from taylor_verify.judge.causes.pairs import Linear
from taylor_verify.judge.causes.replays import replays, steps_beside
from taylor_verify.judge.causes.settled import FAIR, FEW
from taylor_verify.judge.causes.stepped_arcs import stepped
from taylor_verify.judge.causes.terms import families_of_terms, faults_of_terms
from taylor_verify.judge.causes.written_numbers import faults_of_texts, numbers, points_of_weights

# Beside the steps of a method at least this work may be done.
_BESIDE: Final = 100_000.0
# Methods are replayed over so many rows at most.
_LONGEST: Final = 8


@dataclass(frozen=True)
class Dynamics:
    """The search for the cause of the errors of the moving part, by the arcs of an answer."""

    answer: Answer

    def without_numbers(self) -> Cause | None:
        """Return the proven cause that has no number to fit."""
        cause = self._search.cause(self._faults) if self._search.is_clear else None
        if cause is not None and max(cause.leaves.values()) < FAIR:
            self._search.proven = cause.name
        return cause

    def cause(self) -> Cause | None:
        """Return the proven cause, with all others that explain as well."""
        search = self._search
        cause = search.by_arcs(self._faults, self._families, self._arcs[1])
        return cause or (self._beside_steps(search.linear) if search.linear else None)

    def of_steps(self) -> Cause | None:
        """Return the proven method of one step."""
        return self._search.cause(replays(self.answer, min(self._arcs[1], _LONGEST)))

    @cached_property
    def _arcs(self) -> tuple[Arcs, int]:
        return telling_arcs(self.answer)

    @cached_property
    def _search(self) -> Search:
        return search_by(self.answer, self._arcs[0])

    @cached_property
    def _faults(self) -> list[Candidate]:
        right = self.answer.right
        faults = [*faults_of_terms(right), *faults_of_added_mass(right), *faults_of_bodies(right)]
        return [*self._search.without_numbers([*faults, *faults_of_texts(right)])]

    @property
    def _families(self) -> list[Family]:
        right, sizes = self.answer.right, Sizes.of(self.answer)
        of_texts = numbers(right.loads) if right.loads is not None else []
        return [
            *families_of_terms(right, sizes),
            *families_of_bodies(self.answer, sizes),
            *families_of_energies(right),
            *(number.family(right) for number in of_texts),
            *points_of_weights(right),
        ]

    def _beside_steps(self, linear: Sequence[Linear]) -> Cause | None:
        """Return a cause beside the steps of a coarse method."""
        few = [each.slopes for each in linear if each.family.count <= max(FEW, self.answer.n)]
        right, budget = self.answer.right, self.answer.budget
        texts = [fault for fault in faults_of_texts(right) if fault.name.endswith("left out")]
        faults = [fault.changes(fault.right) for fault in (*faults_of_terms(right), *texts)]
        budget.at_least(_BESIDE)
        with suppress(Spent), budget.at_most(max(budget.left / 2, _BESIDE)):
            for steps in steps_beside(*self._arcs, few, faults):
                cause = Dynamics(stepped(self.answer, steps)).cause()
                if cause is not None:
                    beside = f"beside steps of {steps.name}, {steps.words(self.answer)}"
                    text = f"{cause.text or cause.name}, {beside}"
                    return replace(cause, text=text, method=steps)
        return None
