"""The errors of each precision after given numbers of periods."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import SceneProvenance


@dataclass(frozen=True)
class ReachFamily:
    """A family of motions: the texts of its values, and the most periods on each rung."""

    name: str
    title: str
    symbol: str
    extreme: str
    values: tuple[str, ...]
    rungs: dict[str, int]


@dataclass(frozen=True)
class ReachRow:
    """The errors of one member of a family on a rung, after each number of ``periods``.

    ``errors`` and ``floors`` are the largest relative errors up to that number of periods: achieved, and
    attainable. They are None for a lost motion (infinite during the measurement). ``floors`` is shorter
    than ``periods`` if no rung was followed so far. If nothing was run, both are empty, and ``why`` is the
    reason.
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
