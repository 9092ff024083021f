"""The exact motion as decimal text, with a radius that includes the rounding of the digits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import MAX_EMAX, MIN_EMIN, ROUND_CEILING, ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from typing import Any, Final, Protocol

import numpy as np
from mpmath import libmp, mp, mpf

from taylor_verify.exact.as_written import as_written
from taylor_verify.exact.attitude_forms import in_form
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NoClosedForm, Solution, Unsettled
from taylor_verify.numbers.irrational import Irrational, Undecided
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]

MATRIX: Final = "matrix"
# Norms and radii are computed with so many bits, and shown with two digits.
_BOUND_BITS: Final = 128
# The motion has this many digits more than are printed, so that printing limits the accuracy.
_SPARE_DIGITS = 3
# An exponent is written below 10^-5, and where a plain number would need zeros after its last digit.
_LEAST_PLAIN_EXPONENT = -5
# In bits. Larger rationals are printed by mpmath, whose rounding is a thousandth of the last digit.
_LARGEST_RATIONAL = 100_000


def document(
    scene: Scene,
    exact: Solution,
    times: Sequence[tuple[str, Fraction]],
    digits: int,
    attitude: str = MATRIX,
) -> dict[str, Any]:
    """Return the document of `exact --json`: a row for each time, given as its text and its exact value.

    An entry has the digits that its own error bound proves, and is "0" where it proves none; ``absolute``
    bounds the entries of a quantity that are zero for that reason. ``radius`` bounds the error of every
    vector by its norm, the rounding of the printed digits included, except those that are zero throughout,
    and that of an own state by the largest norm that it has had. The row at the start is the initial state
    itself. If some times are not reached, ``because`` says why, and ``rows`` has the other times.
    ``attitude`` is its form: a matrix, or one of exact.attitude_forms.
    """
    elapsed = [time - scene.clock.start for _, time in times]
    because = None
    motion: Motion | None
    places: Sequence[int] = range(len(times))
    try:
        motion = exact.motion(elapsed, digits + _SPARE_DIGITS)
    except Unsettled as doubt:
        motion, places, because = doubt.motion, doubt.places, f"undecided: {doubt} @ {scene.name}"
    start = _start(as_written(scene))
    # An own state that is a number is its own column.
    numbers = {group.name for group in scene.groups if group.columns == (group.name,)}
    # Half a unit in the last digit of a text, which the text of zero would not need.
    least = mpf(10) ** (1 - digits) / 2
    rows = []
    for k, place in enumerate(places):
        assert motion is not None
        values = {
            name: _values(motion, name, k, start if not elapsed[place] else {})
            for name in motion.quantities
        }
        if attitude != MATRIX and "attitude" in values:
            values["attitude"] = in_form(attitude, *values["attitude"], digits + _SPARE_DIGITS)
        printed = {
            name: _printed(
                *numbers_of, digits, motion.peaks[name][k] if name in motion.peaks else None
            )
            for name, numbers_of in values.items()
        }
        texts = {
            name: vector.text[0] if name in numbers else vector.text
            for name, vector in printed.items()
        }
        radius = max(least, *(vector.radius for vector in printed.values()))
        absolute = {
            name: _rounded_up(vector.absolute)
            for name, vector in printed.items()
            if vector.absolute
        }
        rows.append(
            {"t": times[place][0], **texts, "radius": _rounded_up(radius)}
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


@dataclass(frozen=True)
class _Printed:
    """A vector or matrix as text, nested as it is shaped.

    ``radius`` bounds the error of the text by the norm of the true vector, the rounding of the digits
    included; 0 where every entry is printed as zero. ``absolute`` bounds the norm of the entries that are
    printed as zero because no digit of them is proven.
    """

    text: Any
    radius: mpf
    absolute: mpf


def _values(motion: Motion, name: str, k: int, start: Mapping[str, Array]) -> tuple[Array, Array]:
    """Return a quantity of row k and the errors of its entries; those at the start are exact."""
    values = start.get(name, motion[name][k])
    errors = motion.errors[name][k]
    return values, 0 * errors if name in start else errors


def _printed(values: Array, errors: Array, digits: int, peak: mpf | None = None) -> _Printed:
    """Return the text of a vector or matrix: of every entry the digits that its error leaves.

    ``peak`` is the size by which the error of an own state is counted.
    """
    with mp.workprec(_BOUND_BITS):
        counts = [
            _proven_digits(v, e, digits) for v, e in zip(values.flat, errors.flat, strict=True)
        ]
        texts = [_entry(v, n) if n else "0" for v, n in zip(values.flat, counts, strict=True)]
        sizes = [abs(mp.convert(v)) for v in values.flat]
        entries = list(zip(sizes, errors.flat, counts, strict=True))
        hidden = _norm([size + error for size, error, n in entries if not n])
        rounding = [size * mpf(10) ** (1 - n) / 2 + error for size, error, n in entries if n]
        scale = peak or _norm([size - error for size, error, n in entries if n])
        radius = _norm([*rounding, hidden]) / scale if scale else mpf(0)
        text = np.array(texts, dtype=object).reshape(values.shape).tolist()
        return _Printed(text, radius, hidden)


def _proven_digits(value: Any, error: mpf, digits: int) -> int:
    """Return how many digits of an entry its error proves, at most ``digits``; 0 for no digit.

    The error is at most a twentieth of a unit in the last digit, so that the text is off by 0.55 units at
    most.
    """
    if not value:
        return 0
    if not error:
        return digits
    if not mp.isfinite(error):
        return 0
    places = mp.floor(mp.log10(abs(value))) + 1
    return max(0, min(digits, int(mp.floor(places - mp.log10(20 * error)))))


def _norm(entries: Sequence[mpf]) -> mpf:
    """The Frobenius norm, rounded upwards or downwards by far less than two digits show."""
    return mp.norm(list(entries)) if entries else mpf(0)


def _rounded_up(bound: mpf) -> str:
    """The bound to two digits, rounded up; the margin covers the roundings that made it."""
    with mp.workprec(_BOUND_BITS):
        return decimal_text(
            exact_value(bound * (1 + mp.ldexp(1, -_BOUND_BITS // 2))), 2, ROUND_CEILING
        )


def enclosed_number(value: Any, error: mpf, digits: int, least: int) -> tuple[str, str]:
    """Return a number as text, and a bound of its error with the rounding of the text.

    It has the digits that its error leaves, at most ``digits``, and not less than ``least``.
    """
    with mp.workprec(_BOUND_BITS):
        count = max(least, _proven_digits(value, error, digits))
        rounding = abs(mp.convert(value)) * mpf(10) ** (1 - count) / 2
        return _entry(value, count), _rounded_up(rounding + error)


def _start(scene: Scene) -> dict[str, np.ndarray[Any, Any]]:
    """Return the initial state by name, exactly, without what may have a zero that is not proven."""
    initial, kind = scene.initial, kind_of(scene.body)
    z = kind.state(initial)
    state: dict[str, Any] = {name: z[3 * k : 3 * k + 3] for k, name in enumerate(kind.moving)}
    state |= {"attitude": rotation_matrix(initial.attitude), "centre": kind.centre(initial)}
    arrays = {name: np.array(values, dtype=object) for name, values in state.items()}
    return {name: array for name, array in arrays.items() if _zeros_are_proven(array)}


def _zeros_are_proven(array: Array) -> bool:
    try:
        return bool(array.astype(bool).size)
    except Undecided:
        return False


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


def _entry(value: Any, digits: int) -> str:
    """The entry rounded once; on a separatrix it can be e^(-10^9), whose exact rational fills memory."""
    if isinstance(value, Fraction):
        return decimal_text(value, digits)
    if isinstance(value, Irrational):
        with mp.workdps(digits + _SPARE_DIGITS):
            value = mp.convert(value)
    if abs(mp.mag(value)) > _LARGEST_RATIONAL:
        with mp.workdps(digits + _SPARE_DIGITS):
            return str(mp.nstr(value, digits, strip_zeros=False))
    return decimal_text(exact_value(value), digits)


class Moving(Protocol):
    """Something with a motion: a solution, or equations of a user."""

    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """Return the motion at times since the start."""


class Printed(mpf):  # type: ignore[misc]
    """A number of mpmath that prints with the digits that were asked for."""

    digits: int

    def __str__(self) -> str:
        return str(libmp.to_str(self._mpf_, self.digits, strip_zeros=False))

    __repr__ = __str__

    def __format__(self, spec: str) -> str:
        return str(self) if not spec else str(super().__format__(spec))

    def __reduce__(self) -> tuple[Any, ...]:
        return number_with_digits, (self._mpf_, self.digits)


def number_with_digits(number: Any, digits: int) -> Printed:
    """Return the number of a tuple of mpmath's, which no precision in force rounds."""
    printed = Printed.__new__(Printed)
    printed._mpf_, printed.digits = number, digits
    return printed


def motion_at(moving: Moving, times: Sequence[Fraction], start: Fraction, digits: int) -> Motion:
    """Return the motion at times of the clock, whose numbers print with so many digits.

    Raises Unsettled with the rows that there are, which print likewise.
    """
    try:
        return printable(moving.motion([t - start for t in times], digits), times, digits)
    except Unsettled as doubt:
        if doubt.motion is not None:
            doubt.motion = printable(doubt.motion, [times[k] for k in doubt.places], digits)
        raise


def printable(motion: Motion, times: Sequence[Fraction], digits: int) -> Motion:
    """Return the motion with its times, each of its numbers printing with so many digits."""
    quantities = {}
    for name, values in motion.quantities.items():
        numbers = [number_with_digits(value._mpf_, digits) for value in values.flat]
        quantities[name] = np.array([*numbers, None], dtype=object)[:-1].reshape(values.shape)
    return replace(motion, quantities=quantities, times=tuple(times), digits=digits)
