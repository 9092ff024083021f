"""Faults of a scene: each in one line, all of them in one exception."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any

_LONGEST_SHOWN = 60
# Nobody reads a million faults, and to write them takes minutes.
_MOST_FAULTS = 100


class Refused(ValueError):  # noqa: N818 (an answer, not a fault of the code)
    """A scene that cannot be asked of any solver.

    ``faults`` holds one line each, ``expected ..., got ... @ body.inertia[1]``, with the mend in
    brackets where there is an obvious one; indices count from 0. The text is those lines.
    """

    def __init__(self, faults: Sequence[str]) -> None:
        # A name in a fault may have line breaks; a fault is one line.
        self.faults = tuple(fault.replace("\n", "\\n") for fault in faults)
        super().__init__("\n".join(self.faults))

    def __reduce__(self) -> tuple[type[Refused], tuple[tuple[str, ...]]]:
        # An exception is rebuilt from its text by default, and the text is not its argument.
        return Refused, (self.faults,)


class Faults:
    """The faults of one scene or file in the order of the reading, no more than a hundred.

    ``notes`` are sentences on numbers that were computed from those of the file, which is no fault.
    """

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.notes: list[str] = []

    @property
    def is_full(self) -> bool:
        """True if no further fault is recorded."""
        return len(self.lines) > _MOST_FAULTS

    def add(self, expected: str, got: str, path: str, mend: str = "") -> None:
        if self.is_full:
            return
        if len(self.lines) == _MOST_FAULTS:
            self.lines.append("and more faults beyond these hundred")
            return
        self.lines.append(_line(expected, got, path, mend))


def answers(*asked: Callable[[], Any]) -> list[Any]:
    """Return the answer of each question. Raises Refused with the faults of all that are refused."""
    given: list[Any] = []
    faults: list[str] = []
    for ask in asked:
        try:
            given.append(ask())
        except Refused as refused:
            faults += refused.faults
    if faults:
        raise Refused(faults)
    return given


def refusal(expected: str, got: object, place: object, mend: str = "") -> Refused:
    """Return the exception for a single fault."""
    return Refused([_line(expected, got, place, mend)])


def _line(expected: str, got: object, place: object, mend: str) -> str:
    line = f"expected {expected}, got {got} @ {place}"
    return f"{line} ({mend})" if mend else line


def shown(value: object) -> str:
    """Return a value as its scene would write it, cut short where it is long."""
    return cut(_toml(value))


def cut(text: str) -> str:
    """Return the text, cut short where it is long."""
    return text if len(text) <= _LONGEST_SHOWN else f"{text[:_LONGEST_SHOWN]}..."


def brief(value: object) -> str:
    """Return the argument of a Python caller as text on one line, cut short."""
    try:
        text = repr(value)
    except ValueError:  # Python prints no integer of more than 4300 digits
        text = f"a number of the type {type(value).__name__}"
    return cut(" ".join(text.split()))


def _toml(value: object, depth: int = 0) -> str:
    match value:
        case bool() | Decimal():
            return str(value).lower()
        case int() | Fraction():
            return _rational(Fraction(value))
        case str():
            return f'"{value}"'
        case list():
            # tomllib reads a deeper nesting than this recursion can follow.
            inner = ", ".join(_toml(entry, depth + 1) for entry in value) if depth < 3 else ".."
            return f"[{inner}]"
        case Mapping():
            return "a table"
    return f"the {type(value).__name__} {value}"


def _rational(value: Fraction) -> str:
    try:
        return str(value)
    except ValueError:  # Python prints no integer of more than 4300 digits
        power = value.numerator.bit_length() - value.denominator.bit_length()
        return f"{'-' if value < 0 else ''}about 2^{power}"


def near(word: str, known: Iterable[str]) -> str:
    """Return advice: the known word that is most like this one, or else all known words."""
    words = sorted(known)
    close = difflib.get_close_matches(word, words, n=1)
    if close:
        return f"did you mean `{close[0]}`?"
    return f"known: {', '.join(words)}" if words else ""
