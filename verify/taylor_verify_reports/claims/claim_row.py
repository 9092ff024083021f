"""The ledger of both source texts, examined."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from taylor_verify.records.json_text import complete, plain
from taylor_verify.records.provenance import Provenance


class Verdict(StrEnum):
    """The fate of a statement. The first three count as holding, the third on a condition."""

    HOLDS = "holds"
    RESTORED = "holds as restored"
    ONLY_IF = "holds only if"
    FALSE = "false as transcribed"
    UNDECIDED = "undecided"
    VACUOUS = "vacuous"


@dataclass(frozen=True)
class ClaimResiduals:
    """The residual of the statement, and of the transcribed form where that is another one.

    One that is not finite is null in JSON, and satisfies nothing.
    """

    statement: float | None
    transcribed: float | None = None


@dataclass(frozen=True, kw_only=True)
class ClaimRow:
    """An entry of the ledger; ``statement`` and ``correction`` are LaTeX.

    ``verdict`` is what the checks give, ``recorded`` what the ledger expects. ``mutations`` are changes of
    the statement that its check rejects.
    """

    id: str
    statement: str
    domain: str
    verdict: Verdict
    recorded: Verdict
    correction: str | None = None
    condition: str | None = None
    lost: str | None = None
    open: str | None = None
    void: str | None = None
    counterexample: str | None = None
    method: str
    mutations: tuple[str, ...] = ()
    residual: ClaimResiduals
    bound: float | None
    because: str
    remark: str | None = None

    @property
    def is_as_recorded(self) -> bool:
        """True if the checks give the verdict that the ledger expects."""
        return self.verdict is self.recorded

    def document(self) -> dict[str, Any]:
        """Return the entry as JSON holds it: every key, and the residuals that there are."""
        document: dict[str, Any] = complete(self)
        return {**document, "residual": plain(self.residual)}


@dataclass(frozen=True)
class ClaimsStudy:
    """The entries of the ledger; ``cited`` are numbers that a text refers to and does not have."""

    provenance: Provenance
    cited: dict[str, str]
    claims: tuple[ClaimRow, ...]

    def document(self) -> dict[str, Any]:
        """Return the ledger as JSON holds it."""
        document: dict[str, Any] = complete(self)
        return {**document, "claims": [row.document() for row in self.claims]}
