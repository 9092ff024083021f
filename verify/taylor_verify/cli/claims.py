"""The verb `claims`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from taylor_verify.cli.answer import FAIL, PASS, Answer, WrongCall

if TYPE_CHECKING:
    from taylor_verify.claims.claim import Claim
    from taylor_verify.claims.document import ClaimRow


def claims(options: argparse.Namespace) -> Answer:
    """The ledger, or some of its entries."""
    from taylor_verify.claims.ledger import UnknownClaim, find, missed
    from taylor_verify.cli.claims_text import claims_text

    try:
        asked = find(options.ids)
    except UnknownClaim as error:
        raise WrongCall(str(error)) from error
    rows = _examined(asked)
    faults = missed(rows)
    text = partial(claims_text, rows, in_full=bool(options.ids))
    document = [row.document() for row in rows]
    return Answer(FAIL if faults else PASS, document, text, faults)


def _examined(asked: Sequence[Claim]) -> list[ClaimRow]:
    from taylor_verify.claims.ledger import examined
    from taylor_verify.cli.progress import working

    with working(f"claims, {len(asked)} entries"):
        return [finding.row() for finding in examined(asked)]
