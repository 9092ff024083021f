"""The page of a board whose scenes have loads: advice for each job, then each scene at length."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.markdown import bullets, prose, table
from taylor_verify.words.page_parts import whole
from taylor_verify_reports.studies.engines.advice import advice, at_length
from taylor_verify_reports.studies.engines.document import Board, EngineRow
from taylor_verify_reports.studies.engines.entry import EntryList
from taylor_verify_reports.studies.engines.findings import findings
from taylor_verify_reports.studies.engines.page import entries_of, remake, unavailable
from taylor_verify_reports.studies.engines.ranking import EngineSetting, settings

_LEGEND: Final = (
    "A number below a step (or a tolerance) is the largest error of all state quantities of the scene: "
    "relative, and in radians for the attitude. A dash is a step that the engine did not take.",
    "*load* says how the loads of the scene reach the engine. That is a property of its interface, and "
    "decides the order more often than the integrator does.",
    "*order* is the observed order of the error over the steps, of the first quantity and of the "
    "attitude; a dash means that the steps show none.",
    "*rows* are the numbers of the row's runs, from the largest step to the smallest: `taylor-verify board "
    "--board NAME --row N --out row.json` makes the trajectory of one of them, in seconds, and says how "
    "`check` judges it.",
    "*time* is that of the engine's own calls for a second of the motion at the smallest step, in "
    "microseconds. It comes from one run beside others: only its order of magnitude is reliable.",
)


def page(board: Board, folder: Path) -> str:
    """Return the whole page."""
    return text(board, entries_of(board), folder)


def text(board: Board, entries: EntryList, folder: Path) -> str:
    """Return the page of a board with the engines of a list, and findings of the ``folder``."""
    return whole(
        entries.about.title,
        bullets(advice(board, entries)) or "No engine is measured yet.",
        entries.about.what,
        *_scenes(board, entries),
        bullets([*_LEGEND, *entries.about.remarks]),
        *unavailable(board.study.rows),
        *(findings(folder, entries.about.findings) if entries.about.findings else ()),
        "## To remake this",
        bullets(remake(board)),
    )


def _scenes(board: Board, entries: EntryList) -> Iterator[str]:
    """Yield a section for each scene, with a row for each setting."""
    every = settings(board.study)
    for scene in entries.scene:
        own = [setting for setting in every if setting.on(scene.name)]
        if own:
            yield f"## {scene.name}"
            yield bullets(at_length(board, entries, scene.job)) if scene.job else ""
            yield _table(board, own, scene.name, entries.titles)


def _table(board: Board, own: Sequence[EngineSetting], scene: str, titles: dict[str, str]) -> str:
    """Return a table for the settings whose knob is the step, and one for each other knob."""
    tables = []
    for knob in dict.fromkeys(setting.knob for setting in own):
        group = [setting for setting in own if setting.knob == knob]
        values = {row.value for setting in group for row in setting.on(scene)}
        steps = sorted(values, key=_size)[::-1]
        head = [f"{knob} {steps[0]}:", *(f"{step or NOTHING}:" for step in steps[1:])]
        rows = [_cells(board, setting, scene, steps, titles) for setting in group]
        tables.append(table(["engine", "setting", "load", *head, "order:", "time:", "rows:"], rows))
    return "\n\n".join(tables)


def _size(step: str) -> float:
    return float(step or 0)


def _cells(
    board: Board,
    setting: EngineSetting,
    scene: str,
    steps: Sequence[str],
    titles: dict[str, str],
) -> list[str]:
    rows = {row.value: row for row in setting.on(scene)}
    finest = [*rows.values()][-1]
    pace = board.pace(finest)
    return [
        prose(f"{titles.get(setting.engine, setting.engine)} {setting.version}".strip()),
        prose(setting.words) or NOTHING,
        prose(finest.load) or NOTHING,
        *(figure(rows[step].worst) if step in rows else NOTHING for step in steps),
        setting.orders(scene, [*finest.floors][:2]),
        figure(None if pace is None else 1e6 * pace),
        _numbers(board, [*rows.values()]),
    ]


def _numbers(board: Board, rows: Sequence[EngineRow]) -> str:
    """Return the numbers of the first and the last of rows that stand in succession."""
    first, last = (board.numbers[row.key] for row in (rows[0], rows[-1]))
    return f"{first} to {last}" if last > first else f"{first}"
