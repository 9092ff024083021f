"""Hunt for the worst: the largest error over attainable in families of scenes.

A family is a cube: numbers between 0 and 1 become a scene, in exact decimals. A population of points moves
through it by differential evolution. The driver answers every scene, and its score is the largest error
over attainable of all gates that are not vacuous. The budget is a number of runs, and not a time, so that
a hunt can be repeated.
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
from taylor_verify.studies.study import NotMeasured
from taylor_verify.studies.worst.document import WorstOfFamily, WorstStudy

Array = np.ndarray[Any, Any]

RUNG: Final = "f64"
# The budget has at least half a dozen generations, and a population small enough to climb.
_LEAST_POPULATION: Final = 5
_GENERATIONS: Final = 10
_PER_NUMBER: Final = 10


@dataclass(frozen=True)
class Quarry:
    """A family of the hunt, and its scenes in a few words."""

    family: Family
    what: str

    @property
    def name(self) -> str:
        return self.family.name


@dataclass(frozen=True)
class Catch:
    """A scene of a family with its verdict that is nearest to failing."""

    place: tuple[float, ...]
    verdict: Verdict

    @property
    def ratio(self) -> float:
        """Error over attainable; infinite for a gate that failed without a number."""
        ratio = self.verdict.ratio
        return inf if ratio is None or ratio != ratio else ratio


@dataclass(frozen=True)
class FamilyResult:
    """The result of a family: the number of judged scenes, and the worst scene."""

    quarry: Quarry
    judged: int
    worst: Catch

    @property
    def scene_text(self) -> str:
        """The worst scene as a file with its reason."""
        ratio = f"{self.worst.ratio:.3g}"
        return (
            f"# Why: of {self.quarry.what}, the largest error over attainable that a hunt has found,\n"
            f"# {ratio} in {self.worst.verdict.quantity} on {RUNG}; a gate stands at {GATE_FACTOR}.\n"
            f"{self.quarry.family.text(self.worst.place)}"
        )


def hunt(
    quarries: Sequence[Quarry], runs: int, seed: int, finished: Callable[[str], None]
) -> list[FamilyResult]:
    """Return the worst of each family after ``runs`` runs in each.

    ``finished`` is called with the name of each family as it ends. Raises NotMeasured without SciPy, and if
    no scene of a family could be judged.
    """
    results = []
    for quarry in quarries:
        results.append(_hunt(quarry, runs, seed))
        finished(quarry.name)
    return results


def _hunt(quarry: Quarry, runs: int, seed: int) -> FamilyResult:
    try:
        from scipy.optimize import differential_evolution
    except ImportError:
        expected = "expected SciPy (pip install 'taylor-verify[scipy]')"
        raise NotMeasured(f"{expected} for the hunt, got none") from None
    free = quarry.family.free
    # Each family has its own seed, which does not depend on the order of families.
    own = crc32(f"{seed} {quarry.name}".encode())
    catches: list[Catch] = []

    def least(population: Array) -> Array:
        """Return the function to minimise at points that are the columns of an array."""
        catches_of_one = caught(quarry.family, population.T.tolist())
        catches.extend(catch for catch in catches_of_one if catch is not None)
        return np.array([inf if catch is None else -catch.ratio for catch in catches_of_one])

    population = max(_LEAST_POPULATION, min(_PER_NUMBER * free, runs // _GENERATIONS))
    differential_evolution(
        least,
        [(0.0, 1.0)] * free,
        init=places(Spread.SOBOL, free, own, 0, population),
        maxiter=max(runs // population - 1, 0),
        # The search ends with its budget alone.
        tol=0.0,
        atol=-1.0,
        polish=False,
        vectorized=True,
        updating="deferred",
        seed=np.random.default_rng(own),
    )
    if not catches:
        raise NotMeasured(f"expected a scene that can be judged, got none @ {quarry.name}")
    return FamilyResult(quarry, len(catches), max(catches, key=lambda catch: catch.ratio))


def caught(family: Family, several: Sequence[Place]) -> list[Catch | None]:
    """Return the gate nearest to failing at each point; None without a body or a non-vacuous gate."""
    scenes = [_scene(family, place) for place in several]
    answers = iter(judged([scene for scene in scenes if scene is not None], TAYLOR, RUNG))
    return [
        None if scene is None else _nearest(place, next(answers))
        for place, scene in zip(several, scenes, strict=True)
    ]


def _scene(family: Family, place: Place) -> Scene | None:
    try:
        return family.scene(place)
    except Refused:
        return None


def _nearest(place: Place, verdicts: Iterable[Verdict]) -> Catch | None:
    catches = (Catch(tuple(place), verdict) for verdict in verdicts if _counts(verdict))
    return max(catches, key=lambda catch: catch.ratio, default=None)


def _counts(verdict: Verdict) -> bool:
    is_asked = verdict.verdict in (Status.PASS, Status.FAIL)
    # The start is the first row of a state, which the error of the state includes.
    return is_asked and verdict.quantity != INITIAL


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
                name=result.quarry.name,
                what=result.quarry.what,
                judged=result.judged,
                ratio=result.worst.ratio,
                quantity=result.worst.verdict.quantity,
                verdict=result.worst.verdict.verdict,
                max=result.worst.verdict.max,
                scene=f"extremes/worst/{result.quarry.name}",
            )
            for result in results
        ),
    )


_HUNTED: Final = {
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


def quarries() -> tuple[Quarry, ...]:
    """Return the shipped families of the hunt."""
    return tuple(Quarry(family(name), what) for name, what in _HUNTED.items())
