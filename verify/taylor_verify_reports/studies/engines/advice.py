"""The advice of the board: sentences whose names and numbers are computed from the stored rows."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, groupby, pairwise, product
from math import inf, isfinite
from typing import Final

from taylor_verify.words.cells import figure
from taylor_verify.words.markdown import bold, prose
from taylor_verify_reports.studies.engines.document import Board, EngineRow
from taylor_verify_reports.studies.engines.entry import EntryList
from taylor_verify_reports.studies.engines.ranking import (
    EngineSetting,
    Score,
    best_of,
    newest,
    settings,
)

# Accuracy that suffices for most uses: a milliradian, or a thousandth of omega.
ENOUGH: Final = 1e-3
# An error of this size means that the motion is lost.
LOST: Final = 0.05
# A setting gets a warning if another one of its engine has an error this many times smaller.
FAR_WORSE: Final = 10.0
# Errors that differ by less than this factor are a tie; and times, of which only the order is reliable.
TIE: Final = 1.5
TIE_OF_TIMES: Final = 3.0
# No way of giving a load is warned of whose error is below this one times FAR_WORSE.
NEGLIGIBLE: Final = 1e-10
# A warning of too small steps is given if they increase the error by more than this factor.
WORSE_BELOW: Final = 2.0


@dataclass(frozen=True)
class _Job:
    """A job with its scenes, and the settings of engines from which one is taken for it."""

    board: Board
    entries: EntryList
    engines: Sequence[EngineSetting]
    scenes: Sequence[str]
    name: str = ""

    @cached_property
    def scores(self) -> list[Score]:
        """The score of each setting at every step at which all scenes were judged."""
        return [score for setting in self.engines for score in setting.scores(self.scenes)]

    @cached_property
    def titles(self) -> dict[str, str]:
        """The titles of the engines by their names."""
        return self.entries.titles

    def by_engine(self) -> Iterator[tuple[str, list[EngineSetting]]]:
        """Yield each engine with its settings."""
        for engine, group in groupby(self.engines, key=lambda setting: setting.engine):
            yield engine, [*group]


def advice(board: Board, entries: EntryList) -> list[str]:
    """Return sentences that tell a user what to take and what to avoid, the most useful first.

    They follow from the rows of the ``board``. ``entries`` is the list of engines, which names the scenes
    of the advice. A job under loads has one sentence; `at_length` has all that is to say.
    """
    engines, scenes = _entrants(board, entries), advised(board, entries)
    jobs = [_Job(board, entries, engines, own, name) for name, own in scenes.items()]
    return [
        *chain.from_iterable(
            _in_short(job)
            if any(setting.load for setting in engines)
            else [*_take(job), *_never(job)]
            for job in jobs
        ),
        *_as_shipped(engines, _entrants(board, entries, shipped=True), entries),
        *_too_fine(_Job(board, entries, engines, [*chain.from_iterable(scenes.values())])),
    ]


def at_length(board: Board, entries: EntryList, name: str) -> list[str]:
    """Return the sentences on a job under loads: what to take, what suffices, and what to avoid."""
    scenes = advised(board, entries).get(name, [])
    job = _Job(board, entries, _entrants(board, entries), scenes, name)
    return [*_take(job), *_ways_to_avoid(job), *_missed_switches(job), *_lost_engines(job)]


def _in_short(job: _Job) -> Iterator[str]:
    """Yield a paragraph for a job under loads: the best setting, and what to avoid."""
    if (best := best_of(job.scores)) is None:
        return
    _, *equal = _equals(job.scores, lambda score: score.error, TIE)
    others = _either([bold(prose(job.titles[score.setting.engine])) for score in equal], "and")
    tie = f"; a tie with {others}" if equal else ""
    sentences = [
        f"For {job.name} take {named(best.setting, job.titles)}{_step(best)}{_load(best)}: right to "
        f"{figure(best.error)}{tie}."
    ]
    if bad := [f"{prose(w)} ({figure(s.error)} at best)" for w, s in _bad_ways(job.scores).items()]:
        sentences.append(f"Never with the load {_either(bad)}.")
    if any(_missed_switches(job)):
        sentences.append("Never a step that goes over a switch.")
    yield " ".join([*sentences, *_lost_engines(job)])


def _entrants(board: Board, entries: EntryList, shipped: bool = False) -> list[EngineSetting]:
    """Return the settings of engines in their newest versions, without plain solvers."""
    plain = {row.name for row in entries.entry if row.plain}
    every = newest(settings(board.study), shipped)
    return [setting for setting in every if setting.engine not in plain]


def advised(board: Board, entries: EntryList) -> dict[str, list[str]]:
    """Return the scenes of each job that were measured."""
    measured = {row.scene for row in board.study.rows if row.is_judged}
    jobs = {job: [s for s in scenes if s in measured] for job, scenes in entries.jobs.items()}
    return {job: scenes for job, scenes in jobs.items() if scenes}


def error(size: float) -> str:
    """Return an error in three digits, or the word for one that is no finite number."""
    return figure(size) if isfinite(size) else "beyond every number"


def named(setting: EngineSetting, names: dict[str, str]) -> str:
    """Return the name of an engine with its version and its settings; ``names`` has the engines' titles."""
    words = f" with {prose(setting.words)}" if setting.words else ""
    return f"{bold(prose(f'{names[setting.engine]} {setting.version}'.strip()))}{words}"


