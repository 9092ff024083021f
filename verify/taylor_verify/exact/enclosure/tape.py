"""A right-hand side as a tape: a list of operations, each on nodes before it.

An expression is a sum: an exact number and exact multiples of nodes. Equal operations are one node, and
what cancels in exact numbers is gone. At the end each sum that is used once becomes a part of the sum in
which it stands, so that a rate is one operation.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, Final

from flint import arb, ctx

from taylor_verify.exact.enclosure.functions import HyperbolicTangent, Paired
from taylor_verify.exact.enclosure.kinks import Absolute, Norm
from taylor_verify.exact.enclosure.operations import (
    Bilinear,
    Factors,
    Operation,
    Polynomial,
    State,
    Time,
)
from taylor_verify.numbers.irrational import Undecided, ball

_ZERO: Final = Bilinear(Fraction(0))
# A polynomial of the time of a higher degree is a series like any other.
_MOST_DEGREE: Final = 6


@dataclass(frozen=True)
class Sum:
    """constant + sum of number times node, exactly; numbers are rational, or of numbers.irrational."""

    constant: Any = Fraction(0)
    terms: Mapping[int, Any] = field(default_factory=dict)

    def __add__(self, other: Sum) -> Sum:
        terms = dict(self.terms)
        for node, number in other.terms.items():
            total = terms.pop(node, Fraction(0)) + number
            if not vanishes(total):
                terms[node] = total
        return Sum(self.constant + other.constant, terms)

    def __sub__(self, other: Sum) -> Sum:
        return self + other.times(Fraction(-1))

    def times(self, number: Any) -> Sum:
        """The multiple by an exact number."""
        if vanishes(number):
            return Sum()
        return Sum(self.constant * number, {node: c * number for node, c in self.terms.items()})


def vanishes(number: Any) -> bool:
    """True for a number that is known to be zero; one that may be zero stays."""
    try:
        return not number
    except Undecided:
        return False


def _is_one(number: Any) -> bool:
    return isinstance(number, Fraction) and number == 1


def total(sums: Iterable[Sum]) -> Sum:
    """The sum of sums."""
    result = Sum()
    for each in sums:
        result += each
    return result


class Graph:
    """Nodes in the order in which they were made; equal operations are one node."""

    def __init__(self) -> None:
        self.operations: list[Operation] = []
        # The step of the loads that a node was made for, by its place.
        self.written: dict[int, int] = {}
        self._places: dict[Operation, int] = {}
        self._pairs: dict[tuple[type[Operation], int], int] = {}

    def place(self, operation: Operation) -> int:
        """The place of an operation, which is added if it is new."""
        if operation not in self._places:
            self._places[operation] = len(self.operations)
            self.operations.append(operation)
        return self._places[operation]

    def node(self, operation: Operation) -> Sum:
        """The operation as an expression."""
        return Sum(terms={self.place(operation): Fraction(1)})

    def states(self, count: int) -> list[Sum]:
        return [self.node(State(k)) for k in range(count)]

    def split(self, value: Sum) -> tuple[Any, int]:
        """Number and node whose product an expression is; multiples of one expression share the node."""
        if len(value.terms) == 1 and vanishes(value.constant):
            ((node, number),) = value.terms.items()
            return number, node
        leading = value.terms[min(value.terms)] if value.terms else Fraction(1)
        return leading, self._whole(value.times(1 / leading))

    def whole(self, value: Sum) -> int:
        """The node of an expression."""
        number, node = self.split(value)
        return node if _is_one(number) else self._whole(value)

    def _whole(self, value: Sum) -> int:
        time = self._places.get(Time())
        if time is not None and set(value.terms) == {time}:
            return self.place(Polynomial(Fraction(0), (value.constant, value.terms[time])))
        sums = tuple((number, node) for node, number in sorted(value.terms.items()))
        return self.place(Bilinear(value.constant, sums=sums))

    def product(self, first: Sum, second: Sum) -> Sum:
        if not first.terms or not second.terms:
            return first.times(second.constant) if first.terms else second.times(first.constant)
        (c, a), (d, b) = self.split(first), self.split(second)
        pair = (Fraction(1), min(a, b), max(a, b))
        return self.node(Bilinear(Fraction(0), (pair,))).times(c * d)

    def pair(self, first: type[Paired], second: type[Paired], value: Sum) -> tuple[Sum, Sum]:
        """Two functions of an expression, each of which is the other's derivative but for its sign."""
        a = self.whole(value)
        place = self._pairs.setdefault((first, a), len(self.operations))
        return self.node(first(a, place + 1)), self.node(second(a, place))

    def hyperbolic_tangent(self, value: Sum) -> Sum:
        a = self.whole(value)
        place = self._pairs.setdefault((HyperbolicTangent, a), len(self.operations))
        tangent = self.node(HyperbolicTangent(a, place + 1))
        self.place(Bilinear(Fraction(1), ((Fraction(-1), place, place),)))
        return tangent


