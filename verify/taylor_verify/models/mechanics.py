"""The mechanics of one kind of body: the numbers of its equations, their units, and their choice.

The equations name coefficients, loads and momenta by letters: K, M and H for a rigid body; A, B, C, X, L, x
and y for a solid in a fluid. A kind of body converts its parts to letters and back. Rounding, rescaling and
naming are loops over the letters, in problem.py and general.py.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Generic, TypeVar

from taylor_verify.models.fewest_operations import Choice
from taylor_verify.models.form import Equations
from taylor_verify.models.units import Units
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.named_numbers import Part, Shape, Value

B = TypeVar("B", bound=Body)
S = TypeVar("S", bound=State)


def components(letter: Part, value: Value) -> dict[str, Fraction]:
    """Return the components of a value by letter and indices; for a symmetric matrix the upper triangle."""
    name = letter.name
    if letter.shape is Shape.NUMBER:
        return {name: value}
    if letter.shape is Shape.VECTOR:
        return {f"{name}{i}": entry for i, entry in enumerate(value, start=1)}
    is_symmetric = letter.shape is Shape.SYMMETRIC
    return {
        f"{name}{i + 1}{k + 1}": value[i][k]
        for i in range(3)
        for k in range(i if is_symmetric else 0, 3)
    }


@dataclass(frozen=True)
class Change:
    """The map from the moving part z of a state to the momenta: matrix z, or z itself without a matrix."""

    matrix: Matrix | None = None
    inverse: Matrix = ()

    def momentum(self, moving: Vector) -> Vector:
        """Return the momenta, one after the other."""
        return moving if self.matrix is None else tensors.apply(self.matrix, moving)

    def moving(self, momentum: Vector) -> Vector:
        """Return the moving part of the state that has these momenta."""
        return momentum if self.matrix is None else tensors.apply(self.inverse, momentum)


class Mechanics(ABC, Generic[B, S]):
    """Ingredients of the equations of one kind of body.

    ``body_letters`` are its coefficients and loads, ``momenta`` the vectors that are integrated: parts
    whose names are letters.
    """

    body_letters: tuple[Part, ...]
    momenta: tuple[Part, ...]

    @property
    @abstractmethod
    def equations(self) -> Equations:
        """The general equations, with every coefficient and load."""

    @property
    def states(self) -> tuple[str, ...]:
        """The names of the components of the momenta."""
        return tuple(f"{letter.name}{i}" for letter in self.momenta for i in (1, 2, 3))

    @abstractmethod
    def values(self, body: B) -> Mapping[str, Value]:
        """Return the coefficients and loads of a body by letter."""

    @abstractmethod
    def body(self, values: Mapping[str, Value]) -> B:
        """Return the body of these coefficients and loads.

        Raises ValueError, which names what is not positive definite, if there is no such body.
        """

    @abstractmethod
    def change(self, body: B) -> Change:
        """Return the map from omega or the impulses to the momenta."""

    @abstractmethod
    def choice(self, numbers: Mapping[str, Fraction], rung: Rung) -> Choice:
        """Return the shortest equations that are exact for these numbers."""

    @abstractmethod
    def units(self, body: B, start: S, span: Fraction) -> Units:
        """Return the units in which the start and the fastest rate are of order one."""

    def derived(self, body: B, start: S) -> Mapping[str, Mapping[str, Value]]:
        """Return numbers that a program may need besides the parts, by table of the question."""
        del body, start
        return {}
