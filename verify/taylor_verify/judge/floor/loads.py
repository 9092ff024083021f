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

    def _by(self, k: int) -> Floats:
        """Return v dM/dv of step k, (times, outputs)."""
        return np.column_stack([g[k] * self.values[k] for g in self.gradients])

    def _nothing(self) -> Floats:
        return np.zeros((len(self.places), len(self.outputs)))

    def sizes(self) -> Floats:
        """Return the sum of |dM/dv| |v| over all steps but the numbers, which are data."""
        made = (k for k, step in enumerate(self.steps) if step.operation != "number")
        return sum((abs(self._by(k)) for k in made), self._nothing())

    def by_length(self) -> Floats:
        """Return d dM/dd by output, for a quaternion of length d: R(q) has its square, q itself d."""
        powers = {**dict.fromkeys(QUATERNION, 1.0), **dict.fromkeys(ROTATION, 2.0)}
        read = ((k, powers[s.name]) for k, s in enumerate(self.steps) if s.name in powers)
        return sum((power * self._by(k) for k, power in read), self._nothing())

    def numbers(self) -> dict[Fraction, Floats]:
        """Return p dM/dp of each number p of the steps, (times, outputs)."""
        by: dict[Fraction, Floats] = {}
        for k, step in enumerate(self.steps):
            if step.operation == "number" and step.number:
                number = abs(step.number)
                by[number] = by.get(number, 0.0) + self._by(k)
        return by

    def by_numbers(self) -> Floats:
        """Return the sum of |p dM/dp| over all numbers p."""
        return sum(map(abs, self.numbers().values()), self._nothing())


@dataclass(frozen=True)
class Along:
    """The motion of a path in the units of its scene, and its loads.

    Its equations are those of the ``other`` body if there is one, at the same state.
    """

    path: Path
    other: Body | None = None

    @property
    def body(self) -> Body:
        return self.path.scene.body if self.other is None else self.other

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

    def forces(self) -> Floats:
        """Return the loads at every time."""
        return self.split(self.outputs())[0]

    def outputs(self) -> Floats:
        """Return the loads, rates and values of own states, and the momentum of wheels, at every time."""
        return self._placed(lambda each: np.column_stack([each.values[k] for k in each.outputs]))

    def _placed(self, of: Callable[[Piece], Floats]) -> Floats:
        """Return rows of each piece, in the order of the times."""
        first = self.loads.piece(Fraction(0))
        width = len((*first.outputs, *first.rates, *first.values, *first.rotor))
        rows = np.zeros((len(self.path.elapsed), width))
        for piece in self.pieces():
            rows[piece.places] = of(piece)
        return rows

    def split(self, outputs: Floats) -> list[Floats]:
        """Return the columns of outputs: loads, rates, values, and the momentum of wheels."""
        first = self.loads.piece(Fraction(0))
        ends = np.cumsum([len(first.outputs), len(first.rates), len(first.values)])
        return np.split(outputs, ends, axis=1)

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
        return self._placed(Piece.sizes)

    def by_numbers(self) -> Floats:
        """Return what a rounding of each number of the texts adds up to by output."""
        return self._placed(Piece.by_numbers)

    def by_length(self) -> Floats:
        """Return the derivative of the outputs by the length of a quaternion that makes R and q."""
        return self._placed(Piece.by_length)

    def pushes(self, change: Floats) -> tuple[Floats, Floats]:
        """Return the errors of the rates, and of held values, by changes of the outputs.

        Columns are momentum, turn, centre and own states, in the scene's units.
        """
        body, d = self.path.scene.body, len(self.path.flow.components)
        kind = kind_of(body)
        pushed = np.array(kind.pushed(body), dtype=float)
        loads, rates, values, _ = self.split(change)
        push, own = np.zeros((len(change), self.width)), d + 6 + rates.shape[1]
        push[:, :d] = loads @ pushed.T @ kind.momentum_matrix(body).astype(float).T
        push[:, d + 6 : own] = rates
        if self.loads.rotor:
            # The wheels take from the momentum of the body what they gain.
            push[:, :d] -= np.einsum("tij,tj->ti", self.wheels[:, :, : rates.shape[1]], rates)
        taken = np.zeros_like(push)
        taken[:, own:] = values * self.taken
        return push, taken

    @property
    def width(self) -> int:
        """The number of components of momentum, turn, centre and own states."""
        return len(self.sizes_of_state)

    @cached_property
    def sizes_of_state(self) -> Floats:
        """The units of momentum, turn, centre and own states, by component."""
        path = self.path
        units = [float(unit) for unit in path.flow.components] + [1.0] * 3
        own = [float(path.units[n]) for n, rows in path.carried.own.items() for _ in rows[0]]
        return np.array([*units, *[float(path.flow.length)] * 3, *own])

    def rates(self) -> tuple[Floats, Floats, Floats]:
        """Return the rates of z, of the turn and of the centre, (n, d), (n, 3) and (n, 3)."""
        kind, z = kind_of(self.body), self.state
        constant, linear, hessian, spin, velocity = (
            part.astype(float) for part in kind.equations(self.body)
        )
        pushed = np.array(kind.pushed(self.body), dtype=float)
        rate = constant + z @ linear.T + np.einsum("iab,ta,tb->ti", hessian, z, z) / 2
        rate = rate + (self.forces() + self._of_wheels(z @ spin.T)) @ pushed.T
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
        inputs |= dict(zip(ROTATION, R.reshape(-1, 9).T, strict=True))
        if self.loads.inputs.isdisjoint(QUATERNION):
            return inputs
        return inputs | dict(zip(QUATERNION, self.quaternions.T, strict=True))

    @cached_property
    def quaternions(self) -> Floats:
        """Unit quaternions of the attitude, continuous from the scene's."""
        return quaternions(self.attitude, self.path.scene.initial.attitude)
