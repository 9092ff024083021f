"""The page of the ledger: first what a reader of the two texts must correct, then every entry.

It is made from the rows of `claims --json` alone, and holds nothing that another machine would change: what
made the rows stands beside them, in data/claims.json.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from taylor_verify.publish import data, measured
from taylor_verify.publish.markdown import Column, bold, bullets, code, prose, table
from taylor_verify.publish.page import MADE_BY
from taylor_verify.publish.replacement import replace_files

PAGE: Final = "claims.md"
SHEET: Final = "tables/claims.csv"
CLAIMS: Final = f"{data.FOLDER}/claims.json"

_MADE_BY: Final = {"made_by": "taylor-verify publish --claims; do not edit"}

Row = Mapping[str, Any]

_FALSE: Final = "false as transcribed"
_ONLY_IF: Final = "holds only if"
_RESTORED: Final = "holds as restored"
_NEITHER: Final = ("undecided", "vacuous")

_INTRODUCTION: Final = (
    "Every numbered equation of two classic texts, and every sentence of theirs that claims something, "
    "each with a check that can fail: a page of Heinbockel's *Introduction to Tensor Calculus* (Euler's "
    "equations, page 210) and sections 48 and 49 of the *Encyclopædia Britannica*'s Hydromechanics "
    "(Kirchhoff's equations). Both were read as transcribed; the printed pages were not seen, so that a "
    "fault may be the print's or the transcription's."
)
_HOW: Final = (
    "An identity is expanded in exact rationals, with the equations of motion put in: it leaves zero or "
    "it does not. What is claimed of orbits is held to trajectories of 30 to 60 digits, enclosed "
    "by Taylor series that share no closed form with the texts. Every entry also has mutations, the "
    "statement with a sign, a factor or an index changed, that its check rejects."
)
_REMAKE: Final = (
    "`taylor-verify claims` runs all checks and fails if an entry no longer gets its verdict; "
    '`taylor-verify claims "hydromechanics 49 (17)"` shows one in full, and `--json` the same as data. '
    f"`taylor-verify publish --claims` rewrites this page, its [CSV]({SHEET}) and [claims.json]({CLAIMS}), "
    "which also names the versions, the processor and the command."
)


def page(rows: Sequence[Row], cited: Mapping[str, str]) -> str:
    """The whole page."""
    blocks = [
        f"{MADE_BY}\n# What the two texts claim",
        _INTRODUCTION,
        _counts(rows),
        "## Errata",
        _errata(rows),
        "## True on a condition",
        _on_condition(rows),
        "## Neither true nor false",
        _neither(rows),
        "## Restored",
        _restored(rows),
        "## The ledger",
        _HOW,
        *_ledger(rows),
        "## Cited, but not on the page",
        bullets(f"{code(number)}: {prose(what)}" for number, what in cited.items()),
        "## To remake this",
        _REMAKE,
    ]
    return "\n\n".join(blocks) + "\n"


def write(
    folder: Path, rows: Sequence[Row], cited: Mapping[str, str], provenance: Row | None = None
) -> list[Path]:
    """Store the rows, and put page and sheet in place; ``provenance`` is what made them.

    Raises OSError for a folder that cannot be written.
    """
    stored = {**_MADE_BY, "provenance": dict(provenance or {}), "cited": dict(cited)}
    texts = {
        CLAIMS: data.laid_out({**stored, "claims": list(rows)}),
        PAGE: page(rows, cited),
        SHEET: measured.claims(rows),
    }
    return list(replace_files(folder, texts))


def _of(rows: Sequence[Row], *verdicts: str) -> list[Row]:
    return [row for row in rows if row["verdict"] in verdicts]


def _counts(rows: Sequence[Row]) -> str:
    verdicts = [row["verdict"] for row in rows]
    found = list(dict.fromkeys(verdicts))
    columns = [Column(verdict, to_right=True) for verdict in found]
    return table(columns, [[str(verdicts.count(verdict)) for verdict in found]])


def _errata(rows: Sequence[Row]) -> str:
    """For each false entry: as transcribed, correct, and where the first form fails."""
    return "\n\n".join(
        _entry(
            row,
            [
                f"as transcribed: {_math(row['statement'])}",
                f"correct: {_math(row['correction'])}",
                f"counterexample: {prose(row['counterexample'])}",
                f"residual as transcribed {_short(row['residual']['transcribed'])}, corrected "
                f"{_residual(row)}",
                prose(row["remark"] or ""),
            ],
        )
        for row in _of(rows, _FALSE)
    )


def _on_condition(rows: Sequence[Row]) -> str:
    return "\n\n".join(
        _entry(
            row,
            [
                _math(row["statement"]),
                f"only if {prose(row['condition'])}",
                f"correct: {_math(row['correction'])}" if row["correction"] else "",
                f"else, for one: {prose(row['counterexample'])}" if row["counterexample"] else "",
                prose(row["remark"] or ""),
            ],
        )
        for row in _of(rows, _ONLY_IF)
    )


def _neither(rows: Sequence[Row]) -> str:
    return "\n\n".join(
        _entry(
            row,
            [
                _math(row["statement"]),
                f"{bold(row['verdict'])}: {prose(row['open'] or row['void'] or '')}",
                f"what is true: {_math(row['correction'])}" if row["correction"] else "",
                f"checked: {prose(row['method'])}",
            ],
        )
        for row in _of(rows, *_NEITHER)
    )


def _restored(rows: Sequence[Row]) -> str:
    """What the scan lost, where the equation is true once that is put back."""
    lost = [[code(row["id"]), prose(row["lost"])] for row in _of(rows, _RESTORED)]
    return table([Column("equation"), Column("what the scan lost")], lost)


def _entry(row: Row, lines: Sequence[str]) -> str:
    return "\n".join([f"{bold(code(row['id']))}\n", bullets(line for line in lines if line)])


def _ledger(rows: Sequence[Row]) -> list[str]:
    """One table of verdicts for each text, and below it the statements with domain and check."""
    blocks: list[str] = []
    columns = [
        Column(heading) for heading in ("claim", "verdict", "residual", "mutations rejected")
    ]
    for text in dict.fromkeys(_text_of(row) for row in rows):
        own = [row for row in rows if _text_of(row) == text]
        cells = [
            [
                code(row["id"]),
                row["verdict"],
                _residual(row),
                prose("; ".join(row["mutations"])),
            ]
            for row in own
        ]
        blocks += [
            f"### {text}",
            table(columns, cells),
            "\n\n".join(_statement(row) for row in own),
        ]
    return blocks


def _text_of(row: Row) -> str:
    author, number, *_ = row["id"].split()
    return "Heinbockel" if author == "heinbockel" else f"Hydromechanics {number}"


def _statement(row: Row) -> str:
    lines = [
        _math(row["statement"]),
        f"domain: {prose(row['domain'])}",
        f"checked by: {prose(row['method'])}",
        f"remark: {prose(row['remark'])}" if row["remark"] else "",
    ]
    return _entry(row, lines)


def _math(latex: str | None) -> str:
    """Mathematics as GitHub renders it inside a line, safe from Markdown's own signs."""
    return f"$`{latex}`$" if latex else ""


def _residual(row: Row) -> str:
    """Zero where the check is exact; else the bound that holds, which no machine's rounding moves."""
    return "0, exactly" if not row["bound"] else f"within {_short(row['bound'])}"


def _short(size: float | None) -> str:
    return "not finite" if size is None else f"{size:.2g}"
