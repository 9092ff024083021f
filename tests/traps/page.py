"""The table of traps: plain calls of heyoka beside this suite's driver, from stored rows alone.

``TrapsStudy`` in data/traps.json: words, the code that was run, and what was measured in each case.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final

from taylor_verify.publish.cells import INFINITE, NOTHING, figure
from taylor_verify.publish.markdown import bold, bullets, prose, table
from taylor_verify.publish.page import traced
from taylor_verify.records import store
from taylor_verify.records.json_text import complete, plain, read
from taylor_verify.records.replacement import replace_files
from taylor_verify.studies.accuracy import sheet as sheets
from traps.document import TrapCase, TrapRow, TrapsStudy

TRAPS: Final = f"{store.FOLDER}/traps.json"
PAGE: Final = "tables/traps.md"
SHEET: Final = "tables/traps.csv"
SCRIPTS: Final = "upstream"

_MADE_BY: Final = {"made_by": "make traps; do not edit"}
_MAKER: Final = "<!-- made by make traps; do not edit -->"
# The quantities that a free body has gates for.
_GATES: Final = {"omega": "state", "T": "T", "H2": "H²"}
_SHEET: Final = (
    "trap",
    "title",
    "case",
    "reports",
    "silent",
    "error",
    "driver",
    "driver_error",
    "steps",
    *(f"{name}_{field}" for name in _GATES for field in ("verdict", "over_bound")),
    "cause",
    "documented",
    "script",
)
_STATE: Final = "omega"
# Below the roundoff of every format that is shown.
_NO_ERROR: Final = 1e-80

_WHAT: Final = (
    "[heyoka](https://bluescarni.github.io/heyoka.py) is the integrator that this suite is built on. "
    "Called without care it can be wrong without saying so. Each entry here is a few lines that "
    "anybody might write, the very lines that were run; what heyoka reports; how wrong the answer "
    "is, against the exact one; and what the driver of this suite does with the same question."
)
_HOW: Final = (
    "*error* is relative to the size of the true answer, the largest of all samples; the data are "
    "those that the solver was given, to the last bit, and the exact answer starts from them.",
    "*silent* is a call that reports success, or reports nothing: `time_limit` is heyoka's word for "
    "the time asked for having been reached.",
    "*by design* is said of what follows from how heyoka is meant to work, *documented* where we "
    "found a sentence about it. The rest is our view, and a script in "
    "[upstream](../upstream/README.md) shows it in a few lines.",
    "The table *in short* has of each trap the case in which the plain call falls farthest behind "
    "the driver.",
    "A key with T is a wrong answer, one with S a surprise at the edge of what can be asked.",
)


# The files.


def publish(folder: Path, study: TrapsStudy) -> list[Path]:
    """Store the traps in ``folder``/data, and make the page of them.

    Raises OSError for a folder that cannot be written.
    """
    text = store.laid_out({**_MADE_BY, **complete(study), "machine": plain(study.machine)})
    stored = replace_files(folder, {TRAPS: text})
    return [*stored, *replace_files(folder, pages(folder))]


def pages(folder: Path) -> dict[str, str]:
    """Return the page and its sheet by their paths below ``folder``; none where nothing is stored.

    Raises OSError and ValueError as `load` does.
    """
    if not (folder / TRAPS).exists():
        return {}
    study = load(folder)
    return {PAGE: page(study), SHEET: sheet(study.traps)}


def load(folder: Path) -> TrapsStudy:
    """Return the traps of ``folder``/data/traps.json.

    Raises OSError for a file that cannot be read and ValueError for one that holds something else.
    """
    return read(folder / TRAPS, TrapsStudy)


# The page.


def page(stored: TrapsStudy) -> str:
    """Return the page: its findings, every trap in one line and in numbers, and the gates."""
    traps = stored.traps
    blocks = [
        f"{_MAKER}\n# A plain heyoka call against this suite's driver",
        _WHAT,
        "## What it proves",
        bullets(proven(traps)),
        "## How to read it",
        bullets(_HOW),
        "## In short",
        _in_short(traps),
        "## What the gates see of the plain answers",
        _gate_table(traps),
        "## One by one",
        *_entries(traps),
        "## To remake this",
        f"`make traps` makes all of these calls again and writes "
        f"[traps.json](../{TRAPS}), from which this page and its [CSV](traps.csv) are made. "
        f"{traced({'versions': stored.versions, **plain(stored.machine)})}",
    ]
    return "\n\n".join(blocks) + "\n"


def _in_short(traps: Iterable[TrapRow]) -> str:
    columns = [
        "trap",
        "what happens",
        "heyoka reports",
        "error:",
        "driver's error:",
        "whose it is",
    ]
    return table(columns, [_line(trap) for trap in traps])


def _line(trap: TrapRow) -> list[str]:
    worst = worst_of(trap)
    if worst is None:
        return [bold(trap.key), prose(trap.title), "not measured", NOTHING, NOTHING, _cause(trap)]
    return [
        bold(trap.key),
        prose(trap.title),
        prose(worst.said),
        figure(worst.error),
        figure(worst.driver_error),
        _cause(trap),
    ]


def _cause(trap: TrapRow) -> str:
    script = f" ([script](../{SCRIPTS}/{trap.script}.py))" if trap.script else ""
    return f"{prose(trap.cause)}{script}"


def worst_of(trap: TrapRow) -> TrapCase | None:
    """The case in which the plain call falls farthest behind the driver; None without cases."""
    return max(trap.cases, key=_behind, default=None)


def _behind(case: TrapCase) -> float:
    """The error over the driver's; infinite where only the driver has an answer."""
    if case.error is None:
        return -1.0 if case.driver_error is None else math.inf
    return case.error / max(case.driver_error or 0.0, _NO_ERROR)


