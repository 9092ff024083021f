"""The error of pieces against the enclosed motion, as polynomials on the intervals that both have.

On an interval t = middle + half v, |v| <= 1, the error of a column is a polynomial in v and a bound of what
it is off by: the truth's own error, and the rounding of the coefficients to float64.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np
from flint import arb, arb_poly

from taylor_verify.certify.pieces import Piece, Pieces, nearest
from taylor_verify.exact.as_written import as_written
from taylor_verify.exact.enclosure.along import Part
from taylor_verify.exact.event_times import parts_of, system
from taylor_verify.numbers.irrational import rational
from taylor_verify.numbers.rotation import conjugate, product
from taylor_verify.records.quantities import COLUMNS, Measure, Quantity
from taylor_verify.scenes.reading.event import loads_of
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]
QUATERNION: Final = COLUMNS["quaternion"]
ROTATION: Final = COLUMNS["attitude"]
# Coefficients that are together below this share of a polynomial are a part of its bound.
_NEGLIGIBLE: Final = 2.0**-36
# A rounding to float64, and what keeps squares from underflow.
_ROUNDED: Final = 2.0**-50
_LEAST: Final = 1e-140
_SHARES: Final = tuple(arb(k) / 8 for k in range(9))
# The parts of a step from whose beginnings on a state that begins at zero has a size so far, which grows by
# little within each: from a millionth of the step to its end.
_FINER: Final = (Fraction(0), *(Fraction((15 / 16) ** k) for k in range(214, -1, -1)))


class Measured(NamedTuple):
    """A group of columns of a quantity, which has a scale of its own."""

    quantity: Quantity
    columns: Sequence[str]


def measured_of(scene: Scene, columns: Sequence[str]) -> tuple[list[Measured], list[Quantity]]:
    """Return what a scene tracks and the columns have, quantity by quantity, and what they lack."""
    known = {name: group.columns for name, group in scene.known_groups.items()}
    measured, missing = list[Measured](), []
    for quantity in scene.tracked:
        groups = [known[name] for name in quantity.groups]
        if quantity.measure is Measure.ANGLE and not set(QUATERNION) <= set(columns):
            groups = [ROTATION]
        if all(column in columns for group in groups for column in group):
            measured += [Measured(quantity, group) for group in groups]
        else:
            missing.append(quantity)
    return measured, missing


@dataclass
class Interval:
    """Errors on one interval of time, by group: a row of coefficients for each component, and bounds."""

    middle: float
    half: float
    rows: Floats
    beside: Floats
    scale: float = 1.0


@dataclass
class Errors:
    """The intervals of one group of columns, and how large the truth is: at most, and along its way."""

    quantity: Quantity
    columns: Sequence[str]
    intervals: list[Interval] = field(default_factory=list)
    largest: float = 0.0
    way: float = 0.0
    last: list[arb] | None = None

    @property
    def scale(self) -> float:
        """The size by which errors are counted; 1 where nothing moves."""
        sizes = {Measure.VECTORS: self.largest, Measure.PATH: self.way}
        return sizes.get(self.quantity.measure) or 1.0


def errors_of(
    scene: Scene, pieces: Pieces, measured: Sequence[Measured], until: Fraction, bits: int
) -> list[Errors]:
    """Return the errors of each group of columns between the start of a scene and a time.

    At the ambient precision. Raises Coarse, Unreached and Domain.
    """
    columns = [column for each in measured for column in each.columns]
    loads = replace(loads_of(scene), functions=tuple(columns))
    begin = scene.clock.start
    motion = system(as_written(scene), loads, until - begin, orders=0)
    errors = [Errors(*each) for each in measured]
    for part in parts_of(motion, until - begin, begin, bits):
        _Part(part, begin, columns).add(pieces, errors)
    return errors


class _Part:
    """A part of the enclosed motion."""

    def __init__(self, part: Part, origin: Fraction, columns: Sequence[str]) -> None:
        self._begin, self._length = origin + part.begin, part.length
        self._functions = dict(zip(columns, part.functions, strict=True))
        self._polynomials = {c: arb_poly(list(f.polynomial)) for c, f in self._functions.items()}

    def add(self, pieces: Pieces, errors: Sequence[Errors]) -> None:
        for each in errors:
            self._measure(each, _SHARES[:1])
        low, high = sorted((self._begin, self._begin + self._length))
        for piece in pieces.between(low, high):
            a, b = max(low, piece.begin), min(high, piece.end)
            for each in errors:
                for c, d, size in self._sized(each, a, b):
                    each.intervals.append(self._interval(piece, each.columns, c, d, size))
        # What comes later in this part is no size so far of its intervals.
        for each in errors:
            self._measure(each, _SHARES[1:])

    def _measure(self, errors: Errors, shares: Sequence[arb]) -> None:
        """Bound how large the truth is, from below, by its values at a few times."""
        for share in shares:
            values = [self._functions[column].over(share) for column in errors.columns]
            errors.largest = max(errors.largest, _length_from_below(values))
            if errors.last is not None:
                errors.way += _length_from_below(
                    [v - w for v, w in zip(values, errors.last, strict=True)]
                )
            errors.last = values

    def _sized(
        self, so_far: Errors, a: Fraction, b: Fraction
    ) -> Iterator[tuple[Fraction, Fraction, float]]:
        """Yield the parts of an interval, each with the size by which its errors count.

        That of an own state is its largest so far, at the beginning of the part. One that begins at zero
        has none there: a millionth of the step counts by the size at its end.
        """
        counts = so_far.quantity.measure is Measure.SO_FAR
        if not counts or so_far.largest:
            yield a, b, so_far.largest if counts else 1.0
            return
        size = 0.0
        for begin, end in pairwise(_FINER):
            at = begin or end
            share = arb(at.numerator) / at.denominator
            values = [self._functions[column].over(share) for column in so_far.columns]
            size = max(size, _length_from_below(values))
            ends = sorted(self._begin + self._length * part for part in (begin, end))
            low, high = max(a, ends[0]), min(b, ends[1])
            if low < high:
                yield low, high, size or 1.0

    def _interval(
        self, piece: Piece, group: Sequence[str], a: Fraction, b: Fraction, scale: float
    ) -> Interval:
        middle, half = rational(a + b) / 2, rational(b - a) / 2
        begin, length = rational(self._begin), rational(self._length)
        ours = arb_poly([arb((middle - begin) / length), arb(half / length)])
        theirs = arb_poly([arb(middle - rational(piece.begin)), arb(half)])
        truth = [self._polynomials[c](ours) for c in group]
        answer = [arb_poly(piece.polynomials[c])(theirs) for c in group]
        beside = [self._functions[c].beside for c in group]
        if tuple(group) == QUATERNION:
            differences, beside, scale = _turned(truth, answer, beside)
        else:
            differences = [y - z for y, z in zip(answer, truth, strict=True)]
        rows, bounds = _rounded(differences, beside)
        return Interval(nearest(middle), nearest(half), rows, bounds, scale)


def _length_from_below(values: Sequence[arb]) -> float:
    """A lower bound of the length of a vector."""
    squares = sum((value.abs_lower() ** 2 for value in values), arb(0))
    return float(squares.sqrt().lower()) * (1 - _ROUNDED)


def _turned(
    truth: Sequence[arb_poly], answer: Sequence[arb_poly], beside: Sequence[arb]
) -> tuple[list[arb_poly], list[arb], float]:
    """The vector part of q* p for the true quaternion q and the answer p, and the least scalar part.

    The turn between both frames is 2 atan of their quotient.
    """
    scalar, *vector = product(conjugate(truth), answer)
    length = sum((_size(p) for p in answer), arb(0))
    missed = (sum(beside, arb(0)) * length).abs_upper()
    entries = scalar.coeffs() or [arb(0)]
    rest = sum((e.abs_upper() for e in entries[1:]), missed)
    least = float((entries[0].abs_lower() - rest).lower())
    return vector, [missed] * 3, max(least, 0.0)


def _size(polynomial: arb_poly) -> arb:
    return sum((entry.abs_upper() for entry in polynomial.coeffs()), arb(0))


def _rounded(polynomials: Sequence[arb_poly], beside: Sequence[arb]) -> tuple[Floats, Floats]:
    """The coefficients that count in float64, and bounds of all that these leave out."""
    coefficients = [p.coeffs() or [arb(0)] for p in polynomials]
    sizes = [[float(e.abs_upper()) for e in row] for row in coefficients]
    count = max(_counting(row) for row in sizes)
    rows, bounds = np.zeros((len(sizes), count)), np.zeros(len(sizes))
    for i, (row, size) in enumerate(zip(coefficients, sizes, strict=True)):
        leading = row[:count]
        rows[i, : len(leading)] = [float(e.mid()) for e in leading]
        radii = sum((e.rad() for e in leading), beside[i])
        bounds[i] = float(arb(radii).abs_upper()) + sum(size[count:]) + _ROUNDED * sum(size)
    return rows, bounds * (1 + _ROUNDED) + _LEAST


def _counting(sizes: Sequence[float]) -> int:
    """The number of coefficients that count."""
    left, rest, least = len(sizes), 0.0, _NEGLIGIBLE * sum(sizes)
    while left > 1 and rest + sizes[left - 1] <= least:
        left -= 1
        rest += sizes[left]
    return left


def between(pieces: Pieces, begin: Fraction, end: Fraction) -> Iterator[tuple[Fraction, Fraction]]:
    """Yield the parts of a span that no piece covers."""
    reached = begin
    for piece in pieces.between(begin, end):
        if piece.begin > reached:
            yield reached, piece.begin
        reached = max(reached, piece.end)
    if reached < end:
        yield reached, end
