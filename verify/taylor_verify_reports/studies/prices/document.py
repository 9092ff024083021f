"""The computing time of each option of a scene, as a multiple of that of the simplest form."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import SceneProvenance

# A median, and the ends of its interval, which are None if there were too few rounds.
Interval = tuple[float, float | None, float | None]


@dataclass(frozen=True)
class PriceRow:
    """A variant on a rung: the size of its equations, and the cost of a step and of a unit of time.

    ``against`` names the variant whose cost is the unit of ``step_ratio`` and ``time_ratio``. ``states``,
    ``parameters``, ``sums``, ``products`` and ``quotients`` are numbers in one evaluation, ``order`` is
    that of a step. ``microseconds`` is the time of a step, and ``error`` the largest relative error.
    """

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
    """The time of a variant over that of the variant ``against`` at the same achieved error.

    ``ratio`` is None if no measured tolerances enclose that error.
    """

    variant: str
    against: str
    ratio: float | None


@dataclass(frozen=True)
class PriceMethod:
    """The rounds by rung, the least duration of a measurement, and the error of the comparison."""

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
