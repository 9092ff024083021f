"""Mechanics of one kind of body: the numbers of its equations, their units, and the choice of equations.

The equations hold coefficients, loads and momenta under letters: K, M and H of a rigid body; A, B, C, X, L,
x and y of a solid in a fluid. A kind of body says how its letters follow from its parts and back; the rest
(rounding, rescaling, naming) is one loop over the letters, in problem.py and general.py.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, Generic, TypeVar

from taylor_verify.models.choice import Choice
from taylor_verify.models.form import Equations
from taylor_verify.models.manufactured import Inverse
from taylor_verify.models.units import Units
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.parts import Dimension, Shape, Value
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.tensors import Vector

B = TypeVar("B", bound=Body)
S = TypeVar("S", bound=State)


@dataclass(frozen=True)
class Letter:
    """A quantity of the equations, whose components are named by its letter and their indices."""

    letter: str
    shape: Shape
    dimension: Dimension
    is_load: bool = False

    def named(self, value: Value) -> dict[str, Fraction]:
        """Return the components by name; of a symmetric matrix the upper triangle."""
        if self.shape is Shape.NUMBER:
            return {self.letter: value}
        if self.shape is Shape.VECTOR:
            return {f"{self.letter}{i}": entry for i, entry in enumerate(value, start=1)}
        first = (lambda i: i) if self.shape is Shape.SYMMETRIC else (lambda i: 0)
        return {
            f"{self.letter}{i + 1}{j + 1}": value[i][j]
            for i in range(3)
            for j in range(first(i), 3)
        }


class Mechanics(ABC, Generic[B, S]):
    """What the equations of one kind of body are made of.

    ``body_letters`` are its coefficients and loads, ``momenta`` the vectors that are integrated.
    ``inverse`` makes the loads of a manufactured motion.
    """

    body_letters: ClassVar[tuple[Letter, ...]]
    momenta: ClassVar[tuple[Letter, ...]]
    inverse: ClassVar[Inverse]

    @property
    @abstractmethod
    def equations(self) -> Equations:
        """The general equations, with every coefficient and load."""

    @property
    def states(self) -> tuple[str, ...]:
        """The names of the components of the momenta."""
        return tuple(f"{letter.letter}{i}" for letter in self.momenta for i in (1, 2, 3))

    @abstractmethod
    def values(self, body: B) -> Mapping[str, Value]:
        """Return the coefficients and loads of a body by letter."""

    @abstractmethod
    def body(self, values: Mapping[str, Value]) -> B:
        """Return the body of these coefficients and loads.

        Raises ValueError, whose text says what is not positive definite, where there is none.
        """

    @abstractmethod
    def momentum(self, body: B, start: S) -> Vector:
        """Return the momenta of a state, one after the other."""

    @abstractmethod
    def moving(self, body: B, momentum: Vector) -> Vector:
        """Return the moving part of the state that has these momenta."""

    @abstractmethod
    def motion_of_momenta(self, body: B, motion: Manufactured) -> Manufactured:
        """Return the motion of the momenta, of one of omega or of the impulses."""

    @abstractmethod
    def motion_of_state(self, body: B, motion: Manufactured) -> Manufactured:
        """Return the motion of omega or of the impulses, of one of the momenta."""

    @abstractmethod
    def choice(self, numbers: Mapping[str, Fraction], rung: Rung) -> Choice:
        """Return the shortest equations that are exactly those of these numbers."""

    @abstractmethod
    def units(self, body: B, start: S, span: Fraction) -> Units:
        """Return the units in which the start and the fastest rate are of order one."""

    def derived(self, body: B, start: S) -> Mapping[str, Mapping[str, Value]]:
        """Return what a program may want besides the parts, by table of the question."""
        del body, start
        return {}
