"""Courses of a shift in time (constant, linear, free), and the least-squares fit along each.

To first order a further shift dc changes an error e to e + v dc, where v is the velocity. First order
neglects v' dc^2/2 and the roundings of float64. While this is not small beside the remaining error, the
exact motion is evaluated again at t - c (Gauss-Newton). A shift of a large part of a turn is first
searched among many shifts on a few samples.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.judge.errors.shifted import Compared, Floats, Shifted

# The neglected part must be at most this part of the remaining error.
_NEGLIGIBLE: Final = 1 / 16
# A sample at which the motion is slower than this part of its fastest speed shows no time.
_AT_REST: Final = 1e-3
# Convergence is quadratic: 2^-4 becomes 2^-237 in six evaluations; the others serve a poor start.
_EVALUATIONS: Final = 10
_HALVINGS: Final = 3
# The iteration ends if an evaluation leaves more than this part of the error before it.
_PROGRESS: Final = 0.9
# Beyond this error (relative, or radians) first order may have the wrong direction.
FAR: Final = 0.1
# The search: this many steps of half a radian of the fastest turn, in each direction.
_SEARCH_STEPS: Final = 16
_SEARCH_STEP: Final = 0.5

Course = Callable[[Shifted, Floats], Floats]


def constant(fit: Shifted, times: Floats) -> Floats:
    """Return the constant shift that fits all samples best."""
    return _along(np.ones((len(times), 1)), fit)


def linear(fit: Shifted, times: Floats) -> Floats:
    """Return the best shift that is linear in t; ``times`` run over the span from 0 to 1."""
    return _along(np.stack([np.ones(len(times)), times], axis=1), fit)


def _along(basis: Floats, fit: Shifted) -> Floats:
    root = np.sqrt(fit.weight)
    asked = np.divide(fit.wanted, root, out=np.zeros(len(root)), where=root > 0)
    return basis @ np.linalg.lstsq(root[:, None] * basis, asked, rcond=None)[0]


def single(fit: Shifted, times: Floats) -> Floats:
    """Return the best shift of each sample by itself; 0 where the motion rests and shows no time."""
    return np.divide(fit.wanted, fit.weight, out=np.zeros(len(times)), where=moving(fit))


def moving(fit: Shifted) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Return True for the samples at which the motion is fast enough to show the time."""
    return fit.weight > _AT_REST**2 * np.max(fit.weight)


def fitted(compared: Compared, fit: Shifted, course: Course) -> Shifted:
    """Return the least-squares fit along a course, starting from ``fit``."""
    for _ in range(_EVALUATIONS):
        step = course(fit, compared.run.times)
        better = _by_first_order(compared, fit, step)
        if better is not None:
            return better
        closer = _closer(compared, fit, fit.more + step)
        if closer is None:
            return fit
        if closer.left > _PROGRESS * fit.left:
            return closer
        fit = closer
    return fit


def at(compared: Compared, fit: Shifted, shift: Floats) -> Shifted | None:
    """Return the comparison after this shift of each sample; None if it cannot be computed.

    ``fit`` is the one without a shift.
    """
    first_order = _by_first_order(compared, fit, shift / (float(fit.unit) * fit.size))
    return first_order or compared.evaluated(tuple(map(Fraction, shift.tolist())))


def _by_first_order(compared: Compared, fit: Shifted, step: Floats) -> Shifted | None:
    """Return the fit after a further shift, or None where first order neglects too much of it."""
    better = fit.with_first_order(step)
    left = max(float(np.max(np.abs(better.error))), compared.doubt / fit.size)
    return better if fit.neglects(fit.more + step) <= _NEGLIGIBLE * left else None


def _closer(compared: Compared, fit: Shifted, step: Floats) -> Shifted | None:
    """Return the evaluation at a further shift, halved until the error decreases; None if it never does."""
    for halvings in range(_HALVINGS + 1):
        closer = compared.evaluated(fit.moved(step / 2**halvings))
        if closer is None or closer.left < fit.left:
            return closer
    return None


def reach(fit: Shifted) -> float:
    """Return the largest shift of the search, in the scene's unit of time; 0 if the motion rests."""
    return _SEARCH_STEPS * _SEARCH_STEP / fit.rate * float(fit.unit) if fit.rate else 0.0


def best_start(compared: Compared, fit: Shifted, course: Course) -> Shifted:
    """Return the fit to start from: ``fit``, or the best of many shifts if the error is large.

    For a periodic motion many shifts are equally good. The smallest shift is taken among those whose
    error equals the least, up to the error that half the distance between two of them can cause.
    """
    is_far = np.max(np.abs(fit.error)) * fit.size > FAR
    if not is_far or not fit.rate:
        return fit
    times = compared.run.times
    shape = np.ones(len(times)) if course is constant else times
    pace = _SEARCH_STEP / fit.rate
    counts = sorted(range(-_SEARCH_STEPS, _SEARCH_STEPS + 1), key=abs)
    steps = [Fraction(k * pace) * fit.unit for k in counts]
    left = compared.left_by(steps, shape)
    if left is None:
        return fit
    between = (pace / 2) ** 2 * float(np.mean(fit.weight))
    best = next(
        step for step, error in zip(steps, left, strict=True) if error <= min(left) + between
    )
    start = compared.evaluated(tuple(best * Fraction(s) for s in shape.tolist()))
    return fit if start is None or not start.left < fit.left else start
