"""The truth where no closed form is known: the equations of both texts, enclosed by Taylor series.

A motion is a set of balls that is proven to contain it (exact.enclosure): the rounding of the data and of
every operation, the truncation of each series, and what the motion makes of all these are bounded.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, log2
from typing import Any, Final, final

from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.loaded import LoadedBody, body_of
from taylor_verify.exact.enclosure.stopping import MOST_STEPS, reaching
from taylor_verify.exact.enclosure.system import System
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.exact.proving import Proving, Size, SoFar, Times, rows_of
from taylor_verify.exact.registry import kind_of
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.states import Held
from taylor_verify.scenes.motion import Motion, State
from taylor_verify.scenes.scene import Scene

# A motion without instants takes about so many steps.
_FEW_STEPS: Final = 50


@dataclass(frozen=True)
class Enclosing(Proving):
    """Motions of a scene in balls."""

    scene: Scene

    @cached_property
    def _body(self) -> LoadedBody:
        return body_of(self.scene)

    @cached_property
    def _system(self) -> System:
        return self._body.system()

    def _body_until(self, time: Fraction) -> LoadedBody:
        """The body as far as an elapsed time; stairs of floor are listed so far."""
        loads = self.scene.body.loads
        if loads is None or (further := reaching(loads, time)) is loads:
            return self._body
        return body_of(replace(self.scene, body=self.scene.body.with_loads(further)))

    def _rounding_bits(self, elapsed: Sequence[Fraction]) -> int:
        """The bits that are rounded away in the steps from instant to instant, beyond those of others."""
        loads = self.scene.body.loads
        if loads is None or not loads.held_values:
            return 0
        last = max((*elapsed, Fraction(0)))
        count = sum(state.count(last) for state in loads.states if isinstance(state, Held))
        return max(0, ceil(log2(max(count, 1) / _FEW_STEPS)))

    def vectors(self, row: Row) -> dict[str, tuple[Any, Size | SoFar]]:
        """Return the tracked quantities as balls, with their largest sizes so far."""
        vectors: dict[str, tuple[Any, Size | SoFar]] = {
            name: (row.state[3 * k : 3 * k + 3], Size(row.largest[k]))
            for k, name in enumerate(kind_of(self.scene.body).moving)
        }
        if row.turn:
            vectors["attitude"] = [row.turn[i : i + 3] for i in (0, 3, 6)], Size(0.0)
        if "centre" in self.scene.track:
            block = len(vectors)
            span = self._system.spans[block]
            vectors["centre"] = row.state[span.start : span.stop], Size(row.largest[block])
        for name, peak in self.peaks(row).items():
            places = self._system.own[name]
            vectors[name] = row.state[places.start : places.stop], SoFar(peak)
        return vectors

    @property
    def names(self) -> Sequence[str]:
        track = self.scene.track
        frame = ["attitude"] * bool(track) + ["centre"] * ("centre" in track)
        return [*kind_of(self.scene.body).moving, *frame, *self.own_names]

    @property
    def own_names(self) -> Sequence[str]:
        return [group.name for group in self.scene.groups if group.name in self.scene.states]


@final
@dataclass(frozen=True)
class TaylorSolution(Enclosing):
    """The motion of any scene, free or loaded, in balls that are proven to contain it."""

    most_steps: int = MOST_STEPS
    is_one_course = True

    def rows(self, times: Times, bits: int, most_bits: int) -> Iterator[tuple[int, Row]]:
        system = self._body_until(max(times.values(), key=abs)).system()
        course = Course.of(system, system.start_balls(), bits, most_bits)
        course = replace(course, most_steps=self.most_steps, begin=self.scene.clock.start)
        yield from rows_of(course, times)


def arcs(
    scene: Scene,
    starts: Sequence[State],
    spans: Sequence[Fraction],
    digits: int,
    begins: Sequence[Fraction] = (),
    own: Sequence[Mapping[str, Vector]] = (),
) -> Motion:
    """Row k: where the scene's equations lead from the exact state starts[k] in the time spans[k].

    Enclosed to ``digits``, as Solution.motion is, and raises Unsettled likewise. Written
    loads change with time: there each arc has to say when it begins, ``begins`` since the start of the
    scene. Elsewhere that changes nothing. A scene with states of its own needs these too: ``own`` has them
    by name, those that are held as they are after an instant at the beginning of an arc.
    """
    body = scene.body
    if body.loads is not None and len(begins) != len(starts):
        raise ValueError(
            f"expected the times at which {len(starts)} arcs under loads that change with time begin, "
            f"got {len(begins)} @ {scene.name}"
        )
    if body.loads is not None and body.loads.states and len(own) != len(starts):
        raise ValueError(
            f"expected the scene's own states at the start of {len(starts)} arcs, "
            f"got {len(own)} @ {scene.name}"
        )
    return _Arcs(scene, tuple(starts), tuple(begins), tuple(own)).motion(spans, digits)


@final
@dataclass(frozen=True)
class _Arcs(Enclosing):
    """Many short motions of one body, each from a state of its own, and by the clock from its time."""

    starts: tuple[State, ...]
    begins: tuple[Fraction, ...]
    own: tuple[Mapping[str, Vector], ...]

    def rows(self, times: Times, bits: int, most_bits: int) -> Iterator[tuple[int, Row]]:
        begins = self.begins or [Fraction(0)] * len(self.starts)
        body = self._body_until(max((begins[k] + span for k, span in times.items()), key=abs))
        for number, span in times.items():
            own = self.own[number] if self.own else {}
            system = body.starting(self.starts[number], own).system()
            state = system.start_balls(begins[number])
            course = Course.of(system, state, bits, most_bits)
            arc = replace(course, origin=begins[number], has_values=True)
            yield number, next(arc.rows([span]))[1] if span else arc.first_row()
