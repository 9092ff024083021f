"""The studies of the boards: every run of an entry list compared with the exact motion."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from shutil import rmtree
from typing import Final

from taylor_verify_reports.studies.engines import document, loaded_page, page
from taylor_verify_reports.studies.engines.document import Board
from taylor_verify_reports.studies.engines.engine_page import pages
from taylor_verify_reports.studies.engines.entry import entry_list
from taylor_verify_reports.studies.study import (
    Measured,
    NotMeasured,
    Option,
    Progress,
    Study,
    whole_number,
)


def _measure(
    name: str,
    folder: Path,
    progress: Progress,
    only: tuple[str, ...] = (),
    anew: bool = False,
    workers: int | None = None,
) -> Measured:
    """Run the engines whose runs are not stored; a measurement that was stopped is continued."""
    from taylor_verify_reports.studies.engines.answer import Answers
    from taylor_verify_reports.studies.engines.measure import (
        UNFINISHED,
        answers_of,
        board_of,
        measure,
    )

    try:
        entries = entry_list(name)
        board = document.find(folder, name)
        known = [] if board is None else answers_of(board)
    except ValueError as error:
        raise NotMeasured(str(error)) from error
    if unknown := [name for name in only if name not in entries.engines]:
        raise NotMeasured(
            f"expected engines among {', '.join(entries.engines)}, got {', '.join(unknown)}"
        )
    store = Answers(folder / UNFINISHED / name)
    reused = {
        answer.row.key: answer
        for answer in known
        if not (anew and (not only or answer.row.engine in only))
    }
    answers = measure(entries, reused, store, progress.say, only, workers)
    written = document.write(folder, board_of(answers, workers, name))
    # Until the results are stored, the measurement can be continued.
    rmtree(store.folder, ignore_errors=True)
    return Measured(written)


def _names(text: str) -> tuple[str, ...]:
    return tuple(name for name in text.split(",") if name)


OPTIONS: Final = (
    Option("only", "run only these engines, separated by commas", _names, "NAMES"),
    Option("anew", "also run again the engines that are stored"),
    Option(
        "workers",
        "run N engines at a time; default: one for each core",
        partial(whole_number, least=1),
    ),
)


STUDY: Final[Study[Board]] = Study(
    name="engines",
    title="physics engines on free motions: which setting is right to how many digits",
    duration="about 20 minutes on two cores once the engines are installed",
    measure=partial(_measure, "engines"),
    find=document.find,
    page=page.page,
    sheet=page.sheet,
    parts=lambda board: pages(board, entry_list()),
    draw=page.pictures,
    options=OPTIONS,
)


def _under_loads(name: str, title: str) -> Study[Board]:
    """Return the study of a board whose scenes have loads."""
    return Study(
        name=name,
        title=title,
        duration="about 4 minutes on two cores once the engines are installed",
        measure=partial(_measure, name),
        find=lambda folder: document.find(folder, name),
        page=loaded_page.page,
        sheet=page.sheet,
        needs_heyoka=False,
        options=OPTIONS,
    )


SATELLITE: Final = _under_loads(
    "satellite", "satellites under control: which engine and step, and how its load is given"
)
UNDERWATER: Final = _under_loads(
    "underwater",
    "underwater vehicles: added mass, weight, drag and current in engines and programs",
)
