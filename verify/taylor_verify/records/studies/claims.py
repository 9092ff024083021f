"""The ledger of both source texts, examined."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import Provenance


@dataclass(frozen=True)
class ClaimResiduals:
    """The residual of the statement, and of the transcribed form where that is another one."""

    statement: float
    transcribed: float | None = None


@dataclass(frozen=True)
class ClaimRow:
    """One entry of the ledger; ``statement`` and ``correction`` are LaTeX."""

    id: str
    statement: str
    domain: str
    verdict: str
    recorded: str
    method: str
    residual: ClaimResiduals
    bound: float
    because: str
    mutations: tuple[str, ...] = ()
    correction: str | None = None
    condition: str | None = None
    lost: str | None = None
    open: str | None = None
    void: str | None = None
    counterexample: str | None = None
    remark: str | None = None


@dataclass(frozen=True)
class ClaimsStudy:
    """All entries; ``cited`` are numbers that a text refers to and does not have."""

    provenance: Provenance
    cited: dict[str, str]
    claims: tuple[ClaimRow, ...]
