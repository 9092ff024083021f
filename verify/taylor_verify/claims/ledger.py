"""The ledger: all claims in the order of the texts, found by their ids and examined one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from types import ModuleType
from typing import Final

from taylor_verify.claims import heinbockel, hydromechanics
from taylor_verify.claims.claim import Claim, Finding, examine
from taylor_verify.claims.document import ClaimRow
from taylor_verify.claims.numbers import in_order

# A folder for each text; a module of it may have CLAIMS.
_TEXTS: Final = (heinbockel, hydromechanics)


class UnknownClaim(ValueError):
    """An id that no entry has; the text says what may have been meant."""


@cache
def claims() -> tuple[Claim, ...]:
    """Every entry, in the order of the texts; what the order does not know comes last."""
    modules = [import_module(name) for text in _TEXTS for name in _modules(text)]
    found = [claim for module in modules for claim in getattr(module, "CLAIMS", ())]
    places = {id: place for place, id in enumerate(in_order())}
    return tuple(sorted(found, key=lambda claim: places.get(claim.id, len(places))))


def _modules(text: ModuleType) -> list[str]:
    return [f"{text.__name__}.{module.name}" for module in iter_modules(text.__path__)]


def find(ids: Iterable[str]) -> tuple[Claim, ...]:
    """The entries of these ids, or all of them.

    A part that ends or begins an id stands for all that it fits: ``(2.2.70)``, ``hydromechanics 49``.
    Raises UnknownClaim, for all faults at once.
    """
    asked = [" ".join(id.split()).casefold() for id in ids]
    if not asked:
        return claims()
    known = [claim.id for claim in claims()]
    unknown = [id for id in asked if not any(_is_meant(id, name) for name in known)]
    if unknown:
        raise UnknownClaim("\n".join(_told(id, known) for id in unknown))
    return tuple(claim for claim in claims() if any(_is_meant(id, claim.id) for id in asked))


def _is_meant(asked: str, id: str) -> bool:
    name = id.casefold()
    return name == asked or name.startswith(f"{asked} ") or name.endswith(f" {asked}")


def _told(asked: str, known: Sequence[str]) -> str:
    near = get_close_matches(asked, known, n=1, cutoff=0.5)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    return f"expected the id of a claim, such as 'hydromechanics 49 (17)', got {asked!r}{hint}"


def examined(
    asked: Iterable[Claim], finished: Callable[[Finding], None] = lambda finding: None
) -> list[Finding]:
    """The findings in the order asked, each told to ``finished`` when it is there."""
    found = []
    for claim in asked:
        finding = examine(claim)
        finished(finding)
        found.append(finding)
    return found


def missed(rows: Iterable[ClaimRow]) -> list[str]:
    """Return a sentence for each entry whose checks no longer give the verdict of the ledger."""
    return [
        f"expected the verdict {row.recorded.value!r}, got {row.verdict.value!r} @ {row.id}"
        for row in rows
        if not row.is_as_recorded
    ]
