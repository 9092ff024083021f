"""The study of the hard scenes: verdicts, a search for the worst, and the reach of each precision.

A verdict other than `pass` is either expected, with a reason, or a mismatch. The page lists mismatches in
its summary, and every verdict other than `pass` with its reason.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.json_text import complete, plain
from taylor_verify.records.replacement import replace_files
from taylor_verify.records.runs import Run, gravest, runs
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.report import csv_tables as sheets
from taylor_verify.words.cells import NOTHING, figure, judged, peak, reason, word, worst_ratio
from taylor_verify.words.markdown import bold, bullets, code, prose
from taylor_verify.words.page_parts import counts, roundoffs, traced, whole
from taylor_verify_reports.studies import figures
from taylor_verify_reports.studies.columns import Columns, lay_out
from taylor_verify_reports.studies.hard.hard_scenes import (
    ACHIEVED,
    ATTAINABLE,
    HARD,
    HardStudy,
    ReachRow,
    Search,
    WorstOfFamily,
    last_value,
    most_periods,
)
from taylor_verify_reports.studies.hard.picture import Line, lines, pictures
from taylor_verify_reports.studies.study import Measured, Option, Progress, Study, whole_number

_FOLDER: Final = "extremes/"
# Mark after the last value that was tried, beyond which the reach may extend.
_LAST: Final = " \N{RIGHTWARDS ARROW}"

_WHAT: Final = (
    "These scenes are extreme: beside a separatrix and on it, with moments nearly equal or far apart, "
    "sizes near the ends of the number range, many periods, and the worst scenes that a search has "
    "found. The right verdict is not always *pass*. If rounding alone may change a motion by its own "
    "size, the right verdict is *vacuous*. The right verdict of each scene is written down "
    "beforehand, with its reason, and a mismatch in either direction is a fail."
)
_LEGEND: Final = (
    "*state* is the main quantity, the angular velocity or the impulse: *max, mean @ t of the max*, "
    "in u, or a word for a missing number.",
    "*over attainable* is the largest of all quantities of the scene, with the name of the quantity; "
    "a gate allows ten.",
    "*verdict* is the gravest of all quantities. *as expected* counts the quantities with the "
    "expected verdict; a mismatch is bold.",
)
_WORST: Final = (
    "A gate allows {factor} times the attainable error, which is the error that independent roundings "
    "of every component leave. How near does a sound solver come to this bound? In each family "
    "{runs} runs are spent on a population of points that moves by differential evolution. The Taylor "
    "driver answers every scene on {rung}, and the largest *error over attainable* of all its "
    "gates counts. Vacuous gates do not count. The worst scene of every family is stored in exact "
    "numbers, and is one of the scenes above."
)
_REACH: Final = (
    "How far does each precision keep 3, 6 or 12 digits: for many periods, and beside an unstable "
    "motion? The Taylor integrator runs at the rung's own tolerance; the digits left are those of the "
    "largest error up to then, compared with the exact motion of the same rounded data."
)
_REACH_LEGEND: Final = (
    "*3, 6, 12 digits* are the last values at which this number of digits is left, as at all easier "
    "values: the number of *periods*, or the distance *d* from the unstable motion after one period. "
    f"{_LAST.strip()} marks the last value that was tried: the reach may be longer. {NOTHING} means "
    "that there is no value.",
    "*attainable* is the same value for the judge's floor: the effect on the orbit of one rounding of "
    "every component in every step. It is a model of random roundings, and no bound.",
    "Periods are those of omega or of the impulses, and the instants are their quarters. Only omega "
    "or the impulses are compared, except in the motion that names the attitude.",
)


def page(study: HardStudy, folder: Path) -> str:
    """Return the whole page, with the pictures that are in ``folder``/figures."""
    by_model: dict[str, list[Run]] = {}
    for run in runs(study.verdicts):
        by_model.setdefault(run.model, []).append(run)
    return whole(
        "Hard scenes",
        _WHAT,
        counts(study.verdicts),
        _summary(study),
        bullets([*_LEGEND, roundoffs(study.verdicts)]),
        *(
            f"## {model or 'Without a state'}\n\n{lay_out(_scene_columns(study), own)}"
            for model, own in by_model.items()
        ),
        "## No pass, and why",
        _not_passed(study),
        _left_out(study),
        *_worst(study),
        *_reached(study, folder),
        "## To remake this",
        "`taylor-verify publish hard` runs all scenes on float64, follows the families on every rung, and "
        f"writes [hard.json](../{HARD.name}), this page and its pictures. The sheet `hard.csv` has every "
        "quantity of every scene, hard.json also every number of periods. `taylor-verify "
        "run extremes` prints the verdicts and fails at a mismatch; with `--rung` it runs the scenes on "
        "others. The expectations are in `cases/extremes/EXPECTED.toml`.",
        traced({"versions": study.versions, **plain(study.machine)}),
    )


# Verdicts.


def _summary(study: HardStudy) -> str:
    """Return the number of expected verdicts, and all mismatches in full."""
    others = [verdict for verdict in study.verdicts if verdict.verdict is not Status.PASS]
    met = sum(map(study.is_met, others))
    counted = f"{met} of {len(others)} verdicts other than pass were expected."
    if not study.mismatches:
        return counted
    faults = bullets(map(prose, study.mismatches))
    return f"{counted} {bold(f'{len(study.mismatches)} mismatches')}:\n\n{faults}"


def _scene_columns(study: HardStudy) -> Columns[Run]:
    return (
        ("scene", lambda run: _short(run.scene)),
        ("rung", lambda run: run.rung),
        ("what it is", lambda run: prose(study.titles.get(run.scene, ""))),
        ("state:", lambda run: _state(run.state[0] if run.state else run.verdicts[0])),
        ("over attainable:", lambda run: worst_ratio(filter(_is_compared, run.verdicts))),
        ("verdict", lambda run: judged(gravest(run.verdicts))),
        ("as expected:", partial(_met, study)),
    )


def _is_compared(verdict: Verdict) -> bool:
    return verdict.verdict in (Status.PASS, Status.FAIL)


def _short(scene: str) -> str:
    return code(scene.removeprefix(_FOLDER))


def _met(study: HardStudy, run: Run) -> str:
    met = sum(map(study.is_met, run.verdicts))
    counted = f"{met} of {len(run.verdicts)}"
    return counted if met == len(run.verdicts) else bold(counted)


def _state(verdict: Verdict) -> str:
    """Return the error with the verdict unless that is a pass; a word if the error is no number."""
    if verdict.max is None:
        return bold(prose(word(verdict)))
    text = prose(peak(verdict))
    return text if verdict.verdict is Status.PASS else f"{text} {judged(verdict.verdict)}"


def _not_passed(study: HardStudy) -> str:
    """Return a line for every verdict other than pass, beside the expected one."""
    columns: Columns[Verdict] = (
        ("scene", lambda row: _short(row.scene)),
        ("quantity", lambda row: code(row.quantity)),
        ("verdict", lambda row: judged(row.verdict)),
        ("expected", lambda row: _expected(study, row)),
        ("bound:", lambda row: figure(row.bound)),
        ("why", lambda row: prose(_why(study, row) or reason(row))),
    )
    rows = [
        row for row in study.verdicts if row.verdict is not Status.PASS or not study.is_met(row)
    ]
    return lay_out(columns, rows) if rows else "Every answer is a pass."


def _expected(study: HardStudy, verdict: Verdict) -> str:
    wanted = study.expectation(verdict)
    expected = wanted.verdict if wanted else Status.PASS
    return expected.value if study.is_met(verdict) else bold(expected.value)


def _why(study: HardStudy, verdict: Verdict) -> str:
    wanted = study.expectation(verdict)
    return wanted.why if wanted else ""


def _left_out(study: HardStudy) -> str:
    lines = [f"{code(run.scene)}, {run.rung}: {prose(run.why)}" for run in study.left_out]
    return f"Not run:\n\n{bullets(lines)}" if lines else ""


# The search.


_FAMILY: Final[Columns[WorstOfFamily]] = (
    ("family", lambda row: prose(row.what)),
    ("scenes:", lambda row: str(row.judged)),
    ("error over attainable:", lambda row: figure(row.ratio)),
    ("in", lambda row: code(row.quantity)),
    ("its error:", lambda row: figure(row.max)),
    ("verdict", lambda row: row.verdict.value),
    ("stored as", lambda row: code(row.scene)),
)


def _worst(study: HardStudy) -> list[str]:
    search: Search | None = study.search
    if search is None or not study.worst:
        return []
    families = sorted(study.worst, key=lambda row: -row.ratio)
    count = sum(row.judged for row in families)
    return [
        "## The worst that a search has found",
        _WORST.format(factor=search.factor, rung=code(search.rung), runs=search.runs),
        f"Of {count} scenes the worst is {code(families[0].scene)}: "
        f"{figure(families[0].ratio)} in {code(families[0].quantity)}.",
        lay_out(_FAMILY, families),
        f"`taylor-verify publish hard --runs {search.runs} --seed {search.seed}` searches again and "
        f"replaces the scenes. Other scenes may be worse. {traced(complete(search.provenance))}",
    ]


# The reach.


def far(line: Line, digits: int, key: str = ACHIEVED) -> str:
    """Return the last value or the most periods at which so many digits are left."""
    if not line.rows:
        return NOTHING
    if line.family.symbol:
        return cell(last_value(line.rows, 1, digits, key), line.family.values[-1])
    return cell(most_periods(line.rows[0], digits, key), line.rows[0].periods[-1])


_HOW_FAR: Final[Columns[Line]] = (
    ("motion", lambda line: prose(line.family.title)),
    ("varied", lambda line: line.family.symbol or "periods"),
    ("rung", lambda line: line.rung),
    *((f"{n} digits:", partial(far, digits=n)) for n in (3, 6, 12)),
    ("attainable, 6:", partial(far, digits=6, key=ATTAINABLE)),
)


def cell(value: str | int | None, last: str | int) -> str:
    """Return the value as a cell, with a mark if it is the ``last`` that was tried."""
    if value is None:
        return NOTHING
    return f"{value}{_LAST}" if value == last else str(value)


def _reached(study: HardStudy, folder: Path) -> list[str]:
    if not study.reach:
        return []
    return [
        "## How far each precision carries",
        _REACH,
        bullets([*_REACH_LEGEND, *_exceptions(study.reach)]),
        lay_out(_HOW_FAR, lines(study)),
        figures.shown(folder, pictures(study)),
    ]


def _exceptions(rows: Sequence[ReachRow]) -> Iterator[str]:
    """Yield what the tables do not say: the errors over the floors, and the runs without numbers."""
    ratios = sorted(
        error / least
        for row in rows
        for error, least in zip(row.errors, row.floors, strict=False)
        if error is not None and least and least <= 0.1
    )
    if ratios:
        yield (
            f"Error over attainable, if the attainable error leaves a digit: {figure(ratios[-1])} at most, "
            f"with a median of {figure(ratios[len(ratios) // 2])} over {len(ratios)} errors."
        )
    blurred = sum(not row.errors for row in rows)
    yield (
        f"{len(rows)} runs. In {blurred} of them the rung could not represent the motion: the rounded "
        "numbers belong to another orbit, or the machine does not have the rung."
    )
    for row in rows:
        # A run that ended early has no number, like one that was lost.
        if row.errors and row.why:
            yield f"{row.family} {row.value}, {row.rung}: {prose(row.why)}. It counts as lost."


# The sheet.


def sheet(study: HardStudy) -> str:
    """Return a CSV row for every quantity of every scene."""

    def expected(verdict: Verdict) -> dict[str, Any]:
        wanted = study.expectation(verdict)
        return {
            "title": study.titles.get(verdict.scene),
            "expected": (wanted.verdict if wanted else Status.PASS).value,
            "why_expected": _why(study, verdict),
            "as_expected": "yes" if study.is_met(verdict) else "no",
        }

    # The reasons of the bounds are long texts, and hard.json has them.
    return sheets.gates(study.verdicts, expected, without=("because", "scene_sha256"))


# The study.


# Runs of a published search in each family, and enough for the first population and one more generation.
RUNS: Final = 400
LEAST_RUNS: Final = 10


def _measure(folder: Path, progress: Progress, runs: int = 0, seed: int = 1) -> Measured:
    """Run all extremes and follow the families; with ``runs``, search for the worst scenes before.

    Unexpected verdicts are published too, and marked. Without a search the stored one stays.
    """
    from taylor_verify_reports.studies.hard import extremes as measure
    from taylor_verify_reports.studies.hard import reach

    earlier, shipped = HARD.find(folder), list[Path]()
    search, worst = (earlier.search, earlier.worst) if earlier else (None, ())
    if runs:
        from taylor_verify.scenes.library import WORST, cases_directory
        from taylor_verify_reports.studies.hard.search import SEARCHED, search_all

        results = search_all(runs, seed, progress.counting(len(SEARCHED)))
        search, worst = measure.searched(runs, seed), tuple(one.row() for one in results)
        texts = {one.family.name: one.scene_text for one in results}
        shipped = store_scenes(cases_directory() / WORST, texts)
    with progress.jobs() as job_progress:
        judgements = measure.extremes(job_progress)
    rows = reach.measure(progress.counting(len(reach.members())))
    study = replace(measure.study(judgements, rows), search=search, worst=worst)
    written = [*HARD.write(folder, study), *shipped]
    return Measured(written, study.mismatches, judgements.exit_status)


def store_scenes(folder: Path, scenes: Mapping[str, str]) -> list[Path]:
    """Write scene files, TOML by their names, in place of all in ``folder``. Raises OSError."""
    texts = {f"{name}.toml": text for name, text in scenes.items()}
    return list(replace_files(folder, texts, stale=folder.glob("*.toml")))


STUDY: Final = Study(
    name="hard",
    title="hard scenes: their verdicts, the worst found, and how far each precision carries",
    duration="ten minutes, all cores",
    measure=_measure,
    find=HARD.find,
    page=page,
    sheet=sheet,
    draw=pictures,
    options=(
        Option(
            "runs",
            "search each family for the worst scene with N runs, and replace the shipped ones; "
            f"{RUNS} are published",
            partial(whole_number, least=LEAST_RUNS),
        ),
        Option("seed", "the seed of the search; default: 1", whole_number),
    ),
)
