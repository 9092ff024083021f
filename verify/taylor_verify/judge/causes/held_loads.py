"""Loads that are taken once in a step and held in between, in body axes, while all else moves exactly."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.changed_texts import has_text, written_out
from taylor_verify.judge.causes.many_flows import Floats, flow
from taylor_verify.judge.causes.replayed_methods import Method
from taylor_verify.models.acting import Acting
from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.scenes.loads.states import Held

# The price of a step in evaluations, about.
_EVALUATIONS: Final = 12


@dataclass(frozen=True)
class HeldLoads:
    """Loads that are ``taken`` once in a step, and the ``others`` of the scene, that are not; in words."""

    words: str
    taken: Acting
    others: Acting

    def step(self, equations: Equations, time: Floats, z: Floats, h: Floats) -> Floats:
        """Return the exact step under the loads at its begin."""
        taken = replace(equations, acting=self.taken)
        load = taken.loads_at(time, z, equations.velocities(time, z))
        return flow(replace(equations, acting=self.others, load=load).rates, z, time, h, 1)

    def changes(self, h: float) -> Changes:
        """Return the scene whose loads are taken every h; none if it has faults."""
        taken, every = self.taken.written, Fraction(h).limit_denominator(10**6)
        names = {name: f"{name}_held" for name, _ in taken.vectors}
        vectors = tuple((n, tuple(f"{own}{i}" for i in (1, 2, 3))) for n, own in names.items())
        states = tuple(
            Held(names[name], None, entries, every, Fraction(0), is_vector=True)
            for name, entries in taken.vectors
        )
        other = replace(self.others.written, vectors=vectors, states=states)
        return {"acting": self.taken.of(other)} if next(other.faults(), None) is None else {}


def methods(acting: Acting) -> Iterator[tuple[str, Method]]:
    """Yield the methods by which all loads are held, and those alone that are written as texts."""
    loads = acting.written
    nothing = tuple((name, ZERO_VECTOR) for name, _ in loads.vectors)
    every, hung = written_out(loads), replace(loads, vectors=nothing)
    parts = [HeldLoads("loads", acting.of(every), acting.of(replace(hung, hung=())))]
    texts = [name for name, entries in loads.vectors if has_text(entries)]
    if loads.hung and texts:
        words = f"{' and '.join(texts)}, but for weight and buoyancy,"
        parts.append(HeldLoads(words, acting.of(replace(loads, hung=())), acting.of(hung)))
    for part in parts:
        yield part.words, Method(1, part.step, _EVALUATIONS, has_frame=True, held=part)
