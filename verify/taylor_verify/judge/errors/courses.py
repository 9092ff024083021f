"""Courses of a shift in time (constant, linear, free), and the least-squares fit along each.

To first order a further shift dc changes an error e to e + v dc, where v is the velocity. First order
neglects v' dc^2/2 and the roundings of float64. While this is not small beside the remaining error, the
exact motion is evaluated again at t - c (Gauss-Newton). A shift of a large part of a turn is first
searched among many shifts on a few samples.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from taylor_verify.judge.errors.shifted import Compared, Floats, Shifted

# The neglected part must be at most this part of the remaining error.
_NEGLIGIBLE: Final = 1 / 16
# A sample at which the motion is slower than this part of its fastest speed shows no time.
_AT_REST: Final = 1e-3
# Convergence is quadratic: 2^-4 becomes 2^-237 in six evaluations; the others serve a poor start.
_EVALUATIONS: Final = 14
_HALVINGS: Final = 3
# The iteration ends if an evaluation leaves more than this part of the error before it.
_PROGRESS: Final = 0.9
# Beyond this error (relative, or radians) first order may have the wrong direction.
_FAR: Final = 0.1
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
        step = course(fit, compared.times)
        better = _by_first_order(compared, fit, step)
        if better is not None:
            return better
        closer = _closer(compared, fit, (fit.more + step) * fit.size)
        if closer is None or closer.left > _PROGRESS * fit.left:
            # A double cannot hold a better shift, or there is none.
            last = fit.with_first_order(step)
            neglected = fit.neglects(last.more) * fit.size
            return last if last.left + neglected < (closer or fit).left else closer or fit
        fit = closer
    return fit


def at(compared: Compared, shift: Floats) -> Shifted | None:
    """Return the comparison after this shift of each sample; None if it cannot be computed."""
    fit = compared.unshifted
    moved = shift / float(fit.unit)
    return _by_first_order(compared, fit, moved / fit.size) or compared.evaluated(moved)


def _by_first_order(compared: Compared, fit: Shifted, step: Floats) -> Shifted | None:
    """Return the fit after a further shift, or None where first order neglects too much of it."""
    better = fit.with_first_order(step)
    left = max(float(np.max(np.abs(better.error))), compared.doubt / fit.size)
    return better if fit.neglects(fit.more + step) <= _NEGLIGIBLE * left else None


def _closer(compared: Compared, fit: Shifted, step: Floats) -> Shifted | None:
    """Return the evaluation at a further shift, halved until the error decreases; None if it never does."""
    for halvings in range(_HALVINGS + 1):
        closer = compared.evaluated(fit.moved + step / 2**halvings)
        if closer is None or closer.left < fit.left:
            return closer
    return None


def best_start(compared: Compared, fit: Shifted, course: Course) -> Shifted:
    """Return the fit to start from: ``fit``, or the best of many shifts if the error is large.

    For a periodic motion many shifts are equally good. The smallest shift is taken among those whose
    error equals the least, up to the error that half the distance between two of them can cause.
    """
    is_far = np.max(np.abs(fit.error)) * fit.size > _FAR
    if not is_far or not fit.rate:
        return fit
    times = compared.times
    shape = np.ones(len(times)) if course is constant else times
    pace = _SEARCH_STEP / fit.rate
    steps = pace * np.array(sorted(range(-_SEARCH_STEPS, _SEARCH_STEPS + 1), key=abs))
    left = compared.left_by(steps, shape)
    if left is None:
        return fit
    between = (pace / 2) ** 2 * float(np.mean(fit.weight))
    best = steps[np.argmax(left <= np.min(left) + between)]
    start = compared.evaluated(best * shape)
    return fit if start is None or not start.left < fit.left else start
