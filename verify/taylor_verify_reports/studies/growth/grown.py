"""The growth of errors over decades of time, measured on ensembles of starts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from taylor_verify.records.provenance import Provenance
from taylor_verify.records.status import Status

# None stands for a number that is not finite.
Number = float | None

# The word for a quantity without any error.
EXACT: Final = "exact"


@dataclass(frozen=True)
class GrowthGate:
    """The verdict on the growth of a conserved quantity, or of the phase.

    The gate fails if errors grow faster than ``law`` allows. ``chance`` is the probability of at least this
    growth under the law. The gate fails if it is less than ``false_alarm``. This is therefore the
    probability that errors of exactly that law fail.
    """

    verdict: Status
    law: str
    chance: Number
    false_alarm: float
    because: str


@dataclass(frozen=True)
class GrowthOfQuantity:
    """The growth of one quantity of an ensemble.

    ``rms`` are root mean squares over the starts, one for each of the ensemble's instants. ``in_walks`` is
    the last of them over that of a random walk whose steps are single roundoffs. ``exponent`` is the power
    of time, between ``low`` and ``high`` at the confidence ``level``, from ``lanes`` starts; ``word`` names
    it. ``late`` has exponent, low and high for the second half of the decades, and ``late_word`` their
    word.
    """

    quantity: str
    rms: tuple[Number, ...]
    in_walks: Number
    exponent: Number
    low: Number
    high: Number
    level: float
    lanes: int
    word: str
    late: tuple[Number, Number, Number]
    late_word: str
    gate: GrowthGate | None = None


@dataclass(frozen=True)
class Ensemble:
    """A scene followed from ``lanes`` starts for ``periods`` periods; ``lost`` of them did not get there.

    ``period`` is in the scene's unit of time, ``counts`` are the instants in periods, and ``steps`` the
    steps up to each instant, a mean over the lanes. ``why`` is the reason to measure the ensemble.
    """

    scene: str
    digest: str
    solver: str
    rung: str
    periods: float
    lanes: int
    seed: int
    period: float
    lost: int
    counts: tuple[float, ...]
    steps: tuple[float, ...]
    quantities: tuple[GrowthOfQuantity, ...]
    why: str = ""


@dataclass(frozen=True)
class GrowthStudy:
    """All ensembles; ``left_out`` names those whose rung this machine does not have."""

    runs: tuple[Ensemble, ...]
    left_out: tuple[str, ...]
    provenance: Provenance
