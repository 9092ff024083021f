"""Growth of errors over an ensemble of starts: its exponent with an interval, a word for it, and a gate.

t_k          instants, equally many to a decade        e_ik   error of lane i at t_k, signed
p_i          slope of log |e_ik| against log t_k       n      lanes, independent of each other

The roundings of a run are practically independent of each other (Brouwer's law). They change a conserved
quantity by a random walk, e ~ t^1/2. They change a phase, whose rate depends on the conserved quantities,
by the integral of such a walk, e ~ t^3/2. Errors of constant sign give t and t^2 instead.

A process with e(ct) ~ c^p e(t) in distribution has E log |e_ik| = p log t_k + constant, for any
distribution and any correlation between instants. So p_i has no bias. The lanes give independent values
of it, and Student's interval holds for their mean, even if the errors of lanes differ in size.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import isfinite, isnan, nan, sqrt
from typing import Any, Final

import mpmath
import numpy as np

from taylor_verify.records.status import Status
from taylor_verify.records.student import student
from taylor_verify_reports.studies.growth.grown import EXACT, GrowthGate

Floats = np.ndarray[Any, np.dtype[np.float64]]

# The probability that an interval contains the exponent.
LEVEL: Final = 0.99
# A page of a hundred gates raises a false alarm once in a thousand publications.
FALSE_ALARM: Final = 1e-5

# The powers of neighbouring words differ by a half. Over few decades, oscillations within a period and a
# bias beside a walk bend the line. For the choice of a word, an interval therefore extends at least a tenth
# of that half to either side.
_RESOLUTION: Final = 0.05

_LEAST_LANES: Final = 2
# The number of late instants, which are compared with all earlier ones.
_LATE: Final = 2
_LEAST_INSTANTS: Final = _LATE + 2


class Law(StrEnum):
    """The law of a quantity under independent roundings: the null hypothesis of its gate.

    WALK is a conserved quantity, whose error grows with the half power of time; INTEGRATED a phase, the
    integral of such an error, which grows with the power 3/2 (D. Brouwer, 1937).
    """

    WALK = "a random walk"
    INTEGRATED = "the integral of a random walk"


BOUNDED: Final = "bounded"
RANDOM_WALK: Final = "random walk"
BIAS: Final = "bias"
NO_WORD: Final = "no number"

# The word of each power of time. A phase has the word of the errors that change its rate; the phase grows
# by one more power of time than they do.
_WORDS: Final[Mapping[Law, Mapping[float, str]]] = {
    Law.WALK: {0: BOUNDED, 0.5: RANDOM_WALK, 1: BIAS},
    Law.INTEGRATED: {0: BOUNDED, 0.5: "jitter", 1: "constant rate", 1.5: RANDOM_WALK, 2: BIAS},
}


@dataclass(frozen=True)
class Exponent:
    """The mean slope of ``lanes`` lanes, its interval at the confidence ``level``, and the word for it.

    Lanes with an error that is not finite are left out. The numbers are NaN if fewer than two lanes remain.
    """

    value: float
    low: float
    high: float
    word: str
    lanes: int
    level: float = LEVEL


@dataclass(frozen=True)
class Growth:
    """Growth of a quantity of an ensemble: root mean squares over the lanes, exponents and gate.

    ``late`` is the exponent of the second half of the decades; ``gate`` is None for an error without a
    sign, because no law gives its distribution.
    """

    times: tuple[float, ...]
    rms: tuple[float, ...]
    exponent: Exponent
    late: Exponent
    gate: GrowthGate | None


def growth(times: Floats, errors: Floats, law: Law, roundoff: float, signed: bool = True) -> Growth:
    """Return the growth of errors of shape (lanes, instants); NaN marks an instant that was not reached.

    ``times`` (instants) are counted from the start, in any unit, and increase. ``law`` is the law that the
    errors are compared with, if they are ``signed``; ``roundoff`` is the size of one rounding in the unit
    of the errors. Raises ValueError for fewer than two lanes or four instants, and for instants that do not
    increase.
    """
    times, errors = np.asarray(times, dtype=float), np.asarray(errors, dtype=float)
    _check(times, errors)
    with np.errstate(all="ignore"):
        rms = np.sqrt(np.mean(errors**2, axis=0))
    half = len(times) // 2
    return Growth(
        times=tuple(times.tolist()),
        rms=tuple(rms.tolist()),
        exponent=exponent(times, errors, law, roundoff),
        late=exponent(times[half:], errors[:, half:], law, roundoff),
        gate=gate(times, errors, law, roundoff) if signed else None,
    )


def _check(times: Floats, errors: Floats) -> None:
    if errors.ndim != 2 or errors.shape[1] != len(times):
        raise ValueError(
            f"expected errors of shape (lanes, {len(times)}), got {errors.shape} @ growth"
        )
    if not (errors.shape[0] >= _LEAST_LANES and errors.shape[1] >= _LEAST_INSTANTS):
        raise ValueError(
            f"expected at least {_LEAST_LANES} lanes and {_LEAST_INSTANTS} instants, got "
            f"{errors.shape[0]} and {errors.shape[1]} @ growth"
        )
    if not (times[0] > 0 and np.all(np.diff(times) > 0)):
        raise ValueError("expected instants after the start that increase, got others @ growth")


# The exponent.


def exponent(times: Floats, errors: Floats, law: Law, roundoff: float) -> Exponent:
    """Return Student's interval of the mean of the lanes' slopes, of log |error| over log time.

    ``times`` (n), ``errors`` (lanes, n) and ``roundoff`` are as in `growth`. The interval contains the true
    exponent with probability LEVEL; ``law`` determines the word for it. An error of exactly zero, which has
    no logarithm, counts as one rounding.
    """
    whole = errors[np.isfinite(errors).all(axis=1)]
    count = len(whole)
    if count < _LEAST_LANES:
        return Exponent(nan, nan, nan, NO_WORD, count)
    if not whole.any():
        return Exponent(0.0, 0.0, 0.0, EXACT, count)
    x = np.log(times) - np.mean(np.log(times))
    # Slopes of the least-squares lines, one for each lane.
    slopes = np.log(np.where(whole == 0, roundoff, np.abs(whole))) @ x / (x @ x)
    mean = float(np.mean(slopes))
    reach = student(count - 1, LEVEL) * float(np.std(slopes, ddof=1)) / sqrt(count)
    judgement = word(mean, max(reach, _RESOLUTION), law)
    return Exponent(mean, mean - reach, mean + reach, judgement, count)


def word(value: float, reach: float, law: Law) -> str:
    """Return the word of the power between ``value`` - ``reach`` and ``value`` + ``reach``.

    The text says so if there are several such powers, or if the interval lies between or beyond them.
    """
    if isnan(value):
        return NO_WORD
    words, low, high = _WORDS[law], value - reach, value + reach
    inside = [name for power, name in words.items() if low <= power <= high]
    if inside:
        return inside[0] if len(inside) == 1 else f"unclear: {' or '.join(inside)}"
    below = [name for power, name in words.items() if power < low]
    above = [name for power, name in words.items() if high < power]
    if not below:
        return "shrinking"
    return f"between {below[-1]} and {above[0]}" if above else f"faster than {below[-1]}"


# The gate.


def gate(
    times: Floats, errors: Floats, law: Law, roundoff: float, false_alarm: float = FALSE_ALARM
) -> GrowthGate:
    """Judge whether the errors of the last two instants are larger than the law and the earlier ones allow.

    The law's covariance turns the errors of a lane into independent numbers z_ik of one variance (for a
    walk: its increments over the square roots of their times). L_i is the sum of the squares of the last
    two, E_i that of the m before. Then (L_i/2)/(E_i/m) has Fisher's distribution F(2, m) exactly,
    P(L_i/E_i > r) = (1 + r)^(-m/2), for any size of the lane's roundings. For n independent lanes
    -2 sum log P_i = m sum log(1 + L_i/E_i) is chi-square with 2n degrees of freedom.

    The gate fails if the chance of so large a value is below ``false_alarm``. Bounded errors, and early
    errors below one rounding (``roundoff``), have a larger E_i than the law, so that the gate fails less
    often. Errors that are not finite fail.
    """
    early, late = early_and_late(times, errors, law, roundoff)
    lanes, m = len(errors), len(times) - _LATE
    with np.errstate(all="ignore"):
        statistic = float(m * np.sum(np.log1p(late / early)))
    chance = chi_square_tail(statistic, 2 * lanes)
    because = f"expected finite errors of every lane, to be held against {law.value}"
    if isfinite(statistic):
        because = (
            f"no worse than {law.value}, which fails once in {1 / false_alarm:.0f}: "
            f"{statistic:.3g} is chi-square with {2 * lanes} degrees of freedom, chance {chance:.2g}"
        )
    # Written so that a NaN fails.
    verdict = Status.PASS if false_alarm <= chance else Status.FAIL
    return GrowthGate(verdict, law.value, chance, false_alarm, because)


def early_and_late(
    times: Floats, errors: Floats, law: Law, roundoff: float
) -> tuple[Floats, Floats]:
    """Return E_i and L_i of `gate` for every lane; one rounding at the first instant is added to E_i."""
    covariance = covariance_of(law, times)
    spread = np.sqrt(np.diag(covariance))
    # Divided by the spread at each instant, the covariance is far from singular.
    root = np.linalg.cholesky(covariance / np.outer(spread, spread))
    squares = np.linalg.solve(root, (errors / spread).T).T ** 2
    least = (roundoff / spread[0]) ** 2
    return np.sum(squares[:, :-_LATE], axis=1) + least, np.sum(squares[:, -_LATE:], axis=1)


def covariance_of(law: Law, times: Floats) -> Floats:
    """Return the covariance (n, n) of a unit walk W or of its integral at ``times`` (n).

    For s <= t it is E W(s) W(t) = s for the walk, and s^2 (3 t - s)/6 for its integral. Times are taken
    relative to the last one, which changes only the size of both laws.
    """
    scaled = times / times[-1]
    s, t = np.minimum.outer(scaled, scaled), np.maximum.outer(scaled, scaled)
    values: Floats = s if law is Law.WALK else s * s * (3 * t - s) / 6
    return values


# A distribution, written here because the judging code does not depend on SciPy.


def chi_square_tail(value: float, freedom: int) -> float:
    """Return P(chi-square > value); NaN for NaN."""
    if not value >= 0:
        return nan
    return float(mpmath.gammainc(freedom / 2, value / 2, regularized=True))
