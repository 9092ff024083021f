"""The advice of the board: sentences computed from the stored rows, so that no number in them is typed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from math import isfinite
from typing import Final

from taylor_verify.publish.cells import figure
from taylor_verify.publish.markdown import bold, prose
from taylor_verify.studies.engines.document import Board, EngineRow
from taylor_verify.studies.engines.entry import EntryList
from taylor_verify.studies.engines.ranking import (
    Score,
    Setting,
    best_of,
    newest,
    settings,
)

# What most uses of an engine ask for: a milliradian, or a thousandth of omega.
ENOUGH: Final = 1e-3
# A body that is off by so much is somewhere else.
LOST: Final = 0.05
# A setting is warned of where another one of the same engine has an error so many times smaller.
FAR_WORSE: Final = 10.0
# Errors that smaller steps make so many times larger.
WORSE_BELOW: Final = 2.0


def advice(board: Board, entries: EntryList) -> list[str]:
    """Return the sentences that say what a user should do, the most useful first."""
    names = {row.name: row.title for row in entries.entry}
    plain = {row.name for row in entries.entry if row.plain}
    warnings = {row.name: row.warning for row in entries.entry if row.shipped}
    every, scenes = settings(board.study), entries.advised
    engines = [one for one in newest(every) if one.engine not in plain]
    shipped = [one for one in newest(every, shipped=True) if one.engine not in plain]
    return [
        *_take(board, engines, scenes, names),
        *_never(engines, scenes, names),
        *_as_shipped(engines, shipped, names, warnings),
        *_too_fine(engines, scenes, names),
    ]


def error(size: float) -> str:
    """Return an error in three digits, or the word for one that is no finite number."""
    return figure(size) if isfinite(size) else "beyond every number"


def named(setting: Setting, names: dict[str, str]) -> str:
    """Return an engine with its version and the words that are set."""
    words = f" with {prose(setting.words)}" if setting.words else ""
    return f"{bold(prose(f'{names[setting.engine]} {setting.version}'.strip()))}{words}"


def _take(
    board: Board, engines: Sequence[Setting], scenes: Sequence[str], names: dict[str, str]
) -> Iterator[str]:
    scores = [score for one in engines for score in one.scores(scenes)]
    if (best := best_of(scores)) is None:
        return
    yield (
        f"For free rotation take {named(best.setting, names)}{_step(best)}: omega and attitude are "
        f"right to {figure(best.error)} on all of {_listed(scenes)}, the most that an engine reaches here."
    )
    paced = [(pace, s) for s in scores if s.error <= ENOUGH and (pace := board.pace(s.row))]
    if paced:
        pace, cheap = min(paced, key=lambda pair: pair[0])
        yield (
            f"Where {figure(ENOUGH)} is enough, {named(cheap.setting, names)}{_step(cheap)} is the "
            f"cheapest: {figure(1e6 * pace)} microseconds for each second of the motion."
        )


def _never(
    engines: Sequence[Setting], scenes: Sequence[str], names: dict[str, str]
) -> Iterator[str]:
    """Yield a sentence for each engine with methods that lose the motion at every step."""
    for engine, group in groupby(engines, key=lambda one: one.engine):
        own = [best for one in group if (best := best_of(one.scores(scenes))) is not None]
        lost = [best for best in own if best.error >= LOST]
        sound = best_of(best for best in own if best.error < LOST)
        if not lost:
            continue
        least = min(lost, key=lambda best: best.error)
        name = bold(prose(f"{names[engine]} {least.setting.version}".strip()))
        at_best = f"at its best step {_energy(least)}"
        if sound is None:
            yield (
                f"Never {name} for free rotation: no setting of it that was measured follows the motion; "
                f"the least error is {figure(least.error)}, {at_best}."
            )
        elif sound.error * FAR_WORSE <= least.error:
            words = " or ".join(prose(best.setting.words) for best in lost)
            better = prose(sound.setting.words)
            yield (
                f"Never {name} with {words}: the least error is {figure(least.error)}, {at_best}; "
                f"{better} has {figure(sound.error)}."
            )


def _energy(score: Score) -> str:
    drift = score.row.errors.get("T")
    return f"with a drift of the energy of {figure(drift)}"


def _as_shipped(
    engines: Sequence[Setting],
    shipped: Sequence[Setting],
    names: dict[str, str],
    warnings: dict[str, str],
) -> Iterator[str]:
    """Yield the engines that are far worse as shipped than with what the board sets."""
    for engine, group in groupby(shipped, key=lambda one: one.engine):
        own = [one for one in engines if one.engine == engine]
        pairs = [(row, _like(row, own)) for one in group for row in one.rows if row.is_judged]
        ratios = [(a.worst / b, a, b) for a, b in pairs if b]
        ratio, row, least = max(ratios, key=lambda found: found[0], default=(0.0, None, 0.0))
        if row is None or ratio < FAR_WORSE:
            continue
        without = f" without {warnings[engine]}" if warnings[engine] else " as it is shipped"
        yield (
            f"Never {bold(prose(names[engine]))}{without}: on `{row.scene}` its error with "
            f"{row.knob} {row.value} is {error(row.worst)} instead of {figure(least)}."
        )


def _like(row: EngineRow, engines: Sequence[Setting]) -> float:
    """Return the least error on the same scene at the same step with what the board sets; 0 for none."""
    asked = (row.scene, row.value, row.rung)
    same = (each for one in engines for each in one.rows if each.is_judged)
    return min((r.worst for r in same if (r.scene, r.value, r.rung) == asked), default=0.0)


def _too_fine(
    engines: Sequence[Setting], scenes: Sequence[str], names: dict[str, str]
) -> Iterator[str]:
    """Yield the engines whose best step is not their smallest one."""
    for engine, group in groupby(engines, key=lambda one: one.engine):
        found = [one for one in group if best_of(one.scores(scenes)) is not None]
        best = best_of(score for one in found for score in one.scores(scenes))
        if best is None or not best.value or best.setting.knob != "step":
            continue
        finest = best.setting.scores(scenes)[-1]
        if finest.error > WORSE_BELOW * best.error:
            yield (
                f"No smaller step than {best.value} in {bold(prose(names[engine]))}: with "
                f"{finest.value} its error grows from {figure(best.error)} to {error(finest.error)}."
            )


def _step(score: Score) -> str:
    """Return the step behind an "and"; empty for a solver without one."""
    if not score.value:
        return ""
    knob = score.setting.knob
    return f" and a step of {score.value}" if knob == "step" else f" and {knob} {score.value}"


def _listed(scenes: Sequence[str]) -> str:
    return ", ".join(f"`{scene}`" for scene in scenes)
