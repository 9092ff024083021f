"""Documents of speed against accuracy: the errors of every setting on a few scenes, and the times.

The errors are the same on any machine, except for rounding. The times belong to one machine.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.json_text import complete
from taylor_verify.records.provenance import Machine
from taylor_verify.records.standing import Standing
from taylor_verify.tradeoff.document import Number, TradePoint
from taylor_verify_reports.studies.stored import Stored

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


NUMBERS: Final = Stored(TradeNumbers, "tradeoff")
TIMINGS: Final = Stored(TradeTimings, "tradeoff", stem="tradeoff-timings")

# Keys that the times add to a row.
_TIMES: Final = ("seconds", "inner_seconds", "ratio", "low", "high", "processes", "spread")


@dataclass(frozen=True)
class TimedPoint:
    """A sound setting on a scene: its errors, and its time, a median over processes."""

    point: TradePoint
    timing: TradeTiming

    @property
    def error(self) -> float:
        """The largest error; infinite if it is no number."""
        return float("inf") if self.point.error is None else self.point.error


@dataclass(frozen=True)
class Trade:
    """A scene with a point for every setting, the coarsest of a family first, and their times.

    The keys of ``timings`` are solver and rung.
    """

    about: TradeScene
    points: tuple[TradePoint, ...]
    timings: Mapping[tuple[str, str], TradeTiming]

    @property
    def scene(self) -> str:
        """The name of the scene."""
        return self.about.scene

    @property
    def is_long(self) -> bool:
        """True for a scene that is followed beyond its own end, with few solvers."""
        return UNTIL in self.scene

    @property
    def sound(self) -> tuple[TimedPoint, ...]:
        """The points that are sound and timed in every process."""
        timed = ((p, self._timing(p)) for p in self.points if p.standing is Standing.SOUND)
        return tuple(TimedPoint(p, timing) for p, timing in timed if timing is not None)

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The rows of `tradeoff --json`, one for each setting, with the ratio to the yardstick."""
        return [
            {**complete(p), **{name: getattr(self._timing(p), name, None) for name in _TIMES}}
            for p in self.points
        ]

    def document(self) -> dict[str, Any]:
        """Return the stored part of the document of `tradeoff --json` for one scene."""
        return {
            "scene": self.scene,
            "track": list(self.about.track),
            "points": self.rows,
            "attainable": self.about.attainable,
        }

    def _timing(self, point: TradePoint) -> TradeTiming | None:
        return self.timings.get((point.solver, point.rung))


@dataclass(frozen=True)
class Trades:
    """The whole measurement: its errors, its times, and both of them scene by scene."""

    numbers: TradeNumbers
    times: TradeTimings

    @property
    def trades(self) -> tuple[Trade, ...]:
        """The scenes, each with its points and their times."""
        timings: dict[str, dict[tuple[str, str], TradeTiming]] = {}
        for timing in self.times.timings:
            timings.setdefault(timing.scene, {})[timing.solver, timing.rung] = timing
        points = self.numbers.points
        return tuple(
            Trade(
                about,
                tuple(p for p in points if p.scene == about.scene),
                timings.get(about.scene, {}),
            )
            for about in self.numbers.scenes
        )

    @property
    def short(self) -> tuple[Trade, ...]:
        """The scenes as they are shipped, on which all solvers are compared."""
        return tuple(trade for trade in self.trades if not trade.is_long)


def cheapest(rows: Iterable[TimedPoint], digits: int) -> TimedPoint | None:
    """Return the fastest point that leaves so many digits; None if there is none."""
    reached = [row for row in rows if row.error <= 10.0**-digits]
    return min(reached, key=lambda row: row.timing.ratio, default=None)


def write(folder: Path, numbers: TradeNumbers, times: TradeTimings) -> list[Path]:
    """Store both documents of a measurement below ``folder`` and return their files. Raises OSError."""
    return [*NUMBERS.write(folder, numbers), *TIMINGS.write(folder, times)]


def load(folder: Path) -> Trades | None:
    """Return the measurement stored below ``folder``; None if there is none.

    Raises OSError for files that cannot be read and ValueError for files that hold something else.
    """
    numbers = NUMBERS.find(folder)
    return None if numbers is None else Trades(numbers, TIMINGS.load(folder))
