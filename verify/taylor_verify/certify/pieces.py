"""A dense answer as polynomials on pieces of time, its coefficients exact."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any, Final

from flint import fmpq, fmpq_poly

from taylor_verify.numbers.irrational import rational
from taylor_verify.records.faults import Faults, Refused, refusal

MOST_DEGREE: Final = 60
_HUGE: Final = 1e100


@dataclass(frozen=True)
class Piece:
    """Polynomials by column, in powers of t - ``begin``, from one time to a later one."""

    begin: Fraction
    end: Fraction
    polynomials: Mapping[str, fmpq_poly]

    def last(self, column: str) -> fmpq:
        """The value of a column at the end of the piece."""
        return sum(self._terms[column], fmpq(0))

    @cached_property
    def _terms(self) -> Mapping[str, list[fmpq]]:
        """The terms of each polynomial at the end of the piece."""
        whole = fmpq_poly([0, rational(self.end - self.begin)])
        return {column: p(whole).coeffs() for column, p in self.polynomials.items()}

    @cached_property
    def sizes(self) -> Mapping[str, list[float]]:
        """The sizes of the terms of each column at the end of the piece."""
        return {name: [abs(nearest(c)) for c in row] for name, row in self._terms.items()}

    @property
    def is_huge(self) -> bool:
        """True for a term whose square no double would have."""
        try:
            return any(size > _HUGE for row in self.sizes.values() for size in row)
        except OverflowError:
            return True

    def shifted(self, begin: Fraction, end: Fraction) -> Piece:
        """The polynomials on a part of the piece."""
        inner = fmpq_poly([rational(begin - self.begin), 1])
        return Piece(begin, end, {name: p(inner) for name, p in self.polynomials.items()})


def finite(value: Fraction | float) -> fmpq:
    """Return a coefficient. Raises Refused for one that is not finite."""
    try:
        return rational(value)
    except (ValueError, OverflowError):
        raise refusal("finite coefficients", value, "answer") from None


def nearest(value: fmpq) -> float:
    return int(value.p) / int(value.q)


def polynomial(coefficients: Iterable[Any], unit: Fraction = Fraction(1)) -> fmpq_poly:
    """Return the polynomial of exact numbers, or of binary ones as they are, in powers of u/unit."""
    entries, power, factor = [], fmpq(1), rational(unit)
    for coefficient in coefficients:
        entries.append(finite(coefficient) / power)
        power *= factor
    return fmpq_poly(entries)


@dataclass(frozen=True)
class Pieces:
    """Pieces in the order of time, which do not overlap; all have the same columns."""

    each: Sequence[Piece]

    @classmethod
    def of(cls, pieces: Iterable[Piece]) -> Pieces:
        """Return the pieces, sorted. Raises Refused for pieces that overlap, and degrees over sixty."""
        every = sorted(pieces, key=lambda piece: piece.begin)
        faults = Faults()
        if not every:
            faults.add("one piece at least", "none", "answer")
        for k, piece in enumerate(every):
            if not piece.begin < piece.end:
                faults.add("breaks that rise", f"{float(piece.begin):g}", f"breaks[{k}]")
            degree = max((p.degree() for p in piece.polynomials.values()), default=0)
            if degree > MOST_DEGREE:
                faults.add(f"degrees of at most {MOST_DEGREE}", str(degree), f"piece {k}")
            elif piece.begin < piece.end and piece.is_huge:
                faults.add("terms below 1e100", "a larger one", f"piece {k}")
        rise = all(piece.begin < piece.end for piece in every)
        for k, (before, after) in enumerate(pairwise(every)):
            if rise and after.begin < before.end:
                got = f"two at t = {float(after.begin):g}"
                faults.add("pieces that do not overlap", got, f"piece {k + 1}")
        if faults.lines:
            raise Refused(faults.lines)
        return cls(every)

    @property
    def columns(self) -> list[str]:
        return list(self.each[0].polynomials)

    def between(self, begin: Fraction, end: Fraction) -> Sequence[Piece]:
        """The pieces that have a part of a span."""
        first = max(0, bisect_right(self.each, begin, key=lambda piece: piece.begin) - 1)
        last = bisect_right(self.each, end, key=lambda piece: piece.begin)
        return [p for p in self.each[first:last] if p.end > begin and p.begin < end]


def merged(answers: Sequence[Pieces]) -> Pieces:
    """Return the pieces of several answers as one, on the times that all of them have."""
    if len(answers) == 1:
        return answers[0]
    breaks = sorted({t for a in answers for p in a.each for t in (p.begin, p.end)})
    every = []
    for begin, end in pairwise(breaks):
        parts = [part for a in answers for part in a.between(begin, end)]
        if len(parts) == len(answers):
            polynomials: dict[str, fmpq_poly] = {}
            for part in parts:
                polynomials |= part.shifted(begin, end).polynomials
            every.append(Piece(begin, end, polynomials))
    return Pieces.of(every)
