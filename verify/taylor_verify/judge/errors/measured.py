"""The errors of an answer, measured in blocks of rows.

An answer from elsewhere may lack quantities. The exact motion takes their place, and no error that depends
on one of them is returned.

Only one block of the exact motion and of the answer is in memory at a time. The errors of all rows are
stored as doubles. Shifts of time are searched on some thousands of rows, with the rows of the largest
errors among them.
"""

from __future__ import annotations

import logging
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.invariants import Invariant, invariants
from taylor_verify.exact.solution import Solution
from taylor_verify.judge.errors.drifts import Drifts
from taylor_verify.judge.errors.shift import Shift, time_shifts
from taylor_verify.judge.errors.state import (
    Arc,
    Errors,
    Floats,
    States,
    VelocityErrors,
    in_doubles,
    joined,
    norms,
    state_distances,
)
from taylor_verify.judge.floor.arithmetic import MORE_DIGITS
from taylor_verify.judge.gates import index_of_largest
from taylor_verify.records.quantities import VELOCITIES, state_groups
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.loads.loads import QUATERNION, Loads
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import motion_of, rows_at

Quantities = Mapping[str, np.ndarray[Any, Any]]

_PROGRESS: Final = logging.getLogger("taylor_verify.progress")
# Number of rows that are compared at once. A row takes some kB in numbers of mpmath.
BLOCK: Final = 4096
# Larger blocks for the Taylor route, which begins at the start again for every block.
BLOCK_OF_SERIES: Final = 32768
# The names of a state's quantities in a sensitivity, where they differ.
_BLOCKS: Final = {"omega": "momentum"}
# Shifts of time are searched on at most this many evenly chosen rows, and on the worst rows.
MOST_SHIFTED: Final = 4096


@dataclass(frozen=True)
class Velocity:
    """Errors of a velocity that is no state, its ``sizes`` over the largest, and the shift of time."""

    group: str
    errors: Errors
    sizes: Floats
    shift: Shift | None


@dataclass(frozen=True)
class Measured:
    """The errors of all rows; ``at_nodes`` is the exact motion at the requested samples.

    Drifts that are ``worked`` are differences from the exact motion.
    ``excess`` is |q| - 1, or the largest entry of (R^T R - 1)/2, if the answer has an attitude.
    ``shifts`` explain the errors of ``states``;
    ``is_shifted_whole`` is True if the shifts use all rows.
    """

    states: list[Errors]
    drifts: list[tuple[Invariant, Errors]]
    worked: frozenset[str]
    velocities: list[Velocity]
    excess: Floats | None
    at_nodes: Motion
    shifts: list[Shift | None]
    is_shifted_whole: bool


@dataclass(frozen=True)
class Block:
    """Some rows: their indices, a scene at their instants, the exact motion and the answer.

    ``own`` are the numbers of the answer, and ``velocities`` those of its columns that are no states.
    """

    places: Sequence[int]
    scene: Scene
    truth: Motion
    own: Quantities
    velocities: Quantities
    answer: Motion

    def is_whole_of(self, scene: Scene) -> bool:
        """Return True if the block has all rows of the scene."""
        return len(self.places) == len(scene.clock.instants)


