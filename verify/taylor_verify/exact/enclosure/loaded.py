"""The equations of a body under loads that its scene writes down.

Loads that depend on the attitude bring it into the state: as the quaternion e since the start, e(0) = 1, so
that R = R_0 R(e) with the attitude R_0 of the start. Those that depend on the centre bring it in too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from taylor_verify.exact.clocks import Exact
from taylor_verify.exact.enclosure.lowering import Lowering
from taylor_verify.exact.enclosure.operations import Time
from taylor_verify.exact.enclosure.system import Piece, System, natural
from taylor_verify.exact.enclosure.tape import Graph, Sum, Tape, total
from taylor_verify.exact.equations import Equations
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.scenes.loads import loads as written
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.scene import Scene

_STATES = ("x", "y")


class LoadedBody:
    """The tapes of one scene, each made when a motion comes to its piece of time.

    ``frame`` names what is in the state though no load may depend on it: the attitude, or also the centre.
    """

    def __init__(self, scene: Scene, loads: Loads, frame: frozenset[str] = frozenset()) -> None:
        self._scene, self._loads = scene, loads
        self._kind = kind_of(scene.body)
        self._equations = self._kind.equations(scene.body)
        self._natural = self._kind.state(scene.initial)
        self._turns = loads.reads_attitude or bool(frame)
        self._travels = loads.reads_centre or "centre" in frame
        self._tapes: dict[Any, Tape] = {}

    @property
    def start(self) -> Vector:
        start = self._natural
        if self._turns:
            start += (Fraction(1), Fraction(0), Fraction(0), Fraction(0))
        if self._travels:
            start += self._kind.centre(self._scene.initial) or ()
        return start

    @property
    def blocks(self) -> tuple[int, ...]:
        ends = list(range(3, len(self._natural) + 1, 3))
        if self._turns:
            ends.append(ends[-1] + 4)
        if self._travels:
            ends.append(ends[-1] + 3)
        return tuple(ends)

    def system(self) -> System:
        more = len(self.start) - len(self._natural)
        spin, velocity = (
            np.hstack([form, np.full((len(form), more), Fraction(0), dtype=object)])
            for form in (self._equations.spin, self._equations.velocity)
        )
        current = self._loads.current if any(self._loads.current) else ()
        return System(self.piece, self.blocks, self.start, spin, velocity, current)

    def piece(self, elapsed: Fraction, is_later: bool) -> Piece:
        """The tape from an elapsed time on."""
        piece = self._loads.piece(elapsed, is_later)
        key = piece.steps, piece.outputs
        if key not in self._tapes:
            self._tapes[key] = self._tape(piece)
        return Piece(self._tapes[key], piece.end if is_later else piece.begin)

    def _tape(self, piece: written.Piece) -> Tape:
        graph = Graph()
        states = graph.states(len(self.start))
        z = states[: len(self._natural)]
        frame = _Frame(graph, self._equations, states, self._scene, self._turns, self._travels)
        expressions = Lowering(graph, self._inputs(z, frame)).expressions(piece.steps)
        loads = [expressions[place] for place in piece.outputs]
        pushed = self._kind.pushed(self._scene.body)
        rates = [
            rate + total(load.times(c) for c, load in zip(row, loads, strict=True))
            for rate, row in zip(natural(graph, self._equations, z), pushed, strict=True)
        ]
        return Tape.of(graph, len(states), [*rates, *frame.rates()])

    def _inputs(self, z: Sequence[Sum], frame: _Frame) -> Mapping[str, Sum]:
        inputs = {"t": frame.graph.node(Time()), **_named("w", frame.spin)}
        if frame.velocity:
            inputs |= _named("u", frame.velocity) | _named("x", z[:3]) | _named("y", z[3:])
        return inputs | frame.inputs()


class _Frame:
    """The attitude and the centre of the body as expressions of the state."""

    def __init__(
        self,
        graph: Graph,
        equations: Equations,
        states: Sequence[Sum],
        scene: Scene,
        turns: bool,
        travels: bool,
    ) -> None:
        self.graph, self._scene = graph, scene
        size = len(equations.constant)
        self.spin, self.velocity = (
            _formed(form, states[:size]) for form in (equations.spin, equations.velocity)
        )
        self._turn = states[size : size + 4] if turns else []
        self._centre = states[size + 4 : size + 7] if travels else []
        self._rotation = self._of_turn() if turns else []
        self._current = scene.body.loads.current if scene.body.loads is not None else ZERO_VECTOR

    def _of_turn(self) -> list[list[Sum]]:
        """R = R_0 R(e)."""
        graph, e = self.graph, self._turn
        pairs = {(i, j): graph.product(e[i], e[j]) for i in range(4) for j in range(i, 4)}

        def double(*terms: tuple[int, int, int]) -> Sum:
            return total(pairs[i, j].times(Fraction(2 * sign)) for sign, i, j in terms)

        one = Sum(Fraction(1))
        turned = [
            [
                one - double((1, 2, 2), (1, 3, 3)),
                double((1, 1, 2), (-1, 0, 3)),
                double((1, 1, 3), (1, 0, 2)),
            ],
            [
                double((1, 1, 2), (1, 0, 3)),
                one - double((1, 1, 1), (1, 3, 3)),
                double((1, 2, 3), (-1, 0, 1)),
            ],
            [
                double((1, 1, 3), (-1, 0, 2)),
                double((1, 2, 3), (1, 0, 1)),
                one - double((1, 1, 1), (1, 2, 2)),
            ],
        ]
        # Each entry is one node, which all uses of it share.
        shared = [[Sum(terms={graph.whole(entry): Fraction(1)}) for entry in row] for row in turned]
        start = rotation_matrix(self._scene.initial.attitude)
        return [
            [total(shared[k][j].times(start[i][k]) for k in range(3)) for j in range(3)]
            for i in range(3)
        ]

    def inputs(self) -> dict[str, Sum]:
        inputs: dict[str, Sum] = {}
        if self._turn:
            inputs |= {f"r{i + 1}{j + 1}": self._rotation[i][j] for i in range(3) for j in range(3)}
            inputs |= {f"q{i}": self._quaternion(i) for i in range(4)}
        return inputs | _named("c", self._centre)

    def _quaternion(self, i: int) -> Sum:
        """Component i of q e, with the unit quaternion q of the start."""
        a, b, c, d = self._scene.initial.attitude
        row = ((a, -b, -c, -d), (b, a, -d, c), (c, d, a, -b), (d, -c, b, a))[i]
        lowering = Lowering(self.graph, {})
        length = lowering.root(Sum(a * a + b * b + c * c + d * d))
        turned = total(e.times(factor) for e, factor in zip(self._turn, row, strict=True))
        return lowering.quotient(turned, length)

    def rates(self) -> list[Sum]:
        """e' = e Omega/2 and c' = R U."""
        if not self._turn:
            return []
        product = self.graph.product
        e, w = self._turn, self.spin
        turning = [
            Sum() - product(e[1], w[0]) - product(e[2], w[1]) - product(e[3], w[2]),
            product(e[0], w[0]) + product(e[2], w[2]) - product(e[3], w[1]),
            product(e[0], w[1]) + product(e[3], w[0]) - product(e[1], w[2]),
            product(e[0], w[2]) + product(e[1], w[1]) - product(e[2], w[0]),
        ]
        rates = [rate.times(Fraction(1, 2)) for rate in turning]
        if self._centre:
            rates += [
                total(
                    (Sum(drift), *(product(r, u) for r, u in zip(row, self.velocity, strict=True)))
                )
                for row, drift in zip(self._rotation, self._current, strict=True)
            ]
        return rates


def _formed(form: Exact, z: Sequence[Sum]) -> list[Sum]:
    """The rows of a linear form of the state."""
    return [total(c.times(number) for c, number in zip(z, row, strict=True)) for row in form]


def _named(letter: str, vector: Sequence[Sum]) -> dict[str, Sum]:
    return {f"{letter}{i}": component for i, component in enumerate(vector, start=1)}
