"""The errors of an answer, measured in blocks of rows.

Only one block of the exact motion and of the answer is in memory at a time. The errors of all rows are
stored as doubles. Shifts of time are searched on some thousands of rows, with the rows of the largest
errors among them.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.invariants import Invariant
from taylor_verify.exact.solution import Solution
from taylor_verify.judge.costs import CONSERVED, ERRORS, TRUTH, Costs
from taylor_verify.judge.errors.drifts import Drifts
from taylor_verify.judge.errors.shift import Shift, time_shifts
from taylor_verify.judge.errors.state import (
    Arc,
    Errors,
    Floats,
    States,
    in_doubles,
    joined,
    norms,
    state_distances,
)
from taylor_verify.judge.floor.arithmetic import MORE_DIGITS
from taylor_verify.judge.gates import index_of_largest
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import motion_of, rows_at

Quantities = Mapping[str, np.ndarray[Any, Any]]

_PROGRESS: Final = logging.getLogger("taylor_verify.progress")
# Number of rows that are compared at once. A row takes some kB in numbers of mpmath.
BLOCK: Final = 4096
# Larger blocks for the Taylor route, which begins at the start again for every block.
BLOCK_OF_SERIES: Final = 32768
# Shifts of time are searched on at most this many evenly chosen rows, and on the worst rows.
MOST_SHIFTED: Final = 4096


@dataclass(frozen=True)
class Measured:
    """The errors of all rows; ``at_nodes`` is the exact motion at the requested samples.

    ``excess`` is |q| - 1, if the answer has quaternions. ``shifts`` explain the errors of ``states``;
    ``is_shifted_whole`` is True if the shifts use all rows.
    """

    states: list[Errors]
    drifts: list[tuple[Invariant, Errors]]
    excess: Floats | None
    at_nodes: Motion
    shifts: list[Shift | None]
    is_shifted_whole: bool


@dataclass(frozen=True)
class Block:
    """Some rows: their indices, a scene at their instants, the exact motion and the answer."""

    places: Sequence[int]
    scene: Scene
    truth: Motion
    own: Quantities
    answer: Motion

    def is_whole_of(self, scene: Scene) -> bool:
        """Return True if the block has all rows of the scene."""
        return len(self.places) == len(scene.clock.instants)

    def add_to(self, states: States, arc: Arc) -> None:
        """Add the distances of these rows to ``states``; ``arc`` is the path up to here."""
        for distances in state_distances(self.scene, self.truth, self.answer, arc):
            states.add(distances)


@dataclass(frozen=True)
class Comparison:
    """A comparison of an answer with the exact motion of the same scene, at the scene's instants.

    ``digits`` is the precision of the exact motion, ``bits`` that of the errors.
    """

    scene: Scene
    exact: Solution
    quantities: Quantities
    digits: int
    bits: int

    def measured(self, nodes: Sequence[int], costs: Costs) -> Measured:
        """Measure states, drifts and shifts. Raises Unsettled if the exact motion cannot be computed."""
        states, excess, arc = States(), list[Floats](), Arc()
        with costs.of(TRUTH):
            start = self.exact.motion([Fraction(0)], self.digits + MORE_DIGITS)
        drifts = Drifts(self.scene, start, self.digits)
        wanted, at_nodes, last = set(nodes), list[Motion](), None
        for block in self.blocks(costs):
            with mp.workprec(self.bits):
                with costs.of(ERRORS):
                    block.add_to(states, arc)
                with costs.of(CONSERVED):
                    drifts.add(block.scene.clock.elapsed, block.truth, block.answer, block.own)
                    if "quaternion" in block.own:
                        excess.append(in_doubles(norms(block.own["quaternion"]) - 1))
            first = block.places[0]
            at_nodes.append(block.truth.at([k - first for k in block.places if k in wanted]))
            last = block
        assert last is not None
        errors, digits = states.errors(), self.digits
        with costs.of(ERRORS):
            block = self._shifted(errors, last)
            with mp.workprec(self.bits):
                shifts = time_shifts(
                    block.scene, self.exact, block.truth, block.answer, digits, errors
                )
        lengths = np.concatenate(excess) if excess else None
        truth, is_whole = reduce(joined, at_nodes), block.is_whole_of(self.scene)
        return Measured(errors, drifts.errors(), lengths, truth, shifts, is_whole)

    def states(self) -> list[Errors]:
        """Measure the states only. Raises Unsettled if the exact motion cannot be computed."""
        states, arc = States(), Arc()
        for block in self.blocks(Costs()):
            with mp.workprec(self.bits):
                block.add_to(states, arc)
        return states.errors()

    def blocks(self, costs: Costs) -> Iterator[Block]:
        """Yield all rows in blocks of some thousands, and log the progress."""
        count = len(self.scene.clock.instants)
        size = BLOCK_OF_SERIES if self.exact.route == "taylor" else BLOCK
        for begin in range(0, count, size):
            end = min(begin + size, count)
            yield self._block(range(begin, end), costs)
            if count > BLOCK:
                words = f"{100 * end // count} % of {count} rows"
                _PROGRESS.info(words, extra={"share": end / count})

    def _block(self, places: Sequence[int], costs: Costs) -> Block:
        clock = self.scene.clock
        instants = tuple(clock.instants[k] for k in places)
        scene = replace(self.scene, clock=Clock(clock.start, instants))
        with costs.of(TRUTH):
            truth = self.exact.motion(scene.clock.elapsed, self.digits)
        own = rows_at(self.quantities, places)
        return Block(places, scene, truth, own, motion_of(own, self.bits))

    def _shifted(self, errors: Sequence[Errors], last: Block) -> Block:
        """Return the rows on which shifts are searched."""
        if last.is_whole_of(self.scene):
            return last
        count = len(self.scene.clock.instants)
        worst = {index_of_largest(error.doubles) for error in errors}
        return self._block(sorted(worst.union(evenly(count, MOST_SHIFTED))), Costs())