@dataclass(frozen=True)
class Tape:
    """Operations in order, the places of the components of the state, and those of the outputs.

    The outputs are the rates of all components, or functions that are wanted at single times. ``written``
    is the step of the loads that a node was made for, where it was made for one.
    """

    operations: tuple[Operation, ...]
    states: tuple[int, ...]
    outputs: tuple[int, ...]
    written: Mapping[int, int] = field(default_factory=dict, compare=False)

    @classmethod
    def of(cls, graph: Graph, size: int, expressions: Sequence[Sum]) -> Tape:
        """The tape of some expressions of the graph, for a state of this size."""
        states = [graph.place(State(k)) for k in range(size)]
        outputs = [graph.whole(expression) for expression in expressions]
        joined = _joined(graph.operations, outputs)
        order = sorted(_reached(joined, [*states, *outputs]))
        places = [0] * len(joined)
        for place, node in enumerate(order):
            places[node] = place
        operations = tuple(joined[node].moved(places) for node in order)
        written = {places[n]: graph.written[n] for n in order if n in graph.written}
        state_places, output_places = (tuple(places[n] for n in each) for each in (states, outputs))
        return cls(operations, state_places, output_places, written)

    @property
    def size(self) -> int:
        return len(self.states)

    @property
    def rates(self) -> tuple[int, ...]:
        """The places of the rates, one for each component."""
        return self.outputs

    @cached_property
    def moving(self) -> int:
        """The number of components up to the last one whose rate is not zero throughout."""
        return next((k + 1 for k in reversed(range(self.size)) if not self.still[k]), 0)

    @cached_property
    def still(self) -> list[bool]:
        """True for each component whose rate is zero throughout."""
        return [self.operations[rate] == _ZERO for rate in self.rates]

    @cached_property
    def degrees(self) -> list[int | None]:
        """The degree of each node as a polynomial of the time; None of all others."""
        degrees: list[int | None] = []
        for operation in self.operations:
            degree = operation.degree([degrees[a] for a in operation.operands])
            degrees.append(None if degree is None or degree > _MOST_DEGREE else degree)
        return degrees

    @cached_property
    def has_kinks(self) -> bool:
        """True if there is an absolute value or a norm that depends on more than constants."""
        pairs = zip(self.operations, self.degrees, strict=True)
        return any(isinstance(each, Absolute | Norm) and degree is None for each, degree in pairs)

    @cached_property
    def moves(self) -> list[bool]:
        """True for each node that depends on the state."""
        moves: list[bool] = []
        for operation in self.operations:
            moves.append(isinstance(operation, State) or any(moves[a] for a in operation.operands))
        return moves

    def factors(self) -> list[Factors | None]:
        """The exact numbers of bilinear operations in balls, at the ambient precision."""
        if ctx.prec not in self._factors:
            self._factors[ctx.prec] = [_in_balls(each) for each in self.operations]
        return self._factors[ctx.prec]

    @cached_property
    def _factors(self) -> dict[int, list[Factors | None]]:
        return {}


def _in_balls(operation: Operation) -> Factors | None:
    if not isinstance(operation, Bilinear):
        return None
    return Factors(
        ball(operation.constant),
        tuple((_factor(number), a, b) for number, a, b in operation.products),
        tuple((_factor(number), e) for number, e in operation.sums),
    )


def _factor(number: Any) -> arb | None:
    return None if _is_one(number) else ball(number)


def _reached(operations: Sequence[Operation], outputs: Iterable[int]) -> set[int]:
    """The outputs and all nodes that these need."""
    reached: set[int] = set()
    waiting = list(outputs)
    while waiting:
        node = waiting.pop()
        if node not in reached:
            reached.add(node)
            waiting += (*operations[node].operands, *operations[node].partners)
    return reached


def _joined(operations: Sequence[Operation], outputs: Sequence[int]) -> list[Operation]:
    """The operations, with each sum that stands in one sum alone, or has no products, as a part of it."""
    reached = _reached(operations, outputs)
    uses = Counter(outputs)
    for node in reached:
        uses.update((*operations[node].operands, *operations[node].partners))
    joined: list[Operation] = []
    for operation in operations:
        if isinstance(operation, Bilinear):
            joined.append(_with_parts(operation, joined, uses))
        else:
            joined.append(operation)
    return joined


def _with_parts(
    whole: Bilinear, operations: Sequence[Operation], uses: Mapping[int, int]
) -> Bilinear:
    constant = whole.constant
    products = {(a, b): number for number, a, b in whole.products}
    sums: dict[int, Any] = {}
    for factor, node in whole.sums:
        part = operations[node]
        if not isinstance(part, Bilinear) or (part.products and uses[node] > 1):
            sums[node] = sums.get(node, 0) + factor
            continue
        constant += factor * part.constant
        for number, a, b in part.products:
            products[a, b] = products.get((a, b), 0) + factor * number
        for number, inner in part.sums:
            sums[inner] = sums.get(inner, 0) + factor * number
    return Bilinear(
        constant,
        tuple(
            (number, a, b)
            for (a, b), number in sorted(products.items(), key=_places)
            if not vanishes(number)
        ),
        tuple(
            (number, node)
            for node, number in sorted(sums.items(), key=_places)
            if not vanishes(number)
        ),
    )


def _places(entry: tuple[Any, Any]) -> Any:
    return entry[0]
