"""How errors that are made all along an orbit add up.

e(s)     sizes of independent errors, made in the components of the state at time s
Phi(t,s) the derivative of the state at t by the state at s; F(t) = Phi(t, 0)
P(t)     the mean squares and products of what they have become at time t

    P(t) = sum over s <= t of Phi(t, s) diag(e(s)^2) Phi(t, s)^T.

The state is that of condition.Transition: momenta, then attitude and centre where they are tracked.
From differences of a closed form come F(s) and its inverse, all in integers, and then

    P(t) = F(t) W(t) F(t)^T,      W(t) = sum over s <= t of F(s)^-1 diag(e(s)^2) F(s)^-T;

from variational equations in float64 come the steps from point to point, and P is carried along as
a factor L of itself, P = L L^T. Either is one pass over the points, so that there may be many.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, frexp, inf, isqrt, log10
from typing import Any, Final, final

import numpy as np
from flint import fmpz_mat
from mpmath import mp

from taylor_verify.exact.conditioning.condition import (
    Derivatives,
    as_integers,
    differs_dearly,
    inverse,
    log2_size,
    quotient,
    settled,
)
from taylor_verify.exact.conditioning.inputs import momentum
from taylor_verify.exact.conditioning.looks import few, many
from taylor_verify.exact.conditioning.variation import Stepped, fastest, resolved, stepped
from taylor_verify.exact.route import solution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.precision import power_of_two
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]
Floats = np.ndarray[Any, np.dtype[np.float64]]

# A derivative that outgrows 1 + rate x time by more than this comes from a passage of an unstable
# motion: it matters then at which moments of it an error is made, and where it is looked at.
_REGULAR: Final = 8.0
# Steps of float64 cost less than orbits of dozens of digits beside this one until there are many. For a
# solid in a fluid they cost less than seven of hundreds of digits until there are thousands; the four of
# a rigid body, in functions of real numbers, cost less than those.
_FEW_RADIANS: Final = 200
_MOST_RADIANS: Final = 2000
# Norms are wanted to a digit or two, and the size of one that is too large to within a tenth.
_SHARP: Final = 1e-3
_TOLD: Final = 0.1


class Path(ABC):
    """An orbit at the times ``elapsed`` since the start, the first of them 0.

    ``momentum`` (n, d) and ``centre`` (n, 3; from its start; no rows if it is not tracked) are the
    motion there, in ``units``: powers of two by name, of the blocks of the state and of ``omega``.
    ``blocks`` are those of the state, each of three components, in their order. If it comes from
    differences, they are of 10^-``exponent`` units.
    """

    elapsed: tuple[Fraction, ...]
    units: Mapping[str, Fraction]
    blocks: tuple[str, ...]
    momentum: Floats
    centre: Floats
    exponent: int = 0

    @abstractmethod
    def gathered(self, errors: Floats) -> dict[str, Floats]:
        """The size, root mean square, of what the errors up to each time have become there.

        ``errors`` (n, components) are their sizes at each time. By name of the block, ``omega`` too;
        in units, infinite beyond float64.
        """

    @abstractmethod
    def growth(self) -> Floats:
        """|F| of the momenta at each time, in units."""


def path(scene: Scene) -> Path:
    """The orbit of a scene at as many times as it takes; some or all samples are among them.

    Raises Unsettled where the derivatives of the motion cannot be had.
    """
    elapsed = scene.clock.elapsed
    found = _along(scene, few(elapsed))
    rate, growth = _rate(scene, found), found.growth()
    if _is_regular(found, rate, growth):
        return found
    points = many(elapsed, rate)
    is_solid_in_fluid = found.momentum.shape[1] == 6
    if is_solid_in_fluid and rate * abs(elapsed[-1]) <= _MOST_RADIANS and growth.max() < inf:
        steps = _stepped(scene, points, float(growth.max()))
        if steps is not None:
            return steps
    return _sharp(scene, points, found.exponent)


def _along(scene: Scene, points: Sequence[Fraction]) -> Path:
    """The orbit at a few points; no sharper than it takes to see that they are too few."""
    if _is_short(scene) or differs_dearly(scene):
        found = _stepped(scene, points)
        if found is not None:
            return found
    return _sharp(scene, points, to_tell=True)


def _is_short(scene: Scene) -> bool:
    """Whether steps of float64 along the orbit cost less than four or seven orbits beside it."""
    start, body = scene.initial, scene.body
    if isinstance(body, RigidBody) and isinstance(start, Spin):
        z = tensors.apply(body.inertia, start.omega)
    else:
        assert isinstance(start, Impulse)
        z = start.linear + start.angular
    units = momentum(scene).units
    counted = [float(value / unit) for value, unit in zip(z, units, strict=True)]
    rate = resolved(scene, units, np.array(counted))
    return bool(rate * abs(float(scene.clock.elapsed[-1])) <= _FEW_RADIANS)


def _rate(scene: Scene, found: Path) -> float:
    return fastest(scene, momentum(scene).units, found.momentum)


def _is_regular(found: Path, rate: float, growth: Floats) -> bool:
    times = np.array([abs(float(t)) for t in found.elapsed])
    return bool((growth <= _REGULAR * (1 + rate * times)).all())


def _stepped(
    scene: Scene, points: Sequence[Fraction], growth: float = 1.0
) -> _ByIntegration | None:
    """From steps along a truth with so many more digits as ``growth`` may magnify its last one by."""
    exact, units = solution(scene), momentum(scene).units
    found = stepped(scene, exact, units, points, ceil(log10(growth)))
    return None if found is None else _ByIntegration.of(scene, points, found)


def _sharp(
    scene: Scene, points: Sequence[Fraction], least: int = 0, to_tell: bool = False
) -> _ByDifference:
    """From differences so small that products of F with inverses of it have their leading digits.

    A step of 10^-e leaves 10^-e |F|^2 in F, and that is multiplied by F^-1. Where no precision of the
    ladder is enough, what is found there is noise on top of what is asked: more, and not less. An orbit
    that is not regular is left as it is ``to_tell`` that it is not: |F| is sharp before F F^-1 is.
    """
    for found in settled(scene, points, least):
        path = _ByDifference.of(scene, points, found)
        growth = path.growth()
        blurred = growth**2 * path.shrinkage().max()
        if (blurred <= _SHARP * 10.0**found.exponent).all():
            break
        told = growth.max() <= _TOLD * 10.0**found.exponent
        if to_tell and told and not _is_regular(path, _rate(scene, path), growth):
            break
    return path


# By differences of the exact solution.


@final
@dataclass(frozen=True)
class _ByDifference(Path):
    """``forward`` is F with the rows of omega besides, ``backward`` its inverse.

    Both count 2^-bits of the units.
    """

    elapsed: tuple[Fraction, ...]
    units: Mapping[str, Fraction]
    blocks: tuple[str, ...]
    momentum: Floats
    centre: Floats
    rows: tuple[str, ...]
    forward: tuple[Any, ...]
    backward: tuple[Any, ...]
    sizes: Floats
    bits: int
    exponent: int

    @classmethod
    def of(cls, scene: Scene, points: Sequence[Fraction], found: Derivatives) -> _ByDifference:
        momenta = ("momentum",) if len(found.units) == 3 else ("linear_impulse", "angular_impulse")
        rows = (*momenta, *found.others)
        logs = {name: log2_size(values) for name, values in found.others.items()}
        logs |= {
            "attitude": 0,
            "centre": log2_size(found.others.get("centre", _NONE), found.centre),
        }
        units = {name: found.units[3 * j] for j, name in enumerate(momenta)}
        units |= {name: power_of_two(logs[name]) for name in found.others}
        with mp.workdps(found.digits):
            bits = mp.prec
            scaled = [values * mp.ldexp(1, -logs[name]) for name, values in found.others.items()]
            counts = as_integers(np.concatenate([found.momentum, *scaled], axis=1), bits)
            arms = found.centre * mp.ldexp(1, -logs["centre"])
            pairs = list(_pairs(counts, as_integers(arms, bits), rows, bits))
        return cls(
            elapsed=tuple(points),
            units=units,
            blocks=tuple(name for name in rows if name != "omega"),
            momentum=found.state.astype(float),
            centre=arms.astype(float),
            rows=rows,
            forward=tuple(pair[0] for pair in pairs),
            backward=tuple(pair[1] for pair in pairs),
            sizes=np.array([_norm(values.astype(float)) for values in found.momentum]),
            bits=bits,
            exponent=found.exponent,
        )

    def gathered(self, errors: Floats) -> dict[str, Floats]:
        size = 3 * len(self.blocks)
        start, found = fmpz_mat(size, size), []
        for forward, backward, sizes in zip(self.forward, self.backward, errors, strict=True):
            if sizes.any():
                back = backward * _diagonal([_count(float(e), self.bits) for e in sizes])
                start = start + back * back.transpose()
            squares = _inner(forward * start, forward)
            found.append([isqrt(sum(squares[k : k + 3])) for k in range(0, len(squares), 3)])
        unit = 1 << 3 * self.bits
        return {
            name: np.array([quotient(row[j], unit) for row in found])
            for j, name in enumerate(self.rows)
        }

    def growth(self) -> Floats:
        return self.sizes

    def shrinkage(self) -> Floats:
        """|F^-1| of the momenta at each time, in units."""
        d, unit = self.momentum.shape[1], 1 << self.bits
        rows = [matrix.tolist()[:d] for matrix in self.backward]
        return np.array(
            [_norm(np.array([[quotient(int(v), unit) for v in r[:d]] for r in m])) for m in rows]
        )


_NONE: Final = np.empty((0, 3), dtype=object)


def _pairs(
    counts: Array, arms: Array, rows: tuple[str, ...], bits: int
) -> Iterator[tuple[Any, Any]]:
    """F and F^-1 at each time, from the derivatives by the momenta alone.

    With D, A, C those of momenta, attitude and centre, and c the centre from its start,

        F = [[D, 0, 0], [A, 1, 0], [C, -[c]x, 1]],
        F^-1 = [[D^-1, 0, 0], [-A D^-1, 1, 0], [-(C + [c]x A) D^-1, [c]x, 1]].
    """
    d = counts.shape[2]
    place = d + 3 * ("omega" in rows)
    places = counts.shape[1] - place
    for k, by_momentum in enumerate(counts):
        forward = np.zeros((len(by_momentum), d + places), dtype=object)
        backward = np.zeros((d + places, d + places), dtype=object)
        forward[:, :d] = by_momentum
        backward[:d, :d] = back = inverse(by_momentum[:d], bits)
        for i in range(places):
            forward[place + i, d + i] = backward[d + i, d + i] = 1 << bits
        if places:
            turn = by_momentum[place : place + 3]
            backward[d : d + 3, :d] = -(turn @ back >> bits)
        if places > 3:
            arm = _cross_matrix(arms[k])
            forward[place + 3 :, d : d + 3] = -arm
            backward[d + 3 :, d : d + 3] = arm
            moved = by_momentum[place + 3 :] + (arm @ turn >> bits)
            backward[d + 3 :, :d] = -(moved @ back >> bits)
        yield fmpz_mat(forward.tolist()), fmpz_mat(backward.tolist())


def _cross_matrix(v: Array) -> Array:
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], dtype=object)


def _diagonal(counts: Sequence[int]) -> Any:
    size = len(counts)
    return fmpz_mat([[counts[i] if i == j else 0 for j in range(size)] for i in range(size)])


def _inner(one: Any, other: Any) -> list[int]:
    """The product of each row of one with the same row of the other."""
    pairs = zip(one.tolist(), other.tolist(), strict=True)
    return [int(sum(a * b for a, b in zip(p, q, strict=True) if a and b)) for p, q in pairs]


def _count(value: float, bits: int) -> int:
    """A float in units of 2^-bits, rounded to the nearest."""
    fraction, exponent = frexp(value)
    shift = exponent + bits - 53
    whole = int(fraction * 2.0**53)
    return whole << shift if shift >= 0 else (whole >> -shift - 1) + 1 >> 1


def _norm(matrix: Floats) -> float:
    size = float(np.abs(matrix).max())
    return size * float(np.linalg.norm(matrix / size, 2)) if 0 < size < np.inf else size


# By variational equations.


@final
@dataclass(frozen=True)
class _ByIntegration(Path):
    """``steps`` lead from each time to the next; ``omega`` is made of the momentum, if it is asked."""

    elapsed: tuple[Fraction, ...]
    units: Mapping[str, Fraction]
    blocks: tuple[str, ...]
    momentum: Floats
    centre: Floats
    steps: Floats
    omega: Floats

    @classmethod
    def of(cls, scene: Scene, points: Sequence[Fraction], found: Stepped) -> _ByIntegration:
        units = momentum(scene).units
        momenta = ("momentum",) if len(units) == 3 else ("linear_impulse", "angular_impulse")
        by_name = {name: units[3 * j] for j, name in enumerate(momenta)}
        by_name |= {"omega": 1 / found.time, "attitude": Fraction(1), "centre": found.length}
        return cls(
            elapsed=tuple(points),
            units=by_name,
            blocks=momenta + tuple(n for n in ("attitude", "centre") if n in scene.track),
            momentum=found.momentum,
            centre=found.centre,
            steps=found.steps,
            omega=found.omega,
        )

    def gathered(self, errors: Floats) -> dict[str, Floats]:
        size = 3 * len(self.blocks)
        factor, rows = np.diag(errors[0]), []
        with np.errstate(all="ignore"):
            rows.append(self._sizes(factor))
            for step, sizes in zip(self.steps, errors[1:], strict=True):
                both = np.hstack([step[:size, :size] @ factor, np.diag(sizes)])
                factor = _narrowed(both)
                rows.append(self._sizes(factor))
        return {name: np.array([row[name] for row in rows]) for name in rows[0]}

    def _sizes(self, factor: Floats) -> dict[str, float]:
        names = {name: factor[3 * j : 3 * j + 3] for j, name in enumerate(self.blocks)}
        if "momentum" in names:
            names["omega"] = self.omega @ names["momentum"]
        sizes = {name: float(np.linalg.norm(rows)) for name, rows in names.items()}
        return {name: size if size == size else np.inf for name, size in sizes.items()}

    def growth(self) -> Floats:
        d = self.momentum.shape[1]
        carried, found = np.eye(d), [1.0]
        for step in self.steps:
            carried = step[:d, :d] @ carried
            found.append(_norm(carried) if np.isfinite(carried).all() else np.inf)
        return np.array(found)


def _narrowed(factor: Floats) -> Floats:
    """A square L with the same L L^T; what is once beyond float64 is so for ever."""
    if np.isfinite(factor).all():
        return np.linalg.qr(factor.T).R.T
    return np.full((len(factor), len(factor)), np.inf)
