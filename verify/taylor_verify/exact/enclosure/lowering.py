"""Elementary steps of a scene's loads as expressions of a tape."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import partial
from typing import Final

from taylor_verify.exact.enclosure.functions import (
    Angle,
    Arctangent,
    Cosine,
    HyperbolicCosine,
    HyperbolicSine,
    Sine,
)
from taylor_verify.exact.enclosure.jumps import Choice, Jump
from taylor_verify.exact.enclosure.kinks import Absolute, Norm
from taylor_verify.exact.enclosure.operations import Bilinear
from taylor_verify.exact.enclosure.powers import Exponential, Logarithm, Power, Quotient, Root
from taylor_verify.exact.enclosure.tape import Graph, Sum, vanishes
from taylor_verify.numbers.irrational import PI
from taylor_verify.scenes.loads.steps import JUMPS, Step, needed

_ONE: Final = Sum(Fraction(1))
_HALF: Final = Fraction(1, 2)


class Lowering:
    """Adds the steps of one piece to a graph, in which its inputs are expressions."""

    def __init__(self, graph: Graph, inputs: Mapping[str, Sum]) -> None:
        self._graph, self._inputs = graph, inputs
        self._operations = self._by_name()

    def expressions(self, steps: Sequence[Step], places: Sequence[int]) -> list[Sum]:
        """The expressions of the steps at some places, and of no step that these do not need."""
        made: dict[int, Sum] = {}
        for place in needed(steps, places):
            step, first = steps[place], len(self._graph.operations)
            made[place] = self._expression(step, [made[k] for k in step.operands])
            self._graph.written |= dict.fromkeys(range(first, len(self._graph.operations)), place)
        return [made[place] for place in places]

    def _expression(self, step: Step, operands: list[Sum]) -> Sum:
        match step.operation:
            case "number":
                return Sum(step.number)
            case "pi":
                return Sum(PI)
            case "input":
                return self._inputs[step.name]
            case "power":
                assert step.number is not None
                return self.power(operands[0], step.number)
        return self._operations[step.operation](*operands)

    def _by_name(self) -> Mapping[str, Callable[..., Sum]]:
        graph = self._graph
        return {
            "+": lambda a, b: a + b,
            "-": lambda a, b: a - b,
            "*": graph.product,
            "/": self.quotient,
            "sqrt": self.root,
            "exp": lambda a: graph.node(Exponential(graph.whole(a))),
            "log": lambda a: graph.node(Logarithm(graph.whole(a))),
            "sin": lambda a: graph.pair(Sine, Cosine, a)[0],
            "cos": lambda a: graph.pair(Sine, Cosine, a)[1],
            "tan": lambda a: self.quotient(*graph.pair(Sine, Cosine, a)),
            "asin": lambda a: self.angle(a, self._other_side(a)),
            "acos": lambda a: self.angle(self._other_side(a), a),
            "atan": self.arctangent,
            "atan2": self.angle,
            "sinh": lambda a: graph.pair(HyperbolicSine, HyperbolicCosine, a)[0],
            "cosh": lambda a: graph.pair(HyperbolicSine, HyperbolicCosine, a)[1],
            "tanh": graph.hyperbolic_tangent,
            "abs": self.absolute,
            "min": lambda a, b: (a + b - self.absolute(a - b)).times(_HALF),
            "max": lambda a, b: (a + b + self.absolute(a - b)).times(_HALF),
            "norm": lambda *parts: graph.node(Norm(tuple(map(graph.whole, parts)))),
            "choose": lambda *parts: graph.node(Choice(*map(graph.whole, parts))),
            **{name: partial(self._jump, name) for name in JUMPS},
        }

    def quotient(self, above: Sum, below: Sum) -> Sum:
        graph = self._graph
        if not below.terms and vanishes(below.constant):
            # No number: the step that comes to it says so.
            return graph.node(Quotient(graph.whole(above), graph.whole(below)))
        if not below.terms:
            return above.times(1 / below.constant)
        number, divisor = graph.split(below)
        if not above.terms:
            return graph.node(Quotient(None, divisor)).times(above.constant / number)
        factor, node = graph.split(above)
        return graph.node(Quotient(node, divisor)).times(factor / number)

    def root(self, a: Sum) -> Sum:
        return self._graph.node(Root(self._graph.whole(a)))

    def _jump(self, name: str, a: Sum) -> Sum:
        return self._graph.node(Jump(self._graph.whole(a), name))

    def absolute(self, a: Sum) -> Sum:
        if not a.terms:
            return Sum(abs(a.constant))
        return self._graph.node(Absolute(self._graph.whole(a)))

    def power(self, a: Sum, exponent: Fraction) -> Sum:
        """A rational power: by products where it is whole, with one root where twice it is whole."""
        if exponent < 0:
            return self.quotient(_ONE, self.power(a, -exponent))
        if exponent.denominator == 1:
            return self._whole_power(a, int(exponent))
        if exponent.denominator == 2:
            root = self.root(a)
            return self._graph.product(self._whole_power(a, int(exponent)), root)
        return self._graph.node(Power(self._graph.whole(a), exponent))

    def _whole_power(self, a: Sum, exponent: int) -> Sum:
        if exponent == 0:
            return _ONE
        half = self._whole_power(a, exponent // 2)
        square = self._graph.product(half, half)
        return self._graph.product(square, a) if exponent % 2 else square

    def _other_side(self, a: Sum) -> Sum:
        """The root of 1 - a^2."""
        return self.root(_ONE - self._graph.product(a, a))

    def arctangent(self, value: Sum) -> Sum:
        graph = self._graph
        a = graph.whole(value)
        divisor = graph.place(Bilinear(Fraction(1), ((Fraction(1), a, a),)))
        return graph.node(Arctangent(a, divisor))

    def angle(self, above: Sum, beside: Sum) -> Sum:
        """The angle of the point (beside, above)."""
        graph = self._graph
        y, x = graph.whole(above), graph.whole(beside)
        one = Fraction(1)
        divisor = graph.place(Bilinear(Fraction(0), ((one, x, x), (one, y, y))))
        return graph.node(Angle(y, x, divisor))
