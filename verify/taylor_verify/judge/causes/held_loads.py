"""Loads that are taken once in a step and held in between, in body axes, while all else moves exactly."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from itertools import product
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.changed_texts import has_text
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.hung_loads import written_out
from taylor_verify.judge.causes.many_flows import Floats, flow
from taylor_verify.judge.causes.methods_with_memory import runs
from taylor_verify.judge.causes.replayed_methods import Method
from taylor_verify.models.acting import Acting
from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.scenes.loads.states import Held

# The price of a step in evaluations, about.
_EVALUATIONS: Final = 12
_LATE: Final = {
    ", used one step late": 0.0,
    ", used one step late but for the first step": 1.0,
}


@dataclass(frozen=True)
class HeldLoads:
    """Loads that are ``taken`` once in a step, and the ``others`` of the scene, that are not; in words.

    ``late`` says in words if the values of a step are used in the next one; the first step has its own
    values ``times_at_first`` 0 or 1.
    """

    words: str
    taken: Acting
    others: Acting
    late: str = ""
    times_at_first: float = 0.0

    def at(self, equations: Equations, time: Floats, z: Floats) -> Floats:
        """Return the loads that are taken, with those that are constant."""
        taken = replace(equations, acting=self.taken)
        return taken.loads_at(time, z, equations.velocities(time, z))

    def moved(
        self, load: Floats, equations: Equations, time: Floats, z: Floats, h: Floats
    ) -> Floats:
        """Return the exact step under a load in body axes."""
        return flow(replace(equations, acting=self.others, load=load).rates, z, time, h, 1)

    def step(self, equations: Equations, time: Floats, z: Floats, h: Floats) -> Floats:
        """Return the exact step under the loads at its begin."""
        return self.moved(self.at(equations, time, z), equations, time, z, h)

    def late_step(
        self, equations: Equations, time: Floats, z: Floats, h: Floats, before: Any
    ) -> tuple[Floats, Any]:
        """Return the step under the loads of the step before, with the loads now."""
        now = self.at(equations, time, z)
        load = self.times_at_first * now if before is None else before
        return self.moved(load, equations, time, z, h), now

    def over_an_arc(self, equations: Equations, time: Floats, z: Floats, h: Floats) -> Floats:
        """Return the step under the loads of the step before, where its loads are nearly those now."""
        earlier = self.moved(self.at(equations, time, z), equations, time, z, -h)
        return self.moved(self.at(equations, time - h, earlier), equations, time, z, h)

    def changes(self, answer: Answer, h: float) -> Changes:
        """Return the scene whose loads are taken every h; none if it has faults."""
        taken, every = self.taken.written, Fraction(h).limit_denominator(10**6)
        names = {name: f"{name}_held" for name, _ in taken.vectors}
        vectors = tuple((n, tuple(f"{own}{i}" for i in (1, 2, 3))) for n, own in names.items())
        states = [
            Held(names[name], None, entries, every, Fraction(0), is_vector=True)
            for name, entries in taken.vectors
        ]
        if self.late:
            now = [
                replace(state, name=f"{name}_now", start=first)
                for state, (name, _), first in zip(
                    states, taken.vectors, self._first(answer), strict=True
                )
            ]
            states = [
                *(replace(s, value=n.components) for s, n in zip(states, now, strict=True)),
                *now,
            ]
        other = replace(self.others.written, vectors=vectors, states=tuple(states))
        return {"acting": self.taken.of(other)} if next(other.faults(), None) is None else {}

    def _first(self, answer: Answer) -> Iterator[tuple[Fraction, Fraction, Fraction]]:
        """Yield the values of each vector that a late first step has."""
        parts = (answer.start.v, answer.start.q, answer.start.c)
        z = np.hstack([part for part in parts if part is not None]).T[None]
        loads = self.times_at_first * self.at(answer.right, np.array([answer.begins]), z)[0, :, 0]
        for vector in np.split(loads, len(loads) // 3):
            first, second, third = (Fraction(repr(float(value))) for value in vector)
            yield first, second, third


def methods(acting: Acting) -> dict[str, Method]:
    """Return the methods by which all loads are held, and those alone that are written as texts."""
    return {
        part.words: Method(1, part.step, _EVALUATIONS, has_frame=True, held=part)
        for part in _parts(acting)
    }


def late_methods(acting: Acting) -> dict[str, Method]:
    """Return the methods by which the loads of a step are used in the next one."""
    late = [
        replace(part, late=words, times_at_first=times)
        for part, (words, times) in product(_parts(acting), _LATE.items())
    ]
    return {
        f"{part.words}{part.late}": Method(
            1, part.over_an_arc, _EVALUATIONS, has_frame=True, run=runs(part.late_step), held=part
        )
        for part in late
    }


@lru_cache(maxsize=8)
def without_texts(acting: Acting) -> Acting:
    """Return weight and buoyancy alone, of all loads."""
    nothing = tuple((name, ZERO_VECTOR) for name, _ in acting.written.vectors)
    return acting.of(replace(acting.written, vectors=nothing))


@lru_cache(maxsize=8)
def _parts(acting: Acting) -> tuple[HeldLoads, ...]:
    loads, hung = acting.written, without_texts(acting)
    nothing = acting.of(replace(hung.written, hung=()))
    parts = [HeldLoads("loads", acting.of(written_out(loads)), nothing)]
    texts = [name for name, entries in loads.vectors if has_text(entries)]
    if loads.hung and texts:
        words = f"{' and '.join(texts)}, but for weight and buoyancy,"
        parts.append(HeldLoads(words, acting.of(replace(loads, hung=())), hung))
    return tuple(parts)
