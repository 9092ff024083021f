"""Free rigid bodies in their principal axes, posed many at once: all of them have one form.

K and H are the numbers that `pose` has for each body, rounded once from exact ones. Where `pose`
chooses between forms, a difference of K's diagonal that float64 does not hold is here the sum of two
coefficients, D + E exactly. So the differences add up to zero for every body, and |H|^2 is constant
identically.

K  inverse moments    H  momentum    D, E  differences of K, high and low part
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from taylor_verify.models.algebra import add
from taylor_verify.models.euler import principal_rate
from taylor_verify.models.form import Form, Named, labelled
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Sizes at which neither a product of three numbers nor its last bits leave the normal doubles.
_SMALLEST, _LARGEST = 2.0**-60, 2.0**60
# Points of the orbit at which its rate is looked at before it is integrated.
_POINTS: Final = 5
# Powers of a matrix lead to its fastest rate: of 16 factors a norm is some tenths too much.
_SQUARINGS: Final = 4


def split_equations(n: Named) -> dict[str, Any]:
    """Return H' = H x K H in principal axes, each difference of K in two parts."""
    H = n.vector("H")
    parts = (principal_rate(H, n.vector(letter)) for letter in "DE")
    return labelled("H", add(*parts))


FORM: Final = Form(
    split_equations, ("H1", "H2", "H3"), tuple(f"{letter}{i}" for letter in "DE" for i in (1, 2, 3))
)


@dataclass(frozen=True)
class Bodies:
    """Bodies of ``inverse`` moments (3, n) that start with ``momentum`` (3, n), asked at ``times`` (n, m).

    Doubles in units of the scenes; the times count from the start, all of them forwards or backwards.
    """

    inverse: Floats
    momentum: Floats
    times: Floats

    @classmethod
    def of(cls, inertia: Floats, omega: Floats, times: Floats) -> Bodies:
        """Return bodies by their moments of inertia (3, n) and omega (3, n): doubles, taken exactly."""
        return cls(1 / inertia, inertia * omega, times)

    def __len__(self) -> int:
        return len(self.times)

    def at(self, places: Any) -> Bodies:
        """Return some of the bodies."""
        return Bodies(self.inverse[:, places], self.momentum[:, places], self.times[places])

    @cached_property
    def time(self) -> Floats:
        """The unit of time (n) in which the fastest rate is of size one: a power of two."""
        H, K = self.momentum, self.inverse
        D = _differences(K)[0]
        with np.errstate(all="ignore"):
            # The roots of z^3 + s z - d: those of the equations, linearised at the start.
            s = sum(D[i] * D[j] * H[k] ** 2 for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
            d = 2 * np.prod(D, axis=0) * np.prod(H, axis=0)
            omega = _norm(K * H)
            return 1 / _binary(np.maximum(omega, np.maximum(abs(s) ** 0.5, abs(d) ** (1 / 3))))

    @cached_property
    def unit(self) -> Floats:
        """The unit of momentum (n), a power of two."""
        return _binary(_norm(self.momentum))

    @property
    def parameters(self) -> Floats:
        """The parameters (6, n) of the form, in units."""
        return np.concatenate(_differences(self.inverse * (self.unit * self.time)))

    @property
    def starts(self) -> Floats:
        """The initial states (3, n), in units."""
        return self.momentum / self.unit

    @property
    def grid(self) -> Floats:
        """The times (n, m), in units."""
        return self.times / self.time[:, None]

    @property
    def rates(self) -> Floats:
        """The fastest rate (n) of each motion in units, at some points of its orbit.

        The squares of H's components lie on a straight line, along D: by both conserved quantities.
        """
        D, squares = self.parameters[:3], self.starts**2
        with np.errstate(all="ignore"):
            ends = -squares / D
            low = np.max(np.where(D > 0, ends, -np.inf), axis=0)
            high = np.min(np.where(D < 0, ends, np.inf), axis=0)
            shares = np.linspace(0.0, 1.0, _POINTS)
            along = low[:, None] + (high - low)[:, None] * shares
            along = np.where(np.isfinite(along), along, 0.0)
            points = squares[:, :, None] + D[:, :, None] * along
            states = np.sqrt(np.maximum(points, 0.0))
        return fastest(FORM, self.parameters, states)


def fastest(form: Form, parameters: Floats, states: Floats) -> Floats:
    """Return the fastest rate (n) at any of the states (s, n, m) of each body; NaN where not finite.

    Of equations that are quadratic in the states a difference over two steps is the exact derivative.
    """
    count, size = states.shape[1], len(states)
    given = [row[:, None] for row in parameters]
    columns = []
    with np.errstate(all="ignore"):
        for k in range(size):
            step = np.zeros((size, 1, 1))
            step[k] = 1.0
            ahead, behind = (form.rates(list(states + sign * step), given) for sign in (1, -1))
            columns.append([(a - b) / 2 for a, b in zip(ahead, behind, strict=True)])
        jacobian = np.moveaxis(np.array(columns), (0, 1), (-1, -2))
        largest = size * np.max(abs(jacobian), axis=(1, 2, 3))
        power = jacobian / np.where(largest > 0, largest, 1.0).reshape(count, 1, 1, 1)
        for _ in range(_SQUARINGS):
            power = power @ power
        norm = size * np.max(abs(power), axis=(1, 2, 3))
        found: Floats = largest * norm ** (0.5**_SQUARINGS)
    return found


def is_of_kind(scene: Scene) -> bool:
    """Return True for a scene that asks for omega of a free rigid body, given in its principal axes."""
    body = scene.body
    return (
        isinstance(body, RigidBody)
        and isinstance(scene.initial, Spin)
        and not scene.track
        and not body.damping
        and body.is_free
        and not any(body.inertia[i][j] for i in range(3) for j in range(i))
    )


def numbers(scene: Scene) -> tuple[list[float], list[float]]:
    """Return K and H of a scene of the kind, each rounded once from its exact value.

    A quotient of whole numbers is rounded once in Python. Raises OverflowError for one beyond doubles.
    """
    K, H = [], []
    for i, omega in enumerate(scene.initial.moving):
        moment = scene.body.energy_matrix[i][i]
        K.append(moment.denominator / moment.numerator)
        H.append((moment.numerator * omega.numerator) / (moment.denominator * omega.denominator))
    return K, H


def are_moderate(bodies: Bodies) -> Any:
    """Return which bodies (n) have no number so large or small that a double loses some of its bits."""
    sizes = np.concatenate([bodies.inverse, bodies.momentum, bodies.times[:, -1:].T])
    inside = (abs(sizes) >= _SMALLEST) & (abs(sizes) <= _LARGEST)
    inside[3:6] |= bodies.momentum == 0
    return inside.all(axis=0)


def _differences(K: Floats) -> tuple[Floats, Floats]:
    """D and E (3, n): the differences of K, rounded, and what the rounding left."""
    one, other = K[[2, 0, 1]], K[[1, 2, 0]]
    high = one - other
    taken = one - high
    low = (one - (high + taken)) + (taken - other)
    return high, low


def _norm(vectors: Floats) -> Floats:
    found: Floats = np.sqrt(np.sum(vectors**2, axis=0))
    return found


def _binary(sizes: Floats) -> Floats:
    """The powers of two just below, and 1 where there is none."""
    mantissa, exponent = np.frexp(sizes)
    return np.where(mantissa > 0, np.ldexp(1.0, exponent - 1), 1.0)
