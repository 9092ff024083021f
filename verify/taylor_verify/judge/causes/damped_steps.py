"""Damping once in each step of a method, as engines have it: the velocities times a factor."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import product
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, some_arcs
from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.fit import Family, Fitted, Sizes, gauss_newton
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import LEAVES, ROUNDINGS, may_leave, whole
from taylor_verify.judge.causes.replayed_methods import METHODS, Method
from taylor_verify.judge.causes.replays import nearest_count
from taylor_verify.judge.causes.stepped_arcs import Steps, in_steps, moved_by
from taylor_verify.judge.causes.terms import faults_of_terms

_MOST: Final = 60
# The numbers of steps by which the step is measured, and what the best fit there may leave of the defects.
_TRIED: Final = (4, 8)
_NEAR: Final = 0.2
# What the right number of steps leaves, and where no other motion of a step is tried.
_LEAVES: Final = 0.02
_EXACT: Final = 1e-5
# A step is so many rows at most.
_LARGEST: Final = 2.0
# A number of damping within this part of one of three digits is that one.
_SHORT: Final = 1e-6
_DIGITS: Final = 3
# How near, and to how few digits, where no step shows but by the number of its damping: to this part, or to
# so many errors of the number, which are no more than the last.
_FEW_DIGITS: Final = 2
_SURELY: Final = 1e-9
_ERRORS: Final = 5.0
_SURE_ENOUGH: Final = 2e-7
# Where no step shows, a damping is said that is known to this part.
_KNOWN: Final = 1e-4


@dataclass(frozen=True)
class _Motion:
    """The motion of a step by a method, with what a sentence says of it."""

    method: str
    words: str = ""
    is_gyroscopic: bool = True

    def changes(self, right: Equations) -> Changes:
        """Return the changes of a motion without the gyroscopic term; none of others."""
        if self.is_gyroscopic:
            return {}
        none = next(faults_of_terms(right))
        return none.changes(none.right)


# The classical method, where it is right, and the first-order ones of engines.
_MOTIONS: Final = (
    _Motion("RK4"),
    _Motion("explicit Euler", ", beside steps of explicit Euler"),
)
_MOTIONS_OF_ENGINES: Final = (
    _Motion("explicit Euler", ", without the gyroscopic term", is_gyroscopic=False),
    _Motion("one Newton step of backward Euler", ", beside one Newton step of backward Euler"),
)

# The factor of a step, of c and h, and c by that factor and h.
_Of = Callable[[float, float], float]
_LAWS: Final[tuple[tuple[str, str, _Of, _Of], ...]] = (
    ("explicit damping step", "1 - c h", lambda c, h: 1 - c * h, lambda f, h: (1 - f) / h),
    (
        "implicit damping step",
        "1/(1 + c h)",
        lambda c, h: 1 / (1 + c * h),
        lambda f, h: (1 / f - 1) / h,
    ),
    (
        "exponential damping step",
        "exp(-c h)",
        lambda c, h: float(np.exp(-c * h)),
        lambda f, h: -float(np.log(f)) / h,
    ),
    (
        "exponential damping step",
        "(1 - c)^h",
        lambda c, h: (1 - c) ** h if c < 1 else np.nan,
        lambda f, h: 1 - f ** (1 / h),
    ),
)
_FIRST: Final = _LAWS[0]
_ANY: Final = ("damping step", "1 - c h, or 1/(1 + c h) or exp(-c h) by another c,", *_FIRST[2:])


def damped_steps(answer: Answer, stride: int) -> Iterator[Candidate]:
    """Yield damping by a factor once in each step, after the motion of the step or before it."""
    arcs = some_arcs(answer, stride)
    motions = (*_MOTIONS, *(_MOTIONS_OF_ENGINES if answer.n == 3 else ()))
    for of_motion, place in product(motions, ("after", "before")):
        terms, words = of_motion.changes(answer.right), of_motion.words
        method = METHODS[of_motion.method]
        step = partial(_damped, method.step, place == "before")
        fit = _fit(arcs, stride, replace(method, step=step, has_frame=not words), terms)
        if fit is not None and not (fit.is_any and _may_be_continuous(answer, fit, terms)):
            yield _candidate(arcs, fit, place, words, terms)
            if fit.steps.left < max(_EXACT, ROUNDINGS * arcs.floor):
                return


def _damped(
    step: Any, is_first: bool, equations: Equations, time: Floats, v: Floats, h: Floats
) -> Floats:
    """Return a step with the velocities times 1 - loss h before or after the motion."""
    n, factor = equations.size, 1 - np.reshape(equations.loss, (-1, 1, 1)) * h
    if not is_first:
        v = step(equations, time, v, h)
    v = np.concatenate([v[:, :n] * factor, v[:, n:]], axis=1)
    return step(equations, time, v, h) if is_first else v


def _family(law: _Of, h: float, pace: float, terms: Changes, title: str = "") -> Family:
    def changes(p: Floats) -> Changes:
        return {**terms, "damping": 0.0, "loss": (1 - law(float(p[0]), h)) / h}

    return Family(title, "damping step", np.zeros(1), np.array([pace]), changes)


class _Fit(NamedTuple):
    """Steps with their fitted damping; ``is_any`` if any number of steps makes the same rows."""

    steps: Steps
    fitted: Fitted
    is_any: bool


def _fit(arcs: Arcs, stride: int, method: Method, terms: Changes) -> _Fit | None:
    """Return the steps from row to row that leave the least, with their damping; None if that is much.

    What is left is linear in h.
    """
    answer, spacing = arcs.answer, float(np.median(np.abs(arcs.spans))) / stride
    pace = 0.1 * Sizes.of(answer).pace

    @cache
    def fitted(count: int) -> tuple[Fitted, Floats]:
        evidence = in_steps(arcs, method, count * stride)
        family = _family(_FIRST[2], spacing / count, pace, terms)
        fit = gauss_newton(evidence, family)
        return fit, evidence.defects([family.changes(fit.numbers)]).ravel()

    def left(count: int) -> float:
        return fitted(count)[0].size / arcs.size

    is_any, (few, more) = False, _TRIED
    first, second = fitted(few)[1], fitted(more)[1]
    change = first - second
    is_telling = np.linalg.norm(change) > _SURELY * arcs.size
    along = float(second @ change) / float(change @ change) if is_telling else 0.0
    if not np.linalg.norm(second - along * change) < _NEAR * arcs.size:
        return None
    if is_telling:
        inverse = 1 / more - along * (1 / few - 1 / more)
        if not 1 / _MOST < inverse < _LARGEST:
            return None
        count = max(1, round(1 / inverse))
        if left(count) > max(_EXACT, ROUNDINGS * arcs.floor):
            count = nearest_count(left, count, _MOST)
    else:
        # All numbers of steps make these rows, each with a damping of its own.
        counts = _counts_of_short_numbers(fitted(1)[0], spacing)
        is_any = not counts
        if len(counts) > 1 or (is_any and _unsure(fitted(1)[0]) > _KNOWN):
            return None
        count = 1 if is_any else counts[0]
    fit = fitted(count)[0]
    is_near = fit.size < _LEAVES * arcs.size
    return _Fit(Steps("", method, count, fit.size / arcs.size), fit, is_any) if is_near else None


def _may_be_continuous(answer: Answer, fit: _Fit, terms: Changes) -> bool:
    """Return True unless the attitude shows that the damping comes in steps."""
    h = fit.steps.step(answer)
    pace = -float(np.log(_FIRST[2](float(fit.fitted.numbers[0]), h))) / h
    motion = whole(answer, answer.right.changed({**terms, "damping": pace}))
    left = 0.0 if motion is None else answer.leaves(motion).get("attitude", 0.0)
    return left <= may_leave(answer, ["attitude"], 1)


def _counts_of_short_numbers(fit: Fitted, spacing: float) -> list[int]:
    """Return the numbers of steps in which the damping of a whole row has a number of two digits.

    An exponential law has one number for all.
    """
    number, counts, near = float(fit.numbers[0]), list[int](), _unsure(fit)
    of_row = _FIRST[2](number, spacing)
    for count in range(1, _MOST + 1) if of_row > 0 and near < _SURE_ENOUGH else ():
        factor, h = of_row ** (1 / count), spacing / count
        if any(_length(law[3](factor, h), _FEW_DIGITS) < near for law in _LAWS):
            counts.append(count)
    return counts


def _unsure(fit: Fitted) -> float:
    """Return how far the number of a fit may be from the right one, as a part of it."""
    number = abs(float(fit.numbers[0]))
    error = 0.0 if fit.errors is None else float(fit.errors[0])
    return max(_SURELY, _ERRORS * error / number) if number else np.inf


def _candidate(arcs: Arcs, fit: _Fit, place: str, beside: str, terms: Changes) -> Candidate:
    """Return the candidate by the law whose number is short; the laws are alike but for that number."""
    answer, steps = arcs.answer, fit.steps
    h = steps.step(answer)
    factor = _FIRST[2](float(fit.fitted.numbers[0]), h)
    short = [law for law in _LAWS if _length(law[3](factor, h)) < _SHORT]
    name, words, law, number = short[0] if len(short) == 1 else _ANY
    what = "omega" if answer.n == 3 else "the velocities"
    long = steps.words(answer)
    each = f"each step of {long}" if long.startswith("h = ") else f"each of {long}"
    each = f"{long} from row to row, whose steps do not show" if fit.is_any else each
    title = f"{name}: {what} times {words} {place} the motion of {each}{beside}, with c"
    family = _family(law, h, 0.1 * Sizes.of(answer).pace, terms, title)
    numbers, motion = np.array([number(factor, h)]), partial(_motion, steps, h)
    return Candidate(family, numbers, steps.left, motion, LEAVES, steps)


def _length(number: float, digits: int = _DIGITS) -> float:
    """Return how far a number is from one of a few digits, as a part of it."""
    return abs(float(f"{number:.{digits}g}") / number - 1) if number else 1.0


def _motion(steps: Steps, h: float, answer: Answer, changes: Changes) -> Motion | None:
    return moved_by(steps, h, answer, answer.right.changed(changes))
