"""Free rigid bodies in their principal axes, posed many at once, all with one form of the equations.

K and H are the same numbers as in `pose` for each body, rounded once from exact ones. Where `pose` chooses
between forms, a difference of K's diagonal that float64 cannot represent is here the exact sum D + E of two
coefficients. So the differences add up to zero for every body, and |H|^2 is constant identically.

K  inverse moments    H  momentum    D, E  differences of K, high and low part
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.models.algebra import add
from taylor_verify.models.euler import principal_rate, with_frame
from taylor_verify.models.form import Form, Named
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.pairs import Pairs, difference, product
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Limits within which a product of three numbers, with its last bits, stays in the normal doubles.
_SMALLEST, _LARGEST = 2.0**-60, 2.0**60
# Number of points of the orbit at which its rate is evaluated before the integration.
_POINTS: Final = 5
# Squarings of a matrix for its fastest rate: the norm of 16 factors is some tenths too large.
_SQUARINGS: Final = 4
_TRACKS: Final = (frozenset[str](), frozenset({"attitude"}))


def split_equations(n: Named) -> dict[str, Any]:
    """Return H' = H x K H in principal axes, each difference of K in two parts."""
    H = n.vector("H")
    return with_frame(n, add(*(principal_rate(H, n.vector(letter)) for letter in "DE")))


_MOMENTA: Final = tuple(f"H{i}" for i in (1, 2, 3))
_DIFFERENCES: Final = tuple(f"{letter}{i}" for letter in "DE" for i in (1, 2, 3))
FORM: Final = Form(split_equations, _MOMENTA, _DIFFERENCES)
FORM_WITH_ATTITUDE: Final = Form(
    split_equations,
    (*_MOMENTA, *(f"e{i}" for i in range(4))),
    (*_DIFFERENCES, *(f"K{i}{i}" for i in (1, 2, 3))),
)


