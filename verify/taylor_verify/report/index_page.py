"""Index of a report folder: what came out, how to read a number, and the pages with all others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Final, NamedTuple

from taylor_verify.records.precisions import place_of_rung
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.runs import Run, runs
from taylor_verify.records.status import Status
from taylor_verify.records.store import versions
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import (
    NOTHING,
    figure,
    in_roundoffs,
    judged,
    main_error,
    ratio,
    worst,
)
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify.words.page_parts import counts, made_with, whole


class Page(NamedTuple):
    """A file or folder of a report, its contents in words, and the CSV of its numbers if there is one."""

    path: str
    what: str
    sheet: str = ""


_WHAT: Final = (
    "Every *scene* is one motion, given in exact numbers. A solver computes it in several number "
    "formats, the *rungs*, from float32 upwards, and every state is compared with the exact motion of "
    "the same numbers. So the difference is the error of the computation alone."
)
_READING: Final = (
    "*u* is the unit roundoff of the rung, 2^-p for p bits, the largest error of a single rounding. An "
    "error of 100 u costs the last two decimal digits.",
    "*Attainable* is the error that would remain if each step were rounded perfectly: such roundings "
    "add up like a random walk, and the motion itself magnifies them. *Over attainable* is the largest "
    "ratio of an error to it, over all samples: near 1, the solver does all that its arithmetic allows.",
    f"A quantity *passes* if no sample's error exceeds {GATE_FACTOR} times what is attainable there. A "
    "conserved energy or momentum does not prove that a motion is right: a wrong solution may conserve "
    "both.",
    "Numbers have three significant digits, and all digits in the CSV. A word replaces a missing "
    f"number: the verdict, or the outcome of a failed run. {NOTHING} is an empty cell.",
)
_MEANINGS: Final[Mapping[Status, str]] = {
    Status.PASS: "the error of every sample is within its bound",
    Status.FAIL: "an error exceeds its bound or is no number, or the solver did not finish",
    Status.UNDECIDED: "the exact solution is not known sharply enough to judge by",
    Status.VACUOUS: "roundoff alone may be as large as the motion: no answer could fail",
    Status.REFUSED: "the numbers of this rung cannot hold the scene",
    Status.UNAVAILABLE: "this machine does not have the rung",
}
_CONTENTS: Final = (
    (
        "[tables/accuracy.md](tables/accuracy.md)",
        "`gates.csv`",
        "the error of what each scene tracks, beside that of perfect rounding",
    ),
    ("[tables/conserved.md](tables/conserved.md)", "`gates.csv`", "the drift of what is conserved"),
    ("`tables/gates.md`", "`gates.csv`", "every verdict, its bound and the reason of the bound"),
    ("[data/verdicts.json](data/verdicts.json)", NOTHING, "the same for programs, to the last bit"),
)
_REMAKE: Final = (
    "`make verify` runs the standard set and writes a copy of this folder to `reports/local`; `make "
    "reports` rewrites the committed one. `make check-reports` runs a part of it anew, and fails if a "
    "number has left its *rounding class*: other processors round in another order, which changes the "
    "digits of an error, but neither its verdict nor its size.",
    "A clone lacks what is large and made of the other files: gates, sheets, records with every sample, "
    "portraits of the scenes, the JSON of `reference`, pictures as PDF, the paper. `taylor-verify publish "
    "--missing` makes the data in minutes, `make paper` the paper and its pictures, `make release-data` "
    "one archive of all.",
)


def readme(verdicts: Sequence[Verdict], others: Iterable[Page] = ()) -> str:
    """Return the index of a report folder; ``others`` are further pages."""
    judged_runs = runs(verdicts)
    besides = [
        [
            f"[{other.path}]({other.path})",
            code(Path(other.sheet).name) or NOTHING,
            other.what,
        ]
        for other in others
    ]
    return whole(
        "How accurate it is",
        _WHAT,
        _in_short(judged_runs, verdicts),
        counts(verdicts),
        table(BY_RUNG, by_rung(judged_runs)),
        "## The pages",
        table(["page", "every digit", "what it has"], [*_CONTENTS, *besides]),
        "## How to read a cell",
        bullets(_READING),
        table(
            ["verdict", "meaning"], [[judged(status), text] for status, text in _MEANINGS.items()]
        ),
        "## The error of every scene",
        "The largest error of the main quantity, relative to its size: the angular velocity (`euler`) "
        "or the impulse (`kirchhoff`). A word is a verdict other than pass of any quantity of the "
        "run.",
        _by_scene(judged_runs),
        "## To remake this",
        *_REMAKE,
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
    middle = median(finite)
    half = f"below {bold(figure(middle))} of what is attainable" if middle else bold("zero")
    return (
        f"{text}. Half of the errors are {half}; "
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
