"""The number of periods that each precision carries a motion through, and with what error."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import SceneProvenance


@dataclass(frozen=True)
class ReachFamily:
    """A family of motions: its values, and the periods that each rung is followed for."""

    name: str
    title: str
    symbol: str
    extreme: str
    values: tuple[str, ...]
    rungs: dict[str, int]


@dataclass(frozen=True)
class ReachRow:
    """A member of a family on a rung, after each number of periods.

    ``errors`` and ``floors`` are the largest up to then; of a motion that was lost they are None, and
    infinite while it is measured. There are no floors for periods that no rung was followed for. Both
    are empty where nothing was run, and ``why`` says why.
    """

    family: str
    value: str
    rung: str
    periods: tuple[int, ...]
    errors: tuple[float | None, ...]
    floors: tuple[float | None, ...]
    steps: int
    why: str


@dataclass(frozen=True)
class ReachStudy:
    """All families and their rows; from an error of ``lost`` on nothing of a motion is left."""

    families: tuple[ReachFamily, ...]
    rows: tuple[ReachRow, ...]
    lost: float
    provenance: SceneProvenance