@dataclass(frozen=True)
class Bodies:
    """Bodies with ``inverse`` moments (3, n) and ``momentum`` (3, n) at the start, at ``times`` (n, m).

    Doubles in units of the scenes; the times count from the start, all of them forwards or backwards.
    ``attitude`` (4, n) are quaternions of about size one, if attitudes are asked for.
    """

    inverse: Floats
    momentum: Floats
    times: Floats
    attitude: Floats | None = None

    @classmethod
    def of(
        cls, inertia: Floats, omega: Floats, times: Floats, attitude: Floats | None = None
    ) -> Bodies:
        """Return bodies by their moments of inertia (3, n) and omega (3, n): doubles, taken exactly."""
        return cls(1 / inertia, inertia * omega, times, attitude)

    def __len__(self) -> int:
        return len(self.times)

    def at(self, places: Any) -> Bodies:
        """Return some of the bodies."""
        attitude = None if self.attitude is None else self.attitude[:, places]
        return Bodies(
            self.inverse[:, places], self.momentum[:, places], self.times[places], attitude
        )

    @property
    def form(self) -> Form:
        """The one form of all such bodies."""
        return FORM if self.attitude is None else FORM_WITH_ATTITUDE

    @cached_property
    def time(self) -> Floats:
        """The unit of time (n) in which the fastest rate is of size one: a power of two."""
        H, K = self.momentum, self.inverse
        D = _differences(K).hi
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
    def scaled_inverse(self) -> Floats:
        """K (3, n) in units."""
        return self.inverse * (self.unit * self.time)

    @cached_property
    def quaternion(self) -> Pairs | None:
        """The unit quaternions (4, n) of the attitudes."""
        if self.attitude is None:
            return None
        squares = [product(entry, entry) for entry in self.attitude]
        return Pairs(self.attitude) / (squares[0] + squares[1] + squares[2] + squares[3]).sqrt()

    @cached_property
    def parameters(self) -> Floats:
        """The parameters (p, n) of the form, in units."""
        K = self.scaled_inverse
        D = _differences(K)
        return np.concatenate([D.hi, D.lo] if self.attitude is None else [D.hi, D.lo, K])

    @cached_property
    def starts(self) -> Floats:
        """The initial states (s, n), in units."""
        momentum = self.momentum / self.unit
        q = self.quaternion
        return momentum if q is None else np.concatenate([momentum, q.hi])

    @cached_property
    def grid(self) -> Floats:
        """The times (n, m), in units."""
        return self.times / self.time[:, None]

    @cached_property
    def rates(self) -> Floats:
        """Fastest rate (n) of each motion in units, at some points of its orbit.

        By the two conserved quantities, the squares of H's components lie on a straight line along D.
        """
        D, squares = self.parameters[:3], self.starts[:3] ** 2
        with np.errstate(all="ignore"):
            ends = -squares / D
            low = np.max(np.where(D > 0, ends, -np.inf), axis=0)
            high = np.min(np.where(D < 0, ends, np.inf), axis=0)
            along = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _POINTS)
            along = np.where(np.isfinite(along), along, 0.0)
            points = squares[:, :, None] + D[:, :, None] * along
            return self.fastest(np.sqrt(np.maximum(points, 0.0)))

    def fastest(self, states: Floats) -> Floats:
        """Return the fastest rate (n) at any of the states (s, n, m) of each body; NaN where not finite.

        The equations are quadratic in H, so a central difference is the exact derivative. An attitude
        turns at |omega|/2.
        """
        H, parameters = states[:3], [row[:, None] for row in self.parameters[:6]]
        columns = []
        with np.errstate(all="ignore"):
            for step in np.eye(3)[:, :, None, None]:
                ahead, behind = (FORM.rates(list(H + sign * step), parameters) for sign in (1, -1))
                columns.append([(a - b) / 2 for a, b in zip(ahead, behind, strict=True)])
            jacobian = np.moveaxis(np.array(columns), (0, 1), (-1, -2))
            largest = 3 * np.max(abs(jacobian), axis=(1, 2, 3))
            power = jacobian / np.where(largest > 0, largest, 1.0).reshape(-1, 1, 1, 1)
            for _ in range(_SQUARINGS):
                power = power @ power
            norm = 3 * np.max(abs(power), axis=(1, 2, 3))
            rate: Floats = largest * norm ** (0.5**_SQUARINGS)
            if self.attitude is not None:
                omega = self.scaled_inverse[:, :, None] * H
                rate = np.maximum(rate, np.max(_norm(omega), axis=1) / 2)
        return rate

    def grown(self, states: Floats, rates: Floats) -> Floats:
        """Return the fastest rate (n) at any of the states (s, n, m); 0 where it is not above ``rates``."""
        fastest = self.fastest(states)
        return np.where(fastest <= rates, 0.0, fastest)

    @property
    def are_moderate(self) -> Any:
        """Return True for the bodies (n) without a number so large or small that a double loses bits."""
        sizes = abs(np.concatenate([self.inverse, self.momentum, self.times[:, -1:].T]))
        inside = (sizes >= _SMALLEST) & (sizes <= _LARGEST)
        inside[3:6] |= self.momentum == 0
        if self.attitude is not None:
            largest = np.max(abs(self.attitude), axis=0)
            inside &= (largest >= _SMALLEST) & (largest <= _LARGEST)
        return inside.all(axis=0)


class Numbers(NamedTuple):
    """K, H and the quaternion of a body, each number rounded once from its exact value."""

    inverse: list[float]
    momentum: list[float]
    attitude: list[float]


def is_of_kind(scene: Scene) -> bool:
    """Return True for a scene of a free rigid body that is given in its principal axes."""
    body = scene.body
    return (
        isinstance(body, RigidBody)
        and isinstance(scene.initial, Spin)
        and scene.track in _TRACKS
        and not body.damping
        and body.is_free
        and not any(body.inertia[i][j] for i in range(3) for j in range(i))
    )


def numbers(scene: Scene) -> Numbers:
    """Return the numbers of a scene of the kind. A quotient of whole numbers is rounded once in Python.

    Raises OverflowError for a number beyond doubles.
    """
    inverse, momentum = [], []
    for i, omega in enumerate(scene.initial.moving):
        moment = scene.body.energy_matrix[i][i]
        inverse.append(moment.denominator / moment.numerator)
        momentum.append(
            (moment.numerator * omega.numerator) / (moment.denominator * omega.denominator)
        )
    attitude = [q.numerator / q.denominator for q in scene.initial.attitude]
    return Numbers(inverse, momentum, attitude)


def _differences(K: Floats) -> Pairs:
    """Return D and E (3, n): the rounded differences of K, and their rounding errors."""
    return difference(K[[2, 0, 1]], K[[1, 2, 0]])


def _norm(vectors: Floats) -> Floats:
    norm: Floats = np.sqrt(np.sum(vectors**2, axis=0))
    return norm


def _binary(sizes: Floats) -> Floats:
    """Return the powers of two just below the sizes; 1 if there is none."""
    mantissa, exponent = np.frexp(sizes)
    return np.where(mantissa > 0, np.ldexp(1.0, exponent - 1), 1.0)
