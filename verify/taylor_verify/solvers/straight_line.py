"""The equations of a form as one Python function: straight-line code with each operation done once.

`Form.rates` looks every symbol up by its name, anew at each evaluation: it serves every arithmetic, and
takes ten times as long as the operations themselves. A solver that calls the equations from Python
would be timed for that. What stands here does the same operations in the same order, so that in
floating point the rates are the same to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

from taylor_verify.models.form import Form
from taylor_verify.models.functions import Functions, functions_of
from taylor_verify.models.kinks import values
from taylor_verify.models.symbol import Symbol

_ARITHMETIC: Final = ("+", "-", "*", "/")
Rates = Callable[[Any, Sequence[Any]], list[Any]]


@dataclass(frozen=True)
class Lines:
    """The equations of a form as assignments in + - * /, an operation a line, which many languages read.

    State k is called ``s{k}`` and parameter k ``p{k}``. ``rates`` are the names of the results in the order
    of the states. ``constants`` are numbers that the equations have besides, by name, and ``functions`` the
    names of the functions that written loads call. The time since the start is called ``t``.
    """

    lines: tuple[str, ...]
    rates: tuple[str, ...]
    constants: Mapping[str, Any]
    functions: tuple[str, ...] = ()


def lines(form: Form, places: Sequence[int] = ()) -> Lines:
    """Return the lines that compute the rates of a form, or the steps of its loads at some places."""
    code, (states, parameters) = _Code(), _names(form)
    if places:
        steps = values(form, states, parameters, Symbol("t"))
        wanted = [steps[place] for place in places]
    else:
        wanted = form.rates(states, parameters, Symbol("t"))
    results = tuple(map(code.word, wanted))
    return Lines(tuple(code.lines), results, code.constants, tuple(code.functions))


def straight_line(
    form: Form,
    parameters: Sequence[Any],
    functions: Functions | None = None,
    places: tuple[int, ...] = (),
) -> Rates:
    """Return ``rates(t, state)`` in the arithmetic of the parameters and the state.

    The loads of a scene may read t, the time since the start; nothing else does. ``functions`` are those
    of the state, where these are not those of the parameters. With ``places`` it is not the rates that are
    returned, but the steps of the loads there.
    """
    bound, constants, names = _bound(form, places)
    functions = functions or (functions_of(parameters[0]) if names else {})
    rates: Rates = bound(*parameters, *constants, *(functions[name] for name in names))
    return rates


@lru_cache(maxsize=32)
def _bound(
    form: Form, places: tuple[int, ...] = ()
) -> tuple[Callable[..., Rates], tuple[Any, ...], tuple[str, ...]]:
    """Return the function from parameters, constants and functions to the rates; and the last two.

    The functions are returned by name.
    """
    code, (states, names) = lines(form, places), _names(form)
    text = [
        f"def bound({_listed([*names, *map(Symbol, (*code.constants, *code.functions))])}):",
        " def rates(t, state):",
        f"  {_listed(states)} = state",
        *(f"  {line}" for line in code.lines),
        f"  return [{', '.join(code.rates)}]",
        " return rates",
    ]
    made: dict[str, Any] = {}
    # The text is made of the names s0, p0, c0, t0, ..., of + - * / and of functions of the grammar.
    exec("\n".join(text), made)
    return made["bound"], tuple(code.constants.values()), code.functions


def _names(form: Form) -> tuple[list[Symbol], list[Symbol]]:
    states = [Symbol(f"s{k}") for k in range(len(form.states))]
    return states, [Symbol(f"p{k}") for k in range(len(form.parameters))]


class Endless(Exception):
    """More evaluations than a run may take; the text is their number."""


class Counting:
    """A count of evaluations; Endless is raised beyond ``most`` of them."""

    def __init__(self, most: int) -> None:
        self._most = most
        self.evaluations = 0

    def count(self) -> None:
        """Count one evaluation more. Raises Endless."""
        self.evaluations += 1
        if self.evaluations > self._most:
            raise Endless(f"{self.evaluations} evaluations")


class Counted(Counting):
    """The rates of a form, counted."""

    def __init__(self, form: Form, parameters: Sequence[Any], most: int) -> None:
        super().__init__(most)
        self._rates = straight_line(form, parameters)

    def __call__(self, t: Any, state: Sequence[Any]) -> list[Any]:
        self.count()
        return self._rates(t, state)


def _listed(symbols: Sequence[Symbol]) -> str:
    return "".join(f"{symbol.name}, " for symbol in symbols)


class _Code:
    """The lines that compute some expressions, an operation a line, none of them twice."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.constants: dict[str, Any] = {}
        self.functions: dict[str, None] = {}
        self._words: dict[Symbol, str] = {}

    def word(self, expression: Any) -> str:
        """Return the name under which the value of an expression is to be had."""
        if not isinstance(expression, Symbol):
            name = f"c{len(self.constants)}"
            self.constants[name] = expression
            return name
        if not expression.operation:
            return expression.name
        if expression not in self._words:
            operands = [self.word(operand) for operand in expression.operands]
            text = f" {expression.operation} ".join(operands)
            if expression.operation not in _ARITHMETIC:
                self.functions[expression.operation] = None
                text = f"{expression.operation}({', '.join(operands)})"
            elif len(operands) == 1:
                text = f"{expression.operation}{operands[0]}"
            name = f"t{len(self.lines)}"
            self.lines.append(f"{name} = {text}")
            self._words[expression] = name
        return self._words[expression]
