"""The summary of a dataset, made part by part in bounded memory."""

from __future__ import annotations

from collections import Counter
from math import inf, isfinite
from typing import Any, Final

import numpy as np

from taylor_verify.batch.expectations import unjudged_status
from taylor_verify.batch.sweeps.chunk import DRAWN
from taylor_verify.batch.sweeps.dataset import Dataset
from taylor_verify.batch.sweeps.questions import Questions
from taylor_verify.batch.sweeps.sizes import Sizes
from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.records.provenance import Provenance
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL
from taylor_verify.records.status import GRAVITY, Status, exit_status
from taylor_verify.records.sweep import Spread, SweepSummary, WorstCase

Rows = dict[str, np.ndarray[Any, Any]]
"""The columns of a part, by their names."""

_ROWS: Final = (
    "point",
    "scene",
    "quantity",
    "verdict",
    "outcome",
    "max",
    "ratio",
    "unit",
    "because",
)
# Statuses whose reasons are reported, and the number of reasons for each.
_REASONED: Final = (Status.UNAVAILABLE, Status.REFUSED)
_MOST_REASONS: Final = 3
# Scenes with these statuses come before all that passed, the worst first.
_LOOKED_AT: Final = (Status.FAIL, Status.UNDECIDED)
_GRAVITY_OF_WORDS: Final = {status.value: place for place, status in enumerate(GRAVITY)}


def summary(dataset: Dataset, questions: Questions, worst: int) -> SweepSummary:
    """Return the summary of a dataset that is finished, with so many of its worst cases."""
    totals = _Totals(worst, questions.drawn)
    for part in dataset.tables([*_ROWS, *(DRAWN + name for name in questions.drawn)]):
        totals.add(part)
    asked = dataset.manifest
    made = Provenance(versions(), processor(), command())
    return SweepSummary(
        name=asked.name,
        title=questions.title,
        solver=asked.solver,
        rung=asked.rung,
        count=asked.count,
        seed=asked.seed,
        points=asked.points,
        total=asked.total,
        bodies={status.value: totals.bodies[status] for status in Status},
        quantities=totals.spreads(),
        worst=tuple(case for _, case in totals.worst),
        factor=GATE_FACTOR,
        exit_status=totals.exit_status(),
        tolerance=asked.tolerance,
        lacks=totals.lacks(),
        refusals=totals.refusals(),
        provenance=made,
    )