def _gate_table(traps: Iterable[TrapRow]) -> str:
    columns = [
        "trap",
        "case",
        "error:",
        *(f"{heading}:" for heading in _GATES.values()),
    ]
    rows = [
        [trap.key, prose(case.case), figure(case.error), *(_gate(case, q) for q in _GATES)]
        for trap in traps
        for case in trap.cases
        if case.gates
    ]
    legend = (
        "A number is the largest error over the bound of the gate: above 1 the gate fails. *vacuous* "
        "is a gate whose bound forbids nothing, because rounding alone may carry the state as far as "
        "it is large."
    )
    return f"{legend}\n\n{table(columns, rows)}"


def _gate(case: TrapCase, quantity: str) -> str:
    gate = case.gates.get(quantity)
    if gate is None:
        return NOTHING
    if gate.verdict == "pass":
        return figure(gate.over_bound)
    if gate.verdict != "fail":
        return gate.verdict
    if case.error is None:
        return bold("not scored")
    return bold(INFINITE if gate.over_bound is None else figure(gate.over_bound))


def _entries(traps: Iterable[TrapRow]) -> list[str]:
    """Code that several traps share is shown with the first of them."""
    first: dict[str, str] = {}
    return [_entry(trap, first.setdefault(trap.code, trap.key)) for trap in traps]


def _entry(trap: TrapRow, shown_at: str) -> str:
    silence = "silent" if trap.silent else "reported"
    blocks = [
        f"### {trap.key}: {prose(trap.title)}",
        bullets(
            [
                f"The plain call {prose(trap.plain)}.",
                f"The driver: {prose(trap.driver)}.",
                f"{silence}; {_cause(trap)}.",
                *_documented(trap),
                *([prose(trap.remark)] if trap.remark else []),
            ]
        ),
        f"```python\n{trap.code}\n```"
        if shown_at == trap.key
        else f"The code is that of {shown_at}.",
        _cases(trap) or "Not measured: the library that it needs is not installed here.",
    ]
    return "\n\n".join(blocks)


def _documented(trap: TrapRow) -> list[str]:
    if not trap.documented:
        return []
    return [f"heyoka's [documentation]({trap.where}): *{prose(trap.documented)}*."]


def _cases(trap: TrapRow) -> str:
    if not trap.cases:
        return ""
    columns = [
        "case",
        "heyoka reports",
        "steps:",
        "error:",
        "driver's error:",
        "the driver",
    ]
    rows = [
        [
            prose(case.case),
            prose(case.said),
            NOTHING if case.steps is None else str(case.steps),
            figure(case.error),
            figure(case.driver_error),
            prose(case.driver),
        ]
        for case in trap.cases
    ]
    return table(columns, rows)


