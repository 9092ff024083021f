"""A claim: the statement of a text, its check, and the verdict that the check must reach."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Final

from taylor_verify_reports.claims.check import Check, Residual, Worded, measured
from taylor_verify_reports.claims.claim_row import ClaimResiduals, ClaimRow
from taylor_verify_reports.claims.claim_row import Verdict as Verdict

Change = Check | tuple[str, str]
"""A separate check, or old and new words in the text of the claim's check."""


@dataclass(frozen=True)
class Claim:
    """A numbered equation, or a sentence that claims something.

    ``statement`` (LaTeX) is the text restored, and for a false one the text as transcribed;
    ``domain`` says what the symbols are and where it is meant. ``check`` holds the statement to the
    equations of motion: restored, corrected, or under its condition. ``transcribed`` is the change that
    makes it fail: to the form as transcribed, or to the statement without its condition. ``mutants``
    change one thing each (a sign, a factor, an index); the check rejects them.

    ``lost`` says what the scan lost, ``condition`` when the statement holds, ``gap`` what is left open,
    ``void`` why the statement applies to no motion. ``correction`` is the true form (LaTeX),
    ``counterexample`` a point where the false form fails.
    """

    id: str
    statement: str
    domain: str
    method: str
    check: Check
    mutants: Mapping[str, Change]
    transcribed: Change | None = None
    correction: str | None = None
    counterexample: str | None = None
    lost: str | None = None
    condition: str | None = None
    gap: str | None = None
    void: str | None = None
    remark: str | None = None

    @property
    def verdict(self) -> Verdict:
        """The verdict if every check comes out as this entry says."""
        for reason, verdict in (
            (self.void, Verdict.VACUOUS),
            (self.gap, Verdict.UNDECIDED),
            (self.condition, Verdict.ONLY_IF),
            (self.transcribed, Verdict.FALSE),
            (self.lost, Verdict.RESTORED),
        ):
            if reason:
                return verdict
        return Verdict.HOLDS

    def changed(self, change: Change) -> Check:
        """Return the check of the statement with one thing changed."""
        if not isinstance(change, tuple):
            return change
        if not (isinstance(self.check, Worded) and self.check.says(change[0])):
            raise ValueError(f"expected words of the check, got {change[0]!r} @ {self.id}")
        return self.check.but(*change)


@dataclass(frozen=True)
class Finding:
    """The verdict that a claim gets now, and the residuals that it rests on."""

    claim: Claim
    verdict: Verdict
    statement: Residual
    transcribed: Residual | None = None

    @property
    def is_as_recorded(self) -> bool:
        return self.verdict is self.claim.verdict

    def row(self) -> ClaimRow:
        """Return the entry of the ledger."""
        claim, transcribed = self.claim, self.transcribed
        return ClaimRow(
            **{name: getattr(claim, name) for name in _WORDS},
            open=claim.gap,
            verdict=self.verdict,
            recorded=claim.verdict,
            mutations=tuple(claim.mutants),
            residual=ClaimResiduals(self.statement.size, transcribed.size if transcribed else None),
            bound=self.statement.bound,
            because=self.statement.because,
        )


# The fields that an entry of the ledger copies from the claim.
_WORDS: Final = {field.name for field in fields(Claim)} & {f.name for f in fields(ClaimRow)}


def examine(claim: Claim) -> Finding:
    """Return the verdict of a claim by its checks, whatever is recorded.

    A claim that fails its own check, or whose false form is not clearly missed, is undecided: nothing
    is called true or false for want of a check.
    """
    statement, transcribed = measured(claim.check), None
    verdict = claim.verdict
    if claim.transcribed is not None:
        transcribed = measured(claim.changed(claim.transcribed))
        if transcribed.is_satisfied:
            verdict = Verdict.HOLDS  # the form recorded as false is true
        elif not transcribed.is_refuted:
            verdict = Verdict.UNDECIDED
    if not statement.is_satisfied:
        verdict = Verdict.UNDECIDED
    return Finding(claim, verdict, statement, transcribed)
