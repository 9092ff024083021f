"""Formulas in the numbers of a family: the expressions that loads are written in, made of numbers.

All is exact but what is irrational, such as sqrt(2): that is rounded to 20 significant digits, and what is
made of it is exact again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from mpmath import mp

from taylor_verify.scenes.loads.grammar import Grammar, Unread
from taylor_verify.scenes.loads.steps import NoStep, Step, Steps

_DIGITS: Final = 20
_WORKING: Final = 40
_MOST_BITS: Final = 13_280
_TOO_LONG: Final = ("numbers of at most 4000 digits", "more")


@dataclass(frozen=True)
class Formula:
    """A formula, its text and the ``names`` that occur in it."""

    text: str
    names: frozenset[str]

    def value(self, numbers: Mapping[str, Fraction]) -> Fraction:
        """Return the value for these numbers. Raises NoStep where it has none."""
        steps = _Numbers()
        value = steps.value(_read(self.text, steps, lambda name: steps.number(numbers[name])))
        assert value is not None
        return value


def formula(text: object) -> Formula:
    """Return the formula that a text writes. Raises NoStep for another text."""
    if not isinstance(text, str):
        raise NoStep("a formula, in quotation marks", "none")
    names: set[str] = set()
    steps = Steps()

    def named(name: str) -> int:
        names.add(name)
        return steps.input(name)

    _read(text, steps, named)
    return Formula(text, frozenset(names))


def _read(text: str, steps: Steps, named: Callable[[str], int]) -> int:
    """Return the place of a text among the steps. Raises NoStep with its first fault."""
    # Nothing here depends on the time, on which the last two decide.
    grammar = Grammar(steps, named, lambda *_: True, lambda *_: 0)
    grammar.may_jump = True
    try:
        return grammar.read(text)
    except Unread:
        fault = grammar.faults[0]
        raise NoStep(fault.expected, f"{fault.got} in {text!r}") from None


class _Numbers(Steps):
    """Steps of which each is a number."""

    def number(self, value: Fraction) -> int:
        if max(value.numerator.bit_length(), value.denominator.bit_length()) > _MOST_BITS:
            raise NoStep(*_TOO_LONG)
        return super().number(value)

    def _place(self, step: Step, line: tuple[Fraction, Fraction] | None = None) -> int:
        if step.operation == "number":
            return super()._place(step, line)
        with mp.workdps(_WORKING):
            operands = [mp.convert(self.value(place)) for place in step.operands]
            exponent = [] if step.number is None else [mp.convert(step.number)]
            value = getattr(mp, step.operation)(*operands, *exponent)
            if value and abs(mp.mag(value)) > _MOST_BITS:
                raise NoStep(*_TOO_LONG)
            return self.number(Fraction(mp.nstr(value, _DIGITS)))
