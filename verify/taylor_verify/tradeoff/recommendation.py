"""Recommendation of the fastest setting whose error, with a margin, is below a target on several starts."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.models.problem import NotRepresentable
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.passing import Passing
from taylor_verify.records.showing import dataframe, html_table
from taylor_verify.scenes.reading.positive import positive
from taylor_verify.scenes.reading.reader import as_scene
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import PROCESS
from taylor_verify.solvers.solver import Solver
from taylor_verify.tradeoff.accuracy import Truths
from taylor_verify.tradeoff.attainability import left_out, narrowest
from taylor_verify.tradeoff.document import label
from taylor_verify.tradeoff.point import Point
from taylor_verify.tradeoff.random_starts import nearby
from taylor_verify.tradeoff.setting import Setting, settings
from taylor_verify.tradeoff.solves import SEED
from taylor_verify.tradeoff.trade_off import TradeOff, sound_points, trade_off

if TYPE_CHECKING:
    import pandas

# A margin of one binary digit for starts outside the ensemble.
MARGIN: Final = 2.0
# These may compute in a wider precision than that of their answer, so that the floor does not bind them.
_OF_ANOTHER_PRECISION: Final = (PROCESS, "mpmath:")


class OutOfReach(Exception):  # noqa: N818 (it names what the target is)
    """No setting reaches the target; the text names the most accurate one, or the reasons."""


@dataclass(frozen=True, repr=False)
class Recommendation(Passing):
    """A setting that is ready to run: by ``taylor_verify.run``, by ``command``, or by ``solver`` itself.

    ``solver.solve(solver.problem(scene, rung))`` returns a trajectory that is not judged. ``error`` is the
    largest over ``starts`` starts, of which the first is the scene's own; ``margin`` times ``error`` is at
    most ``target``. ``seconds`` is the best time of a solve without compiling. ``left_out`` are the reasons
    why rungs were not measured: their arithmetic cannot reach the target.
    """

    scene: str
    solver: Solver
    rung: Rung
    target: float
    error: float
    margin: float
    starts: int
    seed: int
    seconds: float
    left_out: tuple[str, ...] = ()

    def document(self) -> dict[str, Any]:
        """Return the document that ``tradeoff --target --json`` prints."""
        return {
            "solver": self.solver.name,
            "setting": self.solver.setting,
            "rung": self.rung.name,
            "target": self.target,
            "error": self.error,
            "margin": self.margin,
            "starts": self.starts,
            "seed": self.seed,
            "seconds": self.seconds,
            "left_out": list(self.left_out),
            "command": self.command,
            "sentence": self.sentence,
        }

    @property
    def passed(self) -> bool:
        """True if the error stays below the target with the margin, as that of each one returned does."""
        return self.margin * self.error <= self.target

    def _repr_html_(self) -> str:
        rows = [(name, str(value)) for name, value in self.document().items()]
        return html_table(repr(self)[1:-1], ("", ""), rows)

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame of one row. Raises ModuleNotFoundError without pandas."""
        return dataframe([self.document()])

    def __str__(self) -> str:
        return f"{self.sentence}\n{self.command}"

    def __repr__(self) -> str:
        setting = label(self.solver.name, self.solver.setting, self.rung.name)
        return f"<Recommendation for {self.scene} below {self.target:.3g}: {setting}>"

    @property
    def command(self) -> str:
        """The command line that runs and judges the setting."""
        words = ["taylor-verify", "run", self.scene, "--solver", self.solver.name]
        return shlex.join([*words, "--rung", self.rung.name])

    @property
    def sentence(self) -> str:
        """The recommendation in words, with the rungs that were not measured and the reasons."""
        setting = label(self.solver.name, self.solver.setting, self.rung.name)
        unmeasured = f" Not measured: {'; '.join(self.left_out)}." if self.left_out else ""
        return (
            f"To stay below {self.target:.3g}: {setting}, "
            f"{self.seconds:.3g} s per solve. Its largest error over {self.starts} starts "
            f"(seed {self.seed}) is {self.error:.2g}; a margin of {self.margin:g} is kept."
            f"{unmeasured}"
        )


def recommend(
    scene: Scene | str | PathLike[str],
    error: float,
    asked: Sequence[Setting] | None = None,
    seed: int = SEED,
) -> Recommendation:
    """Return the fastest setting; arguments and raised errors are those of `taylor_verify.recommend`."""
    positive(error, "error", "a positive error")
    scene = as_scene(scene)
    asked = settings(scene) if asked is None else asked
    bound = [
        setting for setting in asked if not setting.solver.name.startswith(_OF_ANOTHER_PRECISION)
    ]
    without = left_out(scene, (setting.rung for setting in bound), error)
    measurable = [
        setting for setting in asked if setting.rung not in without or setting not in bound
    ]
    reasons = tuple(without.values())
    if not measurable and reasons:
        raise OutOfReach(_out_of_reach(scene, error, f": {'; '.join(reasons)}"))
    return replace(recommended(trade_off(scene, measurable, seed=seed), error), left_out=reasons)


def recommended(trade: TradeOff, error: float) -> Recommendation:
    """Return the fastest setting of a measured trade that reaches the target.

    ``error`` is as in `recommend`. Raises OutOfReach if no setting reaches it.
    """
    scenes, truths = nearby(trade.scene, trade.seed), Truths()
    sound = sound_points(trade.points)
    candidates = [p for p in sound if MARGIN * p.error <= error]
    for p in sorted(candidates, key=lambda p: p.seconds):
        worst = _largest(p, scenes, truths, error)
        if worst is not None:
            setting = p.timed.setting
            return Recommendation(
                trade.scene.name,
                setting.solver,
                setting.rung,
                target=error,
                error=worst,
                margin=MARGIN,
                starts=1 + len(scenes),
                seed=trade.seed,
                seconds=p.seconds,
            )
    if not sound:
        raise OutOfReach(_out_of_reach(trade.scene, error, "; none gave a sound answer"))
    best = min(sound, key=lambda p: p.error)
    nearest = f"; the most accurate, {best.label}, has an error of {best.error:.2g} on the scene"
    raise OutOfReach(_out_of_reach(trade.scene, error, nearest))


def _largest(p: Point, scenes: Sequence[Scene], truths: Truths, target: float) -> float | None:
    """Return the largest error over all starts; None if a start misses the target or has no truth."""
    setting, worst = p.timed.setting, p.error
    for scene in scenes:
        try:
            problem = setting.solver.problem(scene, setting.rung)
        except NotRepresentable:
            return None
        accuracy = truths.accuracy(problem, setting.solver.solve(problem))
        if accuracy is None or not MARGIN * accuracy.worst <= target:
            return None
        worst = max(worst, accuracy.worst)
    return worst


def _out_of_reach(scene: Scene, error: float, reason: str) -> str:
    """Return the reason why no setting reaches an error, with the narrowest rung that could."""
    narrowest_rung = narrowest(scene, error / MARGIN)
    wider = "no precision is known on which rounding alone leaves so little"
    if narrowest_rung is not None:
        rung, least = narrowest_rung
        wider = (
            "the narrowest precision on which rounding alone leaves so little is "
            f"{rung.name} ({least:.2g})"
        )
    nothing = f"no setting stays below {error:.3g} with a margin of {MARGIN:g} @ {scene.name}"
    return f"{nothing}{reason}; {wider}"