def _stretch(matrices: np.ndarray[Any, Any]) -> Floats:
    """Return the largest entry of (R^T R - 1)/2 of each matrix; of 1 + e times a rotation it is e."""
    products = np.matmul(matrices.transpose(0, 2, 1), matrices).reshape(-1, 9)
    off = in_doubles((products - np.eye(3, dtype=int).reshape(9)).reshape(-1)).reshape(-1, 9) / 2
    return np.asarray(off[np.arange(len(off)), np.argmax(np.abs(off), axis=1)])


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

    def measured(self, nodes: Sequence[int]) -> Measured:
        """Measure all quantities. Raises Unsettled if the exact motion cannot be computed."""
        states, excess, arc = States(), list[Floats](), Arc()
        start = self.exact.motion([Fraction(0)], self.digits + MORE_DIGITS)
        conserved, worked = self._determined(start)
        arc_scene = self._arc_scene
        groups = state_groups(arc_scene.model, arc_scene.track)
        drifts = Drifts(self.scene, start, self.digits, conserved, arc_scene, worked)
        velocities = [VelocityErrors(group) for group in self._velocities]
        wanted, at_nodes, last = set(nodes), list[Motion](), None
        for block in self.blocks():
            with mp.workprec(self.bits):
                for distances in state_distances(block.scene, block.truth, block.answer, arc):
                    states.add(distances)
                for one in velocities:
                    one.add(block.scene.body, block.truth, block.velocities[one.group])
                if conserved:
                    own = {name: block.own[name] for name in groups}
                    drifts.add(block.scene.clock.elapsed, block.truth, block.answer, own)
                if "quaternion" in block.own:
                    excess.append(in_doubles(norms(block.own["quaternion"]) - 1))
                elif "attitude" in block.own:
                    excess.append(_stretch(block.own["attitude"]))
            first = block.places[0]
            at_nodes.append(block.truth.at([k - first for k in block.places if k in wanted]))
            last = block
        assert last is not None
        has = {self.scene.known_groups[name].quantity for name in self._has}
        errors = [each for each in states.errors() if each.quantity in has]
        moving = [(one.group, *one.joined()) for one in velocities]
        every = [*errors, *(of_one for _, of_one, _ in moving)]
        block = self._shifted(every, last)
        with mp.workprec(self.bits):
            shifts = self._shifts(block, every)
        pairs = zip(moving, shifts[len(errors) :], strict=True)
        return Measured(
            errors,
            drifts.errors(),
            worked,
            [Velocity(*one, shift) for one, shift in pairs],
            np.concatenate(excess) if excess else None,
            reduce(joined, at_nodes),
            shifts[: len(errors)],
            block.is_whole_of(self.scene),
        )

    # What the answer has.

    @property
    def _has(self) -> set[str]:
        return {"attitude" if name == "quaternion" else name for name in self.quantities}

    @property
    def _arc_scene(self) -> Scene:
        """The scene with the quantities that an arc from a row can begin with.

        Its frame is a rotation to the last digit: a quaternion is one, and a matrix of rounded numbers is
        none.
        """
        has_frame = "quaternion" in self.quantities or "attitude" not in self.scene.track
        return self.scene if has_frame else replace(self.scene, track=frozenset())

    def _determined(self, start: Motion) -> tuple[list[Invariant], frozenset[str]]:
        """Return the conserved quantities that depend on nothing that the answer lacks.

        The names are of those that change under written loads, where no arc shows by how much.
        """
        has = {_BLOCKS.get(name, name) for name in self._has}
        determined, worked = list[Invariant](), set[str]()
        for invariant in invariants(self.scene):
            blocks = invariant.sensitivity(start).keys()
            is_followed = invariant.is_conserved or self._has_balance(blocks)
            if has.issuperset(blocks) and (is_followed or self.scene.body.loads is not None):
                determined.append(invariant)
                if not is_followed:
                    worked.add(invariant.name)
        return determined, frozenset(worked)

    def _has_balance(self, blocks: Collection[str]) -> bool:
        """Return True if a quantity that depends on these blocks is known at the end of an arc."""
        loads, frame = self.scene.body.loads, self._arc_scene.track
        is_known = frame >= {"attitude", "centre"}.intersection(blocks)
        return is_known and (loads is None or self._has_arcs(loads))

    def _has_arcs(self, loads: Loads) -> bool:
        """Return True if an arc can begin at a row: where loads read the frame, it needs all of the frame.

        Loads that read the quaternion itself read its sign, which a row does not determine. Nor do rows
        determine states of the scene's own that are in flight.
        """
        if loads.states or loads.rotor or not loads.inputs.isdisjoint(QUATERNION):
            return False
        frame = {"quaternion"} if loads.reads_attitude else set()
        frame |= {"centre"} if loads.reads_centre else set()
        return frame <= self.quantities.keys()

    @property
    def _velocities(self) -> list[str]:
        """The groups of velocities that are no states of the body."""
        names = (name for name in VELOCITIES if name not in self.scene.initial.MOVING)
        return [name for name in names if name in self.quantities]

    def _shifts(self, block: Block, errors: Sequence[Errors]) -> list[Shift | None]:
        """Return the shifts of time; none under written loads, whose rates are not known."""
        if self.scene.body.loads is not None:
            return [None] * len(errors)
        answer = Motion({**block.answer.quantities, **block.velocities}, block.answer.radius)
        return time_shifts(block.scene, self.exact, block.truth, answer, self.digits, errors)

    # The rows in blocks.

    def blocks(self) -> Iterator[Block]:
        """Yield all rows in blocks of some thousands, and log the progress."""
        count = len(self.scene.clock.instants)
        size = BLOCK_OF_SERIES if self.exact.route == "taylor" else BLOCK
        for begin in range(0, count, size):
            end = min(begin + size, count)
            yield self._block(range(begin, end))
            if count > BLOCK:
                words = f"{100 * end // count} % of {count} rows"
                _PROGRESS.info(words, extra={"share": end / count})

    def _block(self, places: Sequence[int]) -> Block:
        clock = self.scene.clock
        instants = tuple(clock.instants[k] for k in places)
        scene = replace(self.scene, clock=Clock(clock.start, instants))
        truth = self.exact.motion(scene.clock.elapsed, self.digits)
        own = rows_at(self.quantities, places)
        velocities = {name: own.pop(name) for name in self._velocities}
        own |= {name: rows for name, rows in truth.quantities.items() if name not in self._has}
        return Block(places, scene, truth, own, velocities, motion_of(own, self.bits))

    def _shifted(self, errors: Sequence[Errors], last: Block) -> Block:
        """Return the rows on which shifts are searched."""
        if last.is_whole_of(self.scene):
            return last
        count = len(self.scene.clock.instants)
        worst = {index_of_largest(error.values) for error in errors}
        return self._block(sorted(worst.union(evenly(count, MOST_SHIFTED))))
