"""Errors that the file's format explains: its printed digits, float32, another convention.

u is half a unit in the last printed place of the largest component, or 2^-24 for float32. Storing one row
changes a vector of three components by at most sqrt(3) u of the largest component, a quaternion by 2 u, so
the attitude by 4 u radians, and a conserved quantity by u times its gradient, which the reason contains.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from math import inf, sqrt
from typing import Final

import numpy as np

from taylor_verify.judge.causes.last_place import relative_unit
from taylor_verify.judge.conventions.fits import Finding
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.judge.judgement import Judgement
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.precisions import bits_of
from taylor_verify.records.quantities import (
    CONSERVED,
    GROUPS,
    SOUND_ATTITUDE,
    STATES,
    changed_by,
)
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.files.single_precision import are_single_precision
from taylor_verify.solvers.trajectory import Trajectory

# A file with this many digits less than the rung is truncated.
_SPARE_DIGITS: Final = 2
_SINGLE_BITS: Final = bits_of("f32")
_VECTOR: Final = sqrt(3)
_ATTITUDE: Final = 4.0
# Both the row and the start of a conserved quantity are rounded.
_GRADIENT: Final = 2 * _VECTOR
# The quantities that a convention changes, by subject; a map of time changes no conserved quantity.
_CHANGED: Final = {
    "time": STATES,
    "body": (*STATES, *CONSERVED),
    "axes": (*STATES, *CONSERVED),
    **{group: changed_by(group) for group in GROUPS},
}
# A shift after which at most this many times as much remains is the finding about the clock.
_AS_WELL: Final = 1e6
_SHIFTED: Final = (ErrorKind.TIME_SHIFT, ErrorKind.PHASE_DRIFT)


@dataclass(frozen=True)
class Storing:
    """The truncation of a file's numbers: the kind of error, its u, and a sentence."""

    kind: ErrorKind
    u: float
    note: str


def storing(file: TrajectoryFile, rung: Rung) -> Storing | None:
    """Return the truncation of a file's numbers; None if they have all digits of the rung."""
    if note := single_precision_note(rung, lambda: file.is_single_precision):
        printed = 0.0 if file.digits is None else 0.5 * 10.0 ** (1 - file.digits)
        return Storing(ErrorKind.SINGLE, 2.0**-_SINGLE_BITS + printed, note)
    digits, needed = file.digits, truth_digits(rung.bits, more=1)
    if digits is None or digits >= needed - _SPARE_DIGITS:
        return None
    note = (
        f"no number is written with more than {digits} significant digits, where "
        f"{rung.name} has {needed}: what the printing cut off counts as error"
    )
    return Storing(ErrorKind.PRINTED, relative_unit(file), note)


def single_precision_note(rung: Rung, is_single: Callable[[], bool]) -> str:
    """Return the note on an answer in float32 numbers; empty for others, and for a rung as narrow."""
    if rung.bits <= _SINGLE_BITS or not is_single():
        return ""
    return (
        f"every number is one of float32, where {rung.name} has {rung.bits} bits: what the storing cut off "
        "counts as error; if float32 arithmetic made these numbers, judge them on f32 (--rung f32)"
    )


def with_note_of_answer(judged: Judgement, rung: Rung, answer: Trajectory) -> Judgement:
    """Return the judgement of a solver's answer that failed, with a note if its numbers are float32."""
    if not any(verdict.verdict is Status.FAIL for verdict in judged.verdicts):
        return judged
    doubles = [np.array(rows, dtype=float) for rows in answer.quantities.values()]
    columns = [(column, column) for rows in doubles for column in rows.reshape(len(rows), -1).T]
    note = single_precision_note(rung, lambda: are_single_precision(columns))
    return replace(judged, notes=(*judged.notes, note)) if note else judged


def with_file_kinds(
    verdicts: Iterable[Verdict], file: TrajectoryFile, rung: Rung, findings: Sequence[Finding]
) -> tuple[Verdict, ...]:
    """Return the verdicts, with the kind of error changed where the file explains the error.

    ``findings`` are the conventions that were not corrected.
    """
    verdicts = tuple(verdicts)
    if not any(_is_open(verdict) for verdict in verdicts):
        return verdicts
    stored, certain = storing(file, rung), [finding for finding in findings if finding.is_certain]
    changed = {name for finding in certain for name in _CHANGED[finding.subject]}
    # The error after the map of time.
    left = next((finding.after for finding in certain if finding.subject == "time"), inf)
    diagnosed = []
    for verdict in verdicts:
        kind = _kind(verdict, stored, changed, left)
        is_own = kind is verdict.error_kind
        diagnosed.append(verdict if is_own else replace(verdict, error_kind=kind, exponent=None))
    return tuple(diagnosed)


def _is_open(verdict: Verdict) -> bool:
    """Return True for an error that roundoff does not explain."""
    return verdict.is_compared and verdict.error_kind is not ErrorKind.ROUNDOFF


def _kind(
    verdict: Verdict, stored: Storing | None, changed: set[str], left: float
) -> ErrorKind | None:
    kind = verdict.error_kind
    if not _is_open(verdict):
        return kind
    largest = inf if verdict.max is None else verdict.max
    if stored is not None and largest <= _left_by_storing(verdict) * stored.u:
        return stored.kind
    if kind not in _SHIFTED:
        return ErrorKind.CONVENTION if verdict.quantity in changed else kind
    is_explained = verdict.remains is None or verdict.remains <= _AS_WELL * left
    return kind if is_explained else ErrorKind.CONVENTION


def _left_by_storing(verdict: Verdict) -> float:
    """Return the largest error that storing a row leaves, in units of u."""
    if verdict.unit == "rad":
        return _ATTITUDE
    if not verdict.is_conserved or verdict.quantity in SOUND_ATTITUDE:
        return _VECTOR
    floor = verdict.reason.floor
    return 0.0 if floor is None or floor.growth is None else _GRADIENT * floor.growth
