"""The operations of each option of a scene, and its time as a multiple of that of the simplest form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from taylor_verify.records.provenance import SceneProvenance
from taylor_verify_reports.studies.stored import Stored

# A median, and the ends of its interval, which are None if there were too few rounds.
Interval = tuple[float, float | None, float | None]


@dataclass(frozen=True)
class PriceRow:
    """A variant: the size of its equations, and the time of a step in float64.

    ``against`` names the variant whose step is the unit of ``step_ratio``. ``states``, ``sums``,
    ``products`` and ``quotients`` are numbers in one evaluation, ``order`` is that of a step.
    """

    variant: str
    against: str
    what: str
    states: int
    sums: int
    products: int
    quotients: int
    order: int
    step_ratio: Interval

    @property
    def operations(self) -> int:
        """The number of operations of one evaluation."""
        return self.sums + self.products + self.quotients


@dataclass(frozen=True)
class PriceMethod:
    """The rounds, and the least duration of a measurement."""

    rounds: int
    seed: int
    least_seconds: float


@dataclass(frozen=True)
class PricesStudy:
    """All variants."""

    rows: tuple[PriceRow, ...]
    method: PriceMethod
    provenance: SceneProvenance


PRICES: Final = Stored(PricesStudy, "prices")
