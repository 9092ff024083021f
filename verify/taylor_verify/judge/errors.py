"""Errors of a trajectory against the truth, sample by sample, in the units of design section 6."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ulp
from typing import Any, Final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import precision, sqrt, to_mpf, to_mpfr
from taylor_verify.scenes.scene import Scene

Column = np.ndarray[Any, Any]
Floats = np.ndarray[Any, np.dtype[np.float64]]

_LEAST: Final = ulp(0.0)


@dataclass(frozen=True)
class Errors:
    """The error of one quantity at every sample, as mpf, in ``unit``.

    ``parts`` names the quantities of the motion that it compares, each with the scale its error is
    divided by; ``truth_radius`` is how wide the truth is, in the same unit. ``is_state`` tells the
    quantities that say where the body is from those it conserves. ``change`` is the error of the last
    sample with its sign, of a conserved number.
    """

    quantity: str
    unit: str
    values: Column
    truth_radius: Column
    parts: dict[str, Any]
    is_state: bool = False
    change: Any = None

    @cached_property
    def doubles(self) -> Floats:
        """The values as bounds are: of float64. What is not zero does not become it."""
        return _doubles(self.values)

    @cached_property
    def widths(self) -> Floats:
        """The truth's radii likewise."""
        return _doubles(self.truth_radius)


def _doubles(values: Column) -> Floats:
    return np.array([float(value) or (_LEAST if value else 0.0) for value in values])


def state_errors(scene: Scene, truth: Motion, answer: Motion) -> list[Errors]:
    """The errors of everything tracked, evaluated at the ambient precision of mpmath."""
    if scene.model == "euler":
        errors = [_vector_error("omega", "max|omega|", ["omega"], truth, answer)]
    else:
        parts = ["linear_impulse", "angular_impulse"]
        errors = [_vector_error("impulse", "max|x|, max|y|", parts, truth, answer)]
    if "attitude" in scene.track:
        errors.append(_attitude_error(truth, answer))
    if "centre" in scene.track:
        errors.append(_centre_error(scene, truth, answer))
    return errors


def _vector_error(
    quantity: str, unit: str, parts: Sequence[str], truth: Motion, answer: Motion
) -> Errors:
    """Each part over the largest norm it reaches (absolute where that is zero); the larger counts."""
    scales = {part: or_one(largest(norms(truth[part]))) for part in parts}
    by_part = [norms(answer[part] - truth[part]) / scales[part] for part in parts]
    values = _larger(by_part)
    radius = _larger([_width(truth, part) / scales[part] for part in parts])
    return Errors(quantity, unit, values, radius, scales, is_state=True)


def _larger(by_part: Sequence[Column]) -> Column:
    """Sample by sample the largest of all parts."""
    return np.array([largest(row) for row in zip(*by_part, strict=True)], dtype=object)


def _width(truth: Motion, quantity: str) -> Column:
    """How wrong each vector of the truth may be, in its own unit."""
    sizes = [or_one(size) for size in norms(truth[quantity])]
    width: Column = truth.radius_of(quantity) * np.array(sizes, dtype=object)
    return width


def _attitude_error(truth: Motion, answer: Motion) -> Errors:
    """The angle of R_exact^T R: |R - R_exact| in the Frobenius norm is 2 sqrt 2 sin(angle/2)."""
    chords = norms(answer["attitude"] - truth["attitude"]) / (2 * mp.sqrt(2))
    values = np.array([_angle(chord) for chord in chords], dtype=object)
    # |R|_F is sqrt 3, so a relative radius is less than this many radians.
    radius = 2 * truth.radius_of("attitude")
    return Errors("attitude", "rad", values, radius, {"attitude": mpf(1)}, is_state=True)


def _angle(half_chord: Any) -> Any:
    return 2 * mp.asin(half_chord) if half_chord <= 1 else mp.pi + 0 * half_chord


def _centre_error(scene: Scene, truth: Motion, answer: Motion) -> Errors:
    """Relative to the whole arc length of the path (absolute where that is zero)."""
    scale = or_one(arc_length(scene, truth))
    values = norms(answer["centre"] - truth["centre"]) / scale
    radius = _width(truth, "centre") / scale
    return Errors("centre", "arc length", values, radius, {"centre": scale}, is_state=True)


def arc_length(scene: Scene, truth: Motion) -> Any:
    """The length of the centre's path, from the speed |U| at the samples by the trapezium rule."""
    body = scene.body
    assert isinstance(body, ImmersedBody)
    A, B = exact_matrix(body.linear), exact_matrix(body.coupling)
    speeds = norms(truth["linear_impulse"] @ A.T + truth["angular_impulse"] @ B.T)
    times = [mp.convert(t) for t in scene.clock.elapsed]
    # The start is not always sampled; the speed there is close enough to the first sample's.
    speeds, times = np.concatenate([speeds[:1], speeds]), [mpf(0), *times]
    pairs = zip(times, times[1:], speeds, speeds[1:], strict=False)
    return sum((abs(t1 - t0) * (v0 + v1) / 2 for t0, t1, v0, v1 in pairs), mpf(0))


def exact_matrix(matrix: Sequence[Sequence[Any]]) -> Column:
    """A matrix of rationals in the ambient precision."""
    return np.array([[mp.convert(entry) for entry in row] for row in matrix], dtype=object)


def norms(rows: Column) -> Column:
    """The Frobenius norm of every row (vectors or matrices) of numbers of mpmath."""
    flat = to_mpfr(rows.reshape(len(rows), -1))
    with precision():
        return to_mpf(sqrt(np.sum(flat * flat, axis=1)))


def largest(values: Any) -> Any:
    """The largest value, or NaN if any is NaN (Python's max would lose it)."""
    values = list(values)
    nan = next((value for value in values if value != value), None)
    return max(values) if nan is None else nan


def or_one(scale: Any) -> Any:
    return scale if scale > 0 else mpf(1)
