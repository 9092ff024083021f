"""The contract of a kind of body: everything that the exact solution needs to know about it.

A new kind is a folder with one class like exact.euler.rigid.Rigid, and one line in exact.registry.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from taylor_verify.exact.invariant import Invariant
from taylor_verify.exact.quadratic_forms import Equations
from taylor_verify.exact.units import Units
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]
B = TypeVar("B", bound=Body)
S = TypeVar("S", bound=State)


class Kind(ABC, Generic[B, S]):
    """A kind of body, with its body and its initial state as scenes hold them.

    The state z is what moves by equations of its own, in body axes: omega, or both impulses. The momentum
    is what these equations are linearised in, because its flow conserves volume: H, or the impulses.
    """

    moving: ClassVar[tuple[str, ...]]
    """The quantities that z consists of, three components each."""
    momenta: ClassVar[tuple[str, ...]]
    """The blocks of the momentum, three components each."""
    room: ClassVar[str]
    """The package of this kind, for what is imported late.

    Its module ``closed`` has the closed forms of a scene: ``enclosed`` in balls, ``closed_form`` in mpmath;
    each may raise NoClosedForm. Its module ``elements`` has ``elements`` (scene, digits) of the orbit.
    """

    # The state and the equations.

    @abstractmethod
    def state(self, initial: S) -> Vector:
        """z at the start."""

    @abstractmethod
    def with_state(self, initial: S, z: Vector) -> S:
        """The start with another z."""

    @abstractmethod
    def energy(self, body: B) -> Matrix:
        """The matrix of 2T = z . energy z."""

    @abstractmethod
    def equations(self, body: B) -> Equations:
        """The equations of z, without written loads."""

    @abstractmethod
    def pushed(self, body: B) -> Matrix:
        """The matrix of the rates of z by the loads: by the moment, or by force and couple."""

    def centre(self, initial: S) -> Vector | None:
        """The origin of the body at the start, in space axes; None where it does not move."""
        return None

    @abstractmethod
    def units(self, body: B, z: Vector) -> Units:
        """Powers of two in which a motion from z is of size one."""

    # The momentum. It is z itself unless stated.

    def momentum(self, body: B, z: Vector) -> Vector:
        """The momentum of a state."""
        return z

    def momentum_rows(self, body: B, motion: Any) -> Array:
        """The momentum at every row of a motion (n, d), at the ambient precision."""
        return np.concatenate([motion[name] for name in self.moving], axis=1)

    def of_momentum(self, body: B, momentum: Vector) -> Vector:
        """The state of a momentum."""
        return momentum

    def momentum_matrix(self, body: B) -> Array:
        """The matrix of the momentum by z (d, d), exactly."""
        return _columns(self.momentum, body, self.energy(body))

    def state_matrix(self, body: B) -> Array:
        """The matrix of z by the momentum (d, d), exactly."""
        return _columns(self.of_momentum, body, self.energy(body))

    def momentum_energy(self, body: B) -> Matrix:
        """The matrix of 2T by the momentum."""
        return self.energy(body)

    def momentum_equations(self, body: B) -> Equations:
        """The equations of the momentum, without written loads."""
        return self.equations(body)

    # What is conserved.

    @abstractmethod
    def invariants(self, scene: Scene) -> tuple[Invariant, ...]:
        """The conserved quantities that the tracked quantities of a scene determine."""

    @abstractmethod
    def sizes(self, scene: Scene, motion: Any) -> list[Array]:
        """The sizes (n,) at every row of a motion that the scales of the invariants are made of."""


def _columns(linear: Callable[[B, Vector], Vector], body: B, sized: Matrix) -> Array:
    """The matrix of a linear map of vectors as long as the rows of another matrix."""
    return np.array([linear(body, unit) for unit in tensors.identity(len(sized))], dtype=object).T
