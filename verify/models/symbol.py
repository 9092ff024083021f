"""A symbol that writes down what is done to it: the equations printed are the equations built."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

_SUM, _PRODUCT, _ATOM = 1, 2, 3


@dataclass(frozen=True)
class Symbol:
    """Text of an expression, with the binding strength of its outermost operation."""

    text: str
    strength: int = _ATOM

    def __str__(self) -> str:
        return self.text

    def __add__(self, other: Any) -> Symbol:
        return Symbol(f"{self} + {_of(other)}", _SUM)

    def __sub__(self, other: Any) -> Symbol:
        return Symbol(f"{self} - {_of(other).within(_PRODUCT)}", _SUM)

    def __neg__(self) -> Symbol:
        return Symbol(f"-{self.within(_PRODUCT)}", _SUM)

    def __mul__(self, other: Any) -> Symbol:
        return Symbol(f"{self.within(_PRODUCT)} {_of(other).within(_PRODUCT)}", _PRODUCT)

    def __rmul__(self, other: Any) -> Symbol:
        return _of(other) * self

    def __truediv__(self, other: Any) -> Symbol:
        return Symbol(f"{self.within(_PRODUCT)}/{_of(other).within(_ATOM)}", _PRODUCT)

    def within(self, strength: int) -> str:
        """The text, in brackets if it binds less than its surroundings."""
        return self.text if self.strength >= strength else f"({self.text})"


def _of(value: Any) -> Symbol:
    return value if isinstance(value, Symbol) else Symbol(str(value))
