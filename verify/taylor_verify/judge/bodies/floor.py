"""The roundoff floor of many free rigid bodies at once: the floor of judge.floor, in arrays.

The points of the orbit, the roundings of a step and the counted steps are the same as in `floor` for one
body. Phi comes from the closed form. Its determinant is 1, so its inverse is made of products:

    P(t) = Phi(t) [ sum over s <= t of Phi(s)^-1 diag(e(s)^2) Phi(s)^-T ] Phi(t)^T.

Where errors grow faster than in proportion to time, more points of the orbit are used, as in `floor`.
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

# The Frobenius norm of a 3x3 matrix exceeds its spectral norm by at most this factor.
_FROBENIUS: Final = 3**0.5
# This near to the limit of a regular orbit, the case is left to the judge of one body.
_NEAR: Final = 1.02
# A matrix product whose determinant has a larger error than this has lost its leading digits.
_VOLUME: Final = 1e-3


class Points(NamedTuple):
    """The points of n orbits as fractions of their times, and the points that stand for each sample.

    ``shares`` (n, p) are the points; where an orbit has fewer, its last point is repeated. ``later`` and
    ``earlier`` (n, m) are the points beside each sample, and ``ends`` (n, nodes) the number of points until
    each node. Nodes are the samples at which gradients are evaluated.
    """

    shares: Floats
    later: Places
    earlier: Places
    ends: Places

    @classmethod
    def of(cls, samples: tuple[Fraction, ...], points: Sequence[Sequence[Fraction]]) -> Points:
        """Return the points of orbits with samples at these fractions of their times."""
        at, longest = np.array(samples, dtype=float), max(map(len, points))
        shares = np.ones((len(points), longest))
        for row, orbit_shares in zip(shares, points, strict=True):
            row[: len(orbit_shares)] = [float(share) for share in orbit_shares]
        beside = [
            _beside(row[: len(orbit_shares)], at)
            for row, orbit_shares in zip(shares, points, strict=True)
        ]
        ends = [
            np.searchsorted(row[: len(orbit_shares)], at[nodes(len(at))], side="right")
            for row, orbit_shares in zip(shares, points, strict=True)
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
    """Return the samples at which gradients are evaluated."""
    return np.array(evenly(samples, MOST_NODES))


def _beside(points: Floats, places: Floats) -> tuple[Places, Places]:
    later = np.minimum(np.searchsorted(points, places), len(points) - 1)
    earlier = np.maximum(np.searchsorted(points, places, side="right") - 1, 0)
    return later, earlier


@dataclass(frozen=True)
class Floors:
    """The roundoff floors of n bodies at m samples: ``omega`` (n, m) in units of their K and H.

    ``attitude`` (n, m) is in radians, None where it is not asked for. ``reached`` (n, m) are the steps up
    to each sample. ``squares`` (3, n, nodes) and ``turns`` (n, nodes) are the sums of squares of their
    roundings. ``is_known`` (n) is True for the bodies whose floor is known.
    """

    omega: Floats
    attitude: Floats | None
    reached: Floats
    squares: Floats
    turns: Floats
    is_known: Any

    def put(self, places: Places, others: Floors) -> None:
        """Replace the floors of some bodies by others."""
        self.omega[places], self.reached[places] = others.omega, others.reached
        self.squares[:, places], self.turns[places] = others.squares, others.turns
        self.is_known[places] = others.is_known
        if self.attitude is not None and others.attitude is not None:
            self.attitude[places] = others.attitude

    def of_gradients(self, momentum: Floats, attitude: Floats | float = 0.0) -> Floats:
        """Return the attainable drift (n, m) for gradients that are divided by the scale.

        The gradient with respect to ``momentum`` is (3, n, nodes), with respect to the turn (n, nodes).
        """
        rounded = np.diff(self.squares, axis=2, prepend=0.0)
        turned = np.diff(self.turns, axis=1, prepend=0.0)
        injected = np.sum(momentum**2 * rounded, axis=0) + attitude**2 * turned
        drift = np.sqrt(np.cumsum(injected, axis=1))
        count = self.omega.shape[1]
        later, earlier = _beside(nodes(count).astype(float), np.arange(float(count)))
        attainable: Floats = np.maximum(drift[:, later], drift[:, earlier])
        return attainable


@dataclass(frozen=True)
class _Orbits:
    """The orbits of some bodies at their points, and the transition matrices from the start to there."""

    tops: Tops
    points: Points
    times: Floats
    transition: Transition

    @classmethod
    def of(cls, tops: Tops, points: Points, ends: Floats, is_sharp: bool = False) -> _Orbits:
        times = ends[:, None] * points.shares
        return cls(tops, points, times, tops.transition(times, is_sharp))

    def floors(self, steps: Any, samples: int) -> Floors:
        """Return the floors of runs that take ``steps`` (n) from one end to the other."""
        points, K, every = self.points, self.tops.inverse, np.arange(len(steps))[:, None]
        count = np.maximum(steps, samples).astype(float)
        steps_at = np.diff(points.shares, prepend=0.0) * count[:, None]
        steps_at[:, 0] = 1.0
        Phi, Theta = self.transition.moved, self.transition.turn
        rounded, turn = _roundings(K, self.transition.momentum, abs(self.times[:, -1]) / count)
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
            self.transition._replace(
                momentum=self.transition.momentum[:, places], moved=self.transition.moved[places]
            ),
        )

    @property
    def may_be_irregular(self) -> Any:
        """Return True for the bodies (n) whose errors may grow faster than in proportion to time."""
        growth = np.sqrt(np.sum(self.transition.moved**2, axis=(-1, -2)))
        rate = np.sqrt(np.max(np.sum(self._jacobian() ** 2, axis=(-1, -2)), axis=1)) / _FROBENIUS
        excess = growth / (REGULAR * (1 + rate[:, None] * abs(self.times)))
        return ~(np.max(excess, axis=1) * _NEAR <= 1)

    def excess(self) -> tuple[Floats, Floats]:
        """Return the growth (n) relative to the limit of a regular orbit, and the fastest rate (n)."""
        growth = np.linalg.norm(self.transition.moved, 2, axis=(-2, -1))
        rate = np.max(np.linalg.norm(self._jacobian(), 2, axis=(-2, -1)), axis=1)
        return np.max(growth / (REGULAR * (1 + rate[:, None] * abs(self.times))), axis=1), rate

    def _jacobian(self) -> Floats:
        """J (n, points, 3, 3) of H' = H x K H: the column k is H x K e_k + e_k x K H."""
        H, K, unit = (
            self.transition.momentum,
            self.tops.inverse[:, :, None],
            np.eye(3)[:, :, None, None],
        )
        omega = K * H
        columns = [cross(H, K * unit[k]) + cross(unit[k], omega) for k in range(3)]
        return np.moveaxis(np.array(columns), (0, 1), (-1, -2))


