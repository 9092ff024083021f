"""The page of the engine board: first advice to users, then the tables and pictures behind it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from math import inf
from pathlib import Path
from typing import Any, Final

from taylor_verify.plotting.picture import Picture
from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.csv_sheet import sheet as csv_sheet
from taylor_verify.words.markdown import bullets, code, prose, table
from taylor_verify.words.page_parts import made_with, whole
from taylor_verify_reports.studies import figures
from taylor_verify_reports.studies.engines.advice import advice, like
from taylor_verify_reports.studies.engines.document import Board, EngineRow, places
from taylor_verify_reports.studies.engines.engine_page import place
from taylor_verify_reports.studies.engines.entry import EntryList, entry_list, list_of
from taylor_verify_reports.studies.engines.findings import findings
from taylor_verify_reports.studies.engines.pictures import energy, sweeps, work
from taylor_verify_reports.studies.engines.ranking import (
    EngineSetting,
    best_of_each,
    digits,
    newest,
    settings,
)

_WHAT: Final = (
    "Each engine turns a free body, and its answer is compared with the exact motion of the same "
    "numbers. Energy and angular momentum are compared too, although they do not show whether the "
    "body is in the right place. The authors of this page sell no engine. The trajectory "
    "of every row can be made again and judged alone: the end of this page says how."
)
_LEGEND: Final = (
    "*omega* is the largest error of all samples relative to the largest omega, *attitude* the largest "
    "angle in radians, *energy* and *H in space* the largest relative drift.",
    "*order* is the observed order of the error over the steps, of omega and of the attitude; a dash "
    "means that the steps show no order.",
    "*time* is that of the engine's own calls for a second of the motion, in microseconds, without "
    "starting and compiling. It comes from one run beside others: only its order of magnitude is reliable.",
    "*step* is the coarsest of the steps with the least error. Steps are decimal, and every sample is "
    "at a whole number of steps.",
    "Adapters switch off sleeping, damping and caps on the velocity if an engine has them. The table "
    "*as shipped* shows the engines without these changes.",
)
_FAIRNESS: Final = (
    "The first row of every trajectory is the start of the scene, from an oblique attitude. It proves "
    "that axes, order of the quaternion and units are right. The column *start* of the "
    "sheet, `engines.csv`, has its error.",
    "Every engine gets the same numbers, each rounded once to the precision of its arithmetic, and is "
    "compared with the exact motion of the rounded numbers.",
    "An engine that takes principal moments alone is given the principal axes of `engines/full-tensor`, "
    "and its answer is turned back; the remark on its page says so. In space that is the motion of "
    "`engines/oblique`.",
    "A surprising finding is published only with a second demonstration that does not use our "
    "adapter: the engine's own data, its source or its changelog, and a short script that runs with "
    "the engine alone.",
)
_OBJECT: Final = (
    "A row that is unfair to an engine is a fault of this project. Please report the row, and the call of "
    "the engine that would do better: "
    '`taylor-verify run SCENE --solver "outside:NAME?..."` of the engine\'s page shows it as we see it.',
    "A better adapter is one file, `cases/README.md` says how (To add an engine); a new setting or "
    "version is a word in the engine's row of `verify/taylor_verify_reports/studies/engines/engines.toml`.",
    "An engine of your own needs no adapter here: `taylor-verify board add NAME --solver ...` puts it on a "
    "copy of this page (`docs/bring-your-engine.md`).",
)


def page(board: Board, folder: Path) -> str:
    """Return the whole page, with the pictures that are in ``folder``/figures."""
    return text(board, entries_of(board), folder)


def text(board: Board, entries: EntryList, folder: Path) -> str:
    """Return the page of a board with the engines of a list."""
    every = settings(board.study)
    return whole(
        "The engine board",
        bullets(advice(board, entries)) or "No engine is measured yet.",
        _WHAT,
        "## What each engine achieves",
        _best(board, entries, every),
        bullets(_LEGEND),
        figures.shown(folder, _pictures(board, entries)),
        *_scenes(board, entries, every),
        *_as_shipped(board, entries, every),
        *unavailable(board.study.rows),
        "## Fairness",
        bullets(_FAIRNESS),
        *findings(folder),
        "## To object, and to send a better adapter",
        bullets(_OBJECT),
        "## To remake this",
        bullets(remake(board)),
    )


def pictures(board: Board) -> list[Picture]:
    """Return the pictures of the board: energy and motion, error against time, step and version."""
    return _pictures(board, entries_of(board))


def _pictures(board: Board, entries: EntryList) -> list[Picture]:
    return [picture for kind in (energy, work, sweeps) for picture in kind.pictures(board, entries)]


def entries_of(board: Board) -> EntryList:
    """Return the entry list. Raises ValueError for rows of an engine that is not in the list."""
    entries = entry_list(board.name)
    stored = dict.fromkeys(row.engine for row in board.study.rows)
    if unknown := [name for name in stored if name not in entries.engines]:
        raise ValueError(
            f"expected engines of {list_of(board.name).name}, got {', '.join(unknown)}: "
            f"`publish {board.name}` leaves their rows out @ {places(board.name).rows.name}"
        )
    return entries


def _best(board: Board, entries: EntryList, every: Sequence[EngineSetting]) -> str:
    """Return a table of the engines, each with its best setting on the first scene of the advice."""
    scene = entries.advised[0]
    titles, rows = entries.titles, []
    for best in best_of_each(every, scene):
        engine = best.setting.engine
        name = f"[{prose(titles.get(engine, engine))}]({place(engine).removeprefix('tables/')})"
        rows.append(
            [f"{name} {best.setting.version}".strip(), *cells(board, best.setting, best.row)]
        )
    if not rows:
        return "Nothing was judged."
    return f"On {code(scene)}, each engine with its best setting:\n\n{table(COLUMNS, rows)}"


COLUMNS: Final = (
    "engine",
    "setting",
    "step:",
    "omega:",
    "attitude:",
    "order:",
    "energy:",
    "time:",
)


def cells(board: Board, setting: EngineSetting, row: EngineRow) -> list[str]:
    """Return the cells of a row of `COLUMNS` after the name of its engine."""
    pace = board.pace(row)
    return [
        prose(setting.words) or NOTHING,
        _knob(row),
        figure(row.errors.get("omega")),
        figure(row.errors.get("attitude")),
        setting.orders(row.scene, ("omega", "attitude")),
        figure(row.errors.get("T")),
        figure(None if pace is None else 1e6 * pace),
    ]


def _knob(row: EngineRow) -> str:
    if not row.value:
        return NOTHING
    return row.value if row.knob == "step" else f"{row.knob} {row.value}"


def _scenes(board: Board, entries: EntryList, every: Sequence[EngineSetting]) -> Iterator[str]:
    """Yield a section for each scene: every engine with its best setting there."""
    titles = entries.titles
    for scene in dict.fromkeys(row.scene for row in board.study.rows):
        rows = []
        for engine, group in groupby(newest(every), key=lambda setting: setting.engine):
            best_rows = [(row, s.cause(scene)) for s in group if (row := s.best(scene)) is not None]
            best, cause = min(best_rows, key=lambda pair: pair[0].worst, default=(None, ""))
            if best is not None:
                rows.append(_scene_row(best, titles.get(engine, engine), cause))
        if rows:
            states = (
                ("omega", "attitude") if "omega" in _states(board, scene) else ("impulse", "centre")
            )
            space = "H in space:" if "omega" in states else "momentum in space:"
            numbers = (*(f"{name}:" for name in states), "energy:", space, "digits:")
            yield f"## {scene}"
            yield table(["engine", "setting", "step:", *numbers, "cause"], rows)


def _scene_row(row: EngineRow, title: str, cause: str) -> list[str]:
    is_rotation = "omega" in row.floors
    names = (
        ("omega", "attitude", "T", "H_space")
        if is_rotation
        else ("impulse", "centre", "T", "x_space")
    )
    words = ", ".join(filter(None, [row.variant, row.rung if row.rung != "f64" else ""]))
    return [
        prose(title),
        prose(words) or NOTHING,
        _knob(row),
        *(figure(row.errors.get(name)) for name in names),
        f"{digits(row.worst):.1f}",
        prose(cause) or NOTHING,
    ]


def _states(board: Board, scene: str) -> set[str]:
    """Return the state quantities that were judged on a scene."""
    return {name for row in board.study.rows if row.scene == scene for name in row.floors}


def _as_shipped(board: Board, entries: EntryList, every: Sequence[EngineSetting]) -> Iterator[str]:
    """Yield the table of the engines as shipped beside the settings of the board."""
    titles, rows, usual = entries.titles, [], newest(every)
    for setting in newest(every, shipped=True):
        for row in setting.rows:
            other = like(row, usual, entries)
            if row.is_judged:
                rows.append(
                    [
                        prose(titles.get(setting.engine, setting.engine)),
                        prose(other.variant if other else row.variant) or NOTHING,
                        code(row.scene.rpartition("/")[2]),
                        row.value,
                        *(figure(row.errors.get(name)) for name in ("omega", "attitude", "T")),
                        figure(other.worst if other and other.worst < inf else None),
                        prose(row.cause) or NOTHING,
                    ]
                )
    if rows:
        columns = [
            "engine",
            "setting",
            "scene",
            "step:",
            "omega:",
            "attitude:",
            "energy:",
            "set by us:",
            "cause",
        ]
        yield "## As shipped"
        yield (
            "Sleeping, damping and caps are left as an engine ships them; *set by us* is the error with "
            "what the adapter sets, at the same step."
        )
        yield table(columns, rows)


def unavailable(rows: Iterable[EngineRow]) -> Iterator[str]:
    """Yield a section of the runs without numbers, with a line for each engine, version and reason."""
    lost = {
        (row.engine, row.version, row.standing, row.detail): row
        for row in rows
        if not row.is_judged
    }
    if lost:
        yield "## Without a number"
        yield bullets(
            f"{code(row.solver)} on {code(row.scene)}: {row.standing}, {prose(row.detail)}"
            for row in lost.values()
        )


def remake(board: Board) -> list[str]:
    machine, name, place = board.timings.machine, board.name, places(board.name)
    return [
        f"`make {name}` runs what is not stored yet, and `make {name} ENGINE=mujoco` one engine again; "
        f"with `taylor-verify publish {name} --anew` everything is run. It may be killed, and goes on.",
        f"Errors are the same on every machine; they are in [{name}.json](../{place.rows.name}).",
        f"`taylor-verify board --board {name} --row N --out row.json` writes the trajectory of row N, "
        "made by its engine in seconds, which `check` judges alone. "
        f"`board --json` and the sheet, `{name}.csv`, have every row with its number.",
        f"Times are in [{name}-timings.json](../{place.timings.name}), {board.timings.workers} runs at a "
        f"time on {prose(machine.processor)}; no number but a time depends on the machine.",
        made_with(board.study.versions),
    ]


def sheet(board: Board) -> str:
    """Return a row for every run, with every quantity."""
    quantities = dict.fromkeys(name for row in board.study.rows for name in row.errors)
    names = [
        "row",
        "engine",
        "version",
        "variant",
        "knob",
        "value",
        "scene",
        "rung",
        "shipped",
        "standing",
        "steps",
        "start",
        *quantities,
        "microseconds",
        "cause",
        "solver",
    ]
    return csv_sheet(names, (_sheet_row(board, row) for row in board.study.rows))


def _sheet_row(board: Board, row: EngineRow) -> dict[str, Any]:
    pace = board.pace(row)
    return {
        **vars(row),
        **row.errors,
        "row": board.numbers[row.key],
        "microseconds": None if pace is None else f"{1e6 * pace:.3g}",
        "standing": row.standing.value,
        "shipped": "yes" if row.shipped else "no",
    }
