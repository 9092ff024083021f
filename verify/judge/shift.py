"""What an error of the state means: an answer that is right but late, and what is left of the error.

With answer(t) ~ exact(t - c), c is positive if the answer is late. To first order a further shift dc
leaves e + v dc of an error e, v being the velocity. Least squares over all samples give one constant
shift, or one that is linear in t, or one for every sample. What first order neglects, v' dc^2/2 and
the roundings of float64, is held against what is left; while it is not small beside it, the exact
motion is evaluated anew at t - c (Gauss-Newton). A shift of a sizeable part of a turn is looked for
among many on a few samples first.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from typing import Final

import numpy as np

from verify.exact.solution import Solution
from verify.judge.compared import Compared, Floats, Run, Shifted
from verify.judge.errors import Errors
from verify.scenes.motion import Motion
from verify.scenes.scene import Scene

# A shift that leaves more than half of the error (root mean square) explains nothing.
_EXPLAINS: Final = 0.5
# One that leaves less than a tenth is the explanation, and so is one that leaves no more than twice
# what shifts of every single sample leave.
_SETTLES: Final = 0.1
_AS_GOOD: Final = 2.0
# A constant that leaves a quarter may have a few samples against it: it is the explanation too, if a
# drift does not do twice as well.
_MOSTLY: Final = 0.25
# What is neglected is to be this much smaller than what is left.
_NEGLIGIBLE: Final = 1 / 16
# A sample at which the motion is slower than this part of its fastest tells no time.
_AT_REST: Final = 1e-3
# Convergence is quadratic: 2^-4 becomes 2^-237 in six evaluations, the rest is for a poor start.
_EVALUATIONS: Final = 10
_HALVINGS: Final = 3
# An evaluation that leaves more than this part of the error before it is worth no further one.
_PROGRESS: Final = 0.9
# The search: this many steps of half a radian of the fastest turn, each way.
_SEARCH_STEPS: Final = 16
_SEARCH_STEP: Final = 0.5
# Its square is a double. No shift of time makes an error of that size, nor one that is not finite.
_LARGEST_ERROR: Final = 2**500


class Kind(StrEnum):
    """How the shift goes on in time."""

    CONSTANT = "constant"
    DRIFTING = "drifting"
    WANDERING = "wandering"
    NONE = "none"


@dataclass(frozen=True)
class Shift:
    """The shift of one quantity.

    ``time_shift`` is the constant c that leaves least, in the scene's unit of time, and ``residual``
    the largest error that it leaves, in the unit of the error. ``kind`` is the simplest course of the
    shift that explains the error, ``remains`` what that course leaves. ``at_samples`` holds the shift
    of every sample by itself; at those where the motion rests, that of the course. ``trend`` is the
    shift per unit of time of the best course linear in t.
    """

    time_shift: float
    residual: float
    kind: Kind
    remains: float
    trend: float
    times: tuple[float, ...]
    at_samples: tuple[float, ...]

    def sentence(self) -> str:
        """What a person can act on."""
        if self.kind is Kind.NONE:
            return "no shift of time explains it"
        left = f"{self.remains:.2g} remains"
        if self.kind is Kind.CONSTANT:
            return f"{_late(self.time_shift)}, constant; {left}"
        worst = max(range(len(self.times)), key=lambda k: abs(self.at_samples[k]))
        at_worst = f"{_late(self.at_samples[worst])} at t = {self.times[worst]:g}"
        if self.kind is Kind.WANDERING:
            return f"{at_worst}, wandering; {left}"
        pace = f"{'slow' if self.trend > 0 else 'fast'} by {abs(self.trend):.3g} of the time"
        return f"{at_worst}, drifting: its clock runs {pace}; {left}"


def time_shifts(
    scene: Scene, exact: Solution, truth: Motion, answer: Motion, digits: int, of: Sequence[Errors]
) -> list[Shift | None]:
    """The shift behind the errors of each state quantity, at the ambient precision of mpmath.

    ``truth`` is the exact motion of ``scene`` at its own instants to ``digits`` digits. None for a
    conserved quantity, and where an error is not finite or a rate is beyond float64. Where the motion
    rests no shift explains anything.
    """
    run = Run(scene, exact, truth, answer, digits)
    return [_shift(Compared(run, errors)) if errors.is_state else None for errors in of]


def _shift(compared: Compared) -> Shift | None:
    run, errors = compared.run, compared.errors
    if not all(error <= _LARGEST_ERROR for error in errors.values):
        return None
    start = compared.fit(run.truth, run.rates, run.unshifted)
    if not start.is_finite:
        return None
    constant = _fitted(compared, _best_start(compared, start, _constant), _constant)
    linear = _fitted(compared, _best_start(compared, constant, _linear), _linear)
    single = _fitted(compared, min(constant, linear, key=lambda fit: fit.left), _single)
    kind = _kind(start.left, constant.left, linear.left, single.left)
    course = {Kind.CONSTANT: constant, Kind.DRIFTING: linear, Kind.WANDERING: single}
    line = linear.shift
    return Shift(
        time_shift=float(constant.shift[0]),
        residual=compared.largest(constant),
        kind=kind,
        remains=compared.largest(course.get(kind, start)),
        trend=float(line[-1] - line[0]) / run.span if run.span else 0.0,
        times=run.instants,
        at_samples=tuple(single.shift.tolist()),
    )


def _late(shift: float) -> str:
    return f"{'late' if shift >= 0 else 'early'} by {abs(shift):.3g}"


def _kind(error: float, constant: float, linear: float, single: float) -> Kind:
    """The simplest course that explains, from what each leaves in the root mean square."""
    if not single < _EXPLAINS * error:
        return Kind.NONE
    enough = max(_SETTLES * error, min(_AS_GOOD * single, _EXPLAINS * error))
    mostly = constant <= _MOSTLY * error and linear > constant / _AS_GOOD
    if constant <= enough or mostly:
        return Kind.CONSTANT
    return Kind.DRIFTING if linear <= enough else Kind.WANDERING


Course = Callable[[Shifted, Floats], Floats]


def _constant(fit: Shifted, times: Floats) -> Floats:
    """One shift for all samples."""
    return _along(np.ones((len(times), 1)), fit)


def _linear(fit: Shifted, times: Floats) -> Floats:
    """A shift that is linear in t; ``times`` run over the span from 0 to 1."""
    return _along(np.stack([np.ones(len(times)), times], axis=1), fit)


def _along(basis: Floats, fit: Shifted) -> Floats:
    root = np.sqrt(fit.weight)
    asked = np.divide(fit.wanted, root, out=np.zeros(len(root)), where=root > 0)
    parameters = np.linalg.lstsq(root[:, None] * basis, asked, rcond=None)[0]
    found: Floats = basis @ parameters
    return found


def _single(fit: Shifted, times: Floats) -> Floats:
    """Every sample by itself; none where the motion rests, for there it tells no time."""
    moving = fit.weight > _AT_REST**2 * np.max(fit.weight)
    return np.divide(fit.wanted, fit.weight, out=np.zeros(len(times)), where=moving)


def _fitted(compared: Compared, fit: Shifted, course: Course) -> Shifted:
    """The least squares along a course that begins where ``fit`` stands."""
    for _ in range(_EVALUATIONS):
        step = course(fit, compared.run.times)
        better = fit.with_first_order(step)
        left = max(float(np.max(np.abs(better.error))), compared.doubt / fit.size)
        if fit.neglects(fit.more + step) <= _NEGLIGIBLE * left:
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


def _best_start(compared: Compared, fit: Shifted, course: Course) -> Shifted:
    """Where to begin: at ``fit``, or at one of many shifts if the error is that large.

    A motion that comes back has many shifts that are equally good: the smallest is taken of those
    that leave the least but for what the distance between two of them may add.
    """
    if not compared.is_far(fit) or not fit.rate:
        return fit
    times = compared.run.times
    shape = np.ones(len(times)) if course is _constant else times
    pace = _SEARCH_STEP / fit.rate
    tried = sorted(range(-_SEARCH_STEPS, _SEARCH_STEPS + 1), key=abs)
    steps = [Fraction(k * pace) * fit.unit for k in tried]
    left = compared.left_by([tuple(c * Fraction(s) for s in shape.tolist()) for c in steps])
    if left is None:
        return fit
    between = (pace / 2) ** 2 * float(np.mean(fit.weight))
    best = next(k for k, one in enumerate(left) if one <= min(left) + between)
    found = compared.evaluated(tuple(steps[best] * Fraction(s) for s in shape.tolist()))
    return fit if found is None or not found.left < fit.left else found