def floors(tops: Tops, ends: Floats, steps: Any, samples: tuple[Fraction, ...]) -> Floors:
    """Return the floors of bodies that took ``steps`` (n) steps until their ``ends`` (n)."""
    chosen = _few(samples).at(np.zeros(len(ends), dtype=np.intp))
    with np.errstate(all="ignore"):
        orbits = _Orbits.of(tops, chosen, ends)
        result = orbits.floors(steps, len(samples))
        # Where the transition is not finite, its volume is not known either.
        is_finite = np.isfinite(orbits.transition.moved).all(axis=(1, 2, 3))
        places = np.flatnonzero(orbits.may_be_irregular & is_finite)
        excess, rates = orbits.at(places).excess() if places.size else (np.empty(0), np.empty(0))
        result.is_known[places[~(excess * _NEAR <= 1)]] = False
        again = excess >= _NEAR
        if again.any():
            irregular = places[again]
            turned = (rates[again] * abs(ends[irregular])).tolist()
            points = Points.of(samples, [many(samples, rate) for rate in turned])
            sharp = _Orbits.of(tops.at(irregular), points, ends[irregular], is_sharp=True)
            result.put(irregular, sharp.floors(steps[irregular], len(samples)))
    return result


@lru_cache(maxsize=64)
def _few(samples: tuple[Fraction, ...]) -> Points:
    return Points.of(samples, [few(samples)])


def _turned(Theta: Floats, brought: Floats, gathered: Floats) -> Floats:
    """Return the mean squares (n, points) of the turns that errors of H have caused.

    An error of time s that is a when brought back to the start has turned the body by (Theta(t) -
    Theta(s)) a.
    """
    before = Theta @ brought
    mixed = np.cumsum(brought @ np.swapaxes(before, -1, -2), axis=1)
    squares = np.cumsum(np.sum(before**2, axis=(-1, -2)), axis=1)
    after = np.sum((Theta @ gathered) * Theta, axis=(-1, -2))
    squared_turns: Floats = after - 2 * np.trace(Theta @ mixed, axis1=-2, axis2=-1) + squares
    return np.maximum(squared_turns, 0.0)


def _roundings(K: Floats, H: Floats, step: Floats) -> tuple[Floats, Floats]:
    """Return the rounding of a step in each component of H (3, n, points), and in a turn (n, points).

    It is |x| + h S, as in judge.floor.magnitude.

    The rate of a component contains one difference of two K. Where float64 cannot represent that difference
    but can represent the other two, the sum of the other two is used.
    """
    D = difference(K[[2, 0, 1]], K[[1, 2, 0]])
    size, is_exact = abs(D.hi), D.lo == 0
    is_summed = ~is_exact & (np.sum(is_exact & (size > 0), axis=0) == 2)
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
    norms: Floats = np.sqrt(np.sum(vectors**2, axis=0))
    return norms


def _inverse(Phi: Floats) -> Floats:
    """Return the inverses of matrices of determinant 1: their rows are cross products of the columns."""
    a, b, c = (Phi[..., k] for k in range(3))
    return np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-2)
