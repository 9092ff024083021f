"""The errors of each precision after given numbers of periods."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import SceneProvenance


@dataclass(frozen=True)
class ReachFamily:
    """A family of motions: its values, and the numbers of periods on each rung."""

    name: str
    title: str
    symbol: str
    extreme: str
    values: tuple[str, ...]
    rungs: dict[str, int]


@dataclass(frozen=True)
class ReachRow:
    """A member of a family on a rung, after each number of periods.

    ``errors`` and ``floors`` are the largest up to that number. For a lost motion they are None, and
    infinite during the measurement. Periods that no rung was followed for have no floor. Both are empty if
    nothing was run, and ``why`` gives the reason.
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
    """All families and their rows; a motion with an error of ``lost`` or more is lost."""

    families: tuple[ReachFamily, ...]
    rows: tuple[ReachRow, ...]
    lost: float
    provenance: SceneProvenance
