"""The errors of an answer, measured block of rows by block of rows.

The exact motion and the answer are there for one block at a time; of every row remain its errors, in
doubles. Shifts of time are sought on some thousands of the rows, the rows of the largest errors among them.
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
from taylor_verify.judge.errors import accumulated as series
from taylor_verify.judge.errors.accumulated import States, joined
from taylor_verify.judge.errors.drifts import Drifts
from taylor_verify.judge.errors.shift import Shift, time_shifts
from taylor_verify.judge.errors.state import (
    Arc,
    Distances,
    Errors,
    Floats,
    in_doubles,
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
# Shifts of time are sought on so many rows at most, evenly chosen, and on the worst.
MOST_SHIFTED: Final = 4096


@dataclass(frozen=True)
class Measured:
    """The errors of all rows; ``at_nodes`` is the exact motion at the samples that were asked for.

    ``excess`` is |q| - 1, where the answer has quaternions. ``shifts`` are those behind the errors of
    ``states``; ``is_shifted_whole`` tells that no row was left out of them.
    """

    states: list[Errors]
    drifts: list[tuple[Invariant, Errors]]
    excess: Floats | None
    at_nodes: Motion
    shifts: list[Shift | None]
    is_shifted_whole: bool


@dataclass(frozen=True)
class Block:
    """Some rows: their places among all, a scene at their instants, the exact motion and the answer."""

    places: Sequence[int]
    scene: Scene
    truth: Motion
    own: Quantities
    answer: Motion

    def distances(self, arc: Arc) -> list[Distances]:
        return state_distances(self.scene, self.truth, self.answer, arc)


@dataclass(frozen=True)
class Comparison:
    """An answer and the exact motion of the same scene, to be compared at the scene's instants.

    ``digits`` is the precision of the exact motion, ``bits`` that of the errors.
    """

    scene: Scene
    exact: Solution
    quantities: Quantities
    digits: int
    bits: int

    def measured(self, nodes: Sequence[int], costs: Costs) -> Measured:
        """Measure everything. Raises Unsettled where the exact motion cannot be had."""
        elapsed, states, excess, arc = self.scene.clock.elapsed, States(), list[Floats](), Arc()
        with costs.of(TRUTH):
            start = self.exact.motion([Fraction(0)], self.digits + MORE_DIGITS)
        drifts = Drifts(self.scene, start, self.digits)
        wanted, at_nodes, blocks = set(nodes), list[Motion](), list[Block]()
        for block in self.blocks(costs):
            with mp.workprec(self.bits):
                with costs.of(ERRORS):
                    for found in block.distances(arc):
                        states.add(found)
                with costs.of(CONSERVED):
                    moved = [elapsed[k] for k in block.places]
                    drifts.add(moved, block.truth, block.answer, block.own)
                    if "quaternion" in block.own:
                        excess.append(in_doubles(norms(block.own["quaternion"]) - 1))
            first = block.places[0]
            at_nodes.append(block.truth.at([k - first for k in block.places if k in wanted]))
            blocks = [block]
        errors = states.errors()
        with costs.of(ERRORS):
            block, is_whole = self._shifted(errors, blocks[0])
            with mp.workprec(self.bits):
                shifts = time_shifts(
                    block.scene, self.exact, block.truth, block.answer, self.digits, errors
                )
        lengths = np.concatenate(excess) if excess else None
        truth = reduce(joined, at_nodes)
        return Measured(errors, drifts.errors(), lengths, truth, shifts, is_whole)

    def states(self) -> list[Errors]:
        """Measure the states alone. Raises Unsettled likewise."""
        states, arc = States(), Arc()
        for block in self.blocks(Costs()):
            with mp.workprec(self.bits):
                for found in block.distances(arc):
                    states.add(found)
        return states.errors()

    def blocks(self, costs: Costs) -> Iterator[Block]:
        """Yield all rows, some thousands at once, and say how far this has come."""
        count = len(self.scene.clock.instants)
        size = series.BLOCK_OF_SERIES if self.exact.route == "taylor" else series.BLOCK
        for places in series.blocks(count, size):
            yield self._block(places, costs)
            tell_share(places[-1] + 1, count)

    def _block(self, places: Sequence[int], costs: Costs) -> Block:
        clock = self.scene.clock
        instants = tuple(clock.instants[k] for k in places)
        scene = replace(self.scene, clock=Clock(clock.start, instants))
        with costs.of(TRUTH):
            truth = self.exact.motion([clock.elapsed[k] for k in places], self.digits)
        own = rows_at(self.quantities, places)
        return Block(places, scene, truth, own, motion_of(own, self.bits))

    def _shifted(self, errors: Sequence[Errors], last: Block) -> tuple[Block, bool]:
        """The rows on which shifts are sought, and whether they are all."""
        count = len(self.scene.clock.instants)
        if count == len(last.places):
            return last, True
        worst = {index_of_largest(each.doubles) for each in errors}
        places = sorted(worst.union(evenly(count, MOST_SHIFTED)))
        return self._block(places, Costs()), len(places) == count


def tell_share(done: int, count: int) -> None:
    """Tell whoever waits how many of the rows are judged, where there are many."""
    if count > series.BLOCK:
        words = f"{100 * done // count} % of {count} rows"
        _PROGRESS.info(words, extra={"share": done / count})
