"""The exact motion as decimal text, with a radius that includes the rounding of the digits."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import MAX_EMAX, MIN_EMIN, ROUND_CEILING, ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from typing import Any

import numpy as np
from mpmath import mp

from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NoClosedForm, Solution, Unsettled
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.precision import exact_value
from taylor_verify.scenes.scene import Scene

# The motion has this many digits more than are printed, so that printing limits the accuracy.
_SPARE_DIGITS = 3
# An exponent is written below 10^-5, and where a plain number would need zeros after its last digit.
_LEAST_PLAIN_EXPONENT = -5
# In bits. Larger rationals are printed by mpmath, whose rounding is a thousandth of the last digit.
_LARGEST_RATIONAL = 100_000


def document(
    scene: Scene, exact: Solution, times: Sequence[tuple[str, Fraction]], digits: int
) -> dict[str, Any]:
    """Return the document of `exact --json`: a row for each time, given as its text and its exact value.

    ``radius`` is the radius of Motion plus the rounding of the printed digits. A vector that cannot be
    distinguished from zero is printed as zero; ``absolute`` bounds its size, and ``radius`` does not
    count it. The row at the start is the initial state itself. If some times are not reached, ``because``
    says why, and ``rows`` has the other times.
    """
    elapsed = [time - scene.clock.start for _, time in times]
    because = None
    motion: Motion | None
    places: Sequence[int] = range(len(times))
    try:
        motion = exact.motion(elapsed, digits + _SPARE_DIGITS)
    except Unsettled as doubt:
        motion, places, because = doubt.motion, doubt.places, f"undecided: {doubt} @ {scene.name}"
    start = _start(scene)
    rows = []
    for k, place in enumerate(places):
        assert motion is not None
        values = {
            name: values[k] if elapsed[place] else start[name]
            for name, values in motion.quantities.items()
        }
        relative, absolute = _radii(motion, k)
        rows.append(
            {"t": times[place][0]}
            | {name: _text(value, digits) for name, value in values.items()}
            | {"radius": _printed_radius(relative, digits)}
            | ({"absolute": absolute} if absolute else {})
        )
    return {
        "scene": scene.name,
        "route": exact.route,
        "evidence": exact.evidence,
        "digits": digits,
        "regime": _regime(scene, exact),
        "rows": rows,
    } | ({} if because is None else {"because": because})


def _radii(motion: Motion, k: int) -> tuple[Fraction, dict[str, str]]:
    """Return the relative radius of row k, and bounds of the size of vectors that are answered as zero."""
    absolute = {
        name: decimal_text(exact_value(radius[k]), 2, ROUND_CEILING)
        for name, radius in motion.radii.items()
        if radius[k] and not motion[name][k].any()
    }
    relative = [radius[k] for name, radius in motion.radii.items() if name not in absolute]
    if not absolute:
        return exact_value(motion.radius[k]), {}
    return exact_value(max(relative, default=mp.zero)), absolute


def _printed_radius(radius: Fraction, digits: int) -> str:
    """The radius with half a unit in the last printed digit of every entry, rounded up to two digits.

    The entries printed are the midpoints, whose norm is at most 1 + radius by that of the vector.
    """
    printing = Fraction(1, 2 * 10 ** (digits - 1))
    return decimal_text(radius + printing * (1 + radius), 2, ROUND_CEILING)


def _start(scene: Scene) -> dict[str, np.ndarray[Any, Any]]:
    """Return the initial state by name, as rationals; a zero of the start is exactly zero."""
    initial, kind = scene.initial, kind_of(scene.body)
    z = kind.state(initial)
    state: dict[str, Any] = {name: z[3 * k : 3 * k + 3] for k, name in enumerate(kind.moving)}
    state |= {"attitude": rotation_matrix(initial.attitude), "centre": kind.centre(initial)}
    return {name: np.array(values, dtype=object) for name, values in state.items()}


def _regime(scene: Scene, exact: Solution) -> str:
    """Return the kind of orbit if it is known, independent of the route to the numbers."""
    try:
        return solution(scene, "arb").regime
    except NoClosedForm:
        return exact.regime


def decimal_text(value: Fraction, digits: int, rounding: str = ROUND_HALF_EVEN) -> str:
    """The number, rounded once, with exactly that many significant digits; zero is "0".

    Python, C and JSON read it as a number.
    """
    if not value:
        return "0"
    context = Context(prec=digits, rounding=rounding, Emax=MAX_EMAX, Emin=MIN_EMIN)
    quotient = context.divide(Decimal(value.numerator), Decimal(value.denominator))
    exponent = quotient.adjusted()
    # An exact quotient lacks its trailing zeros.
    padded = quotient.quantize(Decimal((0, (1,), exponent - digits + 1)), context=context)
    is_plain = _LEAST_PLAIN_EXPONENT <= exponent < digits
    return format(padded, "f" if is_plain else "e")


def shortest_text(value: Fraction, digits: int) -> str:
    """Return the number to so many digits, without its last zeros."""
    mantissa, e, exponent = decimal_text(value, digits).partition("e")
    if "." in mantissa:
        mantissa = mantissa.rstrip("0").rstrip(".")
    return f"{mantissa}{e}{exponent}"


def _text(values: np.ndarray[Any, Any], digits: int) -> Any:
    if values.ndim > 1:
        return [_text(row, digits) for row in values]
    return [_entry(value, digits) for value in values]


def _entry(value: Any, digits: int) -> str:
    """The entry rounded once; on a separatrix it can be e^(-10^9), whose exact rational fills memory."""
    if isinstance(value, Fraction):
        return decimal_text(value, digits)
    if value and abs(mp.mag(value)) > _LARGEST_RATIONAL:
        with mp.workdps(digits + _SPARE_DIGITS):
            return str(mp.nstr(value, digits, strip_zeros=False))
    return decimal_text(exact_value(value), digits)
