"""The study of the claims: the ledger of both source texts, every entry checked."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.claims import page
from taylor_verify_reports.studies.claims.page import CLAIMS
from taylor_verify_reports.studies.study import Measured, Progress, Study


def _measure(folder: Path, progress: Progress) -> Measured:
    """Check the whole ledger, and store it only if every entry still has its verdict."""
    from taylor_verify.judge.provenance import command, processor, versions
    from taylor_verify.records.provenance import Provenance
    from taylor_verify_reports.claims.document import ClaimsStudy
    from taylor_verify_reports.claims.ledger import claims, examined, missed
    from taylor_verify_reports.claims.numbers import CITED

    asked = claims()
    with progress.working(f"claims, {len(asked)} entries"):
        rows = tuple(finding.row() for finding in examined(asked))
    if faults := missed(rows):
        return Measured(messages=faults, status=1)
    made_by = Provenance(versions(), processor(), command())
    return Measured(CLAIMS.write(folder, ClaimsStudy(made_by, dict(CITED), rows)))


STUDY: Final = Study(
    name="claims",
    title="every numbered equation of the two source texts, checked; errata in front",
    duration="a minute",
    measure=_measure,
    find=CLAIMS.find,
    page=lambda study, folder: page.page(study),
    sheet=page.sheet,
    place="claims.md",
    needs_heyoka=False,
)
