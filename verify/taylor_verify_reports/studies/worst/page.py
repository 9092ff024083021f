"""Page of the search for the worst scenes, made from the stored rows; and the files of these scenes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from taylor_verify.records.json_text import complete, plain
from taylor_verify.records.replacement import replace_files
from taylor_verify.words.cells import figure
from taylor_verify.words.markdown import code, prose, table
from taylor_verify.words.page import traced, whole
from taylor_verify.words.sheet import sheet as csv_sheet
from taylor_verify_reports.studies.stored import Stored
from taylor_verify_reports.studies.worst.document import WorstOfFamily, WorstStudy

# Fields with their default value are not stored.
WORST: Final = Stored(WorstStudy, "worst", fields=plain)

_WHAT: Final = (
    "A gate allows {factor} times the attainable error, which is the error that independent roundings "
    "of every component leave. How near does a sound solver come to this bound? In each family "
    "{runs} runs are spent on a population of points that moves by differential evolution. The Taylor "
    "driver answers every scene on {rung}, and the largest *error over attainable* of all its "
    "gates counts. Vacuous gates do not count."
)
_KEPT: Final = (
    "The worst scene of every family is kept in exact numbers, and runs with the extremes: "
    "`taylor-verify run extremes`."
)


def store_scenes(folder: Path, scenes: Mapping[str, str]) -> list[Path]:
    """Write scene files, TOML by their names, in place of all in ``folder``. Raises OSError."""
    texts = {f"{name}.toml": text for name, text in scenes.items()}
    return list(replace_files(folder, texts, stale=folder.glob("*.toml")))


def page(study: WorstStudy) -> str:
    """Return the page of the worst scene of each family, and of the search."""
    families = sorted(study.families, key=lambda row: -row.ratio)
    judged = sum(row.judged for row in families)
    return whole(
        "The worst that a search has found",
        _WHAT.format(factor=f"{study.factor:g}", rung=code(study.rung), runs=study.runs),
        f"Of {judged} scenes the worst is {code(families[0].scene)}: "
        f"{figure(families[0].ratio)} in {code(families[0].quantity)}.",
        _table(families),
        _KEPT,
        "## To remake this",
        f"`taylor-verify publish worst --runs {study.runs} --seed {study.seed}` repeats the search and "
        "replaces the scenes. With the same versions it finds the same scenes. Other scenes may be "
        f"worse. Every digit is in [worst.csv](worst.csv) and [worst.json](../{WORST.name}).",
        traced(complete(study.provenance)),
    )


def _table(families: Sequence[WorstOfFamily]) -> str:
    columns = [
        "family",
        "scenes:",
        "error over attainable:",
        "in",
        "its error:",
        "verdict",
        "kept as",
    ]
    rows = [
        [
            prose(row.what),
            str(row.judged),
            figure(row.ratio),
            code(row.quantity),
            figure(row.max),
            row.verdict.value,
            code(row.scene),
        ]
        for row in families
    ]
    return table(columns, rows)


# The sheet.


_SHEET: Final = (
    "family",
    "what",
    "rung",
    "judged",
    "ratio",
    "quantity",
    "max",
    "verdict",
    "scene",
    "factor",
)


def sheet(study: WorstStudy) -> str:
    """Return a CSV row for every family."""
    shared = {"rung": study.rung, "factor": study.factor}
    rows = ({**complete(row), **shared, "family": row.name} for row in study.families)
    return csv_sheet(_SHEET, rows)
