"""What becomes of the extremes: the stored verdicts of one run of them, and the page made of those.

    extremes.json   every verdict, beside it what was expected; the scenes with their titles; the runs that
                    were left out; what made the rows

Every extreme is there to be hard. An answer of theirs that is no `pass` is foreseen, with the reason, or it
is a mismatch: the page tells the two apart and shows both.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from taylor_verify.publish import data, sheets
from taylor_verify.publish.cells import NOTHING, figure, judged, peak, ratio, reason, word
from taylor_verify.publish.markdown import Column, bold, bullets, code, prose, table
from taylor_verify.publish.page import MADE_BY, counts, roundoffs, traced
from taylor_verify.publish.replacement import replace_files
from taylor_verify.publish.runs import Run, gravest, is_scored, runs
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

EXTREMES: Final = f"{data.FOLDER}/extremes.json"
PAGE: Final = "tables/extremes.md"
SHEET: Final = "tables/extremes.csv"

_MADE_BY: Final = {"made_by": "taylor-verify publish --extremes; do not edit"}
_FOLDER: Final = "extremes/"

_WHAT: Final = (
    "Scenes at the edge of what can be asked: beside a separatrix and on it, moments nearly equal or "
    "far apart, sizes near the ends of the number range, many periods, and the worst that a search has "
    "found. The right answer is not always *pass*: where rounding alone may carry a motion as far as it "
    "is large, the only honest word is *vacuous*. What is right for each is written down beforehand, "
    "with the reason, and a mismatch either way is a fail."
)
_LEGEND: Final = (
    "*state* is the main quantity, the angular velocity or the impulse: *max, mean @ t of the max*, in u, "
    "or the word for why there is no number.",
    "*over attainable* is the largest of all quantities of the scene, which is named; a gate stands at "
    "ten.",
    "*verdict* is the gravest of all quantities. *as expected* counts the quantities whose verdict is "
    "the one foreseen; a mismatch stands out.",
)


@dataclass(frozen=True)
class Expected:
    """What was expected of one verdict: a word, and its reason where that is no pass."""

    verdict: str
    why: str


@dataclass(frozen=True)
class Stored:
    """One run of all extremes; ``expected`` by scene, rung and quantity."""

    verdicts: tuple[Verdict, ...]
    expected: Mapping[tuple[str, str, str], Expected]
    mismatches: tuple[str, ...]
    titles: Mapping[str, str]
    left_out: Sequence[Mapping[str, str]]
    provenance: Mapping[str, Any]

    def is_met(self, verdict: Verdict) -> bool:
        """What was not held to the file was held to nothing, and is no mismatch."""
        found = self.expected.get((verdict.scene, verdict.rung, verdict.quantity))
        return found is None or found.verdict == verdict.verdict.value


# The files.


def write(folder: Path | str, document: Mapping[str, Any]) -> list[Path]:
    """Store a run below ``folder``: rows of `document`; and make its page. Raises OSError."""
    place = Path(folder)
    stored = replace_files(place, {EXTREMES: data.laid_out({**_MADE_BY, **document})})
    return [*stored, *replace_files(place, pages(place))]


def document(
    verdicts: Sequence[Verdict],
    expected: Mapping[tuple[str, str, str], Expected],
    mismatches: Sequence[str],
    titles: Mapping[str, str],
    left_out: Sequence[Mapping[str, str]],
) -> dict[str, Any]:
    """What is stored of a run: no seconds, which are another number every time."""
    first = verdicts[0] if verdicts else None
    rows = []
    for verdict in verdicts:
        wanted = expected.get((verdict.scene, verdict.rung, verdict.quantity))
        told = {"verdict": wanted.verdict, "why": wanted.why} if wanted else None
        rows.append({**data.row(verdict), "expected": told})
    return {
        "versions": data.versions(verdicts),
        "machine": data.machine(first) if first else {},
        "scenes": [{"scene": scene, "title": title} for scene, title in titles.items()],
        "left_out": list(left_out),
        "mismatches": list(mismatches),
        "verdicts": rows,
    }


def pages(folder: Path) -> dict[str, str]:
    """The page and its sheet by their paths below ``folder``; none where nothing is stored.

    Raises OSError for a file that cannot be read and ValueError for one that holds something else.
    """
    if not (folder / EXTREMES).exists():
        return {}
    found = load(folder)
    return {PAGE: page(found), SHEET: sheet(found)}


def load(folder: Path) -> Stored:
    """What is stored below ``folder``. Raises OSError and ValueError as `pages` does."""
    file = folder / EXTREMES
    stored = data.read_document(file)
    with data.expecting("a run of the extremes", file):
        verdicts, expected = [], {}
        for row in stored["verdicts"]:
            own = dict(row)
            wanted = own.pop("expected")
            verdict = data.verdict(own, stored["versions"], {"machine": stored["machine"]})
            verdicts.append(verdict)
            if wanted is not None:
                expected[verdict.scene, verdict.rung, verdict.quantity] = Expected(**wanted)
        return Stored(
            verdicts=tuple(verdicts),
            expected=expected,
            mismatches=tuple(stored["mismatches"]),
            titles={row["scene"]: row["title"] for row in stored["scenes"]},
            left_out=stored["left_out"],
            provenance={"versions": stored["versions"], **stored["machine"]},
        )


# The page.


def page(found: Stored) -> str:
    """The counts, a line a scene, and every answer that is no pass with its reason."""
    own = runs(found.verdicts)
    blocks = [
        f"{MADE_BY}\n# The extremes",
        _WHAT,
        counts(found.verdicts),
        _held(found),
        bullets([*_LEGEND, roundoffs(found.verdicts)]),
        *(_section(found, [run for run in own if run.model == m], m) for m in _models(own)),
        "## No pass, and why",
        _not_passed(found),
        _left_out(found),
        "## To remake this",
        f"`taylor-verify publish --extremes` runs all of them on float64 and writes "
        f"[extremes.json](../{EXTREMES}), this page and its [CSV](extremes.csv), which has every quantity. "
        "`taylor-verify run extremes` prints the same and fails at a mismatch; with `--rung` it runs them "
        "on others. The expectations are in `cases/extremes/EXPECTED.toml`.",
        traced(found.provenance),
    ]
    return "\n\n".join(block for block in blocks if block) + "\n"


def _models(own: Iterable[Run]) -> list[str]:
    return list(dict.fromkeys(run.model for run in own))


def _held(found: Stored) -> str:
    """How many were foreseen, and whatever was not, in full."""
    met = sum(found.is_met(v) for v in found.verdicts if v.verdict is not Status.PASS)
    others = sum(v.verdict is not Status.PASS for v in found.verdicts)
    told = f"{met} of {others} answers other than pass came as expected."
    if not found.mismatches:
        return told
    faults = bullets(prose(one) for one in found.mismatches)
    return f"{told} {bold(f'{len(found.mismatches)} mismatches')}:\n\n{faults}"


def _section(found: Stored, own: Sequence[Run], model: str) -> str:
    columns = [
        *(Column("scene"), Column("rung"), Column("what it is")),
        *(Column("state", True), Column("over attainable", True)),
        *(Column("verdict"), Column("as expected", True)),
    ]
    rows = [_cells(found, run) for run in own]
    return f"## {model or 'Without a state'}\n\n{table(columns, rows)}"


def _cells(found: Stored, run: Run) -> list[str]:
    main = run.state[0] if run.state else run.verdicts[0]
    met = sum(found.is_met(verdict) for verdict in run.verdicts)
    told = f"{met} of {len(run.verdicts)}"
    return [
        code(run.scene.removeprefix(_FOLDER)),
        run.rung,
        prose(found.titles.get(run.scene, "")),
        _state(main),
        _worst(run),
        judged(gravest(run.verdicts)),
        told if met == len(run.verdicts) else bold(told),
    ]


def _state(verdict: Verdict) -> str:
    """The error, and the word of the verdict where it is no pass."""
    if verdict.max is None:
        return bold(prose(word(verdict)))
    text = prose(peak(verdict))
    return text if verdict.verdict is Status.PASS else f"{text} {judged(verdict.verdict)}"


def _worst(run: Run) -> str:
    """The largest among the quantities that a gate asked; none at all stands above every number."""
    asked = [v for v in run.verdicts if is_scored(v) and v.verdict in (Status.PASS, Status.FAIL)]
    if not asked:
        return NOTHING
    worst = max(asked, key=lambda v: float("inf") if v.ratio is None else v.ratio)
    return f"{ratio(worst)} ({code(worst.quantity)})"


def _not_passed(found: Stored) -> str:
    """A line for every answer that is no pass, as the solver's run has it and as it was foreseen."""
    columns = [
        *(Column("scene"), Column("quantity"), Column("verdict"), Column("expected")),
        *(Column("bound", True), Column("why")),
    ]
    rows = [_told(found, verdict) for verdict in found.verdicts if _is_told(found, verdict)]
    return table(columns, rows) if rows else "Every answer is a pass."


