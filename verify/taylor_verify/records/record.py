"""The record of a run: all numbers that its judgement used, for pages and for `explain`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class GateRecord:
    """The samples of one gate, ``errors`` and ``attainable``, to the four digits a picture needs.

    ``shifts`` are the shifts of time of a state quantity whose gate did not pass; empty else, where
    they are as random as the roundings behind them, and of so many samples that they were not sought
    at each.
    """

    quantity: str
    unit: str
    errors: tuple[float, ...]
    attainable: tuple[float, ...]
    truth_radius: float
    shifts: tuple[float, ...] = ()


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
    times: tuple[float, ...]
    gates: tuple[GateRecord, ...]

    def document(self) -> dict[str, Any]:
        """Return the record as JSON holds it."""
        return {**vars(self), "gates": [{**vars(gate)} for gate in self.gates]}


def four_digits(values: Iterable[float]) -> tuple[float, ...]:
    """Return the numbers, each the nearest double to its own first four decimal digits."""
    tolist = getattr(values, "tolist", None)
    return tuple(map(float, map("{:.4g}".format, values if tolist is None else tolist())))
