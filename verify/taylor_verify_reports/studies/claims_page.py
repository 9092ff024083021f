"""The study of the claims: the ledger of both source texts, every entry checked.

It is made from the rows of `claims --json` alone, and is the same on every machine. Their versions are in
data/claims.json.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from math import isfinite
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.json_text import complete
from taylor_verify.words.csv_sheet import sheet as csv_sheet
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify.words.page_parts import whole
from taylor_verify_reports.claims.claim_row import ClaimRow, ClaimsStudy, Verdict
from taylor_verify_reports.studies.stored import Stored
from taylor_verify_reports.studies.study import Measured, Progress, Study

CLAIMS: Final = Stored(ClaimsStudy, "claims", lambda study: study.document())

_INTRODUCTION: Final = (
    "Every numbered equation of two classic texts, and every sentence of theirs that claims "
    "something, each with a check that can fail: a page of Heinbockel's *Introduction to Tensor "
    "Calculus* (Euler's equations, page 210) and sections 48 and 49 of the *Encyclopædia "
    "Britannica*'s Hydromechanics (Kirchhoff's equations). Both were read as transcriptions without "
    "the printed pages, so that a fault may be in the print or in the transcription."
)
_HOW: Final = (
    "An identity is expanded in exact rationals, with the equations of motion put in: it leaves zero "
    "or it does not. Claims on orbits are compared with trajectories of 30 to 60 digits, enclosed by "
    "Taylor series that share no closed form with the texts. Every entry also has mutations, the "
    "statement with a sign, a factor or an index changed, that its check rejects."
)
_REMAKE: Final = (
    "`taylor-verify claims` runs all checks and fails if an entry no longer gets its verdict; "
    '`taylor-verify claims "hydromechanics 49 (17)"` shows one in full, and `--json` the same as data. '
    f"`taylor-verify publish claims` rewrites this page, its sheet `tables/claims.csv` and "
    f"[claims.json]({CLAIMS.name}), which also names the versions, the processor and the command."
)


def page(study: ClaimsStudy) -> str:
    """Return the whole page."""
    rows = study.claims
    return whole(
        "What the two texts claim",
        _INTRODUCTION,
        _counts(rows),
        "## Errata",
        *_entries(rows, _erratum, Verdict.FALSE),
        "## True on a condition",
        *_entries(rows, _conditional, Verdict.ONLY_IF),
        "## Neither true nor false",
        *_entries(rows, _neither, Verdict.UNDECIDED, Verdict.VACUOUS),
        "## Restored",
        _restored(rows),
        "## The ledger",
        _HOW,
        *_ledger(rows),
        "## Cited, but not on the page",
        bullets(f"{code(number)}: {prose(what)}" for number, what in study.cited.items()),
        "## To remake this",
        _REMAKE,
    )


def _counts(rows: Sequence[ClaimRow]) -> str:
    counts = Counter(row.verdict.value for row in rows)
    return table([f"{verdict}:" for verdict in counts], [list(map(str, counts.values()))])


def _entries(
    rows: Iterable[ClaimRow], lines: Callable[[ClaimRow], Sequence[str]], *verdicts: Verdict
) -> Iterator[str]:
    """Yield the entries with one of the verdicts; ``lines`` returns the lines below the entry's name."""
    for row in rows:
        if row.verdict in verdicts:
            yield f"{bold(code(row.id))}\n\n{bullets(filter(None, lines(row)))}"


def _erratum(row: ClaimRow) -> list[str]:
    """Return the lines of a false entry: as transcribed, corrected, and a counterexample."""
    return [
        f"as transcribed: {_math(row.statement)}",
        f"correct: {_math(row.correction)}",
        f"counterexample: {prose(row.counterexample or '')}",
        f"residual as transcribed {short(row.residual.transcribed)}, corrected {_residual(row)}",
        prose(row.remark or ""),
    ]


def _conditional(row: ClaimRow) -> list[str]:
    """Return the lines of an entry that is true on a condition."""
    return [
        _math(row.statement),
        f"only if {prose(row.condition or '')}",
        f"correct: {_math(row.correction)}" if row.correction else "",
        f"else, for one: {prose(row.counterexample)}" if row.counterexample else "",
        prose(row.remark or ""),
    ]


