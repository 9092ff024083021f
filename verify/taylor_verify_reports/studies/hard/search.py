"""Search for the worst scene of a family: the one with the largest error over attainable.

A point of a cube, numbers between 0 and 1, becomes a scene of the family in exact decimals. A population of
points moves through the cube by differential evolution. The Taylor driver answers every scene; its score is
the largest error over attainable of all gates that are not vacuous. The budget is a number of runs, and not
a time, so that a search can be repeated.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any, Final
from zlib import crc32

import numpy as np

from taylor_verify.records.faults import Refused
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.families.cube import Spread, places
from taylor_verify.scenes.families.family import Family, Place
from taylor_verify.scenes.families.shipped import family
from taylor_verify.scenes.library import WORST
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify_reports.studies.hard.hard_scenes import WorstOfFamily
from taylor_verify_reports.studies.study import NotMeasured

RUNG: Final = "f64"
# The population has ten points for each free number of a family, but no more than leave ten generations to
# the budget, and at least five.
_POINTS_PER_NUMBER: Final = 10
_LEAST_GENERATIONS: Final = 10
_LEAST_POPULATION: Final = 5

# The shipped families that are searched, and what their scenes are.
SEARCHED: Final = {
    "euler-distance": "bodies that start beside their unstable axis",
    "euler-gaps": "bodies with two moments close together",
    "euler-ratios": "bodies with moments far apart",
    "euler-scales": "motions of all sizes",
    "euler-modulus": "motions near the separatrix",
    "kirchhoff-small-impulse": "solids with a small linear impulse",
    "kirchhoff-critical-spin": "spins about the axis near the critical one",
    "kirchhoff-near-singular": "energies that are nearly singular",
    "kirchhoff-added-mass": "solids with any added mass across and along",
}


@dataclass(frozen=True)
class Candidate:
    """A judged scene: its ``place`` in the cube of its family, and its verdict nearest to failing."""

    place: tuple[float, ...]
    verdict: Verdict

    @property
    def ratio(self) -> float:
        """The error over attainable; infinite for a gate that failed without a number."""
        ratio = self.verdict.ratio
        return inf if ratio is None or ratio != ratio else ratio


@dataclass(frozen=True)
class Found:
    """The result of a search: the number of judged scenes of a family, and the worst of them."""

    family: Family
    what: str
    judged: int
    worst: Candidate

    @property
    def scene_text(self) -> str:
        """The worst scene as a TOML file, with a comment that says why it is there."""
        ratio = f"{self.worst.ratio:.3g}"
        return (
            f"# Why: of {self.what}, the largest error over attainable that a hunt has found,\n"
            f"# {ratio} in {self.worst.verdict.quantity} on {RUNG}; a gate stands at {GATE_FACTOR}.\n"
            f"{self.family.text(self.worst.place)}"
        )

    def row(self) -> WorstOfFamily:
        """Return the row of the published table."""
        return WorstOfFamily(
            name=self.family.name,
            what=self.what,
            judged=self.judged,
            ratio=self.worst.ratio,
            quantity=self.worst.verdict.quantity,
            verdict=self.worst.verdict.verdict,
            max=self.worst.verdict.max,
            scene=f"{WORST}/{self.family.name}",
        )


def search_all(runs: int, seed: int, finished: Callable[[str], None]) -> list[Found]:
    """Return the worst scene of each searched family; ``finished`` is called with each name.

    Raises the errors of `search`.
    """
    results = []
    for name, what in SEARCHED.items():
        results.append(search(family(name), what, runs, seed))
        finished(name)
    return results


def search(searched: Family, what: str, runs: int, seed: int) -> Found:
    """Return the worst scene of a family after ``runs`` runs.

    Raises NotMeasured without SciPy, and if no scene of the family could be judged.
    """
    try:
        from scipy.optimize import differential_evolution
    except ImportError:
        expected = "expected SciPy (pip install 'taylor-verify[scipy]')"
        raise NotMeasured(f"{expected} for the search, got none") from None
    # Each family has its own seed, which does not depend on the order of families.
    free, own = searched.free, crc32(f"{seed} {searched.name}".encode())
    candidates: list[Candidate] = []

    def score(population: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        """Return minus the ratio at each of the points, which are the columns of an array."""
        judged_points = candidates_at(searched, population.T.tolist())
        candidates.extend(point for point in judged_points if point is not None)
        return np.array([inf if point is None else -point.ratio for point in judged_points])

    population = max(_LEAST_POPULATION, min(_POINTS_PER_NUMBER * free, runs // _LEAST_GENERATIONS))
    differential_evolution(
        score,
        [(0.0, 1.0)] * free,
        init=places(Spread.SOBOL, free, own, 0, population),
        maxiter=max(runs // population - 1, 0),
        # Only the budget ends the search.
        tol=0.0,
        atol=-1.0,
        polish=False,
        vectorized=True,
        updating="deferred",
        seed=np.random.default_rng(own),
    )
    if not candidates:
        raise NotMeasured(f"expected a scene that can be judged, got none @ {searched.name}")
    worst = max(candidates, key=lambda candidate: candidate.ratio)
    return Found(searched, what, len(candidates), worst)


def candidates_at(searched: Family, points: Sequence[Place]) -> list[Candidate | None]:
    """Return the judged scene at each point; None for a refused scene, and if no verdict counts."""
    return [_candidate(searched, tuple(point)) for point in points]


def _candidate(searched: Family, place: tuple[float, ...]) -> Candidate | None:
    """Return the scene at a point with its verdict that is nearest to failing."""
    try:
        scene = searched.scene(place)
    except Refused:
        return None
    verdicts = filter(counts, run(scene, TAYLOR, RUNG, causes=False).verdicts)
    candidates = (Candidate(place, verdict) for verdict in verdicts)
    return max(candidates, key=lambda candidate: candidate.ratio, default=None)


def counts(verdict: Verdict) -> bool:
    """Return True for a verdict that was compared and is not that of the start, which a state includes."""
    return verdict.verdict in (Status.PASS, Status.FAIL) and verdict.quantity != INITIAL
