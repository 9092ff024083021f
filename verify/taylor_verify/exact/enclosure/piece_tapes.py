"""The tapes of a body under written loads in one piece of time: rates, and what is taken at times."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from typing import Final

from taylor_verify.exact.enclosure.derived import Derived
from taylor_verify.exact.enclosure.framing import Frame, named
from taylor_verify.exact.enclosure.layout import Layout
from taylor_verify.exact.enclosure.lowering import Lowering
from taylor_verify.exact.enclosure.operations import Time
from taylor_verify.exact.enclosure.system import natural
from taylor_verify.exact.enclosure.tape import Graph, Sum, Tape, total
from taylor_verify.exact.quadratic_forms import Exact, exact
from taylor_verify.exact.registry import kind_of
from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.scenes.loads.loads import Piece
from taylor_verify.scenes.loads.vocabulary import INVARIANTS
from taylor_verify.scenes.scene import Scene


class PieceTapes:
    """Expressions of one piece of time, with their tapes."""

    def __init__(self, scene: Scene, layout: Layout, piece: Piece) -> None:
        self._scene, self._layout, self._piece = scene, layout, piece
        self._kind, self._graph = kind_of(scene.body), Graph()
        states = self._graph.states(layout.whole)
        self._z = layout.body(states)
        self._inputs = {"t": self._graph.node(Time()), **layout.components(states)}
        # A rotor reads the time and own states alone: the spin is made of it.
        self._wheels = self._lowered(piece.rotor)
        self._spin, self._velocity = self._velocities()
        turn, centre = layout.turn(states), layout.centre(states)
        self._frame = Frame(self._graph, scene, self._spin, self._velocity, turn, centre)
        read = {step.name for step in piece.steps if step.operation == "input"}
        self._inputs |= {**named("w", self._spin), **self._frame.inputs(read)}
        if self._velocity:
            self._inputs |= named("u", self._velocity)
            self._inputs |= named("x", self._z[:3]) | named("y", self._z[3:])

    def _lowered(self, places: Sequence[int]) -> list[Sum]:
        return Lowering(self._graph, self._inputs).expressions(self._piece.steps, places)

    def _tape(self, expressions: Sequence[Sum]) -> Tape:
        return Tape.of(self._graph, self._layout.whole, expressions)

    def _velocities(self) -> tuple[list[Sum], list[Sum]]:
        body = self._scene.body
        if self._wheels:
            spin = formed(self._kind.state_matrix(body), self._without_wheels)
            # Each is one node, which all uses of it share.
            return [self._shared(component) for component in spin], []
        equations = self._kind.equations(body)
        return formed(equations.spin, self._z), formed(equations.velocity, self._z)

    @cached_property
    def _without_wheels(self) -> list[Sum]:
        """The momentum H - h of the body without its wheels."""
        return [z - h for z, h in zip(self._z, self._wheels, strict=True)]

    def _shared(self, value: Sum) -> Sum:
        return Sum(terms={self._graph.whole(value): _ONE}) if value.terms else value

    @cached_property
    def rates(self) -> Tape:
        """The rates of all components; held values have none."""
        return self._tape(self._rates)

    @cached_property
    def _rates(self) -> list[Sum]:
        loads = self._lowered(self._piece.outputs)
        moving = self._with_wheels(loads) if self._wheels else self._natural(loads)
        rates = [*moving, *self._frame.rates(), *self._lowered(self._piece.rates)]
        return [*rates, *[Sum()] * (self._layout.whole - len(rates))]

    def _natural(self, loads: Sequence[Sum]) -> list[Sum]:
        body = self._scene.body
        equations, pushed = self._kind.equations(body), exact(self._kind.pushed(body))
        rates = natural(self._graph, equations, self._z)
        return [rate + push for rate, push in zip(rates, formed(pushed, loads), strict=True)]

    def functions(self, orders: int) -> Tape:
        """The functions of the motion, then their rates of change, and so on up to an order."""
        if orders not in self._functions:
            self._functions[orders] = self._with_rates(orders)
        return self._functions[orders]

    @cached_property
    def _functions(self) -> dict[int, Tape]:
        return {}

    def _with_rates(self, orders: int) -> Tape:
        names = INVARIANTS[self._scene.model]
        self._inputs |= dict(zip(names, self._invariants(), strict=True))
        rate = Derived(self._graph, self._rates).rate
        columns = [self._lowered(self._piece.functions)]
        for _ in range(orders):
            columns.append([rate(value) for value in columns[-1]])
        return self._tape([value for column in columns for value in column])

    def _with_wheels(self, loads: Sequence[Sum]) -> list[Sum]:
        """H' = H x omega + M, and what the body's own equations add that is linear in H - h."""
        product, H, w = self._graph.product, self._z, self._spin
        equations = self._kind.momentum_equations(self._scene.body)
        rest = formed(equations.linear, self._without_wheels)
        return [
            product(H[j], w[k]) - product(H[k], w[j]) + loads[i] + rest[i] + Sum(constant)
            for (i, j, k), constant in zip(_CYCLES, equations.constant, strict=True)
        ]

    def _invariants(self) -> list[Sum]:
        """The kinetic energy, and the squares of the momenta."""
        energy = exact(self._kind.energy(self._scene.body))
        if self._velocity:
            twice = self._dot(self._z, formed(energy, self._z))
            x, y = self._z[:3], self._z[3:]
            return [twice.times(_HALF), self._dot(x, x), self._dot(x, y)]
        momentum = formed(energy, self._spin)
        rotor = self._wheels or [Sum(h) for h in getattr(self._scene.body, "rotor", ZERO_VECTOR)]
        whole = [p + h for p, h in zip(momentum, rotor, strict=True)]
        return [self._dot(self._spin, momentum).times(_HALF), self._dot(whole, whole)]

    def _dot(self, first: Sequence[Sum], second: Sequence[Sum]) -> Sum:
        return total(self._graph.product(a, b) for a, b in zip(first, second, strict=True))

    @cached_property
    def image(self) -> Tape:
        """The spin."""
        return self._tape(self._spin)

    @cached_property
    def wheels(self) -> Tape:
        """The momentum of the rotor."""
        return self._tape(self._wheels)

    def values(self, places: tuple[int, ...]) -> Tape:
        """The values of held components that are taken together."""
        if places not in self._values:
            steps = [self._piece.values[place] for place in places]
            self._values[places] = self._tape(self._lowered(steps))
        return self._values[places]

    @cached_property
    def _values(self) -> dict[tuple[int, ...], Tape]:
        return {}


_ONE: Final = Fraction(1)
_HALF: Final = Fraction(1, 2)
_CYCLES: Final = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def formed(form: Exact, z: Sequence[Sum]) -> list[Sum]:
    """The rows of a linear form of the state."""
    return [total(c.times(number) for c, number in zip(z, row, strict=True)) for row in form]
