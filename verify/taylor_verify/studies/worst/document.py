"""The worst error over attainable in each family, found by a search."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import Provenance
from taylor_verify.records.status import Status


@dataclass(frozen=True)
class WorstOfFamily:
    """The worst of one family; ``judged`` is the number of scenes, ``scene`` the name of the worst."""

    name: str
    what: str
    judged: int
    ratio: float
    quantity: str
    verdict: Status
    max: float | None
    scene: str


@dataclass(frozen=True, kw_only=True)
class WorstStudy:
    """A search with ``runs`` runs in each family.

    ``factor`` is the bound of a gate over what is attainable.
    """

    factor: int
    rung: str
    runs: int
    seed: int
    provenance: Provenance
    families: tuple[WorstOfFamily, ...]
