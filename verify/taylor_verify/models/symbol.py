"""A symbol that records the operations on it, to print and count the equations as they are built."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

Functions = Mapping[str, Callable[..., Any]]
_STRENGTH = {"+": 1, "-": 1, "*": 2, "/": 2, "": 3}


class _Calls(dict[str, Callable[..., Any]]):
    """Functions that write a call down."""

    def __missing__(self, name: str) -> Callable[..., Symbol]:
        return lambda *operands: Symbol("", name, operands)


@dataclass(frozen=True)
class Symbol:
    """A name, or an operation (+ - * / or a function) on operands; equal expressions are equal."""

    FUNCTIONS: ClassVar[Functions] = _Calls()

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

    def __rtruediv__(self, other: Any) -> Symbol:
        return Symbol("", "/", (other, self))

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        # Computed once: an expression may occur in many others.
        return hash((self.name, self.operation, self.operands))

    def __str__(self) -> str:
        if not self.operation:
            return self.name
        if self.operation not in _STRENGTH:
            return f"{self.operation}({', '.join(map(str, self.operands))})"
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
    operation = operand.operation if isinstance(operand, Symbol) else ""
    own = _STRENGTH.get(operation, _STRENGTH[""])
    return str(operand) if own >= strength else f"({operand})"


def parts(expressions: Iterable[Any]) -> set[Symbol]:
    """Return the distinct symbols that these expressions are made of."""
    done: set[Symbol] = set()
    left = [expression for expression in expressions if isinstance(expression, Symbol)]
    while left:
        symbol = left.pop()
        if symbol not in done:
            done.add(symbol)
            left.extend(operand for operand in symbol.operands if isinstance(operand, Symbol))
    return done


def operations(expressions: Iterable[Any]) -> dict[str, int]:
    """Count the distinct sums, products and quotients of these expressions."""
    done = [symbol for symbol in parts(expressions) if symbol.operation in _STRENGTH]
    return {
        "sums": sum(symbol.operation in ("+", "-") for symbol in done),
        "products": sum(symbol.operation == "*" for symbol in done),
        "quotients": sum(symbol.operation == "/" for symbol in done),
    }
