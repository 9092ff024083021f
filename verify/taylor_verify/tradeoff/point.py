"""Point of a trade-off: the accuracy of one setting on a scene, and its time."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, log10
from typing import Any

from taylor_verify.records.json_text import complete, finite
from taylor_verify.records.standing import Standing
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.tradeoff.accuracy import Accuracy
from taylor_verify.tradeoff.document import TradePoint
from taylor_verify.tradeoff.setting import TOLERANCE
from taylor_verify.tradeoff.solves import Timed


@dataclass(frozen=True)
class Point:
    """The accuracy and the time of a setting; ``because`` is the reason why the point is not sound."""

    timed: Timed
    accuracy: Accuracy
    standing: Standing
    because: str = ""

    @property
    def label(self) -> str:
        """The name of the setting in the output of `tradeoff`."""
        return self.timed.setting.label

    @property
    def error(self) -> float:
        """The largest error of all tracked quantities and samples."""
        return self.accuracy.worst

    @property
    def seconds(self) -> float:
        """The best time of a solve without compiling, in seconds; a point that is not sound has none."""
        assert self.timed.best is not None
        return self.timed.best

    @property
    def asked_digits(self) -> float | None:
        """The digits of the requested tolerance; None for a step, which has none."""
        setting = self.timed.setting
        asks = setting.asked == TOLERANCE and setting.requested is not None
        return digits(setting.requested or 0.0) if asks else None

    def on(self, scene: str) -> TradePoint:
        """Return the point in its stored form, without times."""
        setting, trajectory = self.timed.setting, self.timed.trajectory
        return TradePoint(
            scene=scene,
            solver=setting.solver.name,
            setting=setting.solver.setting,
            rung=setting.rung.name,
            family=setting.family,
            asked=setting.asked,
            requested=setting.requested,
            requested_digits=self.asked_digits,
            achieved_digits=digits(self.error),
            error=finite(self.error),
            max={name: finite(value) for name, value in self.accuracy.max.items()},
            final={name: finite(value) for name, value in self.accuracy.final.items()},
            drift=finite(self.accuracy.drift),
            drifting=self.accuracy.drifting,
            steps=trajectory.steps,
            evaluations=trajectory.evaluations,
            outcome=trajectory.outcome.value,
            standing=self.standing,
            because=self.because,
        )

    def row(self) -> dict[str, Any]:
        """Return the point with its times as a row of JSON; None stands for a number that is not finite."""
        achieved = complete(self.on(""))
        del achieved["scene"]
        return {
            **achieved,
            "seconds": self.timed.best,
            "inner_seconds": self.timed.inner,
            "spread": self.timed.spread,
            "repeats": len(self.timed.seconds),
            "first_seconds": self.timed.first,
            "compile_seconds": self.timed.trajectory.compile_seconds,
        }


def point(timed: Timed, accuracy: Accuracy | None) -> Point:
    """Return the point of a run; ``accuracy`` is None for a run that was not compared with the truth."""
    outcome = timed.trajectory.outcome
    if outcome is not Outcome.FINISHED:
        started = outcome is not Outcome.NOT_STARTED and not outcome.is_unavailable
        because = timed.trajectory.detail or outcome.value
        return Point(timed, Accuracy(), Standing.FAILED if started else Standing.NOT_RUN, because)
    if accuracy is None:
        return Point(timed, Accuracy(), Standing.UNDECIDED, "the truth is not to be had")
    if not accuracy.worst < 1:
        because = f"it claims success with an error of {accuracy.worst:.2g}, the size of the motion"
        return Point(timed, accuracy, Standing.FALSE, because)
    if timed.best is None:
        return Point(timed, accuracy, Standing.UNDECIDED, "it was not timed")
    return Point(timed, accuracy, Standing.SOUND)


def digits(error: float) -> float | None:
    """Return the decimal digits that an error leaves; None for NaN and for zero."""
    return -log10(error) if error > 0 and isfinite(error) else None
