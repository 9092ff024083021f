"""Motions close to an exact one, computed from the equations of their difference.

z, R, c   the exact momentum, attitude and centre; z + s e, R P and c + s R g those beside them
s         a power of two near the largest of these differences
p, s v    the quaternion of P, with p = (1 - |s v|^2)^(1/2)
J         linear in z, with z' = load + J(z) z/2, so that loads drop out of a difference

    e' = J(z + s e/2) e                        v' = (p W + v x (2 Omega + s W))/2,  W = dOmega
    g' = dU - Omega x g + 2 p v x U + 2 s v x (v x U),  U that of z + s e

Nothing is neglected: these are the exact equations of the difference. The difference is small, so float64
suffices for it, however many digits the exact motion has. All arcs are followed at once, by Gragg's method
of extrapolation. Its error is estimated and not proven: two orders must agree, z must arrive at the exact
motion, and the estimate must be negligible.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from math import ceil
from typing import Any, Final

import gmpy2
import numpy as np

from taylor_verify.exact.conditioning.extrapolation import extrapolated
from taylor_verify.exact.conditioning.linearised import Flow, applied
from taylor_verify.exact.invariant import Array
from taylor_verify.exact.kind import Kind
from taylor_verify.exact.quadratic_forms import Floats
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.row_arithmetic import applied as mapped
from taylor_verify.exact.row_arithmetic import cross_matrices, turned
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

# Step in radians of the fastest rate. With more steps than these, enclosed arcs cost little more.
_STEP: Final = 0.75
_MOST_STEPS: Final = 64
# The relative rounding error of some hundred operations on float64, with a margin.
_NOISE: Final = 2.0**-44
# The second derivative of a flow over that of a step squared, in units in which rates are about one.
_BEND: Final = 16.0
# More digits than asked for, so that no digit of a verdict depends on the chosen method.
_MORE_DIGITS: Final = 3
# Beyond it squares are near the end of float64.
_LARGEST: Final = 1e100


def neighbours(
    scene: Scene,
    spans: Sequence[Fraction],
    exact: tuple[Motion, Motion],
    beside: Motion,
    derivatives: Floats | None = None,
) -> Neighbours:
    """Return the ends of arcs of these ``spans`` that start from the states ``beside`` an exact motion.

    ``exact`` are its rows at the beginnings and at the ends of the arcs; row k of ``beside`` belongs to
    the k-th beginning. Motions are in MPFR's numbers, at the ambient precision. Under written loads, which
    are not known here, the ``derivatives`` of the motion over the arcs lead the differences on.
    """
    arcs = _Arcs(scene, Flow.of(scene), kind_of(scene.body))
    begin, end = exact
    start, size = arcs.difference(begin, beside)
    if derivatives is not None:
        ends, errors = arcs.led(exact, start, float(size), derivatives)
    else:
        with np.errstate(all="ignore"):  # what is not finite is not negligible
            times = np.array([float(span / arcs.flow.time) for span in spans])
            ends, errors = arcs.followed(exact, start, float(size), times)
    return Neighbours(arcs, end, ends, errors, size)


@dataclass(frozen=True)
class Neighbours:
    """The ends of arcs beside the ``exact`` ones: their differences in units of ``size``, with errors."""

    arcs: _Arcs
    exact: Motion
    ends: Floats
    errors: Floats
    size: Any

    def to(self, digits: int) -> Motion | None:
        """Return the ends; None if the estimated error is not far below so many digits of the motion."""
        arcs, more = self.arcs, digits + _MORE_DIGITS
        is_close = arcs.is_negligible(self.errors, self.size, self.exact, more)
        return arcs.moved(self.exact, self.ends, self.size) if is_close else None


@dataclass(frozen=True)
class _Arcs:
    """The arcs of one scene, counted in the units of its flow."""

    scene: Scene
    flow: Flow
    kind: Kind[Any, Any]

    @property
    def _has_turn(self) -> bool:
        return "attitude" in self.scene.track

    @property
    def _has_centre(self) -> bool:
        return "centre" in self.scene.track

    def momentum(self, motion: Motion) -> Array:
        """Return the momentum of every row, in the scene's units."""
        return self.kind.momentum_rows(self.scene.body, motion)

    @cached_property
    def _units(self) -> Array:
        return np.array([gmpy2.mpfr(unit) for unit in self.flow.components], dtype=object)

    def counted(self, motion: Motion) -> Floats:
        """Return the momentum of every row in the units of the flow."""
        counts: Floats = (self.momentum(motion) / self._units).astype(float)
        return counts

    # From exact motions to differences, and back.

    def difference(self, exact: Motion, beside: Motion) -> tuple[Floats, Any]:
        """Return (e, v, g) and their size s, a power of two."""
        parts = [(self.momentum(beside) - self.momentum(exact)) / self._units]
        if self._has_turn:
            back = np.swapaxes(exact["attitude"], 1, 2)
            parts.append(_half_turns(back @ beside["attitude"]))
        if self._has_centre:
            length = gmpy2.mpfr(self.flow.length)
            parts.append(turned(back, beside["centre"] - exact["centre"]) / length)
        whole = np.hstack(parts)
        largest = max((abs(value) for value in whole.flat), default=0)
        size = gmpy2.exp2(gmpy2.get_exp(largest)) if gmpy2.is_regular(largest) else gmpy2.mpfr(1)
        return (whole / size).astype(float), size

    def moved(self, exact: Motion, difference: Floats, size: Any) -> Motion:
        """Return the motion that differs so from the exact one."""
        d = len(self.flow.components)
        exactly = np.array([gmpy2.mpfr(v) for v in difference.flat], dtype=object)
        whole = exactly.reshape(difference.shape) * size
        e = whole[:, :d] * self._units
        quantities = dict(exact.quantities)
        if self.kind.moving == ("omega",):
            K = self.kind.momentum_equations(self.scene.body).spin
            quantities["omega"] = quantities["omega"] + mapped(tuple(map(tuple, K)), e)
        else:
            for k, name in enumerate(self.kind.moving):
                quantities[name] = quantities[name] + e[:, 3 * k : 3 * k + 3]
        if self._has_turn:
            R, v = exact["attitude"], whole[:, d : d + 3]
            cosine = np.array([gmpy2.sqrt(1 - sum(v_i * v_i for v_i in row)) for row in v])
            crossed = cross_matrices(v)
            turn = cosine[:, None, None] * crossed + crossed @ crossed
            quantities["attitude"] = R + 2 * (R @ turn)
        if self._has_centre:
            shift = turned(R, whole[:, d + 3 :]) * gmpy2.mpfr(self.flow.length)
            quantities["centre"] = quantities["centre"] + shift
        return Motion(quantities, exact.radius)

    def is_negligible(self, errors: Floats, size: Any, exact: Motion, digits: int) -> bool:
        """Return True if all errors are below so many digits of the largest |H|, |x|, |y|, 1 and |c|."""
        z = self.counted(exact)
        sizes = [np.max(np.abs(z[:, k : k + 3])) for k in range(0, z.shape[1], 3)]
        if self._has_turn:
            sizes.append(1.0)
        if self._has_centre:
            centre = exact["centre"] / gmpy2.mpfr(self.flow.length)
            sizes.append(float(max(abs(value) for value in centre.flat)))
        limit = gmpy2.mpfr(10) ** -digits
        most = [np.max(np.abs(errors[:, 3 * k : 3 * k + 3])) for k in range(len(sizes))]
        return all(
            gmpy2.mpfr(error) * size <= limit * float(largest)
            for error, largest in zip(most, sizes, strict=True)
        )

    # In float64.

    def led(
        self, exact: tuple[Motion, Motion], start: Floats, size: float, derivatives: Floats
    ) -> tuple[Floats, Floats]:
        """Return the differences at the ends of the arcs, to first order, and estimates of the rest."""
        begin, end = (self._frames(motion) for motion in exact)
        moved = np.einsum("kij,kj->ki", derivatives, self._in_space(start, begin))
        growth = np.linalg.norm(derivatives, axis=(1, 2)) * np.linalg.norm(start, axis=1)
        errors = np.tile((_BEND * size * growth**2 + _NOISE * growth)[:, None], start.shape[1])
        return self._in_body(moved, end, start.shape[1]), errors

    def _frames(self, motion: Motion) -> Floats:
        rows = len(motion.radius)
        if not self._has_turn:
            return np.tile(np.eye(3), (rows, 1, 1))
        turns: Floats = motion["attitude"].astype(float)
        return turns

    def _in_space(self, difference: Floats, frames: Floats) -> Floats:
        """Return momentum, turn and centre in space axes, without a frame that is not tracked as zeros."""
        d = len(self.flow.components)
        whole = np.zeros((len(difference), d + 6))
        whole[:, : difference.shape[1]] = difference
        whole[:, d : d + 3] = 2 * applied(frames, whole[:, d : d + 3])
        whole[:, d + 3 :] = applied(frames, whole[:, d + 3 :])
        return whole

    def _in_body(self, whole: Floats, frames: Floats, width: int) -> Floats:
        d, back = len(self.flow.components), np.swapaxes(frames, 1, 2)
        turn, shift = whole[:, d : d + 3], whole[:, d + 3 :]
        parts = whole[:, :d], applied(back, turn) / 2, applied(back, shift)
        return np.hstack(parts)[:, :width]

    def followed(
        self, exact: tuple[Motion, Motion], start: Floats, size: float, spans: Floats
    ) -> tuple[Floats, Floats]:
        """Return the differences at the ends of the arcs, and estimated errors; NaN for too long arcs."""
        z, arrival = map(self.counted, exact)
        d, at = z.shape[1], np.hstack([z, start])
        radians = np.max(np.abs(spans) * self.flow.rate(z), initial=0.0)
        if not radians <= _MOST_STEPS * _STEP or np.max(np.abs(start), initial=0.0) > _LARGEST:
            return start, np.full_like(start, np.nan)
        steps = max(1, ceil(radians / _STEP))
        errors = np.zeros_like(start)
        rates = partial(self._rates, size=size, d=d)
        for _ in range(steps):
            at, error = extrapolated(rates, at, (spans / steps)[:, None])
            errors += np.abs(error[:, d:])
        ends = at[:, d:]
        # No rate of an error is more than about 2 in these units, for a z of 1.
        missed = 4 * (1 + np.abs(spans)) * np.linalg.norm(at[:, :d] - arrival, axis=1)
        largest = np.max(np.abs(np.hstack([start, ends])), axis=1)
        return ends, errors + (largest * (_NOISE + missed))[:, None]

    def _rates(self, at: Floats, size: float, d: int) -> Floats:
        flow = self.flow
        z, e = at[:, :d], at[:, d : 2 * d]
        rates = [flow.rates(z), applied(flow.jacobian(z + size / 2 * e), e)]
        if self._has_turn:
            v = at[:, 2 * d : 2 * d + 3]
            cosine = np.sqrt(1 - size**2 * np.sum(v * v, axis=1))[:, None]
            spin, more = z @ flow.equations.spin.T, e @ flow.equations.spin.T
            rates.append((cosine * more + np.cross(v, 2 * spin + size * more)) / 2)
        if self._has_centre:
            g = at[:, 2 * d + 3 :]
            speed = (z + size * e) @ flow.equations.velocity.T
            across = np.cross(v, speed)
            carried = 2 * cosine * across + 2 * size * np.cross(v, across)
            rates.append(e @ flow.equations.velocity.T - np.cross(spin, g) + carried)
        return np.hstack(rates)


def _half_turns(rotations: Array) -> Array:
    """Return the vector part of the quaternion of every rotation that is no half turn, (n, 3)."""
    trace = np.trace(rotations, axis1=1, axis2=2)
    skew = rotations - np.swapaxes(rotations, 1, 2)
    axes = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1)
    lengths = np.array([gmpy2.sqrt(1 + entry) for entry in trace])
    halves: Array = axes / (2 * lengths)[:, None]
    return halves
