"""Rational values of the nodes of a tape at one exact state, as far as they are rational.

A value that is taken at the start may lie exactly on its jump, which no ball about it shows.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from taylor_verify.exact.enclosure.jumps import Choice, Jump
from taylor_verify.exact.enclosure.kinks import Absolute, Norm
from taylor_verify.exact.enclosure.operations import Bilinear, Operation, Polynomial, State, Time
from taylor_verify.exact.enclosure.powers import Quotient, Root
from taylor_verify.exact.enclosure.tape import Tape
from taylor_verify.scenes.loads.steps import exact_root

Rationals = list[Fraction | None]


def rational_values(tape: Tape, state: Sequence[Any], time: Fraction) -> Rationals:
    """The value of each node; None for one that is not known to be rational."""
    values: Rationals = []
    for operation in tape.operations:
        values.append(_value(operation, values, state, time))
    return values


def _value(
    operation: Operation, values: Rationals, state: Sequence[Any], time: Fraction
) -> Fraction | None:
    match operation:
        case State(component=component):
            return _rational(state[component])
        case Time():
            return time
        case Polynomial(knot=knot, coefficients=coefficients):
            return sum((c * (time - knot) ** k for k, c in enumerate(coefficients)), Fraction(0))
        case Bilinear():
            return _sum(operation, values)
        case Choice(condition=condition):
            chosen = values[condition]
            return None if chosen is None else values[operation.chosen(chosen)]
        case Quotient(b=b, a=a):
            above, below = Fraction(1) if b is None else values[b], values[a]
            return above / below if above is not None and below else None
        case Norm(nodes=nodes):
            parts = [values[a] for a in nodes]
            known = [part for part in parts if part is not None]
            return (
                exact_root(sum((p * p for p in known), Fraction(0)))
                if len(known) == len(parts)
                else None
            )
        case Absolute(a=a) | Jump(a=a) | Root(a=a):
            return None if (inner := values[a]) is None else _of_one(operation, inner)
    return None


def _of_one(operation: Operation, value: Fraction) -> Fraction | None:
    if isinstance(operation, Jump):
        return operation.of(value)
    if isinstance(operation, Root):
        return exact_root(value) if value >= 0 else None
    return abs(value)


def _rational(number: Any) -> Fraction | None:
    return number if isinstance(number, Fraction) else None


def _sum(operation: Bilinear, values: Rationals) -> Fraction | None:
    total = _rational(operation.constant)
    for number, *nodes in (*operation.products, *operation.sums):
        term = _rational(number)
        for node in nodes:
            factor = values[node]
            term = None if term is None or factor is None else term * factor
        total = None if total is None or term is None else total + term
    return total
