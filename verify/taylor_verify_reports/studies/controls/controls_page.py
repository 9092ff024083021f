"""The study of the controls: deliberately broken solvers, and the gates that see their faults."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.json_text import plain
from taylor_verify.records.quantities import INITIAL, STATES, is_conserved
from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.csv_sheet import sheet as csv_sheet
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify.words.page_parts import traced, whole
from taylor_verify_reports.studies.controls.proof import (
    MAIN,
    constant_shift,
    or_infinite,
    proven,
    times_bound,
    title,
)
from taylor_verify_reports.studies.controls.sight import CONTROLS, ControlsStudy, Sight
from taylor_verify_reports.studies.study import Measured, Progress, Study

# Marks around the short table in a page that is otherwise written by hand.
BEGIN: Final = "<!-- controls: made by taylor-verify publish; do not edit -->"
END: Final = "<!-- end of controls -->"

_NOT_SEEN: Final = NOTHING
# Headings of columns, each with its quantities, of which a body has at most one.
_COLUMNS: Final = (
    ("start", (INITIAL,)),
    ("state", MAIN),
    ("attitude", ("attitude",)),
    ("centre", ("centre",)),
    ("T", ("T",)),
    ("H²", ("H2",)),
    ("F²", ("F2",)),
    ("F·G", ("FG",)),
    ("y3", ("y3",)),
    ("momentum in space", ("H_space",)),
    ("impulse in space", ("x_space",)),
    ("moment in space", ("y_space",)),
)
_MODELS: Final = {"omega": "A rigid body", "impulse": "A solid in an ideal fluid"}

_WHAT: Final = (
    "A suite must be able to fail. These solvers were therefore broken on purpose, each in one thing, "
    "and judged like any other. Which of the usual checks see the defects?"
)
_HOW: Final = (
    f"A {bold('bold')} number is the largest error over the bound of a gate that *sees* the defect. "
    f"{_NOT_SEEN} is a gate that the defect passes. A gate that the sound twin fails too does not see "
    "the defect.",
    "*start* is the first sample, which every solver was given. *state* is omega, or the impulse, in "
    "body axes. A comparison with the exact motion checks it together with *attitude* and *centre*. "
    "All columns after these are conserved quantities: T the energy; H² and F² the squares of "
    "momentum and impulse, F·G and y3 the other two in body axes; then the vectors in space.",
    "*time shift* is given if a constant shift of time explains most of the error of the state: the "
    "shift in the scene's unit, positive for a late answer. *outcome* is the solver's own report.",
    "Defects that fewer conserved quantities see come first.",
)


def page(study: ControlsStudy) -> str:
    """Return the whole page: its findings, a table for each kind of body, every defect in words."""
    sights = study.sights
    return whole(
        "What each gate sees",
        _WHAT,
        "## What it proves",
        bullets(proven(sights)),
        "## How to read the tables",
        bullets(_HOW),
        *(_section(sights, quantity, heading) for quantity, heading in _MODELS.items()),
        "## The defects, and why",
        _in_words(sights),
        "Each defect is compared with a *sound twin*, a solver of the same step that differs from it by "
        "the defect alone, so that no failure comes from a step that is too long.",
        "## To remake this",
        f"`taylor-verify publish controls` runs every defect and its twin, and writes "
        f"[controls.json](../{CONTROLS.name}); this page, its sheet `controls.csv` and the short "
        f"table in the docs of the project are made from that alone. "
        f"{traced({'versions': study.versions, **plain(study.machine)})}",
    )


# The tables.


def _section(sights: Sequence[Sight], quantity: str, heading: str) -> str:
    group = [sight for sight in sights if quantity in sight.quantities]
    if not group:
        return ""
    there = {name for sight in group for name in sight.quantities}
    shown = [(words, names) for words, names in _COLUMNS if there.intersection(names)]
    columns = ["defect", *(f"{words}:" for words, _ in shown), "time shift:", "outcome"]
    rows = []
    for sight in _blindest_first(group):
        shift = constant_shift(sight)
        cells = [_cell(sight, names) for _, names in shown]
        rows.append(
            [
                title(sight),
                *cells,
                _NOT_SEEN if shift is None else bold(figure(shift)),
                _NOT_SEEN if sight.is_finished else bold("stopped"),
            ]
        )
    return f"## {heading}\n\n{table(columns, rows)}"


def _cell(sight: Sight, names: Iterable[str]) -> str:
    """Return the cell of that quantity of ``names`` which the scene has.

    It is empty if the scene has none, and if the run stopped.
    """
    name = next((name for name in names if name in sight.quantities), None)
    if name is None or not sight.is_finished:
        return ""
    if sight.is_seen_by(name):
        return bold(times_bound(sight, name))
    return _NOT_SEEN if sight.is_missed_by(name) else sight.verdicts[name].verdict.value


def _blindest_first(sights: Iterable[Sight]) -> list[Sight]:
    """Return the defects that few conserved quantities see first, and those that did not finish last."""

    def key(sight: Sight) -> tuple[bool, int, int]:
        conserved = sum(name in sight.seen_by for name in sight.conserved)
        return not sight.is_finished, conserved, -len(sight.seen_by)

    return sorted(sights, key=key)


def _in_words(sights: Sequence[Sight]) -> str:
    rows = [
        [
            title(sight),
            code(sight.defect.scene),
            prose(sight.defect.what),
            prose(sight.defect.why),
        ]
        for sight in sights
    ]
    return table(["defect", "scene", "what is wrong", "why it shows so"], rows)


# The short table.


SHORT: Final = (
    "what was broken",
    "energy:",
    "other conserved quantities:",
    "compared with the exact motion:",
)


def short(study: ControlsStudy) -> str:
    """Return the short table of some fifteen rows, between the marks BEGIN and END."""
    legend = (
        "A number is the largest error over its bound: that check sees the defect. *not seen* is a "
        "check that passes it."
    )
    return "\n\n".join([BEGIN, table(SHORT, short_rows(study)), legend, END])


def short_rows(study: ControlsStudy) -> list[list[str]]:
    """Return the rows of the short table."""
    shown = [s for s in _blindest_first(study.sights) if s.defect.told and s.is_finished]
    return [
        [
            prose(sight.defect.what),
            _summed(sight, lambda name: name == "T"),
            _summed(sight, lambda name: name != "T" and is_conserved(name)),
            _summed(sight, lambda name: name in STATES),
        ]
        for sight in shown
    ]


def _summed(sight: Sight, wanted: Callable[[str], bool]) -> str:
    """Return the largest error over its bound among the wanted quantities that see the defect."""
    names = [name for name in sight.quantities if wanted(name)]
    failing = [name for name in names if sight.is_seen_by(name)]
    if not failing:
        return "not seen" if all(sight.is_missed_by(name) for name in names) else "undecided"
    worst = max(failing, key=lambda name: or_infinite(sight.over_bound(name)))
    return bold(times_bound(sight, worst))


# The sheet.


_FIELDS: Final = (
    "defect",
    "scene",
    "quantity",
    "seen",
    "error_over_bound",
    "max",
    "bound",
    "unit",
    "verdict",
    "outcome",
    "time_shift",
    "residual",
    "shift",
    "twin",
    "twin_verdict",
    "twin_ratio",
)


def sheet(study: ControlsStudy) -> str:
    """Return a row for every defect and gate, with every digit."""
    return csv_sheet(_FIELDS, (row for sight in study.sights for row in _rows_of(sight)))


def _rows_of(sight: Sight) -> Iterator[dict[str, Any]]:
    for name, verdict in sight.verdicts.items():
        # Some rows exist only for a defect, such as the norm of a quaternion that is not 1.
        twin = sight.sound.get(name)
        yield verdict.row() | {
            "defect": sight.defect.name,
            "seen": "yes" if sight.is_seen_by(name) else "no",
            "error_over_bound": sight.over_bound(name),
            "twin": sight.defect.sound_solver,
            "twin_verdict": None if twin is None else twin.verdict.value,
            "twin_ratio": None if twin is None else twin.ratio,
        }


# The study.


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify_reports.controls.defects import DEFECTS
    from taylor_verify_reports.studies.controls.broken_runs import sights, study

    measured = sights(DEFECTS, progress.counting(len(DEFECTS)))
    return Measured(CONTROLS.write(folder, study(measured)))


STUDY: Final = Study(
    name="controls",
    title="what each gate sees of solvers that were broken on purpose",
    duration="a minute",
    measure=_measure,
    find=CONTROLS.find,
    page=lambda study, folder: page(study),
    sheet=sheet,
)
