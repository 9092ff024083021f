"""The cost of each option of a scene, as a multiple of the barest form of its model."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import SceneProvenance

# A median, and the ends of its interval, which are None if there were too few rounds.
Interval = tuple[float, float | None, float | None]


@dataclass(frozen=True)
class PriceRow:
    """A variant on a rung: the size of its equations, and the cost of a step and of a unit of time."""

    rung: str
    variant: str
    against: str
    what: str
    states: int
    parameters: int
    sums: int
    products: int
    quotients: int
    order: int
    steps_per_time: float
    step_ratio: Interval
    time_ratio: Interval
    microseconds: float
    error: float | None


@dataclass(frozen=True)
class PriceAtEqualError:
    """The time of a variant over that of the barest form at the same achieved error."""

    variant: str
    against: str
    ratio: float | None


@dataclass(frozen=True)
class PriceMethod:
    """The rounds of each rung, and the error at which costs are compared."""

    rounds: dict[str, int]
    seed: int
    least_seconds: float
    equal_error: float


@dataclass(frozen=True)
class PricesStudy:
    """All variants on all rungs."""

    rows: tuple[PriceRow, ...]
    equal: tuple[PriceAtEqualError, ...]
    method: PriceMethod
    provenance: SceneProvenance