def _is_told(found: Stored, verdict: Verdict) -> bool:
    return verdict.verdict is not Status.PASS or not found.is_met(verdict)


def _told(found: Stored, verdict: Verdict) -> list[str]:
    wanted = found.expected.get((verdict.scene, verdict.rung, verdict.quantity))
    expected = wanted.verdict if wanted else NOTHING
    return [
        code(verdict.scene.removeprefix(_FOLDER)),
        code(verdict.quantity),
        judged(verdict.verdict),
        expected if found.is_met(verdict) else bold(expected),
        figure(verdict.bound),
        prose((wanted.why if wanted else "") or reason(verdict)),
    ]


def _left_out(found: Stored) -> str:
    told = [f"{code(row['scene'])}, {row['rung']}: {prose(row['why'])}" for row in found.left_out]
    return f"Not run:\n\n{bullets(told)}" if told else ""


def sheet(found: Stored) -> str:
    """A row for every quantity of every scene."""

    def expected(verdict: Verdict) -> dict[str, Any]:
        wanted = found.expected.get((verdict.scene, verdict.rung, verdict.quantity))
        return {
            "title": found.titles.get(verdict.scene),
            "expected": wanted.verdict if wanted else None,
            "why_expected": wanted.why if wanted else None,
            "as_expected": "yes" if found.is_met(verdict) else "no",
        }

    return sheets.gates(found.verdicts, expected)
