"""The ``[manufactured]`` table of a scene becomes a motion in exact coefficients.

A vector is written as an array of terms, each { frequency = nu, cosine = [..], sine = [..] } and meaning
cosine cos(nu t) + sine sin(nu t), with t since the start; frequency 0 is the constant part.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import chain
from typing import Final

from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.records.faults import shown
from taylor_verify.scenes.loads.manufactured import Manufactured, Wave
from taylor_verify.scenes.reading.table import Table, complete

# A frequency has one digit in the names of the equations' parameters.
MOST_FREQUENCIES: Final = 9

# The coefficients of cosine and sine by frequency.
_Terms = Mapping[Fraction, tuple[Vector, Vector]]


def manufactured(table: Table, vectors: Sequence[str]) -> Manufactured | None:
    """Return the motion of these vectors, one after the other; None after a fault."""
    read = complete([_terms(table, name) for name in vectors])
    if read is None:
        return None
    frequencies = sorted(set().union(*read) - {Fraction(0)})
    if len(frequencies) > MOST_FREQUENCIES:
        table.fault(f"at most {MOST_FREQUENCIES} frequencies", str(len(frequencies)))
        return None

    def amplitudes(frequency: Fraction) -> tuple[Vector, Vector]:
        pairs = [terms.get(frequency, (ZERO_VECTOR, ZERO_VECTOR)) for terms in read]
        cosines, sines = zip(*pairs, strict=True)
        return tuple(chain(*cosines)), tuple(chain(*sines))

    constant, _ = amplitudes(Fraction(0))
    return Manufactured(constant, tuple(Wave(nu, *amplitudes(nu)) for nu in frequencies))


def _terms(table: Table, name: str) -> _Terms | None:
    """Return the terms of one vector by frequency; a frequency that occurs twice is a fault."""
    entries = table.tables(name)
    waves: dict[Fraction, tuple[Vector, Vector]] = {}
    is_sound = entries is not None
    for entry in entries or ():
        term = _term(entry)
        if term is not None and term[0] in waves:
            expected = "a frequency that no term before has"
            entry.fault(expected, shown(term[0]), "frequency", "write one term for it")
            term = None
        if term is None:
            is_sound = False
        else:
            waves[term[0]] = term[1:]
    return waves if is_sound else None


def _term(entry: Table) -> tuple[Fraction, Vector, Vector] | None:
    """Return frequency, cosine and sine of one term; a missing cosine or sine is zero."""
    frequency = entry.number("frequency")
    written = entry.has("cosine") or entry.has("sine")
    cosine = entry.vector("cosine", default=ZERO_VECTOR)
    sine = entry.vector("sine", default=ZERO_VECTOR)
    entry.close()
    if not written:
        entry.fault("`cosine` or `sine`", "neither of them")
        return None
    if frequency is not None and frequency < 0:
        entry.fault("a frequency of 0 or more", shown(frequency), "frequency")
        return None
    if frequency == 0 and sine is not None and any(sine):
        entry.fault("no sine of frequency 0", shown(list(sine)), "sine", "sin 0 = 0: remove it")
        return None
    if frequency is None or cosine is None or sine is None:
        return None
    return frequency, cosine, sine
