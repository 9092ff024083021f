"""The measurement of speed against accuracy, as stored: errors in one file, times in another.

    tradeoff.json           of every scene and setting what was asked and achieved; the same on any
                            machine, but for the rounding
    tradeoff-timings.json   seconds, ratios and intervals; the machine's own, and never compared

Read again, a row has both: it is then a row of `tradeoff --json`, with the ratio to the yardstick and its
interval besides.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from taylor_verify.publish import data
from taylor_verify.publish.replacement import replace_files

NUMBERS: Final = f"{data.FOLDER}/tradeoff.json"
TIMINGS: Final = f"{data.FOLDER}/tradeoff-timings.json"

_MADE_BY: Final = {"made_by": "taylor-verify publish --tradeoff; do not edit"}
_OF_A_ROW: Final = ("seconds", "inner_seconds", "ratio", "low", "high", "processes")

Row = Mapping[str, Any]


@dataclass(frozen=True)
class Trade:
    """One scene: a row for every setting, the coarsest of a family first.

    ``attainable`` is what rounding alone leaves on each rung; empty in measurements without it.
    """

    scene: str
    title: str
    track: tuple[str, ...]
    rows: tuple[Row, ...]
    requests: tuple[str, ...]
    attainable: Mapping[str, float | None] = field(default_factory=dict)

    @property
    def sound(self) -> tuple[Row, ...]:
        """What may be compared: sound, and timed in every process."""
        return tuple(r for r in self.rows if r["standing"] == "sound" and r["ratio"] is not None)

    def document(self) -> dict[str, Any]:
        """As `tradeoff --json` has it for one scene, as far as it is stored."""
        return {
            "scene": self.scene,
            "track": list(self.track),
            "points": list(self.rows),
            "attainable": dict(self.attainable),
        }


@dataclass(frozen=True)
class Trades:
    """The whole measurement: ``method`` and ``machine`` say how and where the times were taken."""

    trades: tuple[Trade, ...]
    doubles: tuple[Row, ...]
    versions: Mapping[str, str]
    yardstick: str
    method: Mapping[str, Any]
    machine: Mapping[str, str]


def write(folder: Path, numbers: Mapping[str, Any], times: Mapping[str, Any]) -> tuple[Path, ...]:
    """Store a measurement below ``folder``, both files or none. Raises OSError."""
    scenes = [{k: v for k, v in scene.items() if k != "points"} for scene in numbers["scenes"]]
    points = [
        {"scene": scene["scene"], **row} for scene in numbers["scenes"] for row in scene["points"]
    ]
    flat = {**_MADE_BY, **numbers, "scenes": scenes, "points": points}
    texts = {NUMBERS: data.laid_out(flat), TIMINGS: data.laid_out({**_MADE_BY, **times})}
    return replace_files(folder, texts)


def load(folder: Path) -> Trades | None:
    """The measurement stored below ``folder``; None where there is none.

    Raises OSError for files that cannot be read and ValueError for files that hold something else.
    """
    file = folder / NUMBERS
    if not file.exists():
        return None
    numbers, times = data.read_document(file), data.read_document(folder / TIMINGS)
    with data.expecting("a measurement of speed and accuracy", file):
        timed = {(r["scene"], r["solver"], r["rung"]): r for r in times["timings"]}
        return Trades(
            trades=tuple(_trade(scene, numbers["points"], timed) for scene in numbers["scenes"]),
            doubles=tuple(numbers["plain_doubles"]),
            versions=numbers["versions"],
            yardstick=numbers["yardstick"],
            method=times["method"],
            machine=times["machine"],
        )


def _trade(
    scene: Row, points: list[Row], timed: Mapping[tuple[str, str, str], Mapping[str, Any]]
) -> Trade:
    rows = []
    for row in points:
        if row["scene"] == scene["scene"]:
            own = timed.get((row["scene"], row["solver"], row["rung"]), {})
            times = {name: own.get(name) for name in _OF_A_ROW}
            rows.append({**row, **times, "spread": _spread(times)})
    track, requests = tuple(scene["track"]), tuple(scene["requests"])
    floors = scene.get("attainable") or {}
    return Trade(scene["scene"], scene["title"], track, tuple(rows), requests, floors)


def _spread(times: Mapping[str, Any]) -> float | None:
    """The upper end of the interval over the lower, which a picture draws as a bar."""
    return times["high"] / times["low"] if times["low"] and times["high"] else None
