"""Damping once in each step of a method, as engines have it: the velocities times a factor."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs
from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.fit import Family, Fitted, Sizes, gauss_newton
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import LEAVES
from taylor_verify.judge.causes.replayed_methods import METHODS, Method
from taylor_verify.judge.causes.replays import Steps, moved_by, replay
from taylor_verify.scenes.instants import evenly

_ARCS: Final = 16
_MOST: Final = 60
# The numbers of steps by which the step is measured, and what the best fit may leave of the defects there.
_TRIED: Final = (4, 8)
_NEAR: Final = 0.2
# A number of damping within this part of one of three digits is that one.
_SHORT: Final = 1e-6
_DIGITS: Final = 3
# The motion of a step: the classical method where it is right, and the first-order one of engines.
_MOTIONS: Final = {"": "RK4", ", beside steps of explicit Euler": "explicit Euler"}

# The factor of a step, of c and h.
_LAWS: Final[tuple[tuple[str, str, Callable[[float, float], float]], ...]] = (
    ("explicit damping step", "1 - c h", lambda c, h: 1 - c * h),
    ("implicit damping step", "1/(1 + c h)", lambda c, h: 1 / (1 + c * h)),
    ("exponential damping step", "exp(-c h)", lambda c, h: float(np.exp(-c * h))),
    ("exponential damping step", "(1 - c)^h", lambda c, h: (1 - c) ** h if c < 1 else np.nan),
)
_ANY: Final = (
    "damping step",
    "1 - c h, or 1/(1 + c h) or exp(-c h) by another c,",
    _LAWS[0][2],
)


def damped_steps(answer: Answer, stride: int) -> Iterator[Candidate]:
    """Yield damping by a factor once in each step, after the motion of the step or before it."""
    rows = np.array(evenly(answer.count - stride, _ARCS))
    arcs = Arcs(answer, rows, rows + stride)
    for words, name in _MOTIONS.items():
        for place in ("after", "before"):
            of_motion = METHODS[name]
            step = partial(_damped, of_motion.step, place == "before")
            method = replace(of_motion, step=step, has_frame=not words)
            count = _count(arcs, stride, method)
            if count:
                yield _candidate(arcs, Steps(name, method, count, 0.0), stride, place, words)


def _damped(
    step: Any, is_first: bool, equations: Equations, time: Floats, v: Floats, h: Floats
) -> Floats:
    """Return a step with the velocities times 1 - loss h before or after the motion."""
    n, factor = equations.size, 1 - np.reshape(equations.loss, (-1, 1, 1)) * h
    if not is_first:
        v = step(equations, time, v, h)
    v = np.concatenate([v[:, :n] * factor, v[:, n:]], axis=1)
    return step(equations, time, v, h) if is_first else v


def _family(right: Equations, law: Any, h: float, pace: float, title: str = "") -> Family:
    def changes(p: Floats) -> Changes:
        return {"damping": 0.0, "loss": (1 - law(float(p[0]), h)) / h}

    return Family(title, "damping step", np.zeros(1), np.array([pace]), changes)


def _fitted(arcs: Arcs, method: Method, law: Any, steps: int, h: float) -> tuple[Fitted, Floats]:
    """Return the fit of a law in so many steps of an arc, and the defects that it leaves."""
    answer = arcs.answer
    own = replace(answer, stepping=partial(replay, answer, method, steps))
    evidence = replace(arcs, answer=own, steps_given=1)
    family = _family(answer.right, law, h, 0.1 * Sizes.of(answer).pace)
    fit = gauss_newton(evidence, family)
    return fit, evidence.defects([family.changes(fit.numbers)]).ravel()


def _count(arcs: Arcs, stride: int, method: Method) -> int:
    """Return the number of steps from row to row that leaves the least; 0 where all leave much.

    What is left is linear in h.
    """
    spacing, law = float(np.median(np.abs(arcs.spans))) / stride, _LAWS[0][2]

    def rest(count: int) -> Floats:
        return _fitted(arcs, method, law, count * stride, spacing / count)[1]

    few, more = _TRIED
    first, second = rest(few), rest(more)
    if not np.linalg.norm(second) < _NEAR * arcs.size:
        return 0
    along = float(second @ (first - second)) / float((first - second) @ (first - second))
    inverse = 1 / more - along * (1 / few - 1 / more)
    if not 1 / _MOST < inverse < 2:
        return 0
    near = max(1, round(1 / inverse))
    some = range(max(1, near - 1), near + 2)
    return min(some, key=lambda count: float(np.linalg.norm(rest(count))))


def _candidate(arcs: Arcs, steps: Steps, stride: int, place: str, beside: str) -> Candidate:
    """Return the candidate by the law whose number is short; the laws are alike but for that number."""
    answer, right = arcs.answer, arcs.answer.right
    h = steps.step(answer)

    def fit(law: Any) -> Fitted:
        return _fitted(arcs, steps.method, law, steps.count * stride, h)[0]

    fits = [(_length(float(best.numbers[0])), best, law) for law in _LAWS if (best := fit(law[2]))]
    short = [each for each in fits if each[0] < _SHORT]
    _, best, (name, words, law) = short[0] if len(short) == 1 else (0.0, fits[0][1], _ANY)
    what = "omega" if answer.n == 3 else "the velocities"
    title = f"{name}: {what} times {words} {place} the motion of each step of h = {h:.6g}{beside}, with c"
    family = _family(right, law, h, 0.1 * Sizes.of(answer).pace, title)
    motion = partial(_motion, steps, h)
    return Candidate(family, best.numbers, best.size / arcs.size, motion, LEAVES, steps)


def _length(number: float) -> float:
    """Return how far a number is from one of a few digits, as a part of it."""
    return abs(float(f"{number:.{_DIGITS}g}") / number - 1) if number else 1.0


def _motion(steps: Steps, h: float, answer: Answer, changes: Changes) -> Motion | None:
    return moved_by(steps, h, answer, answer.right.changed(changes))