class _Totals:
    """The counts over the parts of a dataset."""

    def __init__(self, worst: int, drawn: tuple[str, ...]) -> None:
        self.bodies: Counter[Status] = Counter()
        self.worst: list[tuple[tuple[float, float, int], WorstCase]] = []
        self._most, self._drawn = worst, drawn
        self._quantities: dict[str, _Quantity] = {}
        self._outcomes: set[str] = set()
        # Reasons by status, in the order in which they occurred.
        self._reasons: dict[Status, dict[str, None]] = {status: {} for status in _REASONED}

    def add(self, part: Any) -> None:
        """Count the rows of a part, which has all rows of its bodies, each body's together."""
        rows = _rows(part)
        self._outcomes.update(rows["outcome"].tolist())
        for name in dict.fromkeys(rows["quantity"].tolist()):
            quantity = self._quantities.setdefault(name, _Quantity(name))
            quantity.add({key: row[rows["quantity"] == name] for key, row in rows.items()})
        gravity = np.array([_GRAVITY_OF_WORDS[word] for word in rows["verdict"].tolist()])
        starts = np.flatnonzero(np.diff(rows["point"], prepend=-1))
        gravest = np.minimum.reduceat(gravity, starts)
        self.bodies.update(GRAVITY[which] for which in gravest.tolist())
        for status, reasons in self._reasons.items():
            for because in rows["because"][rows["verdict"] == status.value].tolist():
                if len(reasons) < _MOST_REASONS:
                    reasons[because] = None
        self._add_worst(rows)

    def spreads(self) -> tuple[Spread, ...]:
        """Return the spread of every quantity, in the order of their first rows."""
        return tuple(each.spread() for each in self._quantities.values())

    def exit_status(self) -> int:
        """Return the exit status of a run of all these bodies; unjudged bodies are no failure."""
        if self._is_unjudged():
            return unjudged_status(self._outcomes)
        return exit_status([status for status, count in self.bodies.items() if count])

    def lacks(self) -> tuple[str, ...]:
        """Return the reasons why nothing was judged; empty where something was."""
        return tuple(self._reasons[Status.UNAVAILABLE]) if self._is_unjudged() else ()

    def _is_unjudged(self) -> bool:
        return sum(self.bodies.values()) == self.bodies[Status.UNAVAILABLE]

    def refusals(self) -> tuple[str, ...]:
        """Return some of the reasons why numbers make no body."""
        return tuple(self._reasons[Status.REFUSED])

    def _add_worst(self, rows: Rows) -> None:
        """Keep the bodies that came nearest to failing, of these and those before."""
        if not self._most:
            return
        size = np.where(
            rows["is_asked"] & (rows["quantity"] != INITIAL), rows["ratio_judged"], -inf
        )
        looked_at = np.select(
            [rows["verdict"] == status.value for status in _LOOKED_AT],
            [len(_LOOKED_AT) - i for i in range(len(_LOOKED_AT))],
            0,
        )
        # A body whose numbers make none has no scene to look at.
        places = np.flatnonzero((size > -inf) | (looked_at > 0))
        order = np.lexsort((rows["point"][places], -size[places], -looked_at[places]))
        taken: set[int] = set()
        for place in places[order].tolist():
            point = int(rows["point"][place])
            if point in taken:
                continue
            taken.add(point)
            key = (-float(looked_at[place]), -float(size[place]), point)
            if len(self.worst) >= self._most and key >= self.worst[-1][0]:
                break
            self.worst.append((key, _case(rows, place, self._drawn)))
            self.worst = sorted(self.worst, key=lambda each: each[0])[: self._most]


class _Quantity:
    """The rows of one quantity."""

    def __init__(self, name: str) -> None:
        self._name, self._unit = name, ""
        self._counts: Counter[str] = Counter()
        self._ratio, self._max = Sizes(), Sizes()

    def add(self, rows: Rows) -> None:
        self._counts.update(rows["verdict"].tolist())
        asked = rows["is_asked"]
        self._unit = self._unit or next(filter(None, rows["unit"][asked].tolist()), "")
        self._ratio.add(rows["ratio_judged"][asked])
        self._max.add(rows["max_judged"][asked])

    def spread(self) -> Spread:
        counts = {status.value: self._counts[status.value] for status in Status}
        ratio, largest = self._ratio.quantiles(), self._max.quantiles()
        return Spread(self._name, counts, self._ratio.count, self._unit, ratio, largest)


def _rows(part: Any) -> Rows:
    """Return the columns of a part as arrays, with the sizes that count in quantiles."""
    rows = {name: part.column(name).to_numpy() for name in part.column_names}
    is_fail = rows["verdict"] == Status.FAIL.value
    rows["is_asked"] = is_fail | (rows["verdict"] == Status.PASS.value)
    # A gate that failed without a number is beyond every number; one that passed has no error.
    lost = np.where(is_fail, inf, 0.0)
    for name in ("ratio", "max"):
        rows[f"{name}_judged"] = np.where(np.isnan(rows[name]), lost, rows[name])
    return rows


def _case(rows: Rows, place: int, drawn: tuple[str, ...]) -> WorstCase:
    """Return the body of a row."""
    row = {name: column[place] for name, column in rows.items()}
    ratio, largest = (float(row[name]) for name in ("ratio", "max"))
    return WorstCase(
        point=int(row["point"]),
        scene=row["scene"],
        verdict=Status(row["verdict"]),
        quantity=row["quantity"],
        ratio=ratio if isfinite(ratio) else None,
        max=largest if isfinite(largest) else None,
        because=row["because"],
        drawn={name: float(row[DRAWN + name]) for name in drawn},
    )
