"""A claim: what a text says, how that is checked, and the verdict that the check must reach."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from taylor_verify.claims.document import ClaimResiduals, ClaimRow
from taylor_verify.claims.document import Verdict as Verdict

# What is called false must miss its bound by more than any carelessness in the bound could explain.
_CLEARLY: Final = 1e6


@dataclass(frozen=True)
class Residual:
    """How far apart the two sides of a statement are, and how far apart they may be.

    ``size`` and ``bound`` have the unit of the statement, or are relative where ``because`` says so.
    A bound of zero belongs to an identity that is expanded in exact rationals: there ``size`` is
    zero for an identity, and else the difference of the sides at a stated rational point.
    """

    size: float
    bound: float
    because: str

    @property
    def is_satisfied(self) -> bool:
        """Written so that a NaN is not."""
        return self.size <= self.bound

    @property
    def is_refuted(self) -> bool:
        """Clearly missed; a NaN refutes nothing."""
        return self.size > _CLEARLY * self.bound


Check = Callable[[], Residual]


@dataclass(frozen=True)
class Claim:
    """One numbered equation, or one sentence that claims something.

    ``statement`` (LaTeX) is the text restored, and for a false one the text as transcribed;
    ``domain`` says what the symbols are and where it is meant. ``check`` holds the statement to the
    equations of motion: restored, corrected, or under its condition. ``transcribed`` is the check
    of what must fail: the form as transcribed, or the statement without its condition. ``mutants``
    are the statement with one thing changed each (a sign, a factor, an index); the check rejects them.

    ``lost`` says what the scan lost, ``condition`` under what the statement holds, ``gap`` what is
    left open, ``void`` why nothing is said of any motion; ``correction`` is the true form (LaTeX),
    ``counterexample`` where the false one fails.
    """

    id: str
    statement: str
    domain: str
    method: str
    verdict: Verdict
    check: Check
    mutants: Mapping[str, Check]
    transcribed: Check | None = None
    correction: str | None = None
    counterexample: str = ""
    lost: str = ""
    condition: str = ""
    gap: str = ""
    void: str = ""
    remark: str = ""


@dataclass(frozen=True)
class Finding:
    """What examining a claim gave: the verdict it gets now, and the residuals it rests on."""

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
            id=claim.id,
            statement=claim.statement,
            domain=claim.domain,
            verdict=self.verdict,
            recorded=claim.verdict,
            correction=claim.correction,
            condition=claim.condition or None,
            lost=claim.lost or None,
            open=claim.gap or None,
            void=claim.void or None,
            counterexample=claim.counterexample or None,
            method=claim.method,
            mutations=tuple(claim.mutants),
            residual=ClaimResiduals(
                self.statement.size, None if transcribed is None else transcribed.size
            ),
            bound=self.statement.bound,
            because=self.statement.because,
            remark=claim.remark or None,
        )


def worse(*residuals: Residual) -> Residual:
    """The one that says most: a NaN, else one that misses its bound, else the largest."""
    return max(residuals, key=lambda r: (r.size != r.size, not r.is_satisfied, r.size))


def examine(claim: Claim) -> Finding:
    """Run the checks of a claim and say what they make of it, whatever is recorded.

    A claim that fails its own check, or whose false form is not clearly missed, is undecided: nothing
    is called true or false for want of a check.
    """
    statement = measured(claim.check)
    transcribed = measured(claim.transcribed) if claim.transcribed is not None else None
    return Finding(claim, _verdict(claim, statement, transcribed), statement, transcribed)


def measured(check: Check) -> Residual:
    """What a check gives; a NaN, which satisfies and refutes nothing, where it comes to no number."""
    try:
        return check()
    except ArithmeticError as error:
        return Residual(float("nan"), 0.0, f"no number: {error}")


def _verdict(claim: Claim, statement: Residual, transcribed: Residual | None) -> Verdict:
    if not statement.is_satisfied:
        return Verdict.UNDECIDED
    if transcribed is None:
        if claim.gap:
            return Verdict.UNDECIDED
        if claim.void:
            return Verdict.VACUOUS
        return Verdict.RESTORED if claim.lost else Verdict.HOLDS
    if transcribed.is_satisfied:
        return Verdict.HOLDS  # the form recorded as false is true
    if not transcribed.is_refuted:
        return Verdict.UNDECIDED
    return Verdict.ONLY_IF if claim.condition else Verdict.FALSE
