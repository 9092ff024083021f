"""Letters of the equations with their values: exact, in units, rounded."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Protocol

from taylor_verify.models.mechanics import components
from taylor_verify.models.registry import mechanics
from taylor_verify.models.units import Units
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.named_numbers import Part, Value


class Rounding(Protocol):
    """The protocol of what rounds every number of a value times 2^shift, whatever its shape."""

    def each(self, value: Value, shift: int = 0) -> Value: ...


def numbers_of(body: Body, units: Units) -> dict[str, Fraction]:
    """Return every coefficient and load of a body by name, in these units."""
    kind = mechanics(body)
    return named(kind.body_letters, each(kind.body_letters, kind.values(body), units.counted))


Letters = Sequence[Part]
Values = Mapping[str, Value]


def each(letters: Letters, values: Values, change: Callable[[Part, Value], Value]) -> Values:
    """Return the value of each letter in other units."""
    return {letter.name: change(letter, values[letter.name]) for letter in letters}


def counted(letters: Letters, values: Values, units: Units, rounded: Rounding) -> Values:
    """Return the value of each letter, counted in its unit and rounded once."""
    return {
        letter.name: rounded.each(values[letter.name], -units.exponent(letter.dimension))
        for letter in letters
    }


def named(letters: Letters, values: Values) -> dict[str, Fraction]:
    return {
        name: v for letter in letters for name, v in components(letter, values[letter.name]).items()
    }
