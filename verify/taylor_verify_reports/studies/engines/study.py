"""The study of the engines: every run of the entry list compared with the exact motion."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.engines import page, stored
from taylor_verify_reports.studies.engines.document import Board
from taylor_verify_reports.studies.engines.engine_page import pages
from taylor_verify_reports.studies.engines.entry import entry_list
from taylor_verify_reports.studies.study import Measured, NotMeasured, Option, Progress, Study


def _measure(
    folder: Path,
    progress: Progress,
    only: tuple[str, ...] = (),
    anew: bool = False,
    rejudge: bool = False,
    workers: int | None = None,
) -> Measured:
    """Run the engines whose runs are not stored, or judge the stored trajectories again.

    A measurement that was stopped is continued.
    """
    from taylor_verify_reports.studies.engines.measure import (
        UNFINISHED,
        answers_of,
        board_of,
        judged_again,
        measure,
    )
    from taylor_verify_reports.studies.engines.unfinished import Unfinished

    try:
        entries = entry_list()
        board = stored.find(folder)
        known = [] if board is None else answers_of(board, folder)
    except ValueError as error:
        raise NotMeasured(str(error)) from error
    if unknown := [name for name in only if name not in entries.engines]:
        raise NotMeasured(
            f"expected engines among {', '.join(entries.engines)}, got {', '.join(unknown)}"
        )
    store = Unfinished(folder / UNFINISHED)
    if rejudge:
        answers = judged_again(known, progress.say, workers)
    else:
        reused = {
            answer.row.key: answer
            for answer in known
            if not (anew and (not only or answer.row.engine in only))
        }
        answers = measure(entries, reused, store, progress.say, only, workers)
    written = stored.write(folder, *board_of(answers, workers))
    # Until the results are stored, the measurement can be continued.
    store.forget()
    return Measured(written)


def _names(text: str) -> tuple[str, ...]:
    return tuple(name for name in text.split(",") if name)


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise ValueError(f"expected a number of processes, got {text!r}")
    return int(text)


STUDY: Final[Study[Board]] = Study(
    name="engines",
    title="physics engines on free motions: which setting is right to how many digits",
    duration="about 40 minutes on two cores once the engines are installed",
    measure=_measure,
    find=stored.find,
    page=page.page,
    sheet=page.sheet,
    parts=lambda board: pages(board, entry_list()),
    draw=page.pictures,
    options=(
        Option("only", "run only these engines, separated by commas", _names, "NAMES"),
        Option("anew", "also run again the engines that are stored"),
        Option("rejudge", "judge the stored trajectories again, and run nothing"),
        Option("workers", "run N engines at a time; default: one for each core", _count),
    ),
)
