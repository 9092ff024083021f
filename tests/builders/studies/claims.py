"""A stored ledger in which every claim has its recorded verdict, with no check run."""

from __future__ import annotations

from dataclasses import replace

from taylor_verify.records.provenance import Provenance
from taylor_verify_reports.claims.check import Residual
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.claim_row import ClaimRow, ClaimsStudy
from taylor_verify_reports.claims.ledger import claims, examined
from taylor_verify_reports.claims.numbers import CITED


def row(claim: Claim) -> ClaimRow:
    (finding,) = examined([claim])
    return finding.row()


def without_checks(claim: Claim) -> ClaimRow:
    """The row that the recorded verdict asks for, with no check run."""
    fine = lambda: Residual(0.0, 0.0, "")  # noqa: E731
    missed = (lambda: Residual(1.0, 0.0, "")) if claim.transcribed else None
    return row(replace(claim, check=fine, transcribed=missed))


ROWS = tuple(without_checks(claim) for claim in claims())
STUDY = ClaimsStudy(Provenance({"taylor-verify": "1"}, "A chip", "a command"), dict(CITED), ROWS)
