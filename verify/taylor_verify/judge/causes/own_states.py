"""Scenes with other states of their own, or with loads that are held, each compared as an exact motion."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from typing import Final

import numpy as np

from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.causes.answer import Answer
from taylor_verify.judge.causes.bodies import faults_of_bodies
from taylor_verify.judge.causes.budget import Spent
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.changed_scene import changed_body
from taylor_verify.judge.causes.exact_motion import ExactMotion
from taylor_verify.judge.causes.proof import ROUNDINGS, may_leave
from taylor_verify.judge.causes.terms import faults_of_terms
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Continuous, Held, State

_RATES: Final = tuple(Fraction(f) for f in ("2", "1/2", "4", "1/4", "5", "1/5", "10", "1/10"))
_WRONG_RATES: Final = (("stands still", 0), ("has the rate of the other sign", -1))
# What a candidate leaves of the error at the first wrong row, at most; that is so many roundings large.
_NEAR: Final = 0.01
_CLEAR: Final = 300.0
# The work of an exact motion: to begin it, and for each row and each instant of held states.
_BEGIN: Final = 40_000.0
_WORK: Final = 6_000.0


@dataclass(frozen=True)
class _Changed:
    name: str
    body: Body
    is_fault: bool = False

    @property
    def loads(self) -> Loads:
        assert self.body.loads is not None
        return self.body.loads


def cause_in_states(answer: Answer) -> list[Cause]:
    """Return the change of states, or of held loads, whose scene moves as the answer does.

    Other changes with the same motion stand beside it.
    """
    scene, proven = answer.scene, list[Cause]()
    if scene is None or scene.body.loads is None or not answer.moving:
        return []
    with suppress(Spent):
        for changed in _candidates(scene.body, answer):
            if proven and changed.is_fault:
                break
            # A change may leave a text that no scene may have, such as a jump by the state.
            with suppress(ValueError, ArithmeticError, Unsettled):
                if leaves := _leaves(answer, changed):
                    proven.append(Cause(changed.name, "states", leaves))
    alike = tuple(cause.name for cause in proven[1:])
    return [replace(cause, alike=alike) for cause in proven[:1]]


def _leaves(answer: Answer, changed: _Changed) -> dict[str, float]:
    """Return what a changed scene leaves of each error; empty where it is not proven."""
    assert answer.scene is not None
    if next(changed.loads.faults(), None):
        return {}
    exact = ExactMotion(replace(answer.scene, body=changed.body), answer.file.c is not None)

    def left(rows: list[int]) -> dict[str, float]:
        part = answer.at(rows)
        times = [Fraction(t) for t in part.times.tolist()]
        instants = len(changed.loads.instants(times[-1]))
        answer.budget.spend(_BEGIN + _WORK * (len(rows) + instants))
        motion = exact.at(times, answer.right.has_momenta)
        errors = part.errors(motion)
        return {name: float(np.max(errors[name])) for name in answer.failed}

    first = _first_wrong(answer)
    near = left([first])
    if any(
        near[name] > max(_NEAR * answer.error[name][first], ROUNDINGS * answer.roundings[name])
        for name in answer.failed
    ):
        return {}
    parts = {name: each / answer.worst[name] for name, each in left([*range(answer.count)]).items()}
    return parts if max(parts.values()) <= may_leave(answer, answer.failed) else {}


def _first_wrong(answer: Answer) -> int:
    """Return the first row whose error is clear, or that of the largest error."""
    clear = [
        np.flatnonzero(answer.error[name] > _CLEAR * answer.roundings[name])
        for name in answer.moving
    ]
    return min((int(rows[0]) for rows in clear if len(rows)), default=answer.count - 1)


def _candidates(body: Body, answer: Answer) -> Iterator[_Changed]:
    """Yield changed states, or held loads, and then the faults of terms and bodies."""
    loads = body.loads
    assert loads is not None
    own = _of_states(loads) if loads.states else _held(loads, answer)
    for name, changed in own:
        yield _Changed(name, body.with_loads(changed))
    right = answer.right
    for fault in (*faults_of_terms(right), *faults_of_bodies(right)) if answer.has_states else ():
        if other := changed_body(body, right, fault.changes):
            yield _Changed(fault.name, other, is_fault=True)


def _of_states(loads: Loads) -> Iterator[tuple[str, Loads]]:
    held, own = loads.held_states, [s for s in loads.states if isinstance(s, Continuous)]
    for state in held:
        yield from _without_delay(loads, state)
        yield _late(loads, state)
    if held:
        yield _continuous(loads, held)
        yield from _at_other_rates(loads, held)
    for each, (words, factor) in product(own, _WRONG_RATES):
        rate = tuple(f"{factor}*({entry})" for entry in each.rate)
        yield f"{each.name} {words}", _with(loads, each, replace(each, rate=rate))


def _with(loads: Loads, old: State, *new: State) -> Loads:
    """Return the loads with other states in the place of one."""
    states = tuple(s for each in loads.states for s in (new if each is old else (each,)))
    return replace(loads, states=states)


def _at_other_rates(loads: Loads, held: tuple[Held, ...]) -> Iterator[tuple[str, Loads]]:
    has_offsets = any(state.offset for state in held)
    for factor, keeps_offset in product(_RATES, (False, True)[: 1 + has_offsets]):
        every = " and ".join(f"{float(state.every * factor):.6g}" for state in held)
        names = " and ".join(state.name for state in held)
        states = tuple(_slower(state, factor, keeps_offset) for state in loads.states)
        name = f"{names} taken every {every}, {_ratio(factor)} the scene's time"
        name += ", with the scene's offsets" if keeps_offset else ""
        yield name, replace(loads, states=states)


def _ratio(factor: Fraction) -> str:
    return f"{factor} times" if factor.denominator == 1 else f"{factor} of"


def _slower(state: State, factor: Fraction, keeps_offset: bool) -> State:
    if not isinstance(state, Held):
        return state
    offset = state.offset if keeps_offset else factor * state.offset
    return replace(state, every=factor * state.every, offset=offset)


def _without_delay(loads: Loads, state: Held) -> Iterator[tuple[str, Loads]]:
    """Yield a state that only repeats another one, without its delay."""
    for other in loads.held_states:
        if other is not state and state.value == other.components:
            taken = replace(other, name=state.name, start=state.start)
            yield f"{state.name} without its delay", _with(loads, state, taken)


def _late(loads: Loads, state: Held) -> tuple[str, Loads]:
    """Return a state whose values are used one sample late."""
    now = replace(state, name=f"{state.name}_now")
    start = state.start or (Fraction(0),) * len(state.components)
    late = replace(state, start=start, value=now.components)
    name = f"{state.name} is used one sample late, by {float(state.every):.6g}"
    return name, _with(loads, state, now, late)


def _continuous(loads: Loads, held: tuple[Held, ...]) -> tuple[str, Loads]:
    """Return held states as continuous functions of the state."""
    texts = [pair for each in held for pair in zip(each.components, each.value, strict=True)]
    left = tuple(state for state in loads.states if not isinstance(state, Held))
    names = " and ".join(state.name for state in held)
    changed = replace(loads, definitions=(*loads.definitions, *texts), states=left)
    return f"{names} continuous, where the scene samples", changed


def _held(loads: Loads, answer: Answer) -> Iterator[tuple[str, Loads]]:
    """Yield loads that are taken once in a row, or several times, and held in between."""
    spacing = Fraction(float(np.median(np.diff(answer.times)))).limit_denominator(10**6)
    if not spacing > 0:
        return
    names = {name: f"{name}_held" for name, _ in loads.vectors}
    vectors = tuple(
        (name, tuple(f"{names[name]}{i}" for i in (1, 2, 3))) for name, _ in loads.vectors
    )
    for steps in (1, 2, 4, 5, 10):
        every = spacing / steps
        states = tuple(
            Held(names[name], None, entries, every, Fraction(0), is_vector=True)
            for name, entries in loads.vectors
        )
        name = f"loads taken every {float(every):.6g} and held in between"
        yield name, replace(loads, vectors=vectors, states=states)
