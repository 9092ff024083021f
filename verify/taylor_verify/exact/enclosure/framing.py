"""Attitude and centre in the state: e with R = R_0 R(e), e(0) = 1, and the origin of the body."""

from __future__ import annotations

from collections.abc import Container, Sequence
from fractions import Fraction
from functools import cached_property

from taylor_verify.exact.enclosure.lowering import Lowering
from taylor_verify.exact.enclosure.tape import Graph, Sum, total
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.scenes.loads.vocabulary import QUATERNION, ROTATION
from taylor_verify.scenes.scene import Scene


class Frame:
    """The attitude and the centre of a body as expressions of the state.

    ``turn`` are the four states e, and ``centre`` three, as far as there are any.
    """

    def __init__(
        self,
        graph: Graph,
        scene: Scene,
        spin: Sequence[Sum],
        velocity: Sequence[Sum],
        turn: Sequence[Sum],
        centre: Sequence[Sum],
    ) -> None:
        self._graph, self._scene = graph, scene
        self._spin, self._velocity, self._turn, self._centre = spin, velocity, turn, centre
        self._current = scene.body.loads.current if scene.body.loads is not None else ZERO_VECTOR

    @cached_property
    def rotation(self) -> list[list[Sum]]:
        """R = R_0 R(e)."""
        graph, e = self._graph, self._turn
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

    def inputs(self, read: Container[str]) -> dict[str, Sum]:
        """The inputs of loads that read the frame: the nodes of no others are made."""
        inputs = {
            name: self.rotation[k // 3][k % 3] for k, name in enumerate(ROTATION) if name in read
        }
        inputs |= {name: self._quaternion(i) for i, name in enumerate(QUATERNION) if name in read}
        return inputs | named("c", self._centre)

    def _quaternion(self, i: int) -> Sum:
        """Component i of q e, with the unit quaternion q of the start."""
        a, b, c, d = self._scene.initial.attitude
        row = ((a, -b, -c, -d), (b, a, -d, c), (c, d, a, -b), (d, -c, b, a))[i]
        lowering = Lowering(self._graph, {})
        length = lowering.root(Sum(a * a + b * b + c * c + d * d))
        turned = total(e.times(factor) for e, factor in zip(self._turn, row, strict=True))
        return lowering.quotient(turned, length)

    def rates(self) -> list[Sum]:
        """e' = e Omega/2 and c' = R U."""
        if not self._turn:
            return []
        product = self._graph.product
        e, w = self._turn, self._spin
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
                    (Sum(drift), *(product(r, u) for r, u in zip(row, self._velocity, strict=True)))
                )
                for row, drift in zip(self.rotation, self._current, strict=True)
            ]
        return rates


def named(letter: str, vector: Sequence[Sum]) -> dict[str, Sum]:
    """The components of a vector by letter and number."""
    return {f"{letter}{i}": component for i, component in enumerate(vector, start=1)}
