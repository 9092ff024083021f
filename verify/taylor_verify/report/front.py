"""Front page of a report: its purpose, its main numbers, how to read them, and its other pages."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from statistics import median
from typing import TYPE_CHECKING, Final

from taylor_verify.records.precisions import place_of_rung
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.runs import Run, runs
from taylor_verify.records.store import versions
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import NOTHING, figure, in_roundoffs, main_error, ratio, worst
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify.words.page_parts import counts, made_with, whole

if TYPE_CHECKING:
    from taylor_verify.words.entry import Page

_WHAT = (
    "How accurately can a computer follow a tumbling rigid body, or a solid moving through an ideal "
    "fluid? Each *scene* is one such motion, given in exact numbers. The Taylor integrator of "
    "[heyoka](https://bluescarni.github.io/heyoka.py/) computes it in several number formats, the "
    "*rungs*, from float32 upwards, and every computed state is compared with the exact motion, known "
    "to more digits than the rung has. The difference is the error of the computation alone, because "
    "the exact motion starts from the same numbers as the integrator."
)
_READING = (
    "*u* is the unit roundoff of the rung, the largest error of a single rounding of a number near "
    "one. An error of 100 u costs the last two decimal digits.",
    "*Attainable* is the error that would remain if each step were rounded perfectly: such roundings "
    "add up like a random walk, and the motion itself magnifies them. *Error over attainable* near "
    "1 says that the solver does all that its arithmetic allows.",
    f"A quantity *passes* if no sample's error exceeds {GATE_FACTOR} times what is attainable there. Only "
    "**pass** is good: the [other verdicts](tables/README.md#how-to-read-a-cell) each have a meaning.",
    "A conserved energy or momentum does not prove that a motion is right: a wrong solution may "
    "conserve both.",
)
_CONTENTS = (
    ("[tables](tables/README.md)", "every number, and how a cell is read"),
    (
        "[tables/accuracy.md](tables/accuracy.md)",
        "the error of each scene on each rung, and what was attainable",
    ),
    ("[tables/conserved.md](tables/conserved.md)", "the drift of energy, momenta and the like"),
    ("`tables/gates.md`", "every verdict, its bound and the reason of the bound (not committed)"),
    ("[data/verdicts.json](data/verdicts.json)", "the same for programs, to the last bit"),
    ("[data/timings.json](data/timings.json)", "seconds and machine, which differ from run to run"),
    ("`data/records`", "the equations and every sample's error of each run (not committed)"),
)


def front(verdicts: Sequence[Verdict], others: Iterable[Page]) -> str:
    """Return the front page of a report, with links to all other pages."""
    judged_runs = runs(verdicts)
    contents = [*_CONTENTS, *((page.link(), page.what) for page in others)]
    return whole(
        "How accurate it is",
        _WHAT,
        "## In short",
        _in_short(judged_runs, verdicts),
        counts(verdicts),
        table(BY_RUNG, by_rung(judged_runs)),
        "## How to read it",
        bullets(_READING),
        "## The error of every scene",
        "The largest error of the main quantity, relative to its size: the angular velocity (`euler`) "
        "or the impulse (`kirchhoff`). A word is a verdict other than pass of any quantity of the "
        "run.",
        _by_scene(judged_runs),
        "## What else is here",
        table(["file", "what it has"], contents),
        "## To remake this",
        "`make verify` runs the standard set and writes a copy of this folder to "
        "`reports/local/`; `make reports` rewrites the committed one. `make check-reports` runs "
        "part of it anew and fails if a number has left its *rounding class*: processors fuse "
        "and order operations in their own ways, so the roundings differ, and with them the "
        "digits of an error, but neither its verdict nor its size. "
        "`verify/taylor_verify/batch/differences.py` says what that means in numbers, and why.",
        "Files that are *not committed* are large, and made from the other files: records, portraits "
        "of the scenes, `gates`, pictures as PDF, the paper, and the JSON of `reference`. "
        "`taylor-verify publish --missing` makes the data of these in minutes, `make paper` the paper "
        "and the pictures, and `make release-data` packs all into one archive.",
        made_with(versions(verdicts)),
    )


def _in_short(judged_runs: Sequence[Run], verdicts: Sequence[Verdict]) -> str:
    counted = {
        "scenes": len({run.scene for run in judged_runs}),
        "runs": len(judged_runs),
        "verdicts": len(verdicts),
    }
    text = ", ".join(f"{bold(str(number))} {what}" for what, number in counted.items())
    finite = [v.ratio for v in verdicts if v.is_compared and v.ratio is not None]
    if not finite:
        return f"{text}."
    exact_drifts = sum(
        verdict.max == 0 for run in judged_runs for verdict in run.conserved.values()
    )
    return (
        f"{text}. Half of the errors are below {bold(figure(median(finite)))} of what is attainable; "
        f"{exact_drifts} conserved quantities are kept exactly."
    )


BY_RUNG: Final = (
    "rung",
    "u:",
    "runs:",
    "all pass:",
    "median error, u:",
    "largest error, u:",
    "over attainable:",
    "where",
)


def by_rung(judged_runs: Sequence[Run]) -> list[list[str]]:
    """Return a row of the columns `BY_RUNG` for each rung of the runs."""
    rungs = sorted({run.rung for run in judged_runs}, key=place_of_rung)
    return [_rung_row([r for r in judged_runs if r.rung == rung]) for rung in rungs]


def _rung_row(rung_runs: Sequence[Run]) -> list[str]:
    states = [verdict for run in rung_runs for verdict in run.state if verdict.is_compared]
    sizes = [in_roundoffs(verdict, verdict.max) for verdict in states]
    finite = [size for size in sizes if size is not None]
    most = worst(states)
    passed = sum(all(v.verdict.value == "pass" for v in run.verdicts) for run in rung_runs)
    lost = len(finite) < len(sizes)
    return [
        rung_runs[0].rung,
        figure(next((verdict.roundoff for verdict in states), None)),
        str(len(rung_runs)),
        str(passed) if passed == len(rung_runs) else bold(str(passed)),
        figure(median(finite)) if finite else NOTHING,
        bold("no number") if lost else figure(max(finite, default=None)),
        ratio(most) if most else NOTHING,
        f"{code(most.quantity)} of {code(most.scene)}" if most else NOTHING,
    ]


def _by_scene(judged_runs: Sequence[Run]) -> str:
    """Return a line for each scene and solver: the main quantity's largest error on each rung."""
    rungs = sorted({run.rung for run in judged_runs}, key=place_of_rung)
    solvers = {(run.solver, run.setting) for run in judged_runs}
    lines: dict[tuple[str, str, str], dict[str, Run]] = {}
    for run in judged_runs:
        lines.setdefault((run.scene, run.solver, run.setting), {})[run.rung] = run
    # A single solver needs no column.
    has_solvers = len(solvers) > 1
    columns = ["scene", *(["solver"] if has_solvers else [])]
    rows = [
        [
            code(scene),
            *([prose(f"{solver} {setting}".strip())] if has_solvers else []),
            *(main_error(by_rung.get(rung)) for rung in rungs),
        ]
        for (scene, solver, setting), by_rung in lines.items()
    ]
    return table([*columns, *(f"{rung}:" for rung in rungs)], rows)