def _neither(row: ClaimRow) -> list[str]:
    """Return the lines of an entry that is neither true nor false."""
    return [
        _math(row.statement),
        f"{bold(row.verdict.value)}: {prose(row.open or row.void or '')}",
        f"what is true: {_math(row.correction)}" if row.correction else "",
        f"checked: {prose(row.method)}",
    ]


def _statement(row: ClaimRow) -> list[str]:
    """Return the lines of any entry of the ledger."""
    return [
        _math(row.statement),
        f"domain: {prose(row.domain)}",
        f"checked by: {prose(row.method)}",
        f"remark: {prose(row.remark)}" if row.remark else "",
    ]


def _restored(rows: Sequence[ClaimRow]) -> str:
    """Return the table of the signs that are lost in the scan; with them the equations are true."""
    cells = [
        [code(row.id), prose(row.lost or "")] for row in rows if row.verdict is Verdict.RESTORED
    ]
    return table(["equation", "what the scan lost"], cells)


def _ledger(rows: Sequence[ClaimRow]) -> Iterator[str]:
    """Yield a table of verdicts for each text, and below it the statements with domain and check."""
    texts: dict[str, list[ClaimRow]] = {}
    for row in rows:
        author, number, *_ = row.id.split()
        text = "Heinbockel" if author == "heinbockel" else f"Hydromechanics {number}"
        texts.setdefault(text, []).append(row)
    for text, own in texts.items():
        cells = [
            [code(row.id), row.verdict.value, _residual(row), prose("; ".join(row.mutations))]
            for row in own
        ]
        yield f"### {text}"
        yield table(["claim", "verdict", "residual", "mutations rejected"], cells)
        yield from _entries(own, _statement, *Verdict)


def _math(latex: str | None) -> str:
    """Return a formula within a line as GitHub renders it, so that no sign of it is taken for Markdown."""
    return f"$`{latex}`$" if latex else ""


def _residual(row: ClaimRow) -> str:
    """Return zero for an exact check, else its bound, which is the same on every machine."""
    return "0, exactly" if row.bound == 0 else f"within {short(row.bound)}"


def short(size: float | None) -> str:
    """Return two digits of a residual."""
    return "not finite" if size is None or not isfinite(size) else f"{size:.2g}"


_SHEET: Final = (
    "id",
    "verdict",
    "statement",
    "correction",
    "condition",
    "counterexample",
    "residual",
    "residual_transcribed",
    "bound",
    "because",
    "domain",
    "method",
    "mutations",
    "lost",
    "open",
    "void",
    "remark",
)


def sheet(study: ClaimsStudy) -> str:
    """Return a row for every entry of the ledger."""
    return csv_sheet(_SHEET, (_claimed(row) for row in study.claims))


def _claimed(row: ClaimRow) -> dict[str, Any]:
    residual = complete(row.residual)
    return {
        **complete(row),
        "residual": residual["statement"],
        "residual_transcribed": residual["transcribed"],
        "mutations": "; ".join(row.mutations),
    }


# The study.


def _measure(folder: Path, progress: Progress) -> Measured:
    """Check the whole ledger, and store it only if every entry still has its verdict."""
    from taylor_verify.judge.provenance import command, processor, versions
    from taylor_verify.records.provenance import Provenance
    from taylor_verify_reports.claims.claim_row import ClaimsStudy
    from taylor_verify_reports.claims.ledger import claims, examined, missed
    from taylor_verify_reports.claims.numbers import CITED

    asked = claims()
    with progress.working(f"claims, {len(asked)} entries"):
        rows = tuple(finding.row() for finding in examined(asked))
    if faults := missed(rows):
        return Measured(messages=faults, status=1)
    made_by = Provenance(versions(), processor(), command())
    return Measured(CLAIMS.write(folder, ClaimsStudy(made_by, dict(CITED), rows)))


STUDY: Final = Study(
    name="claims",
    title="every numbered equation of the two source texts, checked; errata in front",
    duration="a minute",
    measure=_measure,
    find=CLAIMS.find,
    page=lambda study, folder: page(study),
    sheet=sheet,
    place="claims.md",
    needs_heyoka=False,
)
