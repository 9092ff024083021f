"""The courses of a shift in time, and the least squares along each of them.

To first order a further shift dc leaves e + v dc of an error e, v being the velocity. What first order
neglects, v' dc^2/2 and the roundings of float64, is held against what is left; while it is not small
beside it, the exact motion is evaluated anew at t - c (Gauss-Newton). A shift of a sizeable part of a
turn is looked for among many on a few samples first.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.judge.errors.compared import Compared, Floats, Shifted

# What is neglected is to be this much smaller than what is left.
NEGLIGIBLE: Final = 1 / 16
# A sample at which the motion is slower than this part of its fastest tells no time.
AT_REST: Final = 1e-3
# Convergence is quadratic: 2^-4 becomes 2^-237 in six evaluations, the rest is for a poor start.
_EVALUATIONS: Final = 10
_HALVINGS: Final = 3
# An evaluation that leaves more than this part of the error before it is worth no further one.
_PROGRESS: Final = 0.9
# Beyond this error (relative, or radians) first order may not even know the direction.
FAR: Final = 0.1
# The search: this many steps of half a radian of the fastest turn, each way.
_SEARCH_STEPS: Final = 16
_SEARCH_STEP: Final = 0.5

Course = Callable[[Shifted, Floats], Floats]


def constant(fit: Shifted, times: Floats) -> Floats:
    """Return one shift for all samples."""
    return _along(np.ones((len(times), 1)), fit)


def linear(fit: Shifted, times: Floats) -> Floats:
    """Return a shift that is linear in t; ``times`` run over the span from 0 to 1."""
    return _along(np.stack([np.ones(len(times)), times], axis=1), fit)


def _along(basis: Floats, fit: Shifted) -> Floats:
    root = np.sqrt(fit.weight)
    asked = np.divide(fit.wanted, root, out=np.zeros(len(root)), where=root > 0)
    return basis @ np.linalg.lstsq(root[:, None] * basis, asked, rcond=None)[0]


def single(fit: Shifted, times: Floats) -> Floats:
    """Return a shift for every sample by itself; none where the motion rests and tells no time."""
    return np.divide(fit.wanted, fit.weight, out=np.zeros(len(times)), where=moving(fit))


def moving(fit: Shifted) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Return the samples at which the motion is fast enough to tell the time."""
    return fit.weight > AT_REST**2 * np.max(fit.weight)


def fitted(compared: Compared, fit: Shifted, course: Course) -> Shifted:
    """Return the least squares along a course that begins where ``fit`` stands."""
    for _ in range(_EVALUATIONS):
        step = course(fit, compared.run.times)
        better = fit.with_first_order(step)
        left = max(float(np.max(np.abs(better.error))), compared.doubt / fit.size)
        if fit.neglects(fit.more + step) <= NEGLIGIBLE * left:
            return better
        closer = _closer(compared, fit, fit.more + step)
        if closer is None:
            return fit
        if closer.left > _PROGRESS * fit.left:
            return closer
        fit = closer
    return fit


def _closer(compared: Compared, fit: Shifted, step: Floats) -> Shifted | None:
    """The evaluation at a further shift, halved until it leaves less; None if it never does."""
    for halvings in range(_HALVINGS + 1):
        found = compared.evaluated(fit.moved(step / 2**halvings))
        if found is None or found.left < fit.left:
            return found
    return None


def best_start(compared: Compared, fit: Shifted, course: Course) -> Shifted:
    """Return the fit to begin with: ``fit``, or that at one of many shifts if the error is large.

    A motion that comes back has many shifts that are equally good: the smallest is taken of those
    that leave the least but for what the distance between two of them may add.
    """
    is_far = np.max(np.abs(fit.error)) * fit.size > FAR
    if not is_far or not fit.rate:
        return fit
    times = compared.run.times
    shape = np.ones(len(times)) if course is constant else times
    pace = _SEARCH_STEP / fit.rate
    counts = sorted(range(-_SEARCH_STEPS, _SEARCH_STEPS + 1), key=abs)
    steps = [Fraction(k * pace) * fit.unit for k in counts]
    tried = [tuple(step * Fraction(s) for s in shape.tolist()) for step in steps]
    left = compared.left_by(tried)
    if left is None:
        return fit
    between = (pace / 2) ** 2 * float(np.mean(fit.weight))
    best = next(k for k, one in enumerate(left) if one <= min(left) + between)
    found = compared.evaluated(tried[best])
    return fit if found is None or not found.left < fit.left else found
