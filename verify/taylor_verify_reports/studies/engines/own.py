"""Engines of users on a board: their rows below reports/local, and a copy of the board's page with them.

Each run is stored in a file of its own as it ends, with its row and the columns that `check` reads. A run
of another program, scene or setting is made; all others are kept.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from shutil import rmtree
from typing import Final

from taylor_verify.check import check
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.replacement import replace_files
from taylor_verify_reports.studies.engines import document, engine_page, loaded_page, page
from taylor_verify_reports.studies.engines.answer import Answer, Answers, row_of
from taylor_verify_reports.studies.engines.document import (
    Board,
    EngineRow,
    EnginesStudy,
    EnginesTimings,
    Standing,
)
from taylor_verify_reports.studies.engines.entry import (
    BOARDS,
    STEP,
    Asked,
    Entry,
    EntryList,
    entry_list,
)
from taylor_verify_reports.studies.engines.measure import answers_of, board_of, measure
from taylor_verify_reports.studies.engines.replay import errors_of

LOCAL: Final = "local/boards"
OWN: Final = f"{LOCAL}/own"
# The folder of copied files, beside the rows of an engine that is known by its files.
_FILES: Final = "files"
_NAME: Final = re.compile(r"[a-z0-9][a-z0-9_-]{0,39}")
_LINKS: Final = {"](../": "](../../", "](engines": "](../../tables/engines"}

Say = Callable[[str], None]


@dataclass(frozen=True)
class OwnEngine:
    """Engine of a user: its name, the name of its solver or a folder of its files, and its steps.

    ``solver`` has STEP in it if there are ``steps``; ``files`` is empty where a solver is given. ``load``
    says how the loads of a scene reach the engine.
    """

    name: str
    solver: str = ""
    files: str = ""
    steps: tuple[str, ...] = ()
    rung: str = "f64"
    load: str = ""

    @property
    def entry(self) -> Entry:
        """The engine as a row of an entry list."""
        solver = self.solver or f"files:{self.files}"
        return Entry(
            self.name,
            self.name,
            solver,
            self.steps,
            rungs=(self.rung,),
            load=self.load or "its own",
        )


def faults_of(engine: OwnEngine) -> Iterator[str]:
    """Yield what is wrong with the name, the solver and the steps of an engine."""
    known = {name for board in BOARDS for name in entry_list(board).engines}
    if not _NAME.fullmatch(engine.name):
        yield f"expected a name of small letters, digits, - and _, got {engine.name!r:.60} @ NAME"
    elif engine.name in known:
        yield f"expected a name that no board has, got {engine.name!r} @ NAME"
    if bool(engine.solver) == bool(engine.files):
        got = "both" if engine.solver else "neither"
        yield f"expected --solver or --files, got {got} @ board add"
    if engine.solver and engine.steps and STEP not in engine.solver:
        yield f"expected {STEP} in the solver of several steps, got {engine.solver!r:.60} @ --solver"
    if engine.solver and not engine.steps and STEP in engine.solver:
        yield f"expected --steps for {STEP} of the solver, got none @ --steps"
    for step in engine.steps:
        try:
            is_step = 0 < float(step) < float("inf")
        except ValueError:
            is_step = False
        if not is_step:
            yield f"expected a positive step, got {step!r:.40} @ --steps"


def add(
    folder: Path, engine: OwnEngine, name: str, scenes: Sequence[str], say: Say, anew: bool
) -> list[Answer]:
    """Measure a user's engine on a board, or on some of its ``scenes``; return its rows.

    What is stored from an earlier call is kept, unless everything is asked for ``anew`` or it failed.
    Raises OSError.
    """
    store = Answers(folder / OWN / engine.name / name)
    if anew:
        rmtree(store.folder, ignore_errors=True)
    for place, answer in store.every().items():
        if not (answer.row.is_judged or answer.row.standing is Standing.UNSUITED):
            place.unlink()
    asked = entry_list(name).scene
    chosen = tuple(scene for scene in asked if not scenes or scene.name in scenes)
    entries = EntryList(chosen, (engine.entry,))
    if not engine.files:
        measure(entries, {}, store, say)
    else:
        for run in entries.runs():
            if result := _file_for(run, Path(engine.files)):
                answer = _judged_file(run, result)
                store.add(answer)
                _copy(result, store, answer)
                say(f"{run}: {answer.row.standing}")
    return own_answers(folder, name, engine.name)


def _file_for(run: Asked, folder: Path) -> Path | None:
    """Return the file of a run, SCENE.* or STEP/SCENE.* in the folder; None where there is none."""
    place = folder / run.value if run.value else folder
    stems = (run.scene.rpartition("/")[2], of_scene(run.scene))
    return next((file for stem in stems for file in sorted(place.glob(f"{stem}.*"))), None)


def _copy(file: Path, store: Answers, answer: Answer) -> None:
    """Store a file of results beside its row, so that whoever gets the folder can judge it."""
    name = f"{store.file_of(answer.row.key.encode()).stem}.{file.name.partition('.')[2]}"
    replace_files(store.folder, {f"{_FILES}/{name}": file.read_bytes()})


def _judged_file(run: Asked, file: Path) -> Answer:
    """Return the row of a file."""
    try:
        result = check(run.scene, file, run.rung, accept_conventions=True)
    except ValueError as fault:
        return Answer(row_of(run, Standing.FAILED, detail=" ".join(str(fault).split())[:300]))
    remarks = "; ".join((f"the file {file.name}", *result.remarks))
    return Answer(
        row_of(run, Standing.JUDGED, detail=remarks, **vars(errors_of(result, run.scene)))
    )


def own_answers(folder: Path, board: str, engine: str = "*") -> list[Answer]:
    """Return the stored answers of one's own engines on a board."""
    places = sorted((folder / OWN).glob(f"{engine}/{board}"))
    answers = [answer for place in places for answer in Answers(place).every().values()]
    order = [scene.name for scene in entry_list(board).scene]
    known = [answer for answer in answers if answer.row.scene in order]
    return sorted(known, key=lambda answer: _order(answer.row, order))


