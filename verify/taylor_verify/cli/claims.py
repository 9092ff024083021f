"""The verb `claims`, and the page that `publish --claims` makes of it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from taylor_verify.cli.answer import FAIL, PASS, Answer, WrongCall, files_written

if TYPE_CHECKING:
    from taylor_verify.claims.claim import Claim
    from taylor_verify.claims.document import ClaimRow


def claims(options: argparse.Namespace) -> Answer:
    """The ledger, or some of its entries."""
    from taylor_verify.claims.ledger import UnknownClaim, find
    from taylor_verify.cli.claims_text import claims_text

    try:
        asked = find(options.ids)
    except UnknownClaim as error:
        raise WrongCall(str(error)) from error
    rows = _examined(asked)
    missed = _missed(rows)
    text = partial(claims_text, rows, in_full=bool(options.ids))
    document = [row.document() for row in rows]
    return Answer(FAIL if missed else PASS, document, text, missed)


def publish_claims(folder: Path) -> Answer:
    """The page of the whole ledger; one whose entries have left their verdicts is not written."""
    from taylor_verify.claims.document import ClaimsStudy
    from taylor_verify.claims.ledger import claims as ledger
    from taylor_verify.claims.numbers import CITED
    from taylor_verify.judge.provenance import command, processor, versions
    from taylor_verify.records.provenance import Provenance
    from taylor_verify.studies.claims.page import write

    rows = _examined(ledger())
    missed = _missed(rows)
    if missed:
        return Answer(FAIL, {"written": []}, lambda: "", missed)
    made_by = Provenance(versions(), processor(), command())
    return files_written(write(folder, ClaimsStudy(made_by, dict(CITED), tuple(rows))))


def _examined(asked: Sequence[Claim]) -> list[ClaimRow]:
    from taylor_verify.claims.ledger import examined
    from taylor_verify.cli.progress import working

    with working(f"claims, {len(asked)} entries"):
        return [finding.row() for finding in examined(asked)]


def _missed(rows: Sequence[ClaimRow]) -> list[str]:
    return [
        f"expected the verdict {row.recorded.value!r}, got {row.verdict.value!r} @ {row.id}"
        for row in rows
        if not row.is_as_recorded
    ]
