"""The roundoff floor of many free rigid bodies at once: that of judge.floor, in arrays.

The points of the orbit, the roundings of a step and the steps that are counted are those of `floor` for one
body. Phi comes from the closed form, and because its determinant is 1 its inverse is made of products:

    P(t) = Phi(t) [ sum over s <= t of Phi(s)^-1 diag(e(s)^2) Phi(s)^-T ] Phi(t)^T.

Where errors grow faster than in proportion to time, the orbit is looked at in more points, as it is there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.exact.conditioning.condition import REGULAR, few, many
from taylor_verify.exact.euler.tops import Tops, Transition, cross
from taylor_verify.judge.floor.attainable import MOST_NODES
from taylor_verify.judge.floor.magnitude import ANGLE, COMPONENT
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.pairs import difference

Floats = np.ndarray[Any, np.dtype[np.float64]]
Places = np.ndarray[Any, np.dtype[np.intp]]

# Of three by three entries the root of the squares exceeds the norm by this factor at most.
_FROBENIUS: Final = 3**0.5
# So near to what counts as regular it is not decided here.
_NEAR: Final = 1.02
# A product of matrices whose determinant is off by more than this has lost its leading digits.
_VOLUME: Final = 1e-3


class Points(NamedTuple):
    """The points of n orbits as parts of their times, and which of them stand for which sample.

    ``shares`` (n, p) are the points, the last one again and again where there are fewer; ``later`` and
    ``earlier`` (n, m) are the points beside each sample, and ``ends`` (n, nodes) the number of points until
    each node. Nodes are the samples at which gradients are looked at.
    """

    shares: Floats
    later: Places
    earlier: Places
    ends: Places

    @classmethod
    def of(cls, samples: tuple[Fraction, ...], points: Sequence[Sequence[Fraction]]) -> Points:
        """Return the points of orbits with samples at these parts of their times."""
        at, most = np.array(samples, dtype=float), max(map(len, points))
        shares = np.ones((len(points), most))
        for row, each in zip(shares, points, strict=True):
            row[: len(each)] = [float(share) for share in each]
        beside = [_beside(row[: len(each)], at) for row, each in zip(shares, points, strict=True)]
        ends = [
            np.searchsorted(row[: len(each)], at[nodes(len(at))], side="right")
            for row, each in zip(shares, points, strict=True)
        ]
        later, earlier = (np.array(rows) for rows in zip(*beside, strict=True))
        return cls(shares, later, earlier, np.array(ends))

    def at(self, places: Places) -> Points:
        """Return the points of some of the orbits."""
        return Points(
            self.shares[places], self.later[places], self.earlier[places], self.ends[places]
        )


@lru_cache(maxsize=64)
def nodes(samples: int) -> Places:
    """Return the samples at which gradients are looked at."""
    return np.array(evenly(samples, MOST_NODES))


def _beside(points: Floats, places: Floats) -> tuple[Places, Places]:
    later = np.minimum(np.searchsorted(points, places), len(points) - 1)
    earlier = np.maximum(np.searchsorted(points, places, side="right") - 1, 0)
    return later, earlier


@dataclass(frozen=True)
class Floors:
    """What is attainable by n bodies at m samples: ``omega`` (n, m) in units of their K and H.

    ``attitude`` (n, m) is in radians, None where it is not asked for. ``reached`` (n, m) are the steps so
    far; ``squares`` (3, n, nodes) and ``turns`` (n, nodes) the sums of squares of their roundings.
    ``is_known`` (n) tells the bodies of which it is the floor.
    """

    omega: Floats
    attitude: Floats | None
    reached: Floats
    squares: Floats
    turns: Floats
    is_known: Any

    def put(self, places: Places, others: Floors) -> None:
        """Put the floors of some bodies in place of these."""
        self.omega[places], self.reached[places] = others.omega, others.reached
        self.squares[:, places], self.turns[places] = others.squares, others.turns
        self.is_known[places] = others.is_known
        if self.attitude is not None and others.attitude is not None:
            self.attitude[places] = others.attitude

    def of_gradients(self, momentum: Floats, attitude: Floats | float = 0.0) -> Floats:
        """Return the attainable drift (n, m) by gradients over the scale.

        That by the ``momentum`` is (3, n, nodes), that by the turn (n, nodes).
        """
        rounded = np.diff(self.squares, axis=2, prepend=0.0)
        turned = np.diff(self.turns, axis=1, prepend=0.0)
        injected = np.sum(momentum**2 * rounded, axis=0) + attitude**2 * turned
        drift = np.sqrt(np.cumsum(injected, axis=1))
        count = self.omega.shape[1]
        later, earlier = _beside(nodes(count).astype(float), np.arange(float(count)))
        found: Floats = np.maximum(drift[:, later], drift[:, earlier])
        return found


@dataclass(frozen=True)
class _Orbits:
    """The orbits of some bodies at points of theirs, and how errors of the start are carried there."""

    tops: Tops
    points: Points
    times: Floats
    found: Transition

    @classmethod
    def of(cls, tops: Tops, points: Points, ends: Floats, is_sharp: bool = False) -> _Orbits:
        times = ends[:, None] * points.shares
        return cls(tops, points, times, tops.transition(times, is_sharp))

    def floors(self, steps: Any, samples: int) -> Floors:
        """Return the floors after so many ``steps`` (n) from one end to the other."""
        points, K, every = self.points, self.tops.inverse, np.arange(len(steps))[:, None]
        count = np.maximum(steps, samples).astype(float)
        steps_at = np.diff(points.shares, prepend=0.0) * count[:, None]
        steps_at[:, 0] = 1.0
        Phi, Theta = self.found.moved, self.found.turn
        rounded, turn = _roundings(K, self.found.momentum, abs(self.times[:, -1]) / count)
        squares = np.cumsum(steps_at * rounded**2, axis=2)
        injected = np.moveaxis(rounded * np.sqrt(steps_at), 0, -1)
        brought = _inverse(Phi) * injected[:, :, None, :]
        gathered = np.cumsum(brought @ np.swapaxes(brought, -1, -2), axis=1)
        out = K.T[:, None, :, None] * Phi
        sizes = np.sqrt(np.sum((out @ gathered) * out, axis=(-1, -2)))
        turns = 3 * np.cumsum(steps_at * turn**2, axis=1)
        angles = None
        if Theta is not None:
            angles = np.sqrt(turns + _turned(Theta, brought, gathered))
            angles = np.maximum(angles[every, points.later], angles[every, points.earlier])
        return Floors(
            omega=np.maximum(sizes[every, points.later], sizes[every, points.earlier]),
            attitude=angles,
            reached=np.cumsum(steps_at, axis=1)[every, points.earlier],
            squares=squares[:, every, points.ends - 1],
            turns=turns[every, points.ends - 1],
            is_known=abs(np.linalg.det(Phi) - 1).max(axis=1) <= _VOLUME,
        )

    def at(self, places: Places) -> _Orbits:
        """Return the orbits of some of the bodies."""
        return _Orbits(
            self.tops.at(places),
            self.points.at(places),
            self.times[places],
            self.found._replace(
                momentum=self.found.momentum[:, places], moved=self.found.moved[places]
            ),
        )

    @property
    def may_be_irregular(self) -> Any:
        """Return the bodies (n) on whose orbits errors may grow faster than in proportion to time."""
        growth = np.sqrt(np.sum(self.found.moved**2, axis=(-1, -2)))
        rate = np.sqrt(np.max(np.sum(self._jacobian() ** 2, axis=(-1, -2)), axis=1)) / _FROBENIUS
        excess = growth / (REGULAR * (1 + rate[:, None] * abs(self.times)))
        return ~(np.max(excess, axis=1) * _NEAR <= 1)

    def excess(self) -> tuple[Floats, Floats]:
        """Return the growth (n) over what counts as regular, and the fastest rate (n)."""
        growth = np.linalg.norm(self.found.moved, 2, axis=(-2, -1))
        rate = np.max(np.linalg.norm(self._jacobian(), 2, axis=(-2, -1)), axis=1)
        return np.max(growth / (REGULAR * (1 + rate[:, None] * abs(self.times))), axis=1), rate

    def _jacobian(self) -> Floats:
        """J (n, points, 3, 3) of H' = H x K H: the column k is H x K e_k + e_k x K H."""
        H, K, unit = self.found.momentum, self.tops.inverse[:, :, None], np.eye(3)[:, :, None, None]
        omega = K * H
        columns = [cross(H, K * unit[k]) + cross(unit[k], omega) for k in range(3)]
        return np.moveaxis(np.array(columns), (0, 1), (-1, -2))


