"""Every printed number against the referee's own, component by component.

A comparison is decided by an interval: the referee knows each number up to an error. If an answer is
neither right for certain nor wrong for certain, the referee sharpens its own numbers and looks again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any, Final, NamedTuple

import gmpy2
from gmpy2 import log2, mpfr, sqrt

from referee.bodies import read_scene
from referee.motion import Known, Row, motion

# Digits that the first two runs have beyond those printed; a motion that loses more is run again.
_SPARE_DIGITS: Final = 6
_MOST_BITS: Final = 6000
_BITS_A_DIGIT: Final = float(log2(10))


class Undecided(Exception):
    """The referee's own error is too large for a verdict."""


class Fault(NamedTuple):
    """A printed number that is wrong, with all that is needed to look again."""

    t: str
    quantity: str
    component: str
    reason: str
    printed: str
    right: str

    def __str__(self) -> str:
        place = f"{self.quantity}{self.component} at t = {self.t}"
        return f"{place}: {self.reason}\n  printed {self.printed}\n  right   {self.right}"


def faults(
    text: str, times: Sequence[str], digits: int, document: Mapping[str, Any]
) -> list[Fault]:
    """Return what is wrong in a document of `exact --json` about this scene."""
    bits = int((digits + _SPARE_DIGITS) * _BITS_A_DIGIT)
    while bits <= _MOST_BITS:
        rows = motion(text, [Fraction(t) for t in times], bits)
        try:
            with gmpy2.context(precision=2 * bits):
                return list(_faults(text, times, digits, document, rows))
        except Undecided:
            bits += bits // 2
    return [Fault("", "", "", f"no verdict with {bits} bits", "", "")]


def _faults(
    text: str, times: Sequence[str], digits: int, document: Mapping[str, Any], rows: Sequence[Row]
) -> Iterator[Fault]:
    """Yield the faults of each row, and rows and quantities that are not those asked for."""
    tracked = read_scene(text).tracked
    printed_times = [row["t"] for row in document["rows"]]
    if printed_times != list(times):
        yield Fault(
            "", "t", "", "the rows are not at the times asked for", str(printed_times), str(times)
        )
        return
    for printed, row in zip(document["rows"], rows, strict=True):
        names = sorted(set(printed) - {"t", "radius", "absolute"})
        if names != sorted(tracked):
            yield Fault(
                printed["t"], "", "", "not the tracked quantities", str(names), str(tracked)
            )
            continue
        for name in tracked:
            yield from _vector_faults(printed, name, row[name], digits)


def _vector_faults(
    printed: Mapping[str, Any], name: str, right: Sequence[Known], digits: int
) -> Iterator[Fault]:
    """Yield the wrong components of one vector or matrix, and a radius that does not hold."""
    values = _flat(printed[name])
    if len(values) != len(right):
        yield Fault(printed["t"], name, "", "not so many components", str(values), str(right))
        return
    # All that is not zero has the digits asked for, as parts of the vector.
    coarsest = mpfr(10) ** (1 - digits) * _norm([known.value for known in right])
    absolute = printed.get("absolute", {}).get(name)
    for k, (value, known) in enumerate(zip(values, right, strict=True)):
        if reason := _wrong(value, known, coarsest, absolute, any(map(Decimal, values))):
            component = f"[{k}]" if len(values) == 3 else f"[{k // 3}][{k % 3}]"
            yield Fault(printed["t"], name, component, reason, value, str(known))
    if any(map(Decimal, values)) and (reason := _radius_fault(printed, values, right, digits)):
        yield Fault(printed["t"], name, "", reason, printed["radius"], "")


def _wrong(
    printed: str, known: Known, coarsest: Any, absolute: str | None, has_others: bool
) -> str | None:
    """Return the reason for which a printed number is wrong; None if it is right."""
    if Decimal(printed):
        unit = mpfr(10) ** int(Decimal(printed).as_tuple().exponent)
        if not unit <= coarsest:
            return "fewer digits than were asked for"
        distance = abs(known.value - _exact(printed))
        return (
            None
            if _is_below(distance, known.error, unit)
            else "more than one unit of the last digit"
        )
    if absolute is None:
        return (
            None if _is_zero(known, coarsest) else "not zero, and no bound of its size is printed"
        )
    if has_others and not _exact(absolute) <= coarsest:
        return "its bound as a zero is too large to say anything"
    is_bounded = _is_below(abs(known.value), known.error, _exact(absolute))
    return None if is_bounded else "larger than the bound that is printed"


def _is_zero(known: Known, coarsest: Any) -> bool:
    """Return True if the referee cannot tell the number from zero by all the digits that it has."""
    return bool(abs(known.value) <= known.error <= coarsest / 2**10)


def _is_below(size: Any, error: Any, bound: Any) -> bool:
    """Return True if a size, known up to an error, is at most the bound. Raises Undecided if it may be."""
    if size + error <= bound:
        return True
    if size - error <= bound:
        raise Undecided
    return False


def _radius_fault(
    printed: Mapping[str, Any], values: Sequence[str], right: Sequence[Known], digits: int
) -> str | None:
    """Return the reason for which a radius is wrong: it must bound the distance, and say something."""
    radius = _exact(printed["radius"])
    if not radius <= mpfr(10) ** (1 - digits):
        return "a radius larger than one unit of the last digit asked for"
    distance = _norm([k.value - _exact(text) for k, text in zip(right, values, strict=True)])
    error = _norm([known.error for known in right])
    size = _norm([known.value for known in right])
    if _is_below(distance, error * (1 + radius), radius * size):
        return None
    return f"a radius smaller than the error, which is {distance / size:.2g}"


def _flat(values: Sequence[Any]) -> list[str]:
    """Return the entries of a vector, or of a matrix row by row."""
    return [text for entry in values for text in (entry if isinstance(entry, list) else [entry])]


def _exact(text: str | Decimal) -> Any:
    """Return a decimal text at the ambient precision, which is more than it has."""
    return mpfr(Fraction(text))


def _norm(values: Sequence[Any]) -> Any:
    """Return the Euclidean norm of a vector, the Frobenius norm of a matrix."""
    return sqrt(sum(value * value for value in values))
