"""The summary of a sweep: how many bodies passed, how the errors are spread, and the worst cases."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Annotated, Any

from taylor_verify.records.json_text import Count, Size, about
from taylor_verify.records.passing import Passing
from taylor_verify.records.provenance import Provenance
from taylor_verify.records.showing import dataframe, html_table
from taylor_verify.records.status import Status

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Quantiles:
    """The sizes below which a half, nine tenths, ... of all lie; each is one that occurred.

    Null is beyond every number: a gate that failed without one.
    """

    median: Size | None
    p90: Annotated[Size | None, about("A tenth of all lie above it.")]
    p99: Annotated[Size | None, about("A hundredth of all lie above it.")]
    p99_9: Annotated[Size | None, about("A thousandth of all lie above it.")]
    largest: Size | None


@dataclass(frozen=True)
class Spread:
    """The errors of one quantity over all bodies.

    ``judged`` rows passed or failed their gate; only these are in the quantiles.
    """

    quantity: str
    counts: dict[str, int]
    judged: Count
    unit: str
    ratio: Annotated[Quantiles | None, about("Of error over attainable.")]
    max: Annotated[Quantiles | None, about("Of the largest error, in unit.")]


@dataclass(frozen=True)
class WorstCase:
    """A body that came nearest to failing, or failed; ``file`` is its scene below the folder.

    ``causes`` are the likely causes of its failures, each a sentence.
    """

    point: int
    scene: str
    verdict: Status
    quantity: str
    ratio: Annotated[Size | None, about("Error over attainable; null where there is no number.")]
    max: Size | None
    because: str = ""
    causes: tuple[str, ...] = ()
    file: str = ""
    drawn: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True, repr=False)
class SweepSummary(Passing):
    """The sweep of one family or folder by one solver.

    ``bodies`` counts the bodies by the gravest of their verdicts. ``tolerance`` is what was asked for in
    place of the bounds from the arithmetic, as `--tolerance` takes it; None if nothing was.
    """

    name: str
    title: str
    solver: str
    rung: str
    count: int
    seed: int | None
    points: str | None
    total: Count
    bodies: dict[str, int]
    quantities: tuple[Spread, ...]
    worst: tuple[WorstCase, ...]
    factor: int
    exit_status: int
    tolerance: str | None = None
    lacks: Annotated[tuple[str, ...], about("Why nothing was judged, where nothing was.")] = ()
    refusals: Annotated[
        tuple[str, ...], about("Some of the reasons why drawn numbers make no body.")
    ] = ()
    provenance: Provenance = field(default_factory=Provenance)

    @property
    def bound(self) -> str:
        """The size above which a body fails, in words: a multiple of the floor, or the tolerance."""
        return str(self.factor) if self.tolerance is None else f"the tolerance {self.tolerance}"

    @property
    def passed(self) -> bool:
        """True if something was judged, and the exit status is 0."""
        return self.exit_status == 0 and not self.lacks

    @property
    def counts(self) -> str:
        """The number of bodies of each verdict that occurs, in words."""
        return ", ".join(f"{n} {word}" for word, n in self.bodies.items() if n) or "none"

    def __getitem__(self, quantity: str) -> Spread:
        """Return the spread of a quantity, as ``summary["omega"]``; KeyError with those there are."""
        for spread in self.quantities:
            if spread.quantity == quantity:
                return spread
        raise KeyError(f"{quantity}, of {', '.join(each.quantity for each in self.quantities)}")

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame with a row for each quantity: its counts, and its quantiles.

        Raises ModuleNotFoundError without pandas (``pip install pandas``).
        """
        return dataframe(self._rows)

    @property
    def _rows(self) -> list[dict[str, Any]]:
        return [
            {"quantity": each.quantity, "judged": each.judged, "unit": each.unit}
            | each.counts
            | {f"ratio_{name}": size for name, size in _sizes(each.ratio)}
            | {f"max_{name}": size for name, size in _sizes(each.max)}
            for each in self.quantities
        ]

    def __str__(self) -> str:
        return f"{self.name}: {self.total} bodies by {self.solver} on {self.rung}: {self.counts}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self}: {'passed' if self.passed else 'not passed'}>"

    def _repr_html_(self) -> str:
        rows = [
            [each.quantity, str(each.judged), str(each.counts["fail"])]
            + [f"{size:.3g}" if size is not None else "" for _, size in _sizes(each.ratio)]
            for each in self.quantities
        ]
        headings = ("quantity", "judged", "fail", *(each.name for each in fields(Quantiles)))
        sentences = [f"errors over the roundoff floor; a body fails above {self.bound}"]
        sentences += [f"{case.scene}: {case.quantity} {case.verdict}" for case in self.worst]
        return html_table(repr(self)[1:-1], headings, rows, [*sentences, *self.lacks])


def _sizes(quantiles: Quantiles | None) -> list[tuple[str, float | None]]:
    """Return the sizes by name, None for each where there are none."""
    return [(each.name, getattr(quantiles, each.name, None)) for each in fields(Quantiles)]
