"""Documents of speed against accuracy: the errors of every setting on a few scenes, and the times.

The errors are the same on any machine, except for rounding. The times belong to one machine.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from taylor_verify.records.provenance import Machine
from taylor_verify.tradeoff.document import Number, TradePoint

# Text between the name of a shipped scene and a later time until which the scene is followed.
UNTIL: Final = " until t = "


@dataclass(frozen=True)
class TradeScene:
    """A measured scene.

    ``attainable`` are the errors that rounding alone leaves, by rung; empty if they were not measured.
    """

    scene: str
    title: str
    track: tuple[str, ...]
    sha256: str
    attainable: dict[str, Number] = field(default_factory=dict)

    @property
    def is_long(self) -> bool:
        """True for a scene that is followed beyond its own end, with few solvers."""
        return UNTIL in self.scene


@dataclass(frozen=True)
class TradeNumbers:
    """All scenes and points; ``yardstick`` names the setting that is the unit of times."""

    versions: dict[str, str]
    yardstick: str
    scenes: tuple[TradeScene, ...]
    points: tuple[TradePoint, ...]


@dataclass(frozen=True)
class TradeTiming:
    """The time of one setting on one scene, a median over processes.

    ``ratio`` is the time over that of the yardstick. Its interval is from ``low`` to ``high``, which are
    None if the processes are too few for one. ``inner_seconds`` is the part of the time in compiled code,
    if known. ``setup_seconds`` is the time before the first solve of a process, mainly of compiling, in the
    slowest process.
    """

    scene: str
    solver: str
    rung: str
    seconds: float
    inner_seconds: Number
    ratio: float
    low: Number
    high: Number
    processes: int
    setup_seconds: Number = None

    @property
    def spread(self) -> float | None:
        """The upper end of the interval over the lower end, for the bar in a picture."""
        return self.high / self.low if self.low and self.high else None


@dataclass(frozen=True)
class TimingMethod:
    """The method of the times: processes, rounds, the least duration of a measurement, and the confidence.

    ``times_resolution`` is the least duration as a multiple of ``clock_resolution``. ``coverage`` is the
    probability that an interval contains its median, by ``formula``. ``of`` says what is timed.
    """

    processes: int
    rounds: int
    seed: int
    least_seconds: float
    times_resolution: int
    clock_resolution: float
    confidence: float
    coverage: float
    formula: str
    of: str


@dataclass(frozen=True)
class TradeTimings:
    """The times of every sound setting, with the machine and the method of the measurement."""

    machine: Machine
    method: TimingMethod
    timings: tuple[TradeTiming, ...]