# What the rows prove.


def proven(traps: Sequence[TrapRow]) -> list[str]:
    """Return the sentences that are true of these rows."""
    sentences = [_silently(traps), _conserving(traps), _unseen(traps), _seen_by_state(traps)]
    return [sentence for sentence in sentences if sentence]


def _silently(traps: Sequence[TrapRow]) -> str:
    silent = [trap.key for trap in traps if trap.silent and trap.cases]
    if not silent:
        return ""
    measured = sum(bool(trap.cases) for trap in traps)
    return (
        f"{bold(f'{len(silent)} of {measured} traps are silent')}: the call reports success, or "
        f"reports nothing ({', '.join(silent)})."
    )


def conserving(traps: Iterable[TrapRow]) -> list[tuple[TrapRow, TrapCase]]:
    """Return the answers that pass every gate on a conserved quantity."""
    return [
        (trap, case)
        for trap in traps
        for case in trap.cases
        if case.gates
        and case.error is not None
        and all(gate.verdict == "pass" for name, gate in case.gates.items() if name != _STATE)
    ]


def _conserving(traps: Iterable[TrapRow]) -> str:
    wrong = [
        (trap, case)
        for trap, case in conserving(traps)
        if case.driver_error is not None and (case.error or 0.0) > 100 * case.driver_error
    ]
    if not wrong:
        return ""
    trap, worst = max(wrong, key=lambda pair: pair[1].error or 0.0)
    return (
        f"{bold('A plain answer can pass every gate on conserved quantities and be wrong')}: "
        f"{len(wrong)} do, and are more than a hundred times as far off as the driver on the same "
        f"scene. The worst is {prose(worst.case)} ({trap.key}), whose energy and momentum are kept "
        f"to the last digit and whose state has an error of {figure(worst.error)} "
        f"(the driver: {figure(worst.driver_error)})."
    )


def _unseen(traps: Iterable[TrapRow]) -> str:
    """Return a sentence on answers that pass the gate of the state too."""
    lost = [
        (trap, case)
        for trap, case in conserving(traps)
        if case.gates[_STATE].verdict != "fail"
        and case.driver_error is not None
        and (case.error or 0.0) > 100 * case.driver_error
    ]
    if not lost:
        return ""
    keys = sorted({trap.key for trap, _ in lost})
    passed = [case for _, case in lost if case.gates[_STATE].verdict == "pass"]
    worst = max((case.error or 0.0 for case in passed), default=0.0)
    return (
        f"{bold('No gate of this suite sees')} {len(lost)} answers of {', '.join(keys)}: roundings "
        f"alone may carry the state as far. The gate of the state passes errors up to {figure(worst)} "
        "there, and is vacuous for the rest. The driver is right all the same; that is why its step is "
        "bounded, and not only judged."
    )


def _seen_by_state(traps: Iterable[TrapRow]) -> str:
    names = sorted(
        {
            t.key
            for t in traps
            for c in t.cases
            if c.error is not None and c.gates and c.gates[_STATE].verdict == "fail"
        }
    )
    return f"The gate of the state sees {', '.join(names)}, from some size on." if names else ""


# The sheet.


def sheet(traps: Iterable[TrapRow]) -> str:
    """Return a row for every case of every trap, with the verdict of each gate that was asked."""
    return sheets.sheet(_SHEET, (_cells(trap, case) for trap in traps for case in trap.cases))


def _cells(trap: TrapRow, case: TrapCase) -> dict[str, Any]:
    gates = {
        f"{name}_{field}": getattr(case.gates.get(name), field, None)
        for name in _GATES
        for field in ("verdict", "over_bound")
    }
    return {
        "trap": trap.key,
        **{name: getattr(trap, name) for name in ("title", "cause", "documented", "script")},
        "silent": "yes" if trap.silent else "no",
        "reports": case.said,
        **{n: getattr(case, n) for n in ("case", "error", "driver", "driver_error", "steps")},
        **gates,
    }
