"""The worst error over attainable that a search has found, family by family."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import Provenance
from taylor_verify.records.status import Status


@dataclass(frozen=True)
class WorstOfFamily:
    """The worst of one family; ``judged`` scenes were run, ``scene`` is where the worst is kept."""

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
    """A search of so many ``runs`` in each family.

    ``factor`` is the bound of a gate over what is attainable.
    """

    factor: int
    rung: str
    runs: int
    seed: int
    provenance: Provenance
    families: tuple[WorstOfFamily, ...]
