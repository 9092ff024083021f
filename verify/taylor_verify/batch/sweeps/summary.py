"""The summary of a dataset, made part by part in bounded memory."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from math import inf, isfinite
from typing import Any, Final

import numpy as np

from taylor_verify.batch.sweeps.chunk import DRAWN
from taylor_verify.batch.sweeps.dataset import Dataset
from taylor_verify.batch.sweeps.questions import Questions
from taylor_verify.batch.sweeps.sizes import Sizes
from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.records.provenance import Provenance
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL
from taylor_verify.records.status import GRAVITY, Status
from taylor_verify.records.sweep import Spread, SweepSummary, WorstCase
from taylor_verify.solvers.trajectory import Outcome

Array = np.ndarray[Any, Any]

WORST: Final = 10
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


def summary(
    dataset: Dataset, questions: Questions, title: str = "", worst: int = WORST
) -> SweepSummary:
    """Return the summary of a dataset that is finished, with so many of its worst cases."""
    totals = _Totals(worst, questions.drawn)
    for part in dataset.tables([*_ROWS, *(DRAWN + name for name in questions.drawn)]):
        totals.add(part)
    asked = dataset.manifest
    made = Provenance(versions(), processor(), command())
    return SweepSummary(
        name=asked.name,
        title=title,
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
        self._outcomes: Counter[str] = Counter()
        # Reasons by status, in the order in which they occurred.
        self._reasons: dict[Status, dict[str, None]] = {status: {} for status in _REASONED}

    def add(self, table: Any) -> None:
        """Count the rows of a part, which has all rows of its bodies, each body's together."""
        rows = _Rows(table)
        self._outcomes.update(rows.words("outcome").tolist())
        for name in dict.fromkeys(rows.words("quantity").tolist()):
            quantity = self._quantities.setdefault(name, _Quantity(name))
            quantity.add(rows, rows.words("quantity") == name)
        gravest = np.minimum.reduceat(rows.gravity, rows.starts)
        self.bodies.update(GRAVITY[which] for which in gravest.tolist())
        for status, reasons in self._reasons.items():
            for because in rows.words("because")[rows.is_status(status)].tolist():
                if len(reasons) < _MOST_REASONS:
                    reasons[because] = None
        self._add_worst(rows)

    def spreads(self) -> tuple[Spread, ...]:
        """Return the spread of every quantity, in the order of their first rows."""
        return tuple(each.spread() for each in self._quantities.values())

    def exit_status(self) -> int:
        """Return the exit status of a run of all these bodies; unjudged bodies are no failure."""
        if self.bodies[Status.FAIL]:
            return 1
        if sum(self.bodies.values()) == self.bodies[Status.UNAVAILABLE]:
            if self._outcomes[Outcome.NO_PACKAGE.value]:
                return 2
            return 0 if set(self._outcomes) == {Outcome.NO_FORMAT.value} else 3
        is_open = any(
            self.bodies[status] for status in (Status.UNDECIDED, Status.REFUSED, Status.VACUOUS)
        )
        return 3 if is_open else 0

    def lacks(self) -> tuple[str, ...]:
        """Return the reasons why nothing was judged; empty where something was."""
        is_nothing = sum(self.bodies.values()) == self.bodies[Status.UNAVAILABLE]
        return tuple(self._reasons[Status.UNAVAILABLE]) if is_nothing else ()

    def refusals(self) -> tuple[str, ...]:
        """Return some of the reasons why numbers make no body."""
        return tuple(self._reasons[Status.REFUSED])

    def _add_worst(self, rows: _Rows) -> None:
        """Keep the bodies that came nearest to failing, of these and those before."""
        size = np.where(rows.is_asked & (rows.words("quantity") != INITIAL), rows.ratio, -inf)
        looked_at = np.select(
            [rows.is_status(status) for status in _LOOKED_AT],
            [len(_LOOKED_AT) - i for i in range(len(_LOOKED_AT))],
            0,
        )
        # A body whose numbers make none has no scene to look at.
        is_case = (size > -inf) | (looked_at > 0)
        places = np.flatnonzero(is_case)
        order = np.lexsort((rows.point[places], -size[places], -looked_at[places]))
        taken: set[int] = set()
        for place in places[order]:
            point = int(rows.point[place])
            if point in taken:
                continue
            taken.add(point)
            key = (-float(looked_at[place]), -float(size[place]), point)
            if len(self.worst) >= self._most and key >= self.worst[-1][0]:
                break
            self.worst.append((key, rows.case(int(place), self._drawn)))
            self.worst = sorted(self.worst, key=lambda each: each[0])[: self._most]


