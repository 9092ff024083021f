"""A symbol that records the operations on it, to print and count the equations as they are built."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

_STRENGTH = {"+": 1, "-": 1, "*": 2, "/": 2, "": 3}


@dataclass(frozen=True)
class Symbol:
    """A name, or an operation (+ - * /) on one or two operands; equal expressions are equal."""

    name: str = ""
    operation: str = ""
    operands: tuple[Any, ...] = ()

    def __add__(self, other: Any) -> Symbol:
        return Symbol("", "+", (self, other))

    def __sub__(self, other: Any) -> Symbol:
        return Symbol("", "-", (self, other))

    def __neg__(self) -> Symbol:
        return Symbol("", "-", (self,))

    def __mul__(self, other: Any) -> Symbol:
        return Symbol("", "*", (self, other))

    def __rmul__(self, other: Any) -> Symbol:
        return Symbol("", "*", (other, self))

    def __truediv__(self, other: Any) -> Symbol:
        return Symbol("", "/", (self, other))

    def __str__(self) -> str:
        if not self.operation:
            return self.name
        if len(self.operands) == 1:
            return f"-{_within(self.operands[0], _STRENGTH['*'])}"
        left, right = self.operands
        if self.operation == "+":
            return f"{left} + {right}"
        if self.operation == "-":
            return f"{left} - {_within(right, _STRENGTH['*'])}"
        if self.operation == "*":
            return f"{_within(left, _STRENGTH['*'])} {_within(right, _STRENGTH['*'])}"
        return f"{_within(left, _STRENGTH['*'])}/{_within(right, _STRENGTH[''])}"


def _within(operand: Any, strength: int) -> str:
    """Return the text, in brackets if it binds less than its surroundings."""
    own = _STRENGTH[operand.operation] if isinstance(operand, Symbol) else _STRENGTH[""]
    return str(operand) if own >= strength else f"({operand})"


def operations(expressions: Iterable[Any]) -> dict[str, int]:
    """Count the distinct sums, products and quotients of these expressions."""
    done: set[Symbol] = set()
    left = [expression for expression in expressions if isinstance(expression, Symbol)]
    while left:
        symbol = left.pop()
        if symbol.operation and symbol not in done:
            done.add(symbol)
            left.extend(operand for operand in symbol.operands if isinstance(operand, Symbol))
    return {
        "sums": sum(symbol.operation in "+-" for symbol in done),
        "products": sum(symbol.operation == "*" for symbol in done),
        "quotients": sum(symbol.operation == "/" for symbol in done),
    }
