"""Hypothesis that a state was stored in float32 inside wider arithmetic.

The numbers of such an answer are float32 numbers. Writing the file in float32 has the same effect, so
three more conditions must hold. The defects from row to row have the size of float32 roundings. They are
independent of each other; the roundings of a written file are not, because the rounding of one row enters
the next defect with the other sign. And the errors add up to more than one rounding of a row.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Candidate, Material, Pairs
from taylor_verify.records.precisions import bits_of
from taylor_verify.scenes.instants import evenly

_BITS: Final = bits_of("f32")
_ROUNDOFF: Final = 2.0**-_BITS
# Numbers with fewer bits than this are small integers or simple fractions in any precision.
_TELLING: Final = 2.0**18
# Bound of the error of a sum of a few products in float64, relative to its largest term.
_FLOAT64: Final = 2.0**-49
# The largest number of neighbouring pairs that are used, and the smallest that can show independence.
_MOST_PAIRS: Final = 400
_FEWEST_PAIRS: Final = 40
# The size of a defect in roundoffs lies between these limits: it is a sum of a few to many roundings.
_LEAST: Final = 0.25
_MOST: Final = 32.0
# The correlation of neighbouring defects is 0 if independent, -1/2 for stored roundings, near 1 for a
# method's truncation. This many standard errors of the correlation are allowed.
_ERRORS: Final = 3.0
_STORED: Final = -0.5
# The error must exceed this many roundoffs; stored roundings stay below one.
_ADDED_UP: Final = 4.0


def single_precision(material: Material) -> Iterator[Candidate]:
    """Yield the candidate if all conditions hold; it leaves the part that is not independent roundings."""
    if material.bits <= _BITS or material.quantity not in material.failed:
        return
    verdict = material.failed[material.quantity]
    if (
        not any(map(_are_float32, _stored_numbers(material)))
        or not (verdict.max or 0.0) > _ADDED_UP * _ROUNDOFF
    ):
        return
    known = np.flatnonzero(np.all(np.isfinite(material.states), axis=1))
    if len(known) < len(material.states) or len(known) < _FEWEST_PAIRS + 2:
        return
    first = np.arange(len(known) - 2)
    first = first[evenly(len(first), _MOST_PAIRS)]
    earlier, later = material.at(first), material.at(first + 1)
    sizes = later.sizes
    before, after = earlier.defect / sizes, later.defect / sizes
    size = float(np.sqrt(np.mean(np.sum(after**2, axis=1))))
    if not _LEAST * _ROUNDOFF <= size <= _MOST * _ROUNDOFF:
        return
    carried = (later.flow - _moved_back(later, earlier.defect)) / sizes
    correlation = float(np.sum(carried * after) / np.sqrt(np.sum(before**2) * np.sum(after**2)))
    allowed = _ERRORS / np.sqrt(len(first))
    if not abs(correlation) <= min(allowed, abs(_STORED) / 2):
        return
    why = (
        "the state was kept in float32: all its numbers are float32 numbers, and what it is off by from "
        f"row to row is {size / _ROUNDOFF:.2g} roundings of 24 bits, independent of the row before"
    )
    yield Candidate("float32 inside", material.quantity, correlation**2, why, fitted=0)


def _stored_numbers(material: Material) -> Iterator[Floats]:
    """Yield the numbers that may have been stored in float32: the columns, and the momentum I omega.

    The row at the start is left out, because it may be a copy of the scene's state.
    """
    yield (material.states if material.columns is None else material.columns)[1:]
    if material.equations.is_rigid:
        yield material.states[1:] @ material.equations.tensor


def _are_float32(numbers: Floats) -> bool:
    """Return True if every number is a float32 number up to float64's rounding, and not by chance."""
    single = numbers.astype(np.float32).astype(float)
    sizes = np.max(np.abs(numbers), axis=1, keepdims=True)
    if not np.all(np.abs(single - numbers) <= _FLOAT64 * sizes):
        return False
    mantissas = np.abs(np.frexp(single)[0]) * _TELLING
    return bool(np.any(mantissas != np.floor(mantissas)))


def _moved_back(later: Pairs, defect: Floats) -> Floats:
    """Return the second rows that would follow if the first rows had no defects."""
    return replace(later, begin=later.begin - defect).flow