def floors(tops: Tops, ends: Floats, steps: Any, samples: tuple[Fraction, ...]) -> Floors:
    """Return the floors of bodies that took so many ``steps`` (n) until their ``ends`` (n)."""
    chosen = _few(samples).at(np.zeros(len(ends), dtype=np.intp))
    with np.errstate(all="ignore"):
        orbits = _Orbits.of(tops, chosen, ends)
        found = orbits.floors(steps, len(samples))
        # Of what is not finite the volume is not known either.
        is_finite = np.isfinite(orbits.found.moved).all(axis=(1, 2, 3))
        places = np.flatnonzero(orbits.may_be_irregular & is_finite)
        excess, rates = orbits.at(places).excess() if places.size else (np.empty(0), np.empty(0))
        found.is_known[places[~(excess * _NEAR <= 1)]] = False
        again = excess >= _NEAR
        if again.any():
            irregular = places[again]
            turned = (rates[again] * abs(ends[irregular])).tolist()
            points = Points.of(samples, [many(samples, rate) for rate in turned])
            sharp = _Orbits.of(tops.at(irregular), points, ends[irregular], is_sharp=True)
            found.put(irregular, sharp.floors(steps[irregular], len(samples)))
    return found


@lru_cache(maxsize=64)
def _few(samples: tuple[Fraction, ...]) -> Points:
    return Points.of(samples, [few(samples)])


