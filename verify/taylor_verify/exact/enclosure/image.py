"""Functions of the state over a box: values at its point, and gradients that hold everywhere in it.

    f(z) in f(point) + G (z - point)

for every z of the box, with G the hull of the gradient over it (mean value theorem). The absolute value
and the norm change by no more than their operands do: where they may be zero, G is [-1, 1] times that of
the operands. Values that jump are decided over the whole box.

A node is bounded over the box twice, by its operands' bounds and by its gradient; both hold.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Final, NamedTuple

from flint import arb, arb_mat, ctx

from taylor_verify.exact.enclosure.box import Box
from taylor_verify.exact.enclosure.jumps import Choice, Jump, OnJump
from taylor_verify.exact.enclosure.kinks import Absolute, Norm, sign_of
from taylor_verify.exact.enclosure.operations import ONE, ZERO, Domain, Operation, State
from taylor_verify.exact.enclosure.rationals import rational_values
from taylor_verify.exact.enclosure.series import Nodes
from taylor_verify.exact.enclosure.tape import Tape
from taylor_verify.exact.enclosure.tube import BOUND_BITS
from taylor_verify.numbers.irrational import ball

_EITHER_SIGN: Final = arb(0, 1)
Gradient = dict[int, arb]


class Functions(NamedTuple):
    """Functions over a box: the balls of their values at its point, and a row of slopes for each."""

    values: list[arb]
    slopes: arb_mat


class _Values(Nodes):
    """Balls of the nodes at one time: the order 0 of a series alone."""

    def product(self, a: int, b: int, k: int) -> arb:
        return self.forward[a][k] * self.forward[b][k]


class Image:
    """The nodes of a tape over a box at one time. To be used at the precision of a course.

    ``exactly`` is the state, where it is known in exact numbers. What is rational, as functions of the
    time are, decides jumps as it is. Raises OnJump, or Domain for a function that may have no value, where
    an output depends on it.
    """

    def __init__(
        self, tape: Tape, box: Box, time: Fraction, exactly: Sequence[Any] | None = None
    ) -> None:
        self._tape, self._apart = tape, box.apart.entries()
        self._rational = rational_values(tape, exactly or [None] * tape.size, time)
        # Operations take these for a series.
        self._point: Any = _Values(tape, time)
        with ctx.workprec(BOUND_BITS):
            self._hull: Any = _Values(tape, time)
        self._gradients: list[Gradient] = []
        self._faults: dict[int, ArithmeticError] = {}
        for i, operation in enumerate(tape.operations):
            self._add(i, operation, box)

    def outputs(self) -> Functions:
        """The outputs of the tape."""
        places, slopes = self._tape.outputs, arb_mat(len(self._tape.outputs), self._tape.size)
        for row, place in enumerate(places):
            self._require(place)
            for component, slope in self._gradients[place].items():
                slopes[row, component] = slope
        return Functions([self._point.forward[place][0] for place in places], slopes)

    def step_of(self, end: Domain) -> int | None:
        """The step of the loads that has no value; None of none."""
        return None if end.node is None else self._tape.written.get(end.node)

    def rational_outputs(self) -> list[Fraction | None]:
        """The outputs that are known to be rational numbers; None for others."""
        return [self._rational[place] for place in self._tape.outputs]

    def _add(self, i: int, operation: Operation, box: Box) -> None:
        """Add a node; one that has no value stops those alone that need it."""
        try:
            value, gradient = self._made(i, operation, box)
        except (Domain, OnJump) as fault:
            if isinstance(fault, Domain) and fault.node is None:
                fault.node = i
            self._faults[i] = fault
            value, gradient = arb("nan"), {}
        del self._point.forward[i:], self._hull.forward[i:]
        self._point.forward.append([value])
        self._gradients.append(gradient)
        with ctx.workprec(BOUND_BITS):
            self._hull.forward.append([value + arb(0, self._spread(gradient))])

    def _made(self, i: int, operation: Operation, box: Box) -> tuple[arb, Gradient]:
        match operation:
            case State(component=component):
                return box.point[component], {component: ONE}
            case Choice():
                rational = self._rational[operation.condition]
                chosen = operation.chosen(
                    self._over_box(operation.condition) if rational is None else rational
                )
                self._require(chosen)
                return self._point.forward[chosen][0], self._gradients[chosen]
        for a in operation.operands:
            self._require(a)
        match operation:
            case Jump() if (rational := self._rational[i]) is not None:
                return ball(rational), {}
            case Jump():
                return operation.decided(self._over_box(operation.a)), {}
            case Absolute():
                return abs(self._point.forward[operation.a][0]), self._of_absolute(operation.a)
            case Norm():
                return self._norm(operation)
        return self._of_others(i, operation)

    def _require(self, i: int) -> None:
        if i in self._faults:
            raise self._faults[i]

    def _over_box(self, i: int) -> arb:
        """The hull of a node, its value in full precision."""
        self._require(i)
        value: arb = self._point.forward[i][0]
        with ctx.workprec(BOUND_BITS):
            spread = self._spread(self._gradients[i])
        return value if spread.is_zero() else value + arb(0, spread)

    def _spread(self, gradient: Gradient) -> arb:
        return sum((g.abs_upper() * self._apart[j] for j, g in gradient.items()), ZERO).abs_upper()

    def _of_absolute(self, a: int) -> Gradient:
        sign = sign_of(self._over_box(a))
        with ctx.workprec(BOUND_BITS):
            return _total([(arb(sign) if sign else _EITHER_SIGN, self._gradients[a])])

    def _norm(self, norm: Norm) -> tuple[arb, Gradient]:
        values = [self._point.forward[a][0] for a in norm.nodes]
        squared = sum((value * value for value in values), ZERO)
        value = squared.sqrt() if squared > 0 else arb(0, squared.abs_upper().sqrt().abs_upper())
        with ctx.workprec(BOUND_BITS):
            hulls = [self._hull.forward[a][0] for a in norm.nodes]
            size = sum((hull * hull for hull in hulls), ZERO)
            slopes = [hull / size.sqrt() if size > 0 else _EITHER_SIGN for hull in hulls]
            pairs = zip(slopes, (self._gradients[a] for a in norm.nodes), strict=True)
            return value, _total(list(pairs))

    def _of_others(self, i: int, operation: Operation) -> tuple[arb, Gradient]:
        value = operation.first(i, self._point)
        if not self._tape.moves[i]:
            return value, {}
        with ctx.workprec(BOUND_BITS):
            self._hull.forward.append([operation.first(i, self._hull)])
            bounds: Any = self
            rule = operation.differential(i, bounds)
            parts = [
                (part.factor * self._factor(part.node), self._gradients[part.operand])
                for part in rule.parts
            ]
            gradient = _total(parts)
            if rule.divisor is not None:
                below = self._hull.forward[rule.divisor][0]
                gradient = {j: slope / below for j, slope in gradient.items()}
        return value, gradient

    def _factor(self, node: int | None) -> arb:
        if node is None:
            return ONE
        if node < len(self._hull.forward):
            value: arb = self._hull.forward[node][0]
            return value
        # The partner of a pair, which comes next.
        return self._tape.operations[node].first(node, self._hull)

    # What differentials ask.

    @property
    def series(self) -> Any:
        return self._hull

    def least(self, i: int) -> arb:
        """A positive lower bound of a node over the box. Raises Domain where there is none."""
        bound: arb = self._hull.forward[i][0].abs_lower()
        if not bound > 0:
            raise Domain("a divisor may be zero")
        return bound


def _total(parts: Sequence[tuple[arb, Gradient]]) -> Gradient:
    """The sum of gradients times factors."""
    total: Gradient = {}
    for factor, gradient in parts:
        for component, slope in gradient.items():
            total[component] = total.get(component, ZERO) + factor * slope
    return total
