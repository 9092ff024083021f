"""Held values of an answer against their law at the rows of the answer itself.

A row on an instant has the value that was just taken, and the state that it was taken from. So the law at
that row gives the value, whatever the integrator did before. The law may read no held value, because a row
does not have those from before the instant.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.conditioning.condition import Path
from taylor_verify.exact.row_arithmetic import applied
from taylor_verify.judge.errors.state import Errors, Floats, in_doubles, norms, or_one
from taylor_verify.judge.floor.loads import Along
from taylor_verify.models.evaluated import evaluated
from taylor_verify.scenes.loads.loads import CENTRE, QUATERNION, ROTATION, Loads
from taylor_verify.scenes.loads.states import Held
from taylor_verify.scenes.loads.steps import needed
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import motion_of, rows_at

Column = np.ndarray[Any, Any]


def laws_of(scene: Scene) -> list[str]:
    """Return the names of the laws of the held states that a scene tracks."""
    loads = scene.body.loads
    states = () if loads is None else loads.held_states
    return [_named_law(state) for state in states if state.name in scene.states]


def _named_law(state: Held) -> str:
    return f"{state.name} law"


@dataclass(frozen=True)
class Laws:
    """The laws of the held states that an answer has.

    ``truth`` is the exact motion at the samples of ``scene``, and ``path`` its orbit.
    """

    scene: Scene
    truth: Motion
    path: Path
    answer: Mapping[str, Column]
    bits: int
    roundoff: float

    def __iter__(self) -> Iterator[tuple[Errors, Floats]]:
        """Yield the errors and the roundoff floor of each law that rows of the answer determine.

        They are those at the rows on the instants of its state, and zero at others.
        """
        loads = self.scene.body.loads
        if loads is None:
            return
        taken = {instant.time: instant.names for instant in loads.instants(self._elapsed[-1])}
        for state in loads.held_states:
            rows = [k for k, t in enumerate(self._elapsed) if state.name in taken.get(t, ())]
            is_known = bool(rows) and state.name in self._numbers
            if is_known and self._reads(loads, state) <= self._columns.keys():
                yield self._law(loads, state, rows)

    @property
    def _elapsed(self) -> Sequence[Any]:
        return self.scene.clock.elapsed

    def _reads(self, loads: Loads, state: Held) -> set[str]:
        """Return the inputs of the values of a state in all pieces of time that hold at the samples."""
        pieces = {id(p): p for p in (loads.piece(time) for time in self._elapsed)}
        names: set[str] = set()
        for piece in pieces.values():
            places = [piece.values[k] for k in _places(loads, state)]
            steps = (piece.steps[k] for k in needed(piece.steps, places))
            names |= {step.name for step in steps if step.operation == "input"}
        return names

    def _law(self, loads: Loads, state: Held, rows: Sequence[int]) -> tuple[Errors, Floats]:
        places, count = _places(loads, state), len(self._elapsed)
        errors, floor = np.full(count, mpf(0), dtype=object), np.zeros(count)
        peaks = [or_one(peak) for peak in self.truth.peaks[state.name]]
        sizes = np.hypot.reduce(self._rounded[:, :, places], axis=2).sum(axis=0)
        for k in rows:
            piece = loads.piece(self._elapsed[k])
            inputs = {name: column[k] for name, column in self._columns.items()}
            values = evaluated(piece, [piece.values[place] for place in places], inputs)
            apart = self._numbers[state.name][k] - np.array(values, dtype=object)
            errors[k] = norms(apart[None, :])[0] / peaks[k]
            floor[k] = 2 * self.roundoff * (sizes[k] / float(peaks[k]))
        unit, widths = f"max|{state.name}|", np.zeros(count)
        return Errors(_named_law(state), unit, in_doubles(errors), widths, {}), floor

    @cached_property
    def _numbers(self) -> Mapping[str, Column]:
        """The numbers of the answer, formed once."""
        return rows_at(self.answer, range(len(self._elapsed)))

    @cached_property
    def _along(self) -> Along:
        return Along(self.path)

    @cached_property
    def _samples(self) -> list[int]:
        """The places of the samples on the path."""
        places = {time: k for k, time in enumerate(self.path.elapsed)}
        return [places[time] for time in self._elapsed]

    @cached_property
    def _rounded(self) -> Floats:
        """The effect of one rounding of each step, and of each number, on all laws, at every sample."""
        along = self._along
        parts = [along.split(part)[2] for part in (along.sizes(), along.by_numbers())]
        return np.array(parts)[:, self._samples]

    @cached_property
    def _columns(self) -> dict[str, Column]:
        """The columns of an answer by the names that texts have for them."""
        numbers, body = self._numbers, self.scene.body
        motion = motion_of(numbers, self.bits)
        moving = self.scene.initial.MOVING
        columns = {"t": np.array([mp.convert(time) for time in self._elapsed], dtype=object)}
        if all(name in numbers for name in moving):
            z = np.concatenate([motion[name] for name in moving], axis=1)
            if len(moving) > 1:
                columns |= _named("x", z[:, :3]) | _named("y", z[:, 3:])
                velocities = applied(body.energy_matrix, z)
                columns |= _named("u", velocities[:, :3]) | _named("w", velocities[:, 3:])
            else:
                columns |= _named("w", z)
        if "attitude" in motion.quantities:
            columns |= dict(zip(ROTATION, motion["attitude"].reshape(-1, 9).T, strict=True))
        if "quaternion" in numbers:
            columns |= dict(zip(QUATERNION, self._continuous().T, strict=True))
        if "centre" in numbers:
            columns |= dict(zip(CENTRE, motion["centre"].T, strict=True))
        for state in self.scene.own_states:
            if state.name in numbers and not isinstance(state, Held):
                columns |= dict(zip(state.components, motion[state.name].T, strict=True))
        return columns

    def _continuous(self) -> Column:
        """The unit quaternions of the answer, with the sign of the exact motion."""
        q, exact = self._numbers["quaternion"], self._along.quaternions[self._samples]
        signs = np.where(np.sum(q.astype(float) * exact, axis=1) < 0, -1, 1)
        unit: Column = q * signs[:, None] / norms(q)[:, None]
        return unit


def _places(loads: Loads, state: Held) -> list[int]:
    return [loads.held_values.index(name) for name in state.components]


def _named(letter: str, rows: Column) -> dict[str, Column]:
    return {f"{letter}{i}": column for i, column in enumerate(rows.T, start=1)}
