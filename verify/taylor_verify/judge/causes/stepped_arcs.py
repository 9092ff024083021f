"""Arcs of an answer that go in steps of a method, as the simulator's did."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs
from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.fit import fault
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import whole
from taylor_verify.judge.causes.replayed_methods import Method, with_unit_attitude
from taylor_verify.words.causes import steps_in_words

# Times are rounded by this part.
_ROUNDED: Final = 2.0**-50


@dataclass(frozen=True)
class Steps:
    """A method with its number of steps from row to row, and the part of the defects that it leaves.

    ``sizes`` are those of the steps where they end at other times than the rows too.
    """

    name: str
    method: Method
    count: int
    left: float
    sizes: tuple[float, ...] = ()

    def step(self, answer: Answer) -> float:
        return answer.spacing / self.count

    def words(self, answer: Answer) -> str:
        """Return how long the steps are."""
        if self.sizes:
            return steps_in_words(self.sizes, 0)
        return steps_in_words(np.diff(answer.times).tolist(), self.count)

    def candidate(self, title: str, near: float, changes: Changes) -> Candidate:
        """Return the steps as a candidate, of a changed scene if there are ``changes``."""
        of_steps, motion = fault(title, "method", changes), partial(motion_of_steps, self)
        return Candidate(of_steps, of_steps.right, self.left, motion, near, self)


def best_steps(arcs: Arcs, tried: Iterable[tuple[str, Method, int]]) -> Steps:
    """Return the steps, of some methods by name with numbers of steps, that leave the least."""
    every = (Steps(name, method, n, _left_by(arcs, method, n)) for name, method, n in tried)
    return min(every, key=lambda steps: steps.left)


def _left_by(arcs: Arcs, method: Method, count: int) -> float:
    """Return the part of the defects that so many steps from row to row leave."""
    left = float(np.linalg.norm(in_steps(arcs, method, count).defects([{}]))) / arcs.size
    return left if np.isfinite(left) else np.inf


def replay(
    answer: Answer,
    method: Method,
    steps: int,
    equations: Equations,
    v: Floats,
    since: Floats,
    spans: Floats,
) -> Floats:
    """Return v after the spans, each in so many steps."""
    if method.frame is not None:
        equations = equations.framed(method.frame)
    if len(equations.switches):
        # A time that is a switch but for rounding is in the later piece, as a switch is.
        rounding = _ROUNDED * float(np.max(np.abs(since) + np.abs(spans)))
        equations = replace(equations, late=equations.late - rounding)
    h = spans / steps
    v = np.broadcast_to(v, (max(len(v), equations.sets), *v.shape[1:]))
    price = equations.price(v.shape[1], len(v) * v.shape[2])
    answer.budget.spend(steps * (method.evaluations or method.order) * price)
    for k in range(steps):
        v = method.step(equations, since + k * h, v, h)
        if v.shape[1] > answer.n:
            v = with_unit_attitude(v, answer.n)
    return v


def in_steps(arcs: Arcs, method: Method, steps: int) -> Arcs:
    """Return arcs that go in so many steps of a method."""
    own = replace(arcs.answer, stepping=partial(replay, arcs.answer, method, steps))
    return replace(arcs, answer=own, steps_given=1)


def motion_of_steps(steps: Steps, answer: Answer, _: Changes) -> Motion | None:
    """Return the motion of an answer in steps from each row to the next one."""
    return moved_by(steps, steps.step(answer), answer, answer.right)


def moved_by(steps: Steps, h: float, answer: Answer, equations: Equations) -> Motion | None:
    """Return the motion of the equations in steps of h."""
    frame = 7 if answer.file.c is not None else 4 * (answer.file.q is not None)
    components = max(equations.coupled, answer.n + frame * steps.method.has_frame)
    if steps.method.run is not None:
        motion: Motion = steps.method.run(answer, equations, h, components)
        return motion
    return whole(with_steps(answer, steps.method, h), equations, components)


def stepped(answer: Answer, steps: Steps) -> Answer:
    """Return the answer with arcs that are stepped from row to row."""
    return with_steps(answer, steps.method, steps.step(answer))


def with_steps(answer: Answer, method: Method, h: float) -> Answer:
    """Return the answer with arcs that are stepped by h, or a little less or more so that they end."""

    def ends(equations: Equations, begin: Floats, since: Floats, spans: Floats) -> Floats:
        counts = np.maximum(1, np.rint(np.abs(spans) / h)).astype(int)
        parts = []
        for count in np.unique(counts):
            some = counts == count
            own = begin[:, :, some], since[some], spans[some]
            parts.append((some, replay(answer, method, int(count), equations, *own)))
        out = np.empty((*parts[0][1].shape[:2], len(spans)))
        for some, each in parts:
            out[:, :, some] = each
        return out

    return replace(answer, stepping=ends)
