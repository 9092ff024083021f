"""Elements, the numbers that describe an orbit as a whole, and the precision at which they settle."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from mpmath import mp, mpf

from taylor_verify.exact.solution import SETTLING_STEP_DIGITS, Unsettled

_GUARD_DIGITS: Final = 10
_ATTEMPTS: Final = 12


@dataclass(frozen=True)
class Element:
    """A number of the orbit, with its unit in words, its meaning and its formula.

    ``unit`` is empty for a pure number. ``size`` is what an error is measured against where the
    number itself may be zero or nearly so; 0 asks for relative accuracy.
    """

    name: str
    value: mpf
    unit: str
    meaning: str
    source: str = ""
    size: mpf | int = 0


def described(table: str, values: Iterable[mpf]) -> list[Element]:
    """The values with a row each of ``name :: unit :: meaning :: formula``; no unit for a pure number."""
    rows = (row.split("::") for row in table.strip().splitlines())
    return [
        Element(name.strip(), value, unit.strip(), meaning.strip(), formula.strip())
        for (name, unit, meaning, formula), value in zip(rows, values, strict=True)
    ]


@dataclass(frozen=True)
class Elements(Mapping[str, Element]):
    """The numbers of one orbit by name, in reading order, with explaining sentences.

    ``sentences`` state what no number can: the conserved quantities and the stability.
    """

    regime: str
    numbers: tuple[Element, ...]
    sentences: tuple[str, ...]

    def __getitem__(self, name: str) -> Element:
        for element in self.numbers:
            if element.name == name:
                return element
        raise KeyError(name)

    def __iter__(self) -> Iterator[str]:
        return (element.name for element in self.numbers)

    def __len__(self) -> int:
        return len(self.numbers)


def settled(evaluate: Callable[[int], Sequence[Element]], digits: int) -> tuple[Element, ...]:
    """The elements to ``digits`` significant digits, believed when two precisions agree.

    ``evaluate`` works at the ambient precision, whose digits it is also given. Raises Unsettled
    when a dozen rises of the precision do not suffice.
    """
    working = digits + _GUARD_DIGITS
    with mp.workdps(working):
        poorer = evaluate(working)
    for attempt in range(_ATTEMPTS):
        working += SETTLING_STEP_DIGITS << attempt // 2
        with mp.workdps(working):
            better = evaluate(working)
            agreed = _agree(poorer, better, mpf(10) ** -digits)
        if agreed:
            with mp.workdps(digits):
                return tuple(replace(element, value=+element.value) for element in better)
        poorer = better
    raise Unsettled(f"the elements of the orbit do not settle to {digits} digits")


def _agree(poorer: Sequence[Element], better: Sequence[Element], tolerance: mpf) -> bool:
    """Return True if both have the same numbers; NaN agrees with nothing."""
    if [p.name for p in poorer] != [b.name for b in better]:
        return False
    return all(
        abs(p.value - b.value) <= tolerance * max(abs(b.value), b.size)
        for p, b in zip(poorer, better, strict=True)
    )
