"""Findings at the beginning of the paper: sentences whose numbers are computed from stored rows."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from math import inf
from statistics import median
from typing import Final

from taylor_verify.records.status import Status
from taylor_verify.words.cells import INFINITE, figure, over_attainable
from taylor_verify.words.markdown import prose
from taylor_verify_reports.studies.controls.proof import conserving
from taylor_verify_reports.studies.engines.advice import LOST
from taylor_verify_reports.studies.engines.ranking import Score
from taylor_verify_reports.studies.hard.hard_scenes import ReachFamily, last_value, most_periods
from taylor_verify_reports.studies.paper.sources import Sources
from taylor_verify_reports.studies.tradeoff.peers import OUTSIDE, TAYLOR
from taylor_verify_reports.studies.tradeoff.trades import TimedPoint, Trade, cheapest

# An error that most users of an engine would ignore.
GOOD: Final = 1e-6
# The numbers of digits in the findings on the trade-off and on the reach.
TRADED: Final = 9
REACHED: Final = 6
_RUNG: Final = "f64"
_RIVAL: Final = "scipy DOP853"


def controls(sources: Sources) -> str:
    """Return the number of defects that each kind of gate sees, in words."""
    sights = [sight for sight in sources.controls.sights if sight.is_finished]
    energy = sum(sight.is_missed_by("T") for sight in sights)
    failing = sum(any(map(sight.is_seen_by, sight.state)) for sight in sights)
    return (
        f"Of {len(sights)} solvers that were broken on purpose, {energy} pass the gate on the energy and "
        f"{len(conserving(sights))} pass the gate of every conserved quantity of their scene; the "
        f"comparison with the exact motion sees {failing}."
    )


def engines(sources: Sources) -> str:
    """Return the errors of engines on a free body, each at its best setting, in words."""
    scores = [score for score in sources.best if not sources.is_plain(score)]
    finite = [score for score in scores if score.error < inf]
    if not finite:
        return ""
    good = sum(score.error <= GOOD for score in finite)
    lost = [score for score in scores if score.error >= LOST]
    best = min(finite, key=lambda score: score.error)
    deceiving = min(lost, key=_drift, default=None)
    words = (
        f"Of {len(scores)} physics engines that turn a free body, each at the best of all its measured "
        f"settings, {good} follow omega and attitude to {GOOD:g} or better; the best, "
        f"{sources.title_of(best)}, to {figure(best.error)}. At every step {len(lost)} are wrong by "
        f"{LOST} or more"
    )
    if deceiving is None or _drift(deceiving) == inf:
        return f"{words}."
    name, attitude = sources.title_of(deceiving), deceiving.row.errors.get("attitude")
    return (
        f"{words}; of these {name} keeps the energy to {figure(_drift(deceiving))} while its attitude is "
        f"off by {figure(attitude)} rad."
    )


def _drift(score: Score) -> float:
    """Return the drift of the energy; infinite if it is unknown."""
    return score.row.errors.get("T", inf)


def accuracy(sources: Sources) -> str:
    """Return the error of a Taylor integrator over that of perfect rounding, in words."""
    verdicts = sources.verdicts
    ratios = [over_attainable(verdict) for verdict in verdicts if verdict.is_compared]
    if not ratios:
        return ""
    largest = INFINITE if max(ratios) == inf else figure(max(ratios))
    rungs = {run.rung for run in sources.runs}
    scenes = {run.scene for run in sources.runs}
    passed = sum(verdict.verdict is Status.PASS for verdict in verdicts)
    return (
        f"The Taylor integrator of heyoka follows {len(scenes)} motions in {len(rungs)} number formats; "
        f"{passed} of {len(verdicts)} comparisons pass. The largest error is {largest} times "
        "what perfect rounding of every step would leave, and half of the errors are below "
        f"{figure(median(ratios))} times that."
    )


def reach(sources: Sources) -> str:
    """Return the reach of float64 in periods, and near an unstable motion, in words."""
    rows = [row for row in sources.hard.reach if row.rung == _RUNG]
    families = sources.hard.families
    long = next((family for family in families if not family.symbol), None)
    near = next((family for family in families if family.symbol == "d"), None)
    words = []
    for row in rows:
        if long is not None and row.family == long.name:
            periods = most_periods(row, REACHED)
            more = " at least" if periods == row.periods[-1] else ""
            words.append(f"{_of(long)}, after{more} {periods or 0} periods")
    if near is not None:
        value = last_value([row for row in rows if row.family == near.name], 1, REACHED)
        down = "at no distance" if value is None else f"only down to $d$ = {value}"
        words.append(f"{_of(near)}, after one period, {down}")
    if not words:
        return ""
    return f"In double precision {REACHED} digits are left {', but '.join(words)}."


def _of(family: ReachFamily) -> str:
    """Return "of" and the title of a family, whose symbol d is set as a formula."""
    return re.sub(r"\bd\b", "$d$", f"of {prose(family.title)}")


def trade(sources: Sources) -> str:
    """Return the time of the Taylor integrator's rivals for the same digits, in words."""
    trades = sources.trades.short
    rival = _multiples(trades, lambda family: family == _RIVAL)
    outside = _multiples(trades, lambda family: family.startswith(OUTSIDE))
    words = []
    if rival:
        words.append(
            f"For {TRADED} digits SciPy's DOP853, which calls Python, takes {_span(rival)} times as long "
            "as the Taylor integrator, which is compiled."
        )
    if outside:
        words.append(
            f"The fastest compiled integrator of another library takes {_span(outside)} times as long."
        )
    return " ".join(words)


def _multiples(trades: Iterable[Trade], is_wanted: Callable[[str], bool]) -> list[float]:
    """Return for each scene the least time of the wanted families over that of taylor."""
    multiples = []
    for trade in trades:
        taylor = _fastest(trade, lambda family: family == TAYLOR)
        other = _fastest(trade, is_wanted)
        if taylor is not None and other is not None:
            multiples.append(other.timing.ratio / taylor.timing.ratio)
    return multiples


def _fastest(trade: Trade, is_wanted: Callable[[str], bool]) -> TimedPoint | None:
    return cheapest((row for row in trade.sound if is_wanted(row.point.family)), TRADED)


def _span(multiples: Iterable[float]) -> str:
    """Return the least and the greatest of some numbers in words."""
    low, *others = sorted(multiples)
    return f"{figure(low)} to {figure(others[-1])}" if others else figure(low)


FINDINGS: Final[Mapping[str, Callable[[Sources], str]]] = {
    "controls": controls,
    "engines": engines,
    "accuracy": accuracy,
    "reach": reach,
    "trade": trade,
}
