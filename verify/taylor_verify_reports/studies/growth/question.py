"""Question of an ensemble: a scene and starts near it, at a few instants in each decade of time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import ceil, floor, log10, pi
from typing import Final

from taylor_verify.exact.elements import elements
from taylor_verify.models.fastest_rate import Linearised
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify.solvers.taylor.settings import tolerance
from taylor_verify.tradeoff.random_starts import nearby

# A hundred periods are thousands of steps. Then roundings have become a random walk, and oscillations
# within a period are small beside it.
FIRST_PERIODS: Final = 100
INSTANTS_PER_DECADE: Final = 2
# The gate needs early instants besides the late ones.
LEAST_PERIODS: Final = 10**3.5
# Most periods of a piece. Pieces are part of the question, because a step ends at the end of each.
PIECE_PERIODS: Final = 100_000

# A number of periods that is short by this part counts as reached.
_SLACK: Final = 1e-6


@dataclass(frozen=True)
class Question:
    """A scene and ``lanes`` - 1 starts near its own, drawn from ``seed``, followed for ``periods`` periods.

    ``solver`` is a name of heyoka's integrator, with its tolerance if it has one; ``why`` is the reason to
    measure the ensemble. The body is free and undamped, so that its motion recurs and conserves. Raises
    ValueError for too few periods.
    """

    scene: Scene
    rung: Rung
    periods: float
    lanes: int = 16
    solver: str = TAYLOR
    seed: int = 1
    why: str = ""

    def __post_init__(self) -> None:
        if not self.periods >= LEAST_PERIODS * (1 - _SLACK):
            raise ValueError(
                f"expected at least {LEAST_PERIODS:.0f} periods, got {self.periods:g} @ periods"
            )

    @property
    def label(self) -> str:
        """The name of the ensemble in messages."""
        return f"{self.scene.name} {self.solver} {self.rung.name}"

    @property
    def tolerance(self) -> Fraction | None:
        """The tolerance of the solver; None for the rung's own."""
        return tolerance(self.solver)

    @cached_property
    def period(self) -> float:
        """The period of the orbit in the scene's unit of time.

        If the orbit has none, it is that of the fastest linear rate at the start.
        """
        period = elements(self.scene).get("period")
        if period is not None:
            return float(period.value)
        problem = pose(self.scene, self.rung)
        rate = Linearised(problem).fastest([float(value) for value in problem.initial_momenta])
        return 2 * pi / rate * float(problem.units.time)

    @cached_property
    def counts(self) -> tuple[float, ...]:
        """The instants, in periods: equally many in each decade."""
        first = round(INSTANTS_PER_DECADE * log10(FIRST_PERIODS))
        last = floor(INSTANTS_PER_DECADE * log10(self.periods * (1 + _SLACK)))
        return tuple(10 ** (k / INSTANTS_PER_DECADE) for k in range(first, last + 1))

    @cached_property
    def problems(self) -> tuple[Problem, ...]:
        """The problem of every lane at the instants; that of the first lane has the scene's own start."""
        start = self.scene.clock.start
        clock = Clock(start, tuple(start + Fraction(n * self.period) for n in self.counts))
        scenes = [self.scene, *nearby(self.scene, self.seed, self.lanes - 1)]
        return tuple(pose(replace(scene, clock=clock), self.rung) for scene in scenes)

    @cached_property
    def pieces(self) -> tuple[tuple[tuple[Fraction, ...], bool], ...]:
        """The ends of the pieces: the time of every lane in its own units, and True if it is an instant."""
        stops: list[tuple[tuple[Fraction, ...], bool]] = []
        instants = [*zip(*(problem.times for problem in self.problems), strict=True)]
        start = (Fraction(0),) * len(self.problems)
        for k, (count, after) in enumerate(pairwise((0.0, *self.counts))):
            before = instants[k - 1] if k else start
            parts = ceil((after - count) / PIECE_PERIODS)
            for part in range(1, parts):
                share = Fraction(part, parts)
                ends = zip(before, instants[k], strict=True)
                stops.append((tuple(self.rung.round(a + share * (b - a)) for a, b in ends), False))
            stops.append((instants[k], True))
        return tuple(stops)