class _Quantity:
    """The rows of one quantity."""

    def __init__(self, name: str) -> None:
        self._name, self._unit = name, ""
        self._counts: Counter[str] = Counter()
        self._ratio, self._max = Sizes(), Sizes()

    def add(self, rows: _Rows, is_mine: Array) -> None:
        self._counts.update(rows.words("verdict")[is_mine].tolist())
        asked = is_mine & rows.is_asked
        self._unit = self._unit or next(filter(None, rows.words("unit")[asked].tolist()), "")
        self._ratio.add(rows.ratio[asked])
        self._max.add(rows.max[asked])

    def spread(self) -> Spread:
        counts = {status.value: self._counts[status.value] for status in Status}
        ratio, largest = self._ratio.quantiles(), self._max.quantiles()
        judged, above = self._ratio.count, self._ratio.above()
        return Spread(self._name, counts, judged, self._unit, ratio, largest, above)


class _Rows:
    """The rows of a part as arrays."""

    def __init__(self, table: Any) -> None:
        self._table = table
        self._words: dict[str, Array] = {}
        self.point = self._numbers("point").astype(np.int64)
        self.starts = np.flatnonzero(np.diff(self.point, prepend=-1))
        self.gravity = np.array(
            [_GRAVITY_OF_WORDS[word] for word in self.words("verdict").tolist()]
        )
        self.is_asked = self.is_status(Status.PASS) | self.is_status(Status.FAIL)
        # A gate that failed without a number is beyond every number; one that passed has no error.
        lost = np.where(self.is_status(Status.FAIL), inf, 0.0)
        ratio, largest = self._numbers("ratio"), self._numbers("max")
        self.ratio = np.where(np.isnan(ratio), lost, ratio)
        self.max = np.where(np.isnan(largest), lost, largest)

    def words(self, name: str) -> Array:
        """Return a column of texts."""
        if name not in self._words:
            self._words[name] = np.array(self._table.column(name).to_pylist(), dtype=object)
        return self._words[name]

    def is_status(self, status: Status) -> Array:
        return np.asarray(self.words("verdict") == status.value)

    def case(self, place: int, drawn: tuple[str, ...]) -> WorstCase:
        """Return the body of a row."""
        row: Mapping[str, Any] = {
            name: self._table.column(name)[place].as_py() for name in self._table.column_names
        }
        ratio, largest = (row[name] for name in ("ratio", "max"))
        return WorstCase(
            point=row["point"],
            scene=row["scene"],
            verdict=Status(row["verdict"]),
            quantity=row["quantity"],
            ratio=ratio if ratio is not None and isfinite(ratio) else None,
            max=largest if largest is not None and isfinite(largest) else None,
            because=row["because"],
            drawn={name: row[DRAWN + name] for name in drawn},
        )

    def _numbers(self, name: str) -> Array:
        return np.asarray(self._table.column(name).to_numpy(), dtype=float)


def with_causes(result: SweepSummary, causes: Mapping[int, tuple[str, ...]]) -> SweepSummary:
    """Return the summary with the causes of each worst case, by its point."""
    return replace(
        result,
        worst=tuple(replace(case, causes=causes.get(case.point, ())) for case in result.worst),
    )


def with_files(result: SweepSummary, files: Mapping[int, str]) -> SweepSummary:
    """Return the summary with the file of each worst case, by its point."""
    return replace(
        result, worst=tuple(replace(case, file=files.get(case.point, "")) for case in result.worst)
    )
