"""The roundoff floor of many free rigid bodies at once: that of judge.floor, in arrays.

The points of the orbit, the roundings of a step and the steps that are counted are those of `floor` for one
body. Phi comes from the closed form, and because its determinant is 1 its inverse is made of products:

    P(t) = Phi(t) [ sum over s <= t of Phi(s)^-1 diag(e(s)^2) Phi(s)^-T ] Phi(t)^T.

Only an orbit on which errors grow no faster than in proportion to time is judged so. Norms are taken
such that what counts as regular here does so for one body.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.exact.conditioning.condition import REGULAR, few
from taylor_verify.exact.euler.tops import Tops
from taylor_verify.exact.pairs import difference
from taylor_verify.judge.floor.attainable import MOST_NODES
from taylor_verify.scenes.instants import evenly

Floats = np.ndarray[Any, np.dtype[np.float64]]
Places = np.ndarray[Any, np.dtype[np.intp]]

# Of three by three entries the root of the squares is the largest factor of a vector, and no more than this
# times it.
_FROBENIUS: Final = 3**0.5


class Points(NamedTuple):
    """The points of an orbit as parts of its time, and which of them stand for which sample.

    ``later`` and ``earlier`` are, for each sample, the points beside it; ``nodes`` are the samples at which
    gradients are looked at, ``ends`` the number of points until each, and the last two as the first.
    """

    shares: Floats
    later: Places
    earlier: Places
    nodes: Places
    ends: Places
    later_node: Places
    earlier_node: Places


@lru_cache(maxsize=64)
def points(samples: tuple[Fraction, ...]) -> Points:
    """Return the points of an orbit with samples at these parts of its time."""
    shares = np.array([float(share) for share in few(samples)])
    at = np.array([float(share) for share in samples])
    nodes = np.array(evenly(len(at), MOST_NODES))
    return Points(
        shares,
        *_beside(shares, at),
        nodes,
        np.searchsorted(shares, at[nodes], side="right"),
        *_beside(at[nodes], at),
    )


def _beside(nodes: Floats, places: Floats) -> tuple[Places, Places]:
    later = np.minimum(np.searchsorted(nodes, places), len(nodes) - 1)
    earlier = np.maximum(np.searchsorted(nodes, places, side="right") - 1, 0)
    return later, earlier


@dataclass(frozen=True)
class Floors:
    """What is attainable by n bodies at m samples: ``omega`` (n, m) in units of its K and H.

    ``counted`` (n, points) are the steps so far, ``rounded`` (3, n, points) the sums of squares of their
    roundings. ``is_regular`` (n) tells the bodies of which it is the floor.
    """

    points: Points
    omega: Floats
    counted: Floats
    squares: Floats
    is_regular: Any

    def steps(self, worst: Places, samples: Floats) -> Floats:
        """Return the steps (n) until the sample of the largest error, at the parts (m) of the time."""
        reached = np.searchsorted(self.points.shares, samples[worst], side="right") - 1
        counts = self.counted[np.arange(len(worst)), reached]
        return np.maximum(1, np.rint(counts))

    def of_gradients(self, gradients: Floats) -> Floats:
        """Return the attainable drift (n, m); ``gradients`` (3, n, nodes) are over the scale."""
        until = self.squares[:, :, self.points.ends - 1]
        rounded = np.diff(until, axis=2, prepend=0.0)
        drift = np.sqrt(np.cumsum(np.sum(gradients**2 * rounded, axis=0), axis=1))
        pair = drift[:, self.points.later_node], drift[:, self.points.earlier_node]
        found: Floats = np.maximum(*pair)
        return found


def floors(tops: Tops, ends: Floats, steps: Any, samples: tuple[Fraction, ...]) -> Floors:
    """Return the floors of bodies that took so many ``steps`` (n) until their ``ends`` (n)."""
    chosen, K = points(samples), tops.inverse
    times = ends[:, None] * chosen.shares
    H, Phi = tops.transition(times)
    count = np.maximum(steps, len(samples)).astype(float)
    steps_at = np.diff(chosen.shares, prepend=0.0) * count[:, None]
    steps_at[:, 0] = 1.0
    with np.errstate(all="ignore"):
        rounded = _roundings(K, H, abs(ends) / count)
        squares = np.cumsum(steps_at * rounded**2, axis=2)
        injected = np.moveaxis(rounded * np.sqrt(steps_at), 0, -1)
        brought = _inverse(Phi) * injected[:, :, None, :]
        gathered = np.cumsum(brought @ np.swapaxes(brought, -1, -2), axis=1)
        out = K.T[:, None, :, None] * Phi
        sizes = np.sqrt(np.sum((out @ gathered) * out, axis=(-1, -2)))
        is_regular = _is_regular(K, H, Phi, times)
    omega = np.maximum(sizes[:, chosen.later], sizes[:, chosen.earlier])
    return Floors(chosen, omega, np.cumsum(steps_at, axis=1), squares, is_regular)


def _roundings(K: Floats, H: Floats, step: Floats) -> Floats:
    """The rounding of a step in each component (3, n, points): |H| + h S, as judge.floor.magnitude has it.

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
    found: Floats = sizes + h[:, None] * S
    return found


def _norms(vectors: Floats) -> Floats:
    found: Floats = np.sqrt(np.sum(vectors**2, axis=0))
    return found


def _inverse(Phi: Floats) -> Floats:
    """The inverses of matrices of determinant 1: the rows are products of the columns."""
    a, b, c = (Phi[..., k] for k in range(3))
    return np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-2)


def _is_regular(K: Floats, H: Floats, Phi: Floats, times: Floats) -> Any:
    growth = np.sqrt(np.sum(Phi**2, axis=(-1, -2)))
    omega = K[:, :, None] * H
    # J = [H]x K - [K H]x: off its diagonal, in the row i and the column j, it is +-(K_i - K_j) H_k.
    pairs = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    entries = [
        (K[j][:, None] * H[k] - omega[k], K[i][:, None] * H[k] - omega[k]) for i, j, k in pairs
    ]
    squares = sum(one**2 + two**2 for one, two in entries)
    rate = np.sqrt(np.max(squares, axis=1)) / _FROBENIUS
    return (growth <= REGULAR * (1 + rate[:, None] * abs(times))).all(axis=1)