def _take(job: _Job) -> Iterator[str]:
    """Yield the most accurate settings, and the cheapest of those that suffice for most uses."""
    scores, names, board = job.scores, job.titles, job.board
    if (best := best_of(scores)) is None:
        return
    equal = _equals(scores, lambda score: score.error, TIE)
    taken = _either([f"{named(score.setting, names)}{_step(score)}" for score in equal])
    tie = f", a tie: their errors differ by less than a factor {TIE}" if len(equal) > 1 else ""
    yield (
        f"For {job.name} take {taken}{_load(best)}: {_states(best)} are right to {figure(best.error)} on "
        f"all of {_listed(job.scenes)}, the most that an engine reaches here{tie}."
    )
    if paced := [s for s in scores if s.error <= ENOUGH and board.pace(s.row)]:
        cheapest, *others = _equals(paced, lambda score: board.pace(score.row) or inf, TIE_OF_TIMES)
        also = _either([bold(prose(names[score.setting.engine])) for score in others], "and")
        within = f"; within a factor {TIE_OF_TIMES:g} of it, a tie, {also}" if others else ""
        yield (
            f"Where {ENOUGH} is enough, {named(cheapest.setting, names)}{_step(cheapest)} is "
            f"{'among ' if others else ''}the cheapest: {figure(1e6 * (board.pace(cheapest.row) or inf))} "
            f"microseconds for each second of the motion{within}."
        )


def _equals(scores: Sequence[Score], size: Callable[[Score], float], factor: float) -> list[Score]:
    """Return the best score of each engine that is within a factor of the best of all, that one first."""
    best: dict[str, Score] = {}
    for score in sorted(scores, key=size):
        best.setdefault(score.setting.engine, score)
    least = min(map(size, best.values()))
    return [score for score in best.values() if size(score) <= factor * least]


def _ways_to_avoid(job: _Job) -> Iterator[str]:
    """Yield a warning of the ways of giving a load whose best engine is far worse than another way's."""
    if listed := [
        f"{prose(way)} ({named(score.setting, job.titles)}{_step(score)} has {figure(score.error)})"
        for way, score in _bad_ways(job.scores).items()
    ]:
        yield f"Never with the load {_either(listed)}, the least error of that way here."


def _bad_ways(scores: Sequence[Score]) -> dict[str, Score]:
    """Return the ways of giving a load that are far worse than the best way, each with its best score."""
    best: dict[str, Score] = {}
    for way in dict.fromkeys(score.row.load for score in scores if score.row.load):
        if score := best_of(score for score in scores if score.row.load == way):
            best[way] = score
    least = max(NEGLIGIBLE, min((score.error for score in best.values()), default=0.0))
    return {way: score for way, score in best.items() if score.error > FAR_WORSE * least}


def _missed_switches(job: _Job) -> Iterator[str]:
    """Yield a warning of a step that goes over a switch: its error is larger than that of a longer step."""
    switched = [s.name for s in job.entries.scene if s.switches and s.name in job.scenes]
    losses = [
        (shorter.worst / longer.worst, setting, longer, shorter)
        for scene, setting in product(switched, job.engines)
        for longer, shorter in pairwise(setting.on(scene))
        if FAR_WORSE * longer.worst < shorter.worst < inf
    ]
    if losses:
        _, setting, longer, shorter = max(losses, key=lambda loss: loss[0])
        yield (
            f"Never a step that goes over a switch: {named(setting, job.titles)} has "
            f"{figure(longer.worst)} with a step of {longer.value}, which ends on every switch, and "
            f"{figure(shorter.worst)} with {shorter.value}, which does not."
        )


def _lost_engines(job: _Job) -> Iterator[str]:
    """Yield a warning of engines that lose the motion at every step."""
    lost = []
    for engine, group in job.by_engine():
        scores = [score for setting in group for score in setting.scores(job.scenes)]
        least = min((score.error for score in scores), default=0.0)
        if least >= LOST:
            lost.append(f"{bold(prose(job.titles[engine]))} ({error(least)})")
    if lost:
        yield f"Not for {job.name}, with the least error at any step: {'; '.join(lost)}."


