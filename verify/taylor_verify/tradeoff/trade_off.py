"""Trade-off of one scene: every setting solved, timed and compared with the truth; and the front."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from taylor_verify.judge.provenance import provenance
from taylor_verify.models.problem import NotRepresentable, Problem
from taylor_verify.records.json_text import finite
from taylor_verify.records.passing import Passing
from taylor_verify.records.showing import dataframe, html_table
from taylor_verify.records.standing import Standing
from taylor_verify.scenes.scene import Scene
from taylor_verify.tradeoff.accuracy import Truths
from taylor_verify.tradeoff.attainability import least_error
from taylor_verify.tradeoff.pareto import pareto
from taylor_verify.tradeoff.point import Point, digits, point
from taylor_verify.tradeoff.setting import Setting, settings
from taylor_verify.tradeoff.solves import PATIENCE, REPEATS, SEED, WHAT_IS_TIMED, timed

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, repr=False)
class TradeOff(Passing):
    """The points of one scene from one run, in the order of the settings."""

    scene: Scene
    points: tuple[Point, ...]
    repeats: int
    seed: int

    @property
    def front(self) -> list[Point]:
        """The sound points that no other beats in both time and error, the fastest first."""
        return front(self.points)

    @property
    def passed(self) -> bool:
        """True if some setting gave a sound answer."""
        return bool(self.front)

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame, a row a setting. Raises ModuleNotFoundError without pandas."""
        return dataframe(p.row() for p in self.points)

    def __repr__(self) -> str:
        best, every = len(self.front), len(self.points)
        return f"<TradeOff of {self.scene.name}: {best} of {every} settings on the front>"

    def __str__(self) -> str:
        return "\n".join([repr(self)[1:-1], *front_sentences(self.points)])

    def _repr_html_(self) -> str:
        rows = [(p.label, f"{p.error:.2g}", f"{p.seconds:.3g}") for p in self.points]
        headings = ("setting", "error", "seconds")
        return html_table(repr(self)[1:-1], headings, rows, front_sentences(self.points))

    def document(self) -> dict[str, Any]:
        """Return the document of `tradeoff --json`.

        ``sentences`` describe the front.
        """
        return {
            "scene": self.scene.name,
            "track": sorted(self.scene.track),
            "points": [p.row() for p in self.points],
            "attainable": self.attainable,
            "front": [p.label for p in self.front],
            "sentences": front_sentences(self.points),
            "timing": {
                "repeats": self.repeats,
                "seed": self.seed,
                "order": "each round shuffled anew",
                "unit": "s",
                "of": WHAT_IS_TIMED,
            },
            "provenance": provenance(self.scene.digest),
        }

    @property
    def attainable(self) -> dict[str, float | None]:
        """The least error that rounding leaves, by rung; None if it is unknown."""
        rungs = dict.fromkeys(p.timed.setting.rung for p in self.points)
        return {rung.name: finite(least_error(self.scene, rung)) for rung in rungs}


def trade_off(
    scene: Scene,
    asked: Sequence[Setting] | None = None,
    repeats: int = REPEATS,
    seed: int = SEED,
    patience: float = PATIENCE,
) -> TradeOff:
    """Measure the errors and the best times of the settings ``asked``, or of all.

    There are ``repeats`` rounds, whose order ``seed`` draws. A setting that has taken ``patience`` seconds
    is timed no further (see `solves.timed`). A setting that cannot run becomes a point with the reason, and
    without an error.
    """
    asked = settings(scene) if asked is None else asked
    posed = {setting: _posed(scene, setting) for setting in asked}
    truths, points = Truths(), []
    for answer in timed(posed, repeats, seed, patience):
        problem = posed[answer.setting]
        known = None if isinstance(problem, str) else truths.accuracy(problem, answer.trajectory)
        points.append(point(answer, known))
    return TradeOff(scene, tuple(points), repeats, seed)


def _posed(scene: Scene, setting: Setting) -> Problem | str:
    """Return the problem of a setting, or the reason why it cannot be posed."""
    if reason := setting.withheld or setting.solver.unavailable(setting.rung):
        return reason
    try:
        problem = setting.solver.problem(scene, setting.rung)
    except NotRepresentable as fault:
        return str(fault)
    return setting.solver.unsuited(problem) or problem


# Sentences on the front and on each tolerance.


def front(points: Iterable[Point]) -> list[Point]:
    """Return the sound points that no other beats in both time and error, the fastest first."""
    return pareto(sound_points(points), lambda p: (p.seconds, p.error))


def sound_points(points: Iterable[Point]) -> list[Point]:
    """Return the sound points whose error is below 1; NaN is not below 1."""
    return [p for p in points if p.standing is Standing.SOUND and p.error < 1]


def front_sentences(points: Sequence[Point]) -> list[str]:
    """Return the front in words, with times as multiples of the fastest."""
    best, sound = front(points), sound_points(points)
    if not best:
        return ["No setting gave an answer that is sound."]
    sentences, fastest = [], best[0].seconds
    for p in best:
        left = digits(p.error)
        named = "All digits" if left is None else f"{left:.1f} digits"
        pace = f", {p.seconds / fastest:.2f} times the fastest" if p.seconds > fastest > 0 else ""
        sentences.append(f"{named} (error {p.error:.2g}): {p.label} in {p.seconds:.3g} s{pace}.")
    beaten = len(sound) - len(best)
    sentences.append(
        f"{beaten} of {len(sound)} sound settings are beaten in both time and error by one of these."
    )
    if (widest := max(p.timed.spread or 1.0 for p in best)) > 1:
        sentences.append(
            f"A setting's slowest solve took up to {widest:.2g} times its fastest: smaller differences "
            "of times mean nothing."
        )
    return sentences
