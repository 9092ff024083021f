"""Formulas in the numbers of a family: + - * / and whole powers, exactly, and three functions.

The functions `sqrt`, `log` (natural) and `exp` are irrational: their values are correctly rounded to 20
significant digits, and all that is made of these is exact again.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from decimal import Context, Decimal, InvalidOperation, Overflow
from fractions import Fraction
from functools import lru_cache
from typing import Final

_DIGITS: Final = Context(prec=20)
_GUARDED: Final = Context(prec=60)
_LONGEST: Final = 200
_LARGEST_POWER: Final = 20
_MOST_BITS: Final = 13_280  # 4000 digits
_ALLOWED: Final = "a formula in numbers defined above, + - * / ** and sqrt log exp"
_FUNCTIONS: Final[Mapping[str, Callable[[Decimal], Decimal]]] = {
    "sqrt": _DIGITS.sqrt,
    "log": _DIGITS.ln,
    "exp": _DIGITS.exp,
}
_OPERATIONS: Final[Mapping[type[ast.operator], Callable[[Fraction, Fraction], Fraction]]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}


class NoValue(ValueError):
    """A formula without a value at this point; the text says what was expected and what came instead."""


@dataclass(frozen=True)
class Formula:
    """A formula, its text and the ``names`` that occur in it."""

    text: str
    names: frozenset[str]

    def value(self, numbers: Mapping[str, Fraction]) -> Fraction:
        """Return the value for these numbers. Raises NoValue where it has none."""
        try:
            return _value(_parsed(self.text), self.text, numbers)
        except ZeroDivisionError:
            raise NoValue(f"expected a divisor that is not zero, got 0 in {self.text!r}") from None
        except (InvalidOperation, Overflow):
            expected = "an argument for which the function is a real number"
            raise NoValue(f"expected {expected}, got another one in {self.text!r}") from None


def formula(text: object) -> Formula:
    """Return the formula that a text writes. Raises ValueError, whose text is what was expected."""
    if not isinstance(text, str) or len(text) > _LONGEST:
        raise ValueError(_ALLOWED)
    try:
        tree = _parsed(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ValueError(_ALLOWED) from None
    return Formula(text, frozenset(_names(tree)))


@lru_cache
def _parsed(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def _names(node: ast.expr) -> set[str]:
    """Return the names in a node. Raises ValueError for a part that no formula may have."""
    match node:
        case ast.Name(id=name):
            return {name}
        case ast.Constant(value=int() | float()) if not isinstance(node.value, bool):
            return set()
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
            return _names(operand)
        case ast.BinOp(left=base, op=ast.Pow(), right=ast.Constant(value=int(power))):
            if not 0 <= power <= _LARGEST_POWER:
                raise ValueError(f"a whole power from 0 to {_LARGEST_POWER}")
            return _names(base)
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div(), right=right):
            return _names(left) | _names(right)
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in _FUNCTIONS:
            return _names(argument)
    raise ValueError(_ALLOWED)


def _value(node: ast.expr, text: str, numbers: Mapping[str, Fraction]) -> Fraction:
    """Return the value of a node. Raises NoValue for a number that no scene file could hold."""
    value = _computed(node, text, numbers)
    if max(value.numerator.bit_length(), value.denominator.bit_length()) > _MOST_BITS:
        raise NoValue(f"expected numbers of at most 4000 digits, got more in {text!r}")
    return value


def _computed(node: ast.expr, text: str, numbers: Mapping[str, Fraction]) -> Fraction:
    match node:
        case ast.Name(id=name):
            return numbers[name]
        case ast.Constant():
            # The literal as it is written: 0.1 is one tenth.
            return Fraction((ast.get_source_segment(text, node) or "").replace("_", ""))
        case ast.UnaryOp(op=op, operand=operand):
            value = _value(operand, text, numbers)
            return -value if isinstance(op, ast.USub) else value
        case ast.BinOp(left=base, op=ast.Pow(), right=ast.Constant(value=int(power))):
            return _value(base, text, numbers) ** power
        case ast.BinOp(left=left, op=op, right=right):
            return _OPERATIONS[type(op)](_value(left, text, numbers), _value(right, text, numbers))
        case ast.Call(func=ast.Name(id=name), args=[argument]):
            exact = _value(argument, text, numbers)
            near = _GUARDED.divide(Decimal(exact.numerator), Decimal(exact.denominator))
            irrational = _FUNCTIONS[name](near)
            if not irrational.is_finite():
                raise InvalidOperation
            return Fraction(irrational)
    raise ValueError(_ALLOWED)
