"""The loads that a scene writes down, in float64 along an orbit, and their derivatives.

Each elementary step v of a load M may be wrong by a rounding of its own. One sweep backwards through the
steps gives dM/dv for all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from taylor_verify.exact.conditioning.condition import Path
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.row_arithmetic import quaternions
from taylor_verify.judge.floor.step_slopes import Values, gradient, values_of
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.loads.loads import QUATERNION, Loads
from taylor_verify.scenes.loads.loads import Piece as Steps
from taylor_verify.scenes.loads.steps import Step
from taylor_verify.scenes.loads.vocabulary import ROTATION

Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Piece:
    """The steps of the loads at some times of a path: their values, and dM/dv by output and step.

    ``outputs`` are those of the loads, of the rates of own states, of their values that are held, and of
    the momentum of wheels.
    """

    places: Sequence[int]
    steps: Sequence[Step]
    outputs: Sequence[int]
    values: Values

    @cached_property
    def gradients(self) -> list[list[Floats]]:
        """Return dM/dv for each output M and each step v."""
        return [gradient(self.steps, self.values, output) for output in self.outputs]

    def sizes(self) -> Floats:
        """Return the sum of |dM/dv| |v| over all steps but the numbers, which are data."""
        made = [k for k, step in enumerate(self.steps) if step.operation != "number"]
        columns = [
            sum((abs(g[k] * self.values[k]) for k in made), np.zeros(len(self.places)))
            for g in self.gradients
        ]
        return np.column_stack(columns)

    def by_length(self) -> Floats:
        """Return d dM/dd by output, for a quaternion of length d: R(q) has its square, q itself d."""
        powers = {**dict.fromkeys(QUATERNION, 1.0), **dict.fromkeys(ROTATION, 2.0)}
        read = [(k, powers[s.name]) for k, s in enumerate(self.steps) if s.name in powers]
        columns = [
            sum((power * g[k] * self.values[k] for k, power in read), np.zeros(len(self.places)))
            for g in self.gradients
        ]
        return np.column_stack(columns)

    def numbers(self) -> Iterator[tuple[Fraction, Floats]]:
        """Yield each number p of the steps with p dM/dp, (times, outputs)."""
        places: dict[Fraction, list[int]] = {}
        for k, step in enumerate(self.steps):
            if step.operation == "number" and step.number:
                places.setdefault(abs(step.number), []).append(k)
        for number, equal in places.items():
            columns = [sum(g[k] * self.values[k] for k in equal) for g in self.gradients]
            yield number, np.column_stack(columns)


@dataclass(frozen=True)
class Along:
    """The motion of a path in the units of its scene, and its loads."""

    path: Path

    @cached_property
    def loads(self) -> Loads:
        scene = self.path.scene
        return scene.body.loads or Loads(scene.model, ())

    @cached_property
    def state(self) -> Floats:
        """The state z, omega or both impulses, at every time."""
        path, kind = self.path, kind_of(self.path.scene.body)
        momentum = path.momentum * np.array([float(unit) for unit in path.flow.components])
        state: Floats = momentum @ kind.state_matrix(path.scene.body).astype(float).T
        return state

    @cached_property
    def attitude(self) -> Floats:
        rows = self.path.carried.attitude
        if rows is None:
            rows = np.tile(np.eye(3), (len(self.path.elapsed), 1, 1))
        return rows

    @cached_property
    def centre(self) -> Floats:
        """The centre in space axes; no rows if nothing asks for it."""
        if not len(self.path.centre):
            return np.empty((0, 3))
        start = np.array(kind_of(self.path.scene.body).centre(self.path.scene.initial), dtype=float)
        centre: Floats = self.path.centre * float(self.path.units["centre"]) + start
        return centre

    def pieces(self) -> Iterator[Piece]:
        """Yield the loads piece by piece."""
        for piece, places in self._groups:
            inputs = {name: rows[places] for name, rows in self._inputs.items()}
            values = values_of(piece.steps, inputs, len(places))
            outputs = (*piece.outputs, *piece.rates, *piece.values, *piece.rotor)
            yield Piece(places, piece.steps, outputs, values)

    @cached_property
    def _groups(self) -> Sequence[tuple[Steps, list[int]]]:
        """The pieces of time, each with the places of its times."""
        elapsed, groups = self.path.elapsed, dict[int, tuple[Steps, list[int]]]()
        is_later = elapsed[-1] >= 0
        for k, time in enumerate(elapsed):
            piece = self.loads.piece(time, is_later)
            groups.setdefault(id(piece), (piece, []))[1].append(k)
        return list(groups.values())

    def forces(self, body: Body | None = None) -> Floats:
        """Return the loads at every time; those at another body's velocities with the same state."""
        return self.outputs(body)[:, : self.loads_count]

    def outputs(self, body: Body | None = None) -> Floats:
        """Return the loads, rates and values of own states, and the momentum of wheels, at every time."""
        along = self if body is None else _Beside(self.path, body)
        return _placed(
            along, lambda piece: np.column_stack([piece.values[k] for k in piece.outputs])
        )

    def split(self, outputs: Floats) -> list[Floats]:
        """Return the columns of outputs: loads, rates, values, and the momentum of wheels."""
        first = self.loads.piece(Fraction(0))
        ends = np.cumsum([len(first.outputs), len(first.rates), len(first.values)])
        return np.split(outputs, ends, axis=1)

    @property
    def loads_count(self) -> int:
        """The number of components of the loads."""
        return len(self.loads.piece(Fraction(0)).outputs)

    @property
    def own_starts(self) -> list[float]:
        """The starts of own states by component, those with a rate first."""
        starts = {s.name: s.start or [0] * len(s.components) for s in self.loads.states}
        return [float(value) for name in self.path.carried.own for value in starts[name]]

    @cached_property
    def taken(self) -> Floats:
        """1 where a held value is taken at a time of the path, else 0: a column for each of them."""
        rows = np.zeros((len(self.path.elapsed), len(self.loads.held_values)))
        places = {time: k for k, time in enumerate(self.path.elapsed)}
        for instant in self.loads.instants(self.path.elapsed[-1]) if rows.size else ():
            if instant.time in places:
                rows[places[instant.time], list(instant.places)] = 1.0
        return rows

    @cached_property
    def wheels(self) -> Floats:
        """The derivative of the momentum of wheels by each component of own states, (times, 3, n)."""
        names = [*self.loads.continuous, *self.loads.held_values]
        rows = np.zeros((len(self.path.elapsed), 3, len(names)))
        for piece in self.pieces():
            inputs = {s.name: k for k, s in enumerate(piece.steps) if s.operation == "input"}
            for i, by in enumerate(piece.gradients[-3:]):
                for j, name in enumerate(names):
                    if name in inputs:
                        rows[piece.places, i, j] = by[inputs[name]]
        return rows

    def sizes(self) -> Floats:
        """Return what the roundings inside the texts add up to by output, in units of roundoff."""
        return _placed(self, Piece.sizes)

    def by_numbers(self) -> Floats:
        """Return what a rounding of each number of the texts adds up to by output."""

        def total(piece: Piece) -> Floats:
            parts = [abs(by) for _, by in piece.numbers()]
            return sum(parts, np.zeros((len(piece.places), len(piece.outputs))))

        return _placed(self, total)

    def by_length(self) -> Floats:
        """Return the derivative of the outputs by the length of a quaternion that makes R and q."""
        return _placed(self, Piece.by_length)

    def pushes(self, change: Floats) -> tuple[Floats, Floats]:
        """Return the errors of the rates, and of held values, by changes of the outputs.

        Columns are momentum, turn, centre and own states, in the scene's units.
        """
        body, d = self.path.scene.body, len(self.path.flow.components)
        kind = kind_of(body)
        pushed = np.array(kind.pushed(body), dtype=float)
        loads, rates, values, _ = self.split(change)
        push, own = np.zeros((len(change), d + 6 + self.own_count)), d + 6 + rates.shape[1]
        push[:, :d] = loads @ pushed.T @ kind.momentum_matrix(body).astype(float).T
        push[:, d + 6 : own] = rates
        if self.loads.rotor:
            # The wheels take from the momentum of the body what they gain.
            push[:, :d] -= np.einsum("tij,tj->ti", self.wheels[:, :, : rates.shape[1]], rates)
        taken = np.zeros_like(push)
        taken[:, own:] = values * self.taken
        return push, taken

    @property
    def own_count(self) -> int:
        """The number of components of the scene's own states."""
        return sum(rows.shape[1] for rows in self.path.carried.own.values())

    @property
    def sizes_of_state(self) -> Floats:
        """The units of momentum, turn, centre and own states, by component."""
        path = self.path
        units = [float(unit) for unit in path.flow.components] + [1.0] * 3
        own = [float(path.units[n]) for n, rows in path.carried.own.items() for _ in rows[0]]
        return np.array([*units, *[float(path.flow.length)] * 3, *own])

    @property
    def body(self) -> Body:
        return self.path.scene.body

    def rates(self, body: Body | None = None) -> tuple[Floats, Floats, Floats]:
        """Return the rates of z, of the turn and of the centre, (n, d), (n, 3) and (n, 3)."""
        other = self.body if body is None else body
        kind, z = kind_of(other), self.state
        equations = kind.equations(other)
        constant, linear, hessian, spin, velocity = (
            np.array(part, dtype=float)
            for part in (
                equations.constant,
                equations.linear,
                equations.hessian,
                equations.spin,
                equations.velocity,
            )
        )
        pushed = (self.forces(body) + self._of_wheels(z @ spin.T)) @ np.array(
            kind.pushed(other), dtype=float
        ).T
        rate = constant + z @ linear.T + np.einsum("iab,ta,tb->ti", hessian, z, z) / 2 + pushed
        turn = np.einsum("tij,tj->ti", self.attitude, z @ spin.T)
        if not len(velocity):
            return rate, turn, np.zeros_like(turn)
        current = np.array(self.loads.current, dtype=float)
        return rate, turn, np.einsum("tij,tj->ti", self.attitude, z @ velocity.T) + current

    def _of_wheels(self, spin: Floats) -> Floats | float:
        """Return h x omega - h', the moment of wheels on the body; the time alone changes no h here."""
        if not self.loads.rotor:
            return 0.0
        _, rates, values, wheels = self.split(self.outputs())
        changes = np.hstack([rates, np.zeros_like(values)])
        moment: Floats = np.cross(wheels, spin) - np.einsum("tij,tj->ti", self.wheels, changes)
        return moment

    @cached_property
    def _inputs(self) -> Mapping[str, Floats]:
        equations, z, R = kind_of(self.body).equations(self.body), self.state, self.attitude
        inputs = {"t": np.array([float(t) for t in self.path.elapsed])}
        vectors = {"w": z @ np.array(equations.spin, dtype=float).T}
        if len(equations.velocity):
            vectors |= {"u": z @ np.array(equations.velocity, dtype=float).T}
            vectors |= {"x": z[:, :3], "y": z[:, 3:]}
        if len(self.centre):
            vectors["c"] = self.centre
        for letter, rows in vectors.items():
            inputs |= {f"{letter}{i + 1}": rows[:, i] for i in range(3)}
        for state in self.loads.states:
            rows = self.path.carried.own[state.name]
            inputs |= dict(zip(state.components, rows.T, strict=True))
        inputs |= {f"r{i + 1}{j + 1}": R[:, i, j] for i in range(3) for j in range(3)}
        if self.loads.inputs.isdisjoint(QUATERNION):
            return inputs
        return inputs | dict(zip(QUATERNION, self.quaternions.T, strict=True))

    @cached_property
    def quaternions(self) -> Floats:
        """Unit quaternions of the attitude, continuous from the scene's."""
        return quaternions(self.attitude, self.path.scene.initial.attitude)


@dataclass(frozen=True)
class _Beside(Along):
    """The motion of a path, taken for one of a body with other numbers."""

    other: Body

    @property
    def body(self) -> Body:
        return self.other

    @cached_property
    def state(self) -> Floats:
        return Along(self.path).state


def _placed(along: Along, of: Callable[[Piece], Floats]) -> Floats:
    """Return rows of each piece, in the order of the times."""
    first = along.loads.piece(Fraction(0))
    width = len((*first.outputs, *first.rates, *first.values, *first.rotor))
    rows = np.zeros((len(along.path.elapsed), width))
    for piece in along.pieces():
        rows[piece.places] = of(piece)
    return rows
