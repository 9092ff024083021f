"""The ledger: all claims in the order of the texts, found by their ids and examined one by one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import Final

from taylor_verify_reports.claims import heinbockel, hydromechanics
from taylor_verify_reports.claims.claim import Claim, Finding, examine
from taylor_verify_reports.claims.claim_row import ClaimRow
from taylor_verify_reports.claims.numbers import IN_ORDER

# A folder for each text; a module of it may have CLAIMS.
_TEXTS: Final = (heinbockel, hydromechanics)


class UnknownClaim(ValueError):
    """An id that no entry has; the text names the nearest."""


@cache
def claims() -> tuple[Claim, ...]:
    """Return every entry, in the order of the texts; those that the order does not know come last."""
    names = [f"{t.__name__}.{module.name}" for t in _TEXTS for module in iter_modules(t.__path__)]
    entries = [claim for name in names for claim in getattr(import_module(name), "CLAIMS", ())]
    places = {id: place for place, id in enumerate(IN_ORDER)}
    return tuple(sorted(entries, key=lambda claim: places.get(claim.id, len(places))))


def find(ids: Iterable[str]) -> tuple[Claim, ...]:
    """Return the entries of these ids, or all of them.

    A part that ends or begins an id stands for all that it fits: ``(2.2.70)``, ``hydromechanics 49``.
    Raises UnknownClaim, for all faults at once.
    """
    asked = [" ".join(id.split()).casefold() for id in ids]
    if not asked:
        return claims()
    known = [claim.id for claim in claims()]
    if unknown := [id for id in asked if not any(_is_meant(id, name) for name in known)]:
        raise UnknownClaim("\n".join(_fault(id, known) for id in unknown))
    return tuple(claim for claim in claims() if any(_is_meant(id, claim.id) for id in asked))


def _is_meant(asked: str, id: str) -> bool:
    return f" {id.casefold()} ".startswith(f" {asked} ") or id.casefold().endswith(f" {asked}")


def _fault(asked: str, known: Sequence[str]) -> str:
    near = get_close_matches(asked, known, n=1, cutoff=0.5)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    return f"expected the id of a claim, such as 'hydromechanics 49 (17)', got {asked!r}{hint}"


def examined(asked: Iterable[Claim]) -> list[Finding]:
    """Return the findings in the order asked."""
    return [examine(claim) for claim in asked]


def missed(rows: Iterable[ClaimRow]) -> list[str]:
    """Return a sentence for each entry whose checks no longer give the verdict of the ledger."""
    return [
        f"expected the verdict {row.recorded.value!r}, got {row.verdict.value!r} @ {row.id}"
        for row in rows
        if not row.is_as_recorded
    ]
