"""A record: everything one run was judged by, for pages, for `explain`, and for a reader in doubt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class GateRecord:
    """The samples of one gate, ``errors`` and ``attainable``, to the four digits a picture needs.

    ``shifts`` are the shifts of time of a state quantity whose gate did not pass; empty else, where
    they are as random as the roundings behind them.
    """

    quantity: str
    unit: str
    errors: tuple[float, ...]
    attainable: tuple[float, ...]
    truth_radius: float
    shifts: tuple[float, ...] = ()


@dataclass(frozen=True)
class Record:
    """One run: what was built, what the orbit is, and each gate's terms."""

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
        """The record as JSON holds it. Its tuples are the record's own: a run has thousands of numbers."""
        return {**vars(self), "gates": [vars(gate) for gate in self.gates]}
