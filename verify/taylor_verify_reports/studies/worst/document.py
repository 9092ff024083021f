"""The largest error over attainable in each family of scenes, from a search."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import Provenance
from taylor_verify.records.status import Status


@dataclass(frozen=True)
class WorstOfFamily:
    """The worst scene of one family, by the name ``scene``.

    ``what`` says what the scenes of the family are, ``judged`` is the number of judged scenes. ``ratio`` is
    the error over attainable of ``quantity``, and ``max`` its error, None if it is no number.
    """

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
    """A search with ``runs`` runs in each family, drawn from ``seed``.

    ``factor`` is the bound of a gate over what is attainable.
    """

    factor: int
    rung: str
    runs: int
    seed: int
    provenance: Provenance
    families: tuple[WorstOfFamily, ...]
