"""A point of a trade-off as it is stored: what was asked of a setting, and what it achieved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from taylor_verify.records.standing import Standing

# None stands for a number that is not finite, or does not exist.
Number = float | None


def label(solver: str, setting: str, rung: str) -> str:
    """Return solver, setting and rung in one printed line."""
    return " ".join(filter(None, (solver, setting, rung)))


def label_of(row: Mapping[str, Any]) -> str:
    """Return the label of a row of a document."""
    return label(row["solver"], row["setting"], row["rung"])


@dataclass(frozen=True)
class TradePoint:
    """A setting on a scene: the requested tolerance or step, and the achieved errors.

    ``asked`` is the word for ``requested``: tolerance, step, or empty. ``error`` is the largest of all
    tracked quantities and samples, ``drift`` the largest of the conserved quantities, ``drifting`` the name
    of that quantity. ``max`` and ``final`` are errors by quantity, of all samples and of the last one.
    ``because`` is the reason why a point is not sound.
    """

    scene: str
    solver: str
    setting: str
    rung: str
    family: str
    asked: str
    requested: Number
    requested_digits: Number
    achieved_digits: Number
    error: Number
    max: dict[str, Number]
    final: dict[str, Number]
    drift: Number
    drifting: str
    steps: int
    evaluations: int
    outcome: str
    standing: Standing
    because: str

    @property
    def label(self) -> str:
        """The name of the setting in the output of `tradeoff`."""
        return label(self.solver, self.setting, self.rung)
