"""A table of a template becomes the rule of a number: a distribution, a grid or a formula."""

from __future__ import annotations

import difflib
from collections.abc import Collection, Mapping
from decimal import Decimal
from fractions import Fraction
from typing import Any, Final

from taylor_verify.numbers.precision import as_decimal
from taylor_verify.records.faults import Faults, cut, near, shown
from taylor_verify.scenes.families.distributions import (
    DISTRIBUTIONS,
    Draw,
    Grid,
    rounded,
)
from taylor_verify.scenes.families.formula import Formula, formula
from taylor_verify.scenes.loads.steps import NoStep
from taylor_verify.scenes.reading.table import exact_number

UNIT: Final = "unit"
KINDS: Final = (*DISTRIBUTIONS, "grid", "formula")
_MOST_VALUES: Final = 100_000
_MOST_DIGITS: Final = 60

Rule = Draw | Grid | Formula


def rule(
    entries: Mapping[str, Any], place: str, digits: int, known: Collection[str], faults: Faults
) -> Rule | None:
    """Return the rule that a table writes; None after a fault.

    ``known`` are the names that a formula may use.
    """
    kinds = [key for key in entries if key in KINDS]
    others = [key for key in entries if key not in (*KINDS, UNIT)]
    expected = f"one of {', '.join(KINDS)}"
    for key in others:
        allowed = f"at most `{UNIT}` beside `{kinds[0]}`" if kinds else expected
        faults.add(allowed, f"`{cut(key)}`", place, _nearest(key))
    if len(kinds) != 1:
        if kinds or not others:
            faults.add(expected, " and ".join(kinds) or "none", place)
        return None
    (kind,) = kinds
    reading = _Parameters(entries[kind], f"{place}.{kind}", digits, faults)
    made = reading.formula(known) if kind == "formula" else reading.rule(kind)
    return None if others else made


def _nearest(key: str) -> str:
    """Return advice: the distribution that was probably meant, if one is near."""
    close = difflib.get_close_matches(key, (*KINDS, UNIT), n=1)
    return f"did you mean `{close[0]}`?" if close else ""


class _Parameters:
    """The parameters of one rule, and where they stand."""

    def __init__(self, value: Any, place: str, digits: int, faults: Faults) -> None:
        self._value, self._place, self._digits, self._faults = value, place, digits, faults

    def formula(self, known: Collection[str]) -> Formula | None:
        """Return the formula; a name that is not among the known ones is a fault."""
        try:
            made = formula(self._value)
        except NoStep as fault:
            self._fault(fault.expected)
            return None
        unknown = sorted(made.names.difference(known))
        for name in unknown:
            mend = near(name, known) or "define it above, in [sweep.numbers]"
            self._faults.add("a number defined above", f"`{name}`", self._place, mend)
        return None if unknown else made

    def rule(self, kind: str) -> Rule | None:
        """Return the draw or the grid of these parameters."""
        if kind in ("choice", "grid"):
            values = self._numbers(least=1, most=_MOST_VALUES)
            if values is None:
                return None
            return Grid(values) if kind == "grid" else Draw(kind, values, _MOST_DIGITS)
        numbers = self._numbers(least=2, most=2)
        if numbers is None or not self._is_sound(kind, *numbers):
            return None
        return Draw(kind, numbers, self._digits)

    def _is_sound(self, kind: str, first: Decimal, second: Decimal) -> bool:
        if kind == "normal":
            if second > 0:
                return True
            self._fault("a mean and a positive standard deviation")
            return False
        if not first < second:
            self._fault("a smaller and a larger number")
            return False
        if kind.startswith("log") and not first > 0:
            self._fault("two positive numbers")
            return False
        if any(rounded(n, self._digits) != n for n in (first, second)):
            # A number rounded to fewer digits than its bounds have could lie outside of them.
            self._fault(f"bounds of at most {self._digits} digits (`digits` in [sweep])")
            return False
        return True

    def _numbers(self, least: int, most: int) -> tuple[Decimal, ...] | None:
        count = f"{least}" if least == most else f"at least {least}"
        if not isinstance(self._value, list) or not least <= len(self._value) <= most:
            self._fault(f"an array of {count} {'number' if count.endswith('1') else 'numbers'}")
            return None
        numbers: list[Decimal] = []
        for i, value in enumerate(self._value):
            place = f"{self._place}[{i}]"
            try:
                numbers.append(_decimal(exact_number(value)))
            except ValueError as error:
                self._faults.add(str(error), shown(value), place)
        return tuple(numbers) if len(numbers) == len(self._value) else None

    def _fault(self, expected: str) -> None:
        self._faults.add(expected, shown(self._value), self._place)


def _decimal(value: Fraction) -> Decimal:
    """Return a rational as the decimal that it is. Raises ValueError for one that is none."""
    exact = as_decimal(value)
    if exact is None or len(exact.as_tuple().digits) > _MOST_DIGITS:
        raise ValueError(f"a decimal of at most {_MOST_DIGITS} digits")
    return exact
