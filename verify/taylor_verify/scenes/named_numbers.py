"""Bodies and states as named exact numbers, each with its shape and its dimension.

Code that treats all numbers of a body alike loops over its parts and asks for no type: it rounds them,
changes their units, moves them by a unit roundoff, or writes them down.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum, auto
from fractions import Fraction
from typing import Any, ClassVar, NamedTuple, Self

# A number, a vector or quaternion, or a matrix, by the shape of its part.
Value = Any


class Shape(Enum):
    """The shape of a part; in a symmetric matrix two equal entries count as one number."""

    NUMBER = auto()
    VECTOR = auto()
    QUATERNION = auto()
    SYMMETRIC = auto()
    MATRIX = auto()


class Dimension(NamedTuple):
    """The powers of mass, length and time that a quantity is measured in."""

    mass: int = 0
    length: int = 0
    time: int = 0

    def per_time(self) -> Dimension:
        """Return the dimension of a rate of this quantity."""
        return Dimension(self.mass, self.length, self.time - 1)


NUMBER = Dimension()
LENGTH = Dimension(length=1)
RATE = Dimension(time=-1)
# Linear impulse, and angular momentum or impulsive couple.
IMPULSE = Dimension(1, 1, -1)
MOMENTUM = Dimension(1, 2, -1)
FORCE = IMPULSE.per_time()
MOMENT = MOMENTUM.per_time()


@dataclass(frozen=True)
class Part:
    """Named quantity of a body or a state.

    ``name`` is the word of documents and files, ``attribute`` the name in Python where that is another.
    A body with a load that is not zero is not free. The energy is made of the parts that are ``is_energy``.
    An optional part of zero is none.
    """

    name: str
    shape: Shape
    dimension: Dimension
    is_load: bool = False
    attribute: str = ""
    is_energy: bool = False
    is_optional: bool = False

    @property
    def key(self) -> str:
        """The name of the attribute that holds the value."""
        return self.attribute or self.name


@dataclass(frozen=True)
class Parted:
    """A frozen dataclass whose exact numbers are listed in PARTS, in reading order."""

    PARTS: ClassVar[tuple[Part, ...]] = ()

    @property
    def listed(self) -> tuple[Part, ...]:
        """The parts that this object has."""
        return tuple(p for p in self.PARTS if not p.is_optional or any(numbers(self.part(p))))

    def parts(self) -> dict[str, Value]:
        """Return the value of every part by its name."""
        return {part.name: self.part(part) for part in self.listed}

    def part(self, part: Part) -> Value:
        """Return the value of one part."""
        return getattr(self, part.key)

    def with_parts(self, values: Mapping[str, Value]) -> Self:
        """Return a copy with other values for the parts of these names."""
        changes = {part.key: values[part.name] for part in self.PARTS if part.name in values}
        return replace(self, **changes)

    def changed(self, change: Callable[[Part, Value], Value]) -> Self:
        """Return a copy with every part changed, whatever its shape."""
        return self.with_parts({part.name: change(part, self.part(part)) for part in self.listed})


def entrywise(change: Callable[[Fraction], Any], value: Value) -> Value:
    """Return the value with every number in it changed."""
    if not isinstance(value, tuple):
        return change(value)
    return tuple([entrywise(change, entry) for entry in value])


def numbers(value: Value) -> Iterator[Fraction]:
    """Yield every number in a value."""
    if isinstance(value, tuple):
        for entry in value:
            yield from numbers(entry)
    else:
        yield value