def _never(job: _Job) -> Iterator[str]:
    """Yield warnings of methods that lose the motion, and of engines whose methods all lose it."""
    methods, whole_engines = [], []
    for engine, group in job.by_engine():
        own = [best for each in group if (best := best_of(each.scores(job.scenes))) is not None]
        lost = [best for best in own if best.error >= LOST]
        sound = best_of(best for best in own if best.error < LOST)
        if not lost:
            continue
        least = min(lost, key=lambda best: best.error)
        name = bold(prose(f"{job.titles[engine]} {least.setting.version}".strip()))
        if sound is None:
            whole_engines.append(
                f"{name} ({figure(least.error)}, drift of the energy {_energy(least)})"
            )
        elif sound.error * FAR_WORSE <= least.error:
            words = _either([prose(best.setting.words) for best in lost])
            better = f"{prose(sound.setting.words)} has {figure(sound.error)}"
            methods.append(f"{name} with {words} (least error {figure(least.error)}; {better})")
    if methods:
        yield f"Never {'; '.join(methods)}."
    if whole_engines:
        listed = "; ".join(whole_engines)
        yield f"Not for {job.name}, with the least error at any step measured here: {listed}."


def _energy(score: Score) -> str:
    return figure(score.row.errors.get("T"))


def _either(words: Sequence[str], joint: str = "or") -> str:
    """Return the words as a list in a sentence, with "or" before the last one; empty without words."""
    *others, last = words or [""]
    return f"{', '.join(others)} {joint} {last}" if others else last


def _as_shipped(
    engines: Sequence[EngineSetting], shipped: Sequence[EngineSetting], entries: EntryList
) -> Iterator[str]:
    """Yield a warning of engines that are far worse as shipped than with the board's settings."""
    warnings = []
    for engine, group in groupby(shipped, key=lambda setting: setting.engine):
        pairs = [(row, like(row, engines, entries)) for setting in group for row in setting.rows]
        ratios = [
            (row.worst / usual.worst, row, usual)
            for row, usual in pairs
            if row.is_judged and usual and usual.worst > 0
        ]
        ratio, row, usual = max(ratios, key=lambda compared: compared[0], default=(0.0, None, None))
        if row is None or usual is None or ratio < FAR_WORSE:
            continue
        warning = next((e.warning for e in entries.entry if e.name == engine and e.warning), "")
        needs = f" needs {warning}" if warning else ""
        warnings.append(
            f"{bold(prose(entries.titles[engine]))}{needs} ({error(row.worst)} becomes "
            f"{figure(usual.worst)})"
        )
    if warnings:
        yield f"Not as shipped: {'; '.join(warnings)}."


def like(row: EngineRow, engines: Sequence[EngineSetting], entries: EntryList) -> EngineRow | None:
    """Return the judged row that differs from ``row``, a run as shipped, in the board's settings alone.

    The result is None if there is none.
    """
    defaults = {
        word
        for entry in entries.entry
        if entry.name == row.engine
        for word in (entry.shipped or {}).values()
    }
    variant = ", ".join(word for word in row.variant.split(", ") if word not in defaults)
    wanted = _identity(replace(row, variant=variant))
    rows = (other for setting in engines for other in setting.rows if other.is_judged)
    return next((other for other in rows if _identity(other) == wanted), None)


def _identity(row: EngineRow) -> tuple[str, ...]:
    """Return the fields that distinguish the runs of the board."""
    return row.engine, row.version, row.variant, row.scene, row.value, row.rung


def _too_fine(job: _Job) -> Iterator[str]:
    """Yield a warning of engines whose smallest step is not their best."""
    steps = []
    for engine, group in job.by_engine():
        best = best_of(score for setting in group for score in setting.scores(job.scenes))
        if best is None or not best.value or best.error >= LOST or best.setting.knob != "step":
            continue
        finest = best.setting.scores(job.scenes)[-1]
        if finest.error > WORSE_BELOW * best.error:
            growth = f"{figure(best.error)} becomes {error(finest.error)} with {finest.value}"
            steps.append(f"{best.value} in {bold(prose(job.titles[engine]))} ({growth})")
    if steps:
        yield f"No smaller step than {', '.join(steps)}."


def _states(score: Score) -> str:
    """Return the names of the state quantities of a score's scene, as a list in a sentence."""
    *others, last = score.row.floors
    return f"{', '.join(others)} and {last}" if others else last


def _load(score: Score) -> str:
    return f" (the load {prose(score.row.load)})" if score.row.load else ""


def _step(score: Score) -> str:
    """Return the step with the words that join it to a setting; empty for a solver without a step."""
    if not score.value:
        return ""
    knob, joint = score.setting.knob, "and" if score.setting.words else "with"
    what = f"a step of {score.value}" if knob == "step" else f"{knob} {score.value}"
    return f" {joint} {what}"


def _listed(scenes: Sequence[str]) -> str:
    return ", ".join(f"`{scene}`" for scene in scenes)
