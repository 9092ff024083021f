"""The page of one engine: all of its settings on every scene, and the commands that measure them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.markdown import bullets, code, prose, table
from taylor_verify.words.orders import order_sentence
from taylor_verify.words.page_parts import whole
from taylor_verify_reports.studies.engines.document import STATES, Board, EngineRow, Standing
from taylor_verify_reports.studies.engines.entry import EntryList
from taylor_verify_reports.studies.engines.ranking import EngineSetting, digits, settings

# Conserved quantities of a rigid body, and of a solid in a fluid.
_CONSERVED = ("T", "H2", "H_space", "F2", "FG", "x_space", "y_space")
_HEADINGS = {"T": "energy", "H2": "H²", "F2": "F²", "H_space": "H in space"}


def place(engine: str) -> str:
    """Return the path of the page of an engine below the report folder."""
    return f"tables/engines-{engine}.md"


def pages(board: Board, entries: EntryList) -> dict[str, str]:
    """Return the page of every engine that has rows, by its path."""
    names = dict.fromkeys(row.engine for row in board.study.rows)
    titles = entries.titles
    return {place(name): page(board, name, titles.get(name, name)) for name in names}


def page(board: Board, engine: str, title: str) -> str:
    """Return the page of one engine."""
    own = [setting for setting in settings(board.study) if setting.engine == engine]
    scenes = dict.fromkeys(row.scene for setting in own for row in setting.rows)
    return whole(
        f"{title} on the engine board",
        "Every setting that was measured, against the exact motion; [the board](engines.md) says what the "
        "columns mean and compares it with the others. Errors are the largest of all samples: relative, "
        "and in radians for the attitude.",
        *(block for scene in scenes for block in _section(board, own, scene)),
        *_not_judged(own),
        "## The commands",
        "Each row is one call; the first makes the engine's environment.",
        _commands(own),
    )


def _section(board: Board, own: Sequence[EngineSetting], scene: str) -> Iterator[str]:
    rows = [row for setting in own for row in setting.on(scene)]
    if not rows:
        return
    yield f"## {scene}"
    states = [name for name in STATES if any(name in row.floors for row in rows)]
    conserved = [name for name in _CONSERVED if any(name in row.errors for row in rows)]
    numbers = (f"{_HEADINGS.get(name, name)}:" for name in (*states, *conserved))
    knob = rows[0].knob
    columns = ["version", "setting", f"{knob}:", *numbers, "digits:", "time:", "cause"]
    yield table(columns, [_cells(board, row, states, conserved) for row in rows])
    if remarks := dict.fromkeys(f"{row.version}: {row.detail}" for row in rows if row.detail):
        yield bullets(prose(f"Remark on {remark}.") for remark in remarks)
    if orders := [_order(setting, scene, states) for setting in own if len(setting.on(scene)) > 2]:
        yield bullets(filter(None, orders))


def _cells(
    board: Board, row: EngineRow, states: Sequence[str], conserved: Sequence[str]
) -> list[str]:
    words = [row.variant, row.rung if row.rung != "f64" else "", "as shipped" * row.shipped]
    pace = board.pace(row)
    return [
        prose(row.version) or NOTHING,
        prose(", ".join(filter(None, words))) or NOTHING,
        row.value or NOTHING,
        *(figure(row.errors.get(name)) for name in (*states, *conserved)),
        f"{digits(row.worst):.1f}",
        figure(None if pace is None else 1e6 * pace),
        prose(row.cause) or NOTHING,
    ]


def _order(setting: EngineSetting, scene: str, states: Sequence[str]) -> str:
    """Return a line with the observed orders of one setting; empty for a setting without steps."""
    orders = [setting.order(scene, name) for name in states]
    sentences = [prose(order_sentence(order)) for order in orders if order]
    words = [setting.version, setting.words, "as shipped" * setting.shipped]
    named = prose(" ".join(filter(None, words)))
    return f"{named}. {'. '.join(sentences)}." if sentences else ""


def _not_judged(own: Iterable[EngineSetting]) -> Iterator[str]:
    """Yield a section of the runs without numbers, with a line for each reason."""
    reasons: dict[str, list[EngineRow]] = {}
    for setting in own:
        for row in setting.rows:
            if not row.is_judged:
                reasons.setdefault(f"{row.standing}: {row.detail}", []).append(row)
    if not reasons:
        return
    yield "## Without a number"
    yield bullets(
        f"{code(rows[0].solver)} on {code(rows[0].scene)}"
        + (f" and {len(rows) - 1} more" if len(rows) > 1 else "")
        + f": {prose(reason)}"
        for reason, rows in reasons.items()
    )
    if any(row.standing is Standing.UNAVAILABLE for rows in reasons.values() for row in rows):
        yield "An engine that is unavailable could not be installed on the machine of the measurement."


def _commands(own: Iterable[EngineSetting]) -> str:
    """Return a block with the command of each setting at its first step, and its further steps."""
    lines = []
    for setting in own:
        steps = " ".join(filter(None, dict.fromkeys(row.value for row in setting.rows)))
        scenes = dict.fromkeys(row.scene for row in setting.rows)
        rung = f" --rung {setting.rung}" if setting.rung != "f64" else ""
        first = setting.rows[0]
        lines += [
            f"# {f'{setting.knob} {steps}; ' if steps else ''}{' '.join(scenes)}",
            f'taylor-verify run {first.scene} --solver "{first.solver}"{rung}',
        ]
    return "```sh\n" + "\n".join(lines) + "\n```"
