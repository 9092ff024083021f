"""Steady spins of a body with wheels, for every size of its momentum: the curves that bifurcate.

Legend, principal axes: J moments, a = 1/J, h momentum of the wheels, G = I omega + h, N = |G|, and mu the
rate omega.G/N^2, so that omega = mu G in a steady spin and G_i = h_i/(1 - mu J_i). A spin is stable if
s^2 = -G.adj(K - mu) G < 0, K = I^-1. Between two poles a_i < mu < a_j the size f(mu) = N^2 is convex:
two spins are born where it is least. All numbers are doubles, to be drawn: moments that agree to eight
digits count as equal.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from taylor_verify.draw.view import Numbers

# After so many bisections an interval is as small as its roundings.
_BISECTIONS: Final = 44
# The least and the greatest distance of a rate from a pole, in parts of an interval. With weak wheels
# the spins are near the poles.
_NEAREST: Final = 1e-9
_FAR: Final = 1e6
# Points on a branch.
_DENSE: Final = 150
# A component of h below this part of its size is zero: h is rounded to nine digits, as the moments are.
ZERO: Final = 1e-8


@dataclass(frozen=True)
class Spin:
    """A steady spin: its momentum in principal axes, and True if it is stable."""

    momentum: Numbers
    stable: bool


@dataclass(frozen=True)
class Branch:
    """Curve of steady spins: their momenta (n, 3) in principal axes, and True if all are stable."""

    momenta: Numbers
    stable: bool

    @property
    def sizes(self) -> Numbers:
        """N of each spin."""
        return np.asarray(np.linalg.norm(self.momenta, axis=1))


@dataclass(frozen=True)
class Wheels:
    """A body with wheels in its principal axes: three moments and h, of shape (3,)."""

    moments: Numbers
    rotor: Numbers

    @classmethod
    def of(cls, moments: Numbers, rotor: Numbers) -> Wheels:
        """Return the body with exact zeros where h has only the rounding of its digits."""
        size = np.linalg.norm(rotor)
        return cls(moments, np.where(np.abs(rotor) > ZERO * size, rotor, 0.0))

    @property
    def poles(self) -> Numbers:
        """Rates a = 1/J, in ascending order."""
        return np.sort(1 / self.moments)

    def energy(self, momenta: Numbers) -> Numbers:
        """Return T = omega.I omega/2 of momenta (n, 3)."""
        return np.asarray(np.square(momenta - self.rotor) @ (1 / self.moments) / 2)

    def momentum(self, rates: Numbers) -> Numbers:
        """Return G of the steady spins with these mu, shape (n, 3); 0 along an axis without h."""
        below = 1 - np.multiply.outer(rates, self.moments)
        with np.errstate(divide="ignore"):
            return np.asarray(
                np.divide(self.rotor, below, out=np.zeros_like(below), where=self.rotor != 0)
            )

    def square(self, rates: Numbers, momenta: Numbers) -> Numbers:
        """Return s^2 of a disturbance of each spin."""
        x, y, z = (1 / self.moments - rates[:, None]).T
        return np.asarray(-(np.square(momenta) * np.stack([y * z, z * x, x * y], -1)).sum(axis=1))

    def at(self, rate: float, size: float) -> list[Numbers]:
        """Return the momenta of this size with a steady spin at this mu.

        There is one; beside an axis without h there are two, because G is free along the axis of a pole.
        """
        momentum = self.momentum(np.array([rate]))[0]
        axis = int(np.abs(1 - rate * self.moments).argmin())
        if self.rotor[axis] or abs(1 - rate * self.moments[axis]) > ZERO:
            return [momentum]
        along = np.zeros(3)
        along[axis] = np.sqrt(max(size**2 - float(momentum @ momentum), 0.0))
        return [momentum + along, momentum - along]

    def without_rotor(self, size: float) -> list[Spin]:
        """Return the steady spins of a body whose h is 0: two along the axis of each single moment."""
        rates = [1 / moment for moment in self.moments if self._count(moment) == 1]
        return [
            Spin(G, bool(self.square(np.array([rate]), G[None])[0] < 0))
            for rate in rates
            for G in self.at(rate, size)
        ]

    def circle(self, size: float) -> Numbers:
        """Return the circle of steady spins of this size, shape (n, 3); no points if there is none.

        It goes round the axis of the third moment if two moments are equal and h is along that axis.
        """
        pair = [axis for axis in range(3) if self._count(self.moments[axis]) == 2]
        if not pair or self.rotor[pair].any():
            return np.empty((0, 3))
        base = self.momentum(np.array([1 / self.moments[pair[0]]]))[0]
        radius = np.sqrt(max(size**2 - float(base @ base), 0.0))
        angle = np.linspace(0, 2 * np.pi, _DENSE)
        plane = np.eye(3)[pair]
        turning = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return base + radius * turning @ plane if radius > 0 else np.empty((0, 3))

    def _count(self, moment: float) -> int:
        """Return how many of the three moments are equal to this one."""
        return int(np.count_nonzero(np.abs(self.moments - moment) <= ZERO * moment))

    def births(self) -> list[float]:
        """Return each N where two more steady spins appear, in ascending order.

        There are two of them, and fewer with equal moments.
        """
        low, middle, high = self.poles
        pairs = [pair for pair in ((low, middle), (middle, high)) if pair[1] > (1 + ZERO) * pair[0]]
        return sorted(float(np.sqrt(least(self.moments, self.rotor, *pair))) for pair in pairs)

    def branches(self, largest: float) -> list[Branch]:
        """Return all steady spins up to this N, as curves that end where stability changes."""
        branches = []
        low, middle, high = self.poles
        outer = np.geomspace(_NEAREST, _FAR, 4 * _DENSE) * high
        for rates in (
            low - outer[::-1],
            _between(low, middle),
            _between(middle, high),
            high + outer,
        ):
            branches += self._pieces(rates, self.momentum(rates), largest)
        for axis in np.flatnonzero(self.rotor == 0):
            branches += self._axial(int(axis), largest)
        return branches

    def _axial(self, axis: int, largest: float) -> list[Branch]:
        """Return the spins at the pole of an axis without h: one of each pair, which has one energy."""
        rate = float(1 / self.moments[axis])
        base = self.momentum(np.array([rate]))[0]
        # If another axis has the same moment, and wheels along it, there are no such spins.
        if not np.isfinite(base).all() or not base @ base < largest**2:
            return []
        along = np.sqrt(np.linspace(0, largest**2 - base @ base, _DENSE))
        momenta = base + np.multiply.outer(along, np.eye(3)[axis])
        if self._count(self.moments[axis]) > 1:
            # A circle of spins: each is at the border of stability, and the circle as a whole is stable.
            return [Branch(momenta, stable=True)]
        return self._pieces(np.full(_DENSE, rate), momenta, largest)

    def _pieces(self, rates: Numbers, momenta: Numbers, largest: float) -> list[Branch]:
        """Return runs of neighbours below this N that are all stable, or all not."""
        # A momentum that is infinite, at a pole, is not within.
        within = np.asarray(np.linalg.norm(momenta, axis=1) <= largest)
        if not within.any():
            return []
        kind = np.asarray(np.where(within, np.where(self.square(rates, momenta) < 0, 1, 2), 0))
        starts = [0, *(np.flatnonzero(np.diff(kind)) + 1), len(kind)]
        return [
            # A run ends where the next one begins, or the curve would have a gap.
            Branch(momenta[first : last + (last < len(kind) and kind[last] > 0)], kind[first] == 1)
            for first, last in pairwise(starts)
            if last - first > 1 and kind[first] > 0
        ]

    def extremes(self, sizes: Numbers) -> tuple[Numbers, Numbers]:
        """Return the least and the greatest T of momenta of each size."""
        low, _, high = self.poles
        both = []
        for pole, side in ((low, -1.0), (high, 1.0)):
            near, far = np.full(len(sizes), _NEAREST / 1e3), np.full(len(sizes), 1e9)
            for _ in range(2 * _BISECTIONS):
                middle = np.sqrt(near * far)
                is_large = np.linalg.norm(self.momentum(pole * (1 + side * middle)), axis=1) > sizes
                near, far = np.where(is_large, middle, near), np.where(is_large, far, middle)
            momenta = self.momentum(pole * (1 + side * far))
            axis = int(np.abs(1 / self.moments - pole).argmin())
            rest = np.square(momenta).sum(axis=1) - momenta[:, axis] ** 2
            sign = 1.0 if self.rotor[axis] == 0 else np.sign(momenta[:, axis])
            momenta[:, axis] = sign * np.sqrt(np.maximum(sizes**2 - rest, 0))
            both.append(self.energy(momenta))
        return both[0], both[1]


def _between(low: float, high: float) -> Numbers:
    if not high > low:
        return np.empty(0)
    near = np.geomspace(_NEAREST, 0.5, _DENSE)
    return np.asarray(low + (high - low) * np.concatenate([near, 1 - near[-2::-1]]))


def least(moments: Numbers, rotors: Numbers, low: float, high: float) -> Numbers:
    """Return the least f(mu) between two poles, for wheels h of shape (..., 3)."""
    squares = np.square(rotors)
    left, right = np.full(rotors.shape[:-1], low), np.full(rotors.shape[:-1], high)
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(_BISECTIONS):
            middle = (left + right) / 2
            below = 1 - middle[..., None] * moments
            slope = np.where(squares > 0, squares * moments / below**3, 0.0).sum(axis=-1)
            left, right = np.where(slope < 0, middle, left), np.where(slope < 0, right, middle)
        below = 1 - ((left + right) / 2)[..., None] * moments
        return np.asarray(np.where(squares > 0, squares / below**2, 0.0).sum(axis=-1))


def number(moments: Numbers, rotors: Numbers, size: float) -> tuple[Numbers, Numbers]:
    """Return log(N^2/min f) for wheels h (..., 3), one number for each pair of neighbouring poles.

    A pair of steady spins exists where it is positive.
    """
    low, middle, high = np.sort(1 / moments)
    with np.errstate(divide="ignore"):
        first, second = (
            np.log(size**2 / np.maximum(least(moments, rotors, *pair), 1e-300))
            for pair in ((low, middle), (middle, high))
        )
    return first, second
