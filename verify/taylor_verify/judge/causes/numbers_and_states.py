"""Causes in states of a scene's own, where no row begins an arc, and in numbers of loads, on some rows."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.actuator_limits import own_limits
from taylor_verify.judge.causes.arcs import Arcs
from taylor_verify.judge.causes.budget import Spent
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.changed_course import SETTLED, Courses
from taylor_verify.judge.causes.energies import families_of_energies
from taylor_verify.judge.causes.fit import DIFFERENCE, Family, Sizes
from taylor_verify.judge.causes.fitted_search import Search, search_by
from taylor_verify.judge.causes.float_answer import Answer, Places
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.misread_states import (
    faults_of_states,
    numbers_of_sampling,
    phase_of_sampling,
)
from taylor_verify.judge.causes.other_bodies import families_of_bodies, faults_of_bodies
from taylor_verify.judge.causes.steps_of_states import steps_of_states
from taylor_verify.judge.causes.terms import families_of_terms, faults_of_terms, loads_late
from taylor_verify.judge.causes.written_numbers import faults_of_texts, numbers

# An arc over what is wrong between two switches passes so many rows.
_ROWS_OF_RUN: Final = 4
# A number that leaves so little may leave no more than the error of the steps.
_ALMOST: Final = 1e-4
_FINER: Final = 4.0


def in_states(answer: Answer) -> Cause | None:
    """Return the change of own states, of loads or of the body whose scene moves as the answer does."""
    right = answer.right
    if not answer.moving:
        return None
    courses = Courses.of(answer)
    search = Search(answer, courses, courses.motion, answer.moving, courses.motion_of_fault)
    faults = [*faults_of_states(right), *faults_of_terms(right), *faults_of_bodies(right)]
    faults += faults_of_texts(right)
    cause = search.cause([*search.without_numbers(faults)])
    cause = cause or search.cause(steps_of_states(answer, courses))
    with suppress(Spent):
        cause = cause or _of_numbers(answer, courses, search)
        sizes = Sizes.of(answer)
        families = [*families_of_terms(right, sizes), *families_of_bodies(answer, sizes)]
        families += families_of_energies(right)
        one = [each for each in families if each.count == 1 and each.kind != "clock"]
        cause = cause or search.cause([*search.fitted(one)])
        cause = cause or search.cause([*search.from_far([*phase_of_sampling(right)])])
    return cause


def _of_numbers(answer: Answer, courses: Courses, search: Search) -> Cause | None:
    """Return the number of the texts that explains the answer, if need be by finer steps."""
    candidates = [*search.fitted(_written(answer))]
    cause = search.cause(candidates)
    nearest = min(candidates, key=lambda each: each.defects, default=None)
    if cause or nearest is None or nearest.defects > _ALMOST:
        return cause
    answer.budget.at_least(SETTLED)
    fine = replace(courses, finer=_FINER)
    search = Search(answer, fine, fine.motion, answer.moving)
    return search.cause([*search.fitted([nearest.family])])


def in_numbers(answer: Answer, wrong: Places) -> Cause | None:
    """Return the one number of the loads with which the scene moves as the answer does, or their lateness.

    ``wrong`` are the rows that the next one does not follow from. Numbers that move a switch come first. At
    most three quarters of the work that may be done are done for it.
    """
    moves_switch, others, runs = list[tuple[Family, Floats]](), list[Family](), _runs(wrong)
    ends = [(answer.times[row] + answer.times[row + 1]) / 2 for run in runs for row in run[[0, -1]]]
    for family in (loads_late(answer.right, Sizes.of(answer)), *_written(answer)):
        moved = answer.right.changed(family.ahead[0]).switches
        if np.array_equal(moved, answer.right.switches):
            others.append(family)
        else:
            begins = _that_move(answer.right.switches, family, moved, ends)
            moves_switch.append((family, begins))
    with answer.budget.share(3 / 4):
        # A switch may come a little before or after the row at which the motion is seen to be wrong.
        wider = [np.arange(max(run[0] - 1, 0), min(run[-1] + 2, answer.count - 1)) for run in runs]
        search = search_by(answer, _arcs_over(answer, wider))
        far = [*moves_switch, *own_limits(answer.right)]
        cause = search.cause([*search.from_far(far)]) if far else None
        return cause or search.cause([*search.fitted(others)])
    return None


def _that_move(switches: Floats, family: Family, moved: Floats, times: Sequence[float]) -> Floats:
    """Return the values of a number that move a switch to each of some times, and its own value."""
    shifts = moved - switches if len(moved) == len(switches) else np.zeros(0)
    paces = [(switches[k], shift / DIFFERENCE) for k, shift in enumerate(shifts) if shift]
    own, scale = family.right[0], family.scale[0]
    return np.unique([own, *(own + scale * (t - at) / pace for at, pace in paces for t in times)])


def _runs(rows: Places) -> list[Places]:
    """Return rows in runs of those that follow one another."""
    return np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)


def _arcs_over(answer: Answer, runs: Sequence[Places]) -> Arcs:
    """Return arcs that begin and end at rows on either side of what is wrong, each over a few rows."""
    first = np.array([row for run in runs for row in run[::_ROWS_OF_RUN]])
    ends = [min(row + _ROWS_OF_RUN, run[-1] + 1) for run in runs for row in run[::_ROWS_OF_RUN]]
    return Arcs(answer, first, np.array(ends))


def _written(answer: Answer) -> list[Family]:
    """Return the families of the numbers of the texts and of sampling."""
    right, loads = answer.right, answer.right.loads
    assert loads is not None
    return [each.family(right) for each in (*numbers_of_sampling(loads), *numbers(loads))]