def _order(row: EngineRow, scenes: Sequence[str]) -> tuple[str, str, int, float]:
    """Return the place of a row: by engine and solver's words, by scene, from coarse to fine."""
    return row.engine, row.variant, scenes.index(row.scene), -float(row.value or 0)


def file_of(folder: Path, board: str, answer: Answer) -> Path:
    """Return the file of an own answer, which `check` reads: the copy of a file, or the stored answer."""
    store = Answers(folder / OWN / answer.row.engine / board)
    place = store.file_of(answer.row.key.encode())
    return next((store.folder / _FILES).glob(f"{place.stem}.*"), place)


def copied(folder: Path, name: str) -> Path:
    """Write a copy of a board's page and sheet with the rows of one's own engines; return the page."""
    board, entries, answers = read(folder, name)
    document = with_own(board, answers, name)
    own = dict.fromkeys(answer.row.engine for answer in answers)
    is_free = name == BOARDS[0]
    texts = {name: (page.text if is_free else loaded_page.text)(document, entries, folder)}
    texts |= {f"engines-{e}": engine_page.page(document, e, e) for e in own if is_free}
    for engine in own:
        texts[name] = texts[name].replace(f"](engines-{engine}.md)", f"](./engines-{engine}.md)")
    files = {f"{LOCAL}/{stem}.md": _from_here(text) for stem, text in texts.items()}
    replace_files(folder, {**files, f"{LOCAL}/{name}.csv": page.sheet(document)})
    return folder / LOCAL / f"{name}.md"


def _from_here(text: str) -> str:
    """Return a page of the folder tables with links as they are in that of the copies."""
    for link, longer in _LINKS.items():
        text = text.replace(link, longer)
    return text


def read(folder: Path, name: str) -> tuple[Board | None, EntryList, list[Answer]]:
    """Return a board as it is stored, its list with one's own engines, and their answers.

    Raises OSError for files that cannot be read and ValueError for files that hold something else.
    """
    answers, entries = own_answers(folder, name), entry_list(name)
    engines = {answer.row.engine: answer.row.solver for answer in answers}
    more = (Entry(engine, engine, solver) for engine, solver in engines.items())
    board = document.find(folder, name)
    return board, replace(entries, entry=(*entries.entry, *more)), answers


def every_answer(folder: Path, name: str) -> list[Answer]:
    """Return the answers of a board, those of one's own engines behind. Raises as ``read`` does."""
    board, _, answers = read(folder, name)
    return [*(answers_of(board) if board else ()), *answers]


def with_own(board: Board | None, answers: Sequence[Answer], name: str) -> Board:
    """Return a board with rows of one's own behind its own rows."""
    ours = board_of(answers, None, name)
    if board is None:
        return ours
    study, times = board.study, board.timings
    spans, rows = {**study.spans, **ours.study.spans}, (*study.rows, *ours.study.rows)
    seconds = {**times.seconds, **ours.timings.seconds}
    return Board(
        EnginesStudy(study.versions, spans, rows),
        EnginesTimings(times.workers, times.machine, seconds),
        name,
    )
