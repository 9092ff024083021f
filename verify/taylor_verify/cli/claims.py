"""The verb `claims`: the ledger of the source texts, or some of its entries."""

from __future__ import annotations

import argparse
from functools import partial

from taylor_verify.claims.ledger import UnknownClaim, examined, find, missed
from taylor_verify.cli.answer import FAIL, PASS, Answer, wrong_calls
from taylor_verify.cli.claims_text import claims_text
from taylor_verify.cli.progress import working


def answer(options: argparse.Namespace) -> Answer:
    """Examine the claims asked for."""
    with wrong_calls("", UnknownClaim):
        asked = find(options.ids)
    with working(f"claims, {len(asked)} entries"):
        rows = [finding.row() for finding in examined(asked)]
    faults = missed(rows)
    text = partial(claims_text, rows, in_full=bool(options.ids))
    return Answer(FAIL if faults else PASS, [row.document() for row in rows], text, faults)
