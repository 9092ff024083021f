"""The record of a run: all numbers that its judgement used, for pages and for `explain`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from taylor_verify.records.doubles import Doubles


@dataclass(frozen=True)
class GateRecord:
    """The samples of one gate, ``errors`` and ``attainable``, to the four digits a picture needs.

    ``shifts`` are the shifts of time of a state quantity whose gate did not pass; empty else, where
    they are as random as the roundings behind them, and of so many samples that they were not sought
    at each.
    """

    quantity: str
    unit: str
    errors: Sequence[float]
    attainable: Sequence[float]
    truth_radius: float
    shifts: Sequence[float] = ()

    def __post_init__(self) -> None:
        _pack(self, "errors", "attainable", "shifts")

    def document(self) -> dict[str, Any]:
        """Return the gate as JSON holds it."""
        series = {name: tuple(getattr(self, name)) for name in ("errors", "attainable", "shifts")}
        return {**vars(self), **series}


@dataclass(frozen=True)
class Record:
    """Record of one run: the equations as built, the regime of the orbit, and each gate's terms."""

    scene: str
    title: str
    solver: str
    rung: str
    track: tuple[str, ...]
    equations: tuple[str, ...]
    parameters: dict[str, str]
    units: dict[str, str]
    regime: str
    route: str
    truth_digits: int
    outcome: str
    steps: int
    unit_roundoff: float
    times: Sequence[float]
    gates: tuple[GateRecord, ...]

    def __post_init__(self) -> None:
        _pack(self, "times")

    def document(self) -> dict[str, Any]:
        """Return the record as JSON holds it."""
        gates = [gate.document() for gate in self.gates]
        return {**vars(self), "times": tuple(self.times), "gates": gates}


def _pack(record: GateRecord | Record, *fields: str) -> None:
    """Hold numbers of a record in eight bytes each, in whatever sequence they came."""
    for field in fields:
        numbers = getattr(record, field)
        if not isinstance(numbers, Doubles):
            object.__setattr__(record, field, Doubles(numbers))