def _turned(Theta: Floats, brought: Floats, gathered: Floats) -> Floats:
    """The mean squares (n, points) of the turns that errors of H have made since they were.

    An error that is brought back to the start as a has turned the body by Theta(t) a - Theta(s) a.
    """
    before = Theta @ brought
    mixed = np.cumsum(brought @ np.swapaxes(before, -1, -2), axis=1)
    squares = np.cumsum(np.sum(before**2, axis=(-1, -2)), axis=1)
    after = np.sum((Theta @ gathered) * Theta, axis=(-1, -2))
    found: Floats = after - 2 * np.trace(Theta @ mixed, axis1=-2, axis2=-1) + squares
    return np.maximum(found, 0.0)


def _roundings(K: Floats, H: Floats, step: Floats) -> tuple[Floats, Floats]:
    """The rounding of a step in each component of H (3, n, points), and of a turn (n, points).

    It is |x| + h S, as judge.floor.magnitude has it.

    The rate of a component has the sum of two differences of K where float64 does not hold its own, and
    holds the others.
    """
    D = difference(K[[2, 0, 1]], K[[1, 2, 0]])
    size, is_held = abs(D.hi), D.lo == 0
    is_summed = ~is_held & (np.sum(is_held & (size > 0), axis=0) == 2)
    size = np.where(is_summed, np.sum(size, axis=0) - size, size)
    sizes = abs(H)
    S = size[:, :, None] * sizes[[1, 2, 0]] * sizes[[2, 0, 1]]
    limit = np.max(_norms(sizes), axis=1) / np.max(_norms(S), axis=1)
    h = np.fmin(step, np.where(np.isfinite(limit), limit, np.inf))
    # A component of the quaternion is 1/2, and its rate the half of three of its products with omega.
    rate = COMPONENT / 2 * np.sum(abs(K)[:, :, None] * sizes, axis=0)
    turn = ANGLE * 2 * (COMPONENT + h[:, None] * rate) / np.sqrt(3.0)
    return sizes + h[:, None] * S, turn


def _norms(vectors: Floats) -> Floats:
    found: Floats = np.sqrt(np.sum(vectors**2, axis=0))
    return found


def _inverse(Phi: Floats) -> Floats:
    """The inverses of matrices of determinant 1: the rows are products of the columns."""
    a, b, c = (Phi[..., k] for k in range(3))
    return np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-2)
