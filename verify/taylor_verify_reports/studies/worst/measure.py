"""Search for the worst scene of a family: the one with the largest error over attainable.

A point of a cube, numbers between 0 and 1, becomes a scene of the family in exact decimals. A population of
points moves through the cube by differential evolution. The Taylor driver answers every scene; its score is
the largest error over attainable of all gates that are not vacuous. The budget is a number of runs, and not
a time, so that a search can be repeated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any, Final
from zlib import crc32

import numpy as np
from taylor_verify.batch.bodies import judged

from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.records.provenance import Provenance
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.families.cube import Spread, places
from taylor_verify.scenes.families.family import Family, Place
from taylor_verify.scenes.families.library import family
from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify_reports.studies.study import NotMeasured
from taylor_verify_reports.studies.worst.document import WorstOfFamily, WorstStudy

Array = np.ndarray[Any, Any]

RUNG: Final = "f64"
# The population has ten points for each free number of a family, but no more than leave ten generations to
# the budget, and at least five.
_POINTS_PER_NUMBER: Final = 10
_LEAST_GENERATIONS: Final = 10
_LEAST_POPULATION: Final = 5


@dataclass(frozen=True)
class SearchedFamily:
    """A family of scenes to search; ``what`` says in a few words what its scenes are."""

    family: Family
    what: str

    @property
    def name(self) -> str:
        """The name of the family."""
        return self.family.name


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
class FamilyResult:
    """The result of a search: the number of judged scenes of a family, and the worst of them."""

    searched: SearchedFamily
    judged: int
    worst: Candidate

    @property
    def scene_text(self) -> str:
        """The worst scene as a TOML file, with a comment that says why it is there."""
        ratio = f"{self.worst.ratio:.3g}"
        return (
            f"# Why: of {self.searched.what}, the largest error over attainable that a hunt has found,\n"
            f"# {ratio} in {self.worst.verdict.quantity} on {RUNG}; a gate stands at {GATE_FACTOR}.\n"
            f"{self.searched.family.text(self.worst.place)}"
        )


def search(
    families: Sequence[SearchedFamily], runs: int, seed: int, finished: Callable[[str], None]
) -> list[FamilyResult]:
    """Return the worst scene of each family, after ``runs`` runs in each.

    ``finished`` is called with the name of each family as its search ends. Raises NotMeasured without
    SciPy, and if no scene of a family could be judged.
    """
    results = []
    for searched in families:
        results.append(_search(searched, runs, seed))
        finished(searched.name)
    return results


def _search(searched: SearchedFamily, runs: int, seed: int) -> FamilyResult:
    try:
        from scipy.optimize import differential_evolution
    except ImportError:
        expected = "expected SciPy (pip install 'taylor-verify[scipy]')"
        raise NotMeasured(f"{expected} for the search, got none") from None
    free = searched.family.free
    # Each family has its own seed, which does not depend on the order of families.
    own = crc32(f"{seed} {searched.name}".encode())
    candidates: list[Candidate] = []

    def score(population: Array) -> Array:
        """Return minus the ratio at each of the points, which are the columns of an array."""
        judged_points = candidates_at(searched.family, population.T.tolist())
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
    return FamilyResult(searched, len(candidates), worst)


def candidates_at(family: Family, points: Sequence[Place]) -> list[Candidate | None]:
    """Return the judged scene at each point; None for a refused scene, and if no verdict counts."""
    scenes = [_scene(family, point) for point in points]
    answers = iter(judged([scene for scene in scenes if scene is not None], TAYLOR, RUNG))
    return [
        None if scene is None else _nearest(point, next(answers))
        for point, scene in zip(points, scenes, strict=True)
    ]


def _scene(family: Family, place: Place) -> Scene | None:
    """Return the scene at a point; None if the reader refuses it."""
    try:
        return family.scene(place)
    except Refused:
        return None


def _nearest(place: Place, verdicts: Iterable[Verdict]) -> Candidate | None:
    """Return the scene with its verdict that is nearest to failing; None if no verdict counts."""
    candidates = (Candidate(tuple(place), verdict) for verdict in verdicts if _counts(verdict))
    return max(candidates, key=lambda candidate: candidate.ratio, default=None)


def _counts(verdict: Verdict) -> bool:
    is_compared = verdict.verdict in (Status.PASS, Status.FAIL)
    # The start is the first row of a state, which the error of the state includes.
    return is_compared and verdict.quantity != INITIAL


def study(results: Iterable[FamilyResult], runs: int, seed: int) -> WorstStudy:
    """Return the document of the published table."""
    return WorstStudy(
        factor=GATE_FACTOR,
        rung=RUNG,
        runs=runs,
        seed=seed,
        provenance=Provenance(versions(), processor(), command()),
        families=tuple(
            WorstOfFamily(
                name=result.searched.name,
                what=result.searched.what,
                judged=result.judged,
                ratio=result.worst.ratio,
                quantity=result.worst.verdict.quantity,
                verdict=result.worst.verdict.verdict,
                max=result.worst.verdict.max,
                scene=f"extremes/worst/{result.searched.name}",
            )
            for result in results
        ),
    )


_SEARCHED: Final = {
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


def searched_families() -> tuple[SearchedFamily, ...]:
    """Return the shipped families that are searched."""
    return tuple(SearchedFamily(family(name), what) for name, what in _SEARCHED.items())
