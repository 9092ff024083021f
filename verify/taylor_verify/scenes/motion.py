"""Motion of a body: its exact initial state, the instants it is asked at, and its samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from mpmath import mp

from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.records.quantities import MOMENTA
from taylor_verify.records.sampled import Sampled
from taylor_verify.scenes.instants import Instants
from taylor_verify.scenes.named_numbers import (
    IMPULSE,
    LENGTH,
    MOMENTUM,
    NUMBER,
    RATE,
    Part,
    Parted,
    Shape,
)

Quaternion = tuple[Fraction, Fraction, Fraction, Fraction]
IDENTITY: Quaternion = (Fraction(1), Fraction(0), Fraction(0), Fraction(0))


_ATTITUDE = Part("attitude", Shape.QUATERNION, NUMBER)


class State(Parted):
    """The initial state of a body: what enters its own equations, then where the body is.

    ``MOVING`` are the names of the parts that move by equations of their own, as files have them: omega,
    or both impulses.
    """

    MOVING: ClassVar[tuple[str, ...]]
    attitude: Quaternion

    @cached_property
    def moving(self) -> Vector:
        """The state that enters its own equations, as one vector of three or six."""
        values = self.parts()
        return tuple(entry for name in self.MOVING for entry in values[name])

    def with_moving(self, vector: Vector) -> Self:
        """Return the state with another moving part, at the same place."""
        return self.with_parts(
            {name: vector[3 * k : 3 * k + 3] for k, name in enumerate(self.MOVING)}
        )


@dataclass(frozen=True)
class Spin(State):
    """The initial state of a rigid body.

    ``omega`` is in body axes. ``attitude`` is a quaternion, scalar first, body to space, any norm but
    zero: whoever uses it divides by the norm, because the quotient is rarely rational.
    """

    omega: Vector
    attitude: Quaternion = IDENTITY

    MOVING = MOMENTA["euler"]
    PARTS = (Part("omega", Shape.VECTOR, RATE), _ATTITUDE)


@dataclass(frozen=True)
class Impulse(State):
    """The initial state of a solid in a fluid.

    ``linear`` x and ``angular`` y, about the body's origin, are the impulses of body and fluid together,
    in body axes; ``attitude`` is a quaternion as in Spin; ``centre`` is the body's origin, in space axes.
    """

    linear: Vector
    angular: Vector
    attitude: Quaternion = IDENTITY
    centre: Vector = ZERO_VECTOR

    MOVING = MOMENTA["kirchhoff"]
    PARTS = (
        Part("linear_impulse", Shape.VECTOR, IMPULSE, attribute="linear"),
        Part("angular_impulse", Shape.VECTOR, MOMENTUM, attribute="angular"),
        _ATTITUDE,
        Part("centre", Shape.VECTOR, LENGTH),
    )


@dataclass(frozen=True)
class Clock:
    """The time of the initial state and the instants asked for, strictly monotonic.

    The instants do not change; a tuple, or one of scenes.instants.
    """

    start: Fraction
    instants: Sequence[Fraction]

    @cached_property
    def elapsed(self) -> Sequence[Fraction]:
        """Time since the initial state. The equations are autonomous: this alone enters them."""
        if not self.start:
            return self.instants
        return Instants(len(self.instants), lambda k: self.instants[k] - self.start)


@dataclass(frozen=True, eq=False, repr=False)
class Motion(Sampled):
    """A motion sampled at n instants, as NumPy object arrays of mpmath numbers.

    ``quantities`` maps ``omega``, ``linear_impulse``, ``angular_impulse`` (n, 3; body axes),
    ``attitude`` (n, 3, 3; v_space = R v_body) and ``centre`` (n, 3; space axes), as far as tracked.
    ``radius`` (n,) bounds the error of every vector and matrix of the row in the Frobenius norm, relative
    to the norm of the true one, on every route. A vector that a thousand bits more than were asked for do
    not distinguish from zero is zero here, and its bound is absolute. The radius is zero where the numbers
    are exact. ``radii`` bounds the error of single quantities in the same way, where it is known, and
    ``errors`` that of every component, absolutely: shaped as the quantities are. Quantities are also the
    scene's own states that it tracks, by name and of shape (n, components), read after an instant; the
    radius of such a one is relative to ``peaks``, a lower bound of its largest norm up to each row.
    ``digits`` are those that were asked for: each number prints with them. The truth value of a motion
    is ``passed``.
    """

    quantities: Mapping[str, np.ndarray[Any, Any]]
    radius: np.ndarray[Any, Any]
    radii: Mapping[str, np.ndarray[Any, Any]] = field(default_factory=dict)
    errors: Mapping[str, np.ndarray[Any, Any]] = field(default_factory=dict)
    peaks: Mapping[str, np.ndarray[Any, Any]] = field(default_factory=dict)
    times: Sequence[Fraction] = ()
    digits: int | None = None

    @property
    def passed(self) -> bool:
        """True if every row has the digits that were asked for, by its radius.

        The radius is proven, or, by the route ``mpmath``, as two precisions agree.
        """
        limit = mp.inf if self.digits is None else mp.mpf(10) ** -self.digits
        return all(radius <= limit for radius in self.radius)

    @property
    def _remark(self) -> str:
        return "" if self.digits is None else f", to {self.digits} digits"

    def radius_of(self, quantity: str) -> np.ndarray[Any, Any]:
        """Return the radius of this quantity alone, or that of the whole row if no other is known."""
        return self.radii.get(quantity, self.radius)

    def at(self, rows: Sequence[int]) -> Motion:
        """Return the motion at some of its instants."""
        quantities, radii, errors, peaks = (
            {name: values[rows] for name, values in by_name.items()}
            for by_name in (self.quantities, self.radii, self.errors, self.peaks)
        )
        times = [self.times[k] for k in rows] if self.times else ()
        return Motion(quantities, self.radius[rows], radii, errors, peaks, times, self.digits)
