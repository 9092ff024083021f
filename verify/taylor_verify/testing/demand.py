"""Verdicts that a test asks for, and the report on those that are no pass."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Final

from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.faults import brief
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.account import account

Only = str | Collection[str] | None

CONSERVED: Final = "conserved"


def demanded_rows(judgement: Judgement, only: Only = None) -> list[Verdict]:
    """Return the verdicts that a test asks for, at least one.

    ``only`` are the quantities asked for, or ``conserved`` for all conserved ones. If the judgement was not
    compared with the exact motion, all its verdicts are returned. Raises ValueError for a quantity that
    the scene does not have.
    """
    verdicts = list(judgement.verdicts)
    if judgement.record is None or only is None:
        return verdicts
    if only == CONSERVED:
        return [verdict for verdict in verdicts if verdict.is_conserved]
    if not isinstance(only, str) and not (
        isinstance(only, Collection) and all(isinstance(name, str) for name in only)
    ):
        raise ValueError(f"expected names of quantities, got {brief(only)} @ only")
    wanted = [only] if isinstance(only, str) else list(only)
    known = [*(verdict.quantity for verdict in verdicts), CONSERVED]
    unknown = [name for name in wanted if name not in known]
    if unknown or not wanted:
        got = ", ".join(unknown) or "nothing"
        raise ValueError(f"expected some of {', '.join(known)}, got {got} @ only")
    return [verdict for verdict in verdicts if verdict.quantity in wanted]


def is_met(verdict: Verdict) -> bool:
    """Return True for a pass; undecided, vacuous, refused and unavailable are none."""
    return verdict.verdict is Status.PASS


def report(judgement: Judgement, demanded: Sequence[Verdict]) -> str:
    """Return the text on the demanded verdicts, with what they were compared with."""
    some, record = judgement.verdicts[0], judgement.record
    unmet = sum(not is_met(verdict) for verdict in demanded)
    run = f"{some.solver} on {some.scene}, {some.rung}"
    if record is not None:
        run += (
            f", against the exact motion of the same rounded data ({record.route}, {record.regime})"
        )
    run += f": {unmet} of {len(demanded)} judged quantities are no pass"
    return "\n".join(account(demanded, judgement.causes, judgement.notes, run))
