"""Motions of somebody's own equations, enclosed as those of bodies are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, Final, final

from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.lowering import Lowering
from taylor_verify.exact.enclosure.operations import Time
from taylor_verify.exact.enclosure.stopping import reaching
from taylor_verify.exact.enclosure.system import Piece, System
from taylor_verify.exact.enclosure.tape import Graph, Tape
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.exact.proving import Proving, SoFar, Times, rows_of
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.loads import Piece as Texts
from taylor_verify.scenes.loads.steps import text_with_address

# Minutes of work. Beside the end of a motion steps become short before anything else shows it.
_MOST_STEPS: Final = 20_000


@final
@dataclass(frozen=True)
class Field(Proving):
    """The motion of the continuous states of loads without a body, each a block of its own."""

    loads: Loads
    is_one_course = True

    @property
    def names(self) -> Sequence[str]:
        return self.loads.continuous

    @property
    def own_names(self) -> Sequence[str]:
        return self.names

    def vectors(self, row: Row) -> dict[str, tuple[Any, SoFar]]:
        """The numbers as balls; each error is counted by the largest size so far."""
        peaks = self.peaks(row)
        return {
            name: (ball, SoFar(peaks[name]))
            for name, ball in zip(self.names, row.state, strict=True)
        }

    def rows(self, times: Times, bits: int, most_bits: int) -> Iterator[tuple[int, Row]]:
        loads = reaching(self.loads, max(times.values(), key=abs))
        system = _system(loads, self._tapes)
        course = Course.of(system, system.start_balls(), bits, most_bits)
        course = replace(course, begin=self.loads.origin, most_steps=_MOST_STEPS)
        yield from rows_of(course, times)

    @cached_property
    def _tapes(self) -> dict[Any, Tape]:
        return {}


def _system(loads: Loads, tapes: dict[Any, Tape]) -> System:
    names = loads.continuous

    def piece(elapsed: Fraction, is_later: bool) -> Piece:
        texts = loads.piece(elapsed, is_later)
        key = texts[2:]
        if key not in tapes:
            tapes[key] = _tape(names, texts)
        return Piece(tapes[key], texts.end if is_later else texts.begin)

    def step_text(elapsed: Fraction, is_later: bool, place: int) -> str:
        texts = loads.piece(elapsed, is_later)
        outputs = ((f"the rate of {name}", k) for name, k in zip(names, texts.rates, strict=True))
        return text_with_address(texts.steps, place, outputs)

    ends = tuple(range(1, len(names) + 1))
    start = tuple(entry for state in loads.states for entry in state.start or ())
    own: Mapping[str, range] = {name: range(k, k + 1) for k, name in enumerate(names)}
    return System(piece, ends, start, own=own, step_text=step_text)


def _tape(names: Sequence[str], texts: Texts) -> Tape:
    """The rates of all names in one piece of time."""
    graph = Graph()
    inputs = dict(zip(names, graph.states(len(names)), strict=True))
    inputs["t"] = graph.node(Time())
    rates = Lowering(graph, inputs).expressions(texts.steps, texts.rates)
    return Tape.of(graph, len(names), rates)
