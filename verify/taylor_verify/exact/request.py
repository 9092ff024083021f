"""The request of an exact motion: its times and its digits, as exact numbers or refused in one sentence."""

from __future__ import annotations

from collections.abc import Iterable
from decimal import Decimal
from fractions import Fraction
from numbers import Rational
from operator import index
from typing import Any, Final

from taylor_verify.records.faults import Faults, Refused, brief, refusal
from taylor_verify.scenes.reading.table import exact_number

MOST_DIGITS: Final = 10_000


def exact_times(times: Iterable[Any]) -> list[Fraction]:
    """Return each time as the rational that it is; a binary number of any width exactly.

    Raises Refused for what is no sequence of finite numbers, with every fault: text in its place, a table,
    a number that is masked.
    """
    expected = "a sequence of times"
    if isinstance(times, str | bytes | set | frozenset) or hasattr(times, "columns"):
        kind = "text" if isinstance(times, str) else type(times).__name__
        raise refusal(expected, f"the {kind} {brief(times)}", "times")
    try:
        listed = list(times)
    except TypeError:
        raise refusal(expected, brief(times), "times") from None
    faults = Faults()
    exact = [_exact_time(time, f"times[{i}]", faults) for i, time in enumerate(listed)]
    if faults.lines:
        raise Refused(faults.lines)
    return exact


def exact_time(time: Any, place: str) -> Fraction:
    """Return a single time likewise."""
    faults = Faults()
    exact = _exact_time(time, place, faults)
    if faults.lines:
        raise Refused(faults.lines)
    return exact


def check_digits(digits: Any) -> int:
    """Return the number of digits. Raises Refused unless it is a whole number from 1 to ten thousand."""
    try:
        number = None if isinstance(digits, bool) else index(digits)
    except TypeError:
        number = None
    if number is None or not 1 <= number <= MOST_DIGITS:
        raise refusal(f"digits from 1 to {MOST_DIGITS}", brief(digits), "digits")
    return number


def _exact_time(time: Any, place: str, faults: Faults) -> Fraction:
    try:
        return _exact(time)
    except (ValueError, OverflowError) as error:
        faults.add(str(error), brief(time), place)
        return Fraction(0)


def _exact(time: Any) -> Fraction:
    if isinstance(time, str | Decimal):
        return exact_number(time)
    if isinstance(time, Rational) and not isinstance(time, bool):
        return Fraction(int(time.numerator), int(time.denominator))
    ratio = getattr(time, "as_integer_ratio", None)
    if ratio is None or isinstance(time, bool):
        raise ValueError("a finite number")
    try:
        numerator, denominator = ratio()
    except (ValueError, OverflowError):
        raise ValueError("a finite number") from None
    return Fraction(int(numerator), int(denominator))
