"""Published ensembles, and the long one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.records.provenance import Provenance
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify.solvers.taylor.numbers import unavailable
from taylor_verify_reports.studies.growth.document import Ensemble, GrowthStudy
from taylor_verify_reports.studies.growth.experiment import experiment
from taylor_verify_reports.studies.growth.question import Question


@dataclass(frozen=True)
class Entry:
    """An ensemble as text and numbers; ``why`` is the reason to measure it."""

    scene: str
    rung: str
    periods: float
    lanes: int
    why: str
    solver: str = TAYLOR

    def question(self, most: float | None = None) -> Question:
        """Return the question of the ensemble, with ``most`` periods at most. Raises ValueError."""
        periods = self.periods if most is None else min(self.periods, most)
        return Question(load(self.scene), rung(self.rung), periods, self.lanes, self.solver)

    @property
    def label(self) -> str:
        """The name of the ensemble in messages."""
        return f"{self.scene} {self.solver} {self.rung}"


PUBLISHED: Final = (
    Entry(
        "euler/about-max-axis", "f64", periods=1e6, lanes=16, why="Brouwer's law over four decades"
    ),
    # x87 has no batch mode: a lane takes a minute or two, and six are enough for an interval.
    Entry(
        "euler/about-max-axis", "f80", periods=1e6, lanes=6, why="the same with eleven bits more"
    ),
    Entry(
        "euler/generic",
        "f64",
        periods=1e6,
        lanes=16,
        why="moments 1, 2, 3, whose coefficients are rounded small fractions",
    ),
    Entry(
        "euler/about-max-axis",
        "f64",
        periods=1e5,
        lanes=16,
        why="a bias that is known: truncation at a coarse tolerance",
        solver=f"{TAYLOR}?tol=1e-12",
    ),
    Entry("kirchhoff/two-real-roots", "f64", periods=1e5, lanes=16, why="a solid in a fluid"),
)
LONG: Final = (
    Entry("euler/about-max-axis", "f64", periods=1e8, lanes=8, why="a hundred million periods"),
)

# A function that is called after each piece with the ensemble's label, the pieces done, and their number.
Finished = Callable[[str, int, int], None]


def followed(
    entries: Sequence[Entry], finished: Finished, most: float | None = None
) -> GrowthStudy:
    """Follow the ensembles of the entries; those whose rung this machine lacks are named as left out.

    ``most`` is the most periods of an ensemble. Raises ValueError for too few periods.
    """
    runs: list[Ensemble] = []
    left_out: list[str] = []
    for entry in entries:
        if missing := unavailable(rung(entry.rung)):
            left_out.append(f"{entry.label}: {missing}")
            continue
        result = experiment(entry.question(most), partial(finished, entry.label))
        runs.append(result.ensemble(entry.why))
    return GrowthStudy(tuple(runs), tuple(left_out), Provenance(versions(), processor(), command()))
