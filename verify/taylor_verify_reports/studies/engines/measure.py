"""The runs of the entry list, each in processes of its own, and the board that they make.

A run is not repeated while its scene, setting, version and adapter are the same, nor if the engine is not
made for its scene. A run that failed, and one of an engine that could not be installed, is tried again by
the next measurement: the cause may be the machine of that day, such as a time limit, too little memory or a
registry that does not answer. Each environment is made once for all runs.
"""

from __future__ import annotations

import resource
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import Final

from taylor_verify.batch.pool import available_cores
from taylor_verify.batch.work import run_all
from taylor_verify.judge.provenance import machine, packages
from taylor_verify.scenes.reading.reader import load as load_scene
from taylor_verify.solvers.engines.engine import PREFIX, Outside, prepare
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.solvers.registry import solver_named
from taylor_verify_reports.studies.engines.answer import Answer, Answers, answered, made_of, row_of
from taylor_verify_reports.studies.engines.document import (
    Board,
    EnginesStudy,
    EnginesTimings,
    Standing,
)
from taylor_verify_reports.studies.engines.entry import BOARDS, STEP, Asked, EntryList

# A part of the report folder that is neither published nor committed.
UNFINISHED: Final = "local/boards"

# With more runs in a process, a library is loaded less often, but more of them are lost if it is killed.
_RUNS_OF_A_PROCESS: Final = 12

Say = Callable[[str], None]
Known = Mapping[str, Answer]


def measure(
    entries: EntryList,
    known: Known,
    store: Answers,
    say: Say,
    only: Collection[str] = (),
    workers: int | None = None,
) -> list[Answer]:
    """Run what has no valid answer yet, and return all answers in the order of the list.

    ``known`` has earlier answers by their keys, and ``store`` those of a measurement that was stopped; each
    new answer is stored there at once. With ``only``, no engines but those of these names are run.
    ``workers`` is the number of processes, by default one for each core. Raises OSError if an answer cannot
    be stored.
    """
    every = entries.runs()
    unfinished = {answer.row.key: answer for answer in store.every().values()}
    final = {key: answer for key, answer in known.items() if _is_final(answer)} | unfinished
    answers = {**known, **unfinished}
    waiting = [
        run
        for run in every
        if (not only or run.entry.name in only) and not _is_current(run, final.get(run.key))
    ]
    lacking = _prepared(waiting, say)
    for run in waiting:
        if reason := lacking.get(_environment(run), ""):
            answers[run.key] = _unavailable(run, reason)
    waiting = [run for run in waiting if not lacking.get(_environment(run), "")]
    done = 0

    def ended(runs: Sequence[Asked], set_answers: Sequence[Answer]) -> None:
        nonlocal done
        for run, answer in zip(runs, set_answers, strict=True):
            done += 1
            store.add(answer)
            say(f"{done}/{len(waiting)} {run}: {answer.row.standing}")

    before = _processor_seconds()
    made = run_all(answered, _sets(waiting), workers=workers or available_cores(), ended=ended)
    if waiting:
        say(f"{len(waiting)} runs took {_processor_seconds() - before:.0f} s of one core")
    answers |= {answer.row.key: answer for set_answers in made for answer in set_answers}
    return [answers[run.key] for run in every if run.key in answers]


def _processor_seconds() -> float:
    """Return the seconds that ended child processes, and theirs, have had of a core."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _sets(runs: Iterable[Asked]) -> list[list[Asked]]:
    """Return the runs in sets, one for each process; a set has one environment and one precision."""
    alike: dict[tuple[str, str], list[Asked]] = {}
    for run in runs:
        solver = solver_named(run.solver)
        script = solver.block if isinstance(solver, Outside) else run.entry.solver
        alike.setdefault((script, run.rung), []).append(run)
    return [
        every[first : first + _RUNS_OF_A_PROCESS]
        for every in alike.values()
        for first in range(0, len(every), _RUNS_OF_A_PROCESS)
    ]


def _is_final(answer: Answer) -> bool:
    """Return True for an answer that no later measurement would change."""
    return answer.row.standing in (Standing.JUDGED, Standing.UNSUITED)


def _is_current(run: Asked, answer: Answer | None) -> bool:
    """Return True for an answer by the present adapter to the present text of the scene."""
    digest = made_of(run.scene, run.entry.solver)
    return answer is not None and answer.row.made_of == digest


def _environment(run: Asked) -> str:
    """Return the name of the environment that a run needs; empty for a solver of this process."""
    if not run.entry.solver.startswith(PREFIX):
        return ""
    if STEP in run.entry.solver:
        return run.solver
    return run.entry.solver + (f"?version={run.version}" if run.version else "")


def _prepared(runs: Iterable[Asked], say: Say) -> dict[str, str]:
    """Make the environments of runs, and return the reason for each one that could not be made."""
    lacking = {}
    names = [name for name in dict.fromkeys(map(_environment, runs)) if name]
    for place, name in enumerate(names, 1):
        try:
            prepare(name, say)
        except NotMade as reason:
            lacking[name] = str(reason)
            say(f"environment {place}/{len(names)} {name}: unavailable: {reason}")
    return lacking


def _unavailable(run: Asked, reason: str) -> Answer:
    return Answer(row_of(run, Standing.UNAVAILABLE, detail=reason))


def board_of(answers: Sequence[Answer], workers: int | None, name: str = BOARDS[0]) -> Board:
    """Return the document of the board made from answers."""
    rows = tuple(answer.row for answer in answers)
    seconds = {
        answer.row.key: float(f"{answer.seconds:.3g}") for answer in answers if answer.row.is_judged
    }
    spans = {scene: _span(scene) for scene in dict.fromkeys(row.scene for row in rows)}
    timings = EnginesTimings(workers or available_cores(), machine(), seconds)
    return Board(EnginesStudy(packages(), spans, rows), timings, name)


def answers_of(board: Board) -> list[Answer]:
    """Return the answers of a board, without their trajectories: those are made again by the engines."""
    seconds = board.timings.seconds
    return [Answer(row, seconds.get(row.key, 0.0)) for row in board.study.rows]


def _span(scene: str) -> float:
    """Return the duration of a scene in its unit of time."""
    return float(max(abs(t) for t in load_scene(scene).clock.elapsed))
