"""The sentence with which every report begins: the verdict, the likely cause, the worst row."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Final

from taylor_verify.records.answers import LikelyCause
from taylor_verify.records.status import GRAVITY, Status, gravest
from taylor_verify.records.verdict import Verdict

# A longer title is cut here in the sentence.
_LONGEST: Final = 120


def opening(verdicts: Sequence[Verdict], causes: Sequence[LikelyCause] = ()) -> str:
    """Return one sentence: the gravest status, the likely causes, and the worst row.

    The row of one of several runs begins with its scene and rung.
    """
    if not verdicts:
        return "nothing was judged"
    # What this machine has no numbers for hides no verdict on the rest.
    known = [v for v in verdicts if v.verdict is not Status.UNAVAILABLE] or [*verdicts]
    status = gravest(verdict.verdict for verdict in known)
    names = " and ".join(dict.fromkeys(map(_title, causes)))
    cause = f", likely cause: {names}" if names else ""
    where = "nearest to its bound" if status is Status.PASS else "worst"
    row, unknown = worst(known), len(verdicts) - len(known)
    but = (
        f", {unknown} row{'s' * (unknown > 1)} unavailable"
        if unknown and status is Status.PASS
        else ""
    )
    is_one_run = len({(verdict.scene, verdict.rung) for verdict in verdicts}) == 1
    place = "" if is_one_run else f"{row.scene} {row.rung} "
    return f"{status.value}{cause}{but}; {where}: {place}{row.sentence}"


def _title(cause: LikelyCause) -> str:
    """Return the cause without what it leaves, and without the end of a long list of numbers."""
    title = cause.sentence.partition("; leaves")[0].partition("; not told")[0]
    if len(title) <= _LONGEST:
        return title
    return f"{title[:_LONGEST].rpartition(' ')[0].rstrip(',')} ..."


def worst(verdicts: Sequence[Verdict]) -> Verdict:
    """Return the row of the gravest status whose error is largest beside its bound."""
    return min(verdicts, key=lambda verdict: (GRAVITY.index(verdict.verdict), -_excess(verdict)))


def _excess(verdict: Verdict) -> float:
    """Return what decides the row: the error over the tolerance, or else over the roundoff floor."""
    if verdict.max is None or verdict.max != verdict.max:
        return inf
    if verdict.tolerance is None and verdict.ratio is not None:
        return verdict.ratio
    return verdict.max / verdict.bound if verdict.bound else verdict.max
