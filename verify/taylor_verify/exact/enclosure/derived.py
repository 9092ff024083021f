"""The rate of change of an expression along the motion, as an expression of the same graph."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from taylor_verify.exact.enclosure.functions import Angle, Arctangent, Paired
from taylor_verify.exact.enclosure.kinks import Absolute, Norm, Sign
from taylor_verify.exact.enclosure.lowering import Lowering
from taylor_verify.exact.enclosure.operations import Bilinear, OfOne, Polynomial, State, Time
from taylor_verify.exact.enclosure.powers import Exponential, Logarithm, Power, Quotient, Root
from taylor_verify.exact.enclosure.tape import Graph, Sum, total

_TWO = Fraction(2)


class Derived:
    """Rates of expressions, by those of the components of the state."""

    def __init__(self, graph: Graph, rates: Sequence[Sum]) -> None:
        self._graph, self._rates = graph, rates
        self._quotient = Lowering(graph, {}).quotient
        self._of_node: dict[int, Sum] = {}

    def rate(self, value: Sum) -> Sum:
        """The rate of an expression."""
        return total(self._node(i).times(number) for i, number in value.terms.items())

    def _node(self, i: int) -> Sum:
        if i not in self._of_node:
            self._of_node[i] = self._made(i)
        return self._of_node[i]

    def _made(self, i: int) -> Sum:
        product, v = self._graph.product, _itself(i)
        match self._graph.operations[i]:
            case State(component=k):
                return self._rates[k]
            case Time():
                return Sum(Fraction(1))
            case Polynomial() as polynomial:
                return self._of_polynomial(polynomial)
            case Bilinear() as sums:
                return self._of_products(sums)
            case Quotient(b=b, a=a):
                above = Sum() if b is None else self._node(b)
                return self._quotient(above - product(v, self._node(a)), _itself(a))
            case Exponential(a=a):
                return product(v, self._node(a))
            case Paired(a=a, pair=pair) as function:
                return product(_itself(pair), self._node(a)).times(Fraction(function.sign))
            case Arctangent(a=a, divisor=divisor):
                return self._quotient(self._node(a), _itself(divisor))
            case Angle(y=y, x=x, divisor=divisor):
                turned = product(_itself(x), self._node(y)) - product(_itself(y), self._node(x))
                return self._quotient(turned, _itself(divisor))
            case Norm(nodes=nodes):
                pairs = (product(_itself(a), self._node(a)) for a in nodes)
                return self._quotient(total(pairs), v)
            case Sign():
                return Sum()
            case OfOne() as function:
                return self._of_one(function, v)
            case other:
                raise TypeError(f"{type(other).__name__} has no rate")

    def _of_polynomial(self, polynomial: Polynomial) -> Sum:
        first, *rest = (k * c for k, c in enumerate(polynomial.coefficients) if k)
        if not any(rest):
            return Sum(first)
        return self._graph.node(Polynomial(polynomial.knot, (first, *rest)))

    def _of_products(self, sums: Bilinear) -> Sum:
        product = self._graph.product
        parts = [
            (product(_itself(a), self._node(b)) + product(self._node(a), _itself(b))).times(number)
            for number, a, b in sums.products
        ]
        return total([*parts, *(self._node(e).times(number) for number, e in sums.sums)])

    def _of_one(self, function: OfOne, v: Sum) -> Sum:
        product, a, rate = self._graph.product, _itself(function.a), self._node(function.a)
        match function:
            case Root():
                return self._quotient(rate, v.times(_TWO))
            case Logarithm():
                return self._quotient(rate, a)
            case Power(exponent=exponent):
                return self._quotient(product(v, rate), a).times(exponent)
            case Absolute(a=operand):
                return product(self._graph.node(Sign(operand)), rate)
        raise TypeError(f"{type(function).__name__} has no rate")


def _itself(i: int) -> Sum:
    return Sum(terms={i: Fraction(1)})
