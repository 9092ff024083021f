"""Loads whose own states are run otherwise: at other times, late, standing still, without a lag."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import product
from typing import Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.changed_texts import renamed, rewritten
from taylor_verify.judge.causes.fit import Family, fault
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.written_numbers import Number
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Continuous, Held, State

_TIMES: Final = ("2", "3/2", "3", "4", "5", "10", "5/4")
_RATES: Final = tuple(Fraction(times) ** sign for times in _TIMES for sign in (1, -1))
# Parts of an interval at which the fit of another phase begins.
_PHASES: Final = (0.1, 0.3, 0.5, 0.7, 0.9)
_WRONG_RATES: Final = (("stands still", 0), ("has the rate of the other sign", -1))


def faults_of_states(right: Equations) -> Iterator[Family]:
    """Yield the own states of a scene, run otherwise; what no scene may have is none."""
    acting = right.acting
    assert acting is not None
    with suppress(ValueError):
        for name, other in _misread_states(acting.written):
            if next(other.faults(), None) is None:
                yield fault(name, "states", {"acting": acting.of(other)})


def _misread_states(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield the loads of a scene with own states, run otherwise, with what was done."""
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
    yield from (_without_lag(loads, state) for state in own)


def numbers_of_sampling(loads: Loads) -> Iterator[Number]:
    """Yield the times of sampling as numbers: the offset of each held state, and all intervals at once."""
    for state in loads.held_states:
        if state.offset:
            name = f"states.{state.name}.offset"

            def put(value: float, state: Held = state) -> Loads:
                return _with(loads, state, replace(state, offset=_time(value)))

            yield Number(name, float(state.offset), put)
    if loads.held_states:
        every = loads.held_states[0].every

        def scaled(value: float) -> Loads:
            factor = _time(value) / every
            states = (_slower(s, factor, keeps_offset=False) for s in loads.states)
            return replace(loads, states=tuple(states))

        yield Number("every", float(every), scaled)


def phase_of_sampling(right: Equations) -> Iterator[tuple[Family, Floats]]:
    """Yield the time by which all instants are late, with numbers that a fit may begin at.

    Until its first instant a state is what the scene says, or 0.
    """
    acting = right.acting
    assert acting is not None
    loads = acting.written
    if not loads.held_states:
        return
    every = float(loads.held_states[0].every)

    def late(values: Floats) -> Changes:
        shift = _time(float(values[0]))
        states = (_late_by(state, shift) for state in loads.states)
        return {"acting": acting.of(replace(loads, states=tuple(states)))}

    names = [state.name for state in loads.held_states]
    label = f"time by which {' and '.join(names)} {'is' if len(names) == 1 else 'are'} taken late"
    one, none = np.array([every]), np.zeros(1)
    yield Family(label, "states", none, one, late, (label,)), every * np.array(_PHASES)


def _late_by(state: State, shift: Fraction) -> State:
    if not isinstance(state, Held):
        return state
    return replace(state, start=state.first, offset=state.offset + shift)


def _time(value: float) -> Fraction:
    """Return a time of sampling; raises ValueError where it is none."""
    if not value > 0:
        raise ValueError(value)
    return Fraction(value).limit_denominator(10**9)


def _with(loads: Loads, old: State, *new: State) -> Loads:
    """Return the loads with other states in the place of one."""
    states = tuple(s for each in loads.states for s in (new if each is old else (each,)))
    return replace(loads, states=states)


def _at_other_rates(loads: Loads, held: tuple[Held, ...]) -> Iterator[tuple[str, Loads]]:
    has_offsets = any(state.offset for state in held)
    for factor, keeps_offset in product(_RATES, (False, True)[: 1 + has_offsets]):
        every = " and ".join(f"{float(state.every * factor):.6g}" for state in held)
        names = " and ".join(state.name for state in held)
        states = tuple(_slower(state, factor, keeps_offset=keeps_offset) for state in loads.states)
        name = f"{names} taken every {every}, {_ratio(factor)} the scene's time"
        name += ", with the scene's offsets" if keeps_offset else ""
        yield name, replace(loads, states=states)


def _ratio(factor: Fraction) -> str:
    return f"{factor} times" if factor.denominator == 1 else f"{factor} of"


def _slower(state: State, factor: Fraction, *, keeps_offset: bool) -> State:
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
    now = replace(state, name=f"{state.name}_now", start=state.first)
    late = replace(state, start=state.first, value=now.components)
    name = f"{state.name} is used one sample late, by {float(state.every):.6g}"
    return name, _with(loads, state, now, late)


def _continuous(loads: Loads, held: tuple[Held, ...]) -> tuple[str, Loads]:
    """Return loads that read held states as continuous functions."""
    texts = {
        name: str(text)
        for each in held
        for name, text in zip(each.components, each.value, strict=True)
    }
    names = " and ".join(state.name for state in held)
    return f"{names} continuous, where the scene samples", _as_functions(loads, held, texts)


def _without_lag(loads: Loads, state: Continuous) -> tuple[str, Loads]:
    """Return loads that read a state as the value at which its rate, linear in the state, is zero."""
    texts = dict[str, str]()
    for name, rate in zip(state.components, map(str, state.rate), strict=True):
        at_0, at_1 = (renamed(rate, {name: number}) for number in ("0", "1"))
        texts[name] = f"({at_0})/(({at_0}) - ({at_1}))"
    return f"{state.name} without its lag", _as_functions(loads, (state,), texts)


def _as_functions(loads: Loads, states: Sequence[State], texts: Mapping[str, str]) -> Loads:
    """Return loads that read the components of states as texts; the states stay, unread."""
    now = {name: f"{name}_now" for name in texts}
    others = tuple(state for state in loads.states if state not in states)
    changed = rewritten(replace(loads, states=others), partial(renamed, names=now))
    own = ((now[name], renamed(text, now)) for name, text in texts.items())
    return replace(
        changed, definitions=(*changed.definitions, *own), states=(*changed.states, *states)
    )
