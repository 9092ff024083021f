"""The verb `claims`, and the page that `publish --claims` makes of it."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from taylor_verify.cli.answer import FAIL, PASS, Answer, WrongCall, files_written

if TYPE_CHECKING:
    from taylor_verify.claims.claim import Claim


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
    return Answer(FAIL if missed else PASS, rows, text, missed)


def publish_claims(folder: Path) -> Answer:
    """The page of the whole ledger; one whose entries have left their verdicts is not written."""
    from taylor_verify.claims.ledger import claims as ledger
    from taylor_verify.claims.numbers import CITED
    from taylor_verify.judge.provenance import command, processor, versions
    from taylor_verify.publish.claims import write

    rows = _examined(ledger())
    missed = _missed(rows)
    if missed:
        return Answer(FAIL, {"written": []}, lambda: "", missed)
    provenance = {"versions": versions(), "processor": processor(), "command": command()}
    return files_written(write(folder, rows, CITED, provenance))


def _examined(asked: Sequence[Claim]) -> list[dict[str, Any]]:
    from taylor_verify.claims.ledger import examined
    from taylor_verify.cli.progress import working

    with working(f"claims, {len(asked)} entries"):
        return [finding.row() for finding in examined(asked)]


def _missed(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    return [
        f"expected the verdict {row['recorded']!r}, got {row['verdict']!r} @ {row['id']}"
        for row in rows
        if row["verdict"] != row["recorded"]
    ]
