"""Page of one scene as Markdown: its question, its exact motion, and the answer on each rung."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from html import escape
from itertools import groupby
from typing import Final

from taylor_verify.draw.caption import WAYS
from taylor_verify.plotting.picture import Picture
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.quantities import COLUMNS, GATE_FACTOR
from taylor_verify.records.runs import Run, gravest
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import conclusion, figure, verdict_table
from taylor_verify.words.markdown import bullets, code, prose, table
from taylor_verify.words.page_parts import packages
from taylor_verify_reports.studies.reference.exact_table import columns
from taylor_verify_reports.studies.reference.reference_page import sheet_of
from taylor_verify_reports.studies.source import Document, Report

# The navigation has no lines for scenes, which are too many; the table of scenes has links to them.
_ORPHAN: Final = "---\norphan: true\n---"
_ACCURACY: Final = (
    "rung",
    "quantity",
    "max:",
    "mean:",
    "max, u:",
    "at t:",
    "attainable:",
    "bound:",
    "over attainable:",
    "steps:",
    "verdict",
)
_ALLOWED: Final = (
    f"A gate allows {GATE_FACTOR} times what perfect rounding of every step would leave on this orbit; the "
    "table above has both."
)


def scene_page(
    scene: str, report: Report, pictures: Sequence[Picture], has_motion: bool = False
) -> str:
    """Return the whole page of a scene with its ``pictures``; empty sections are left out.

    With ``has_motion`` the page on which the scene moves is shown too.
    """
    runs = report.runs_of(scene)
    portrait, records = report.portrait(scene) or {}, report.records(scene)
    record = next(iter(records.values()), {})
    verdicts = [verdict for run in runs for verdict in run.verdicts]
    toml = portrait.get("toml", "").strip()
    condition = portrait.get("explain", {}).get("condition") or {}
    digest = next((str(v.provenance.get("scene", "")) for v in verdicts), "")
    sections = {
        "": [
            f"[Scenes](../scenes.md) / {code(scene)}",
            _facts(runs, portrait, record),
            *_words(portrait),
        ],
        "Equations of motion": _equations(portrait, record),
        "The orbit in numbers": _orbit(portrait),
        "Initial data": ["The whole scene, in exact numbers:", _block("toml", toml, "scene")]
        if toml
        else [],
        "Accuracy": [verdict_table(_ACCURACY, verdicts)],
        "Pictures": [*([_turning(scene)] if has_motion else []), *_drawings(pictures)],
        "The arithmetic of the gates": [
            prose(condition.get("sentence", "")),
            _folded("Every bound with its terms", _gates(verdicts)),
        ],
        "Exact values": _values(portrait.get("values") or {}),
        "How to reproduce this": [
            _block("text", _commands(scene, report.rungs, portrait), "commands"),
            _reference(scene, report),
            f"SHA-256 of the scene: {code(portrait.get('sha256') or digest)}. {made_with(report)}",
        ],
    }
    title = portrait.get("title") or record.get("title") or scene
    blocks = [_ORPHAN, f"# {prose(title)}"]
    for heading, parts in sections.items():
        if filled := [part for part in parts if part]:
            blocks += [*([f"## {heading}"] if heading else []), *filled]
    return "\n\n".join(blocks) + "\n"


def motion_place(scene: str) -> str:
    """Return the path of the page on which a scene moves, from the folder of the report."""
    return f"motions/{of_scene(scene)}.html"


def _turning(scene: str) -> str:
    """Return the page on which a scene moves, within another page; without empty lines, as HTML needs."""
    address = f"../{motion_place(scene)}"
    return (
        f'<figure class="turning" id="motion">\n<iframe loading="lazy" title="The motion of {scene}, '
        f'which plays and can be turned" src="{address}"></iframe>\n'
        f'<figcaption>The exact motion, moving. <a href="{address}">On a page of its own</a></figcaption>\n'
        "</figure>"
    )


def made_with(report: Report) -> str:
    """Return the versions and machines behind the numbers, in a sentence."""
    machines = "; ".join(
        f"{prose(machine.get('processor', 'an unnamed processor'))}, {code(machine.get('command', ''))}"
        for machine in report.machines
    )
    parts = (packages(report.versions) or "unknown versions", machines)
    return f"Made with {'; '.join(filter(None, parts))}."


def _drawings(pictures: Sequence[Picture]) -> Iterator[str]:
    """Yield the static pictures of a scene; a sentence on gates follows the errors."""
    for picture in pictures:
        yield f"![{prose(picture.alt)}](../scenes/{picture.stem}.svg)"
        if picture.stem.endswith("-errors"):
            yield _ALLOWED


def _reference(scene: str, report: Report) -> str:
    """Return links to the exact trajectory as CSV and as JSON, if they exist."""
    names = [sheet_of(scene), f"{of_scene(scene)}.json"]
    links = [f"[{n}](../reference/{n})" for n in names if report.has(f"reference/{n}")]
    if not links:
        return ""
    return (
        f"Exact trajectory with 32 digits and proven radii: {', '.join(links)}. "
        "[What the columns mean](../reference/README.md)."
    )


def _facts(runs: Sequence[Run], portrait: Document, record: Document) -> str:
    """Return the list of short facts at the head of the page."""
    periods = [row["value"] for row in portrait.get("analytic", ()) if row["name"] == "period"]
    facts = {
        "verdict": gravest(verdict for run in runs for verdict in run.verdicts).value,
        "model": portrait.get("model") or (runs[0].model.lower() if runs else ""),
        "regime": portrait.get("regime") or record.get("regime", ""),
        "period": f"{float(periods[0]):.6g}" if periods else "",
        "compared": ", ".join(dict.fromkeys(v.quantity for run in runs for v in run.state)),
        "truth": WAYS.get((portrait.get("values") or record).get("route", ""), ""),
        "source": portrait.get("source") or "",
    }
    return "\n".join(f":{name}: {prose(value)}" for name, value in facts.items() if value)


def _words(portrait: Document) -> Iterator[str]:
    """Yield the reason for the scene, and its warnings."""
    # Empty lines separate the comment into paragraphs.
    for is_filled, lines in groupby((line.strip() for line in portrait.get("why", ())), key=bool):
        if is_filled:
            text = " ".join(lines).removeprefix("Why: ")
            yield prose(f"{text[0].upper()}{text[1:]}")
    for warning in portrait.get("warnings", ()):
        yield f"```{{warning}}\n{prose(warning)}\n```"


def _equations(portrait: Document, record: Document) -> list[str]:
    """Return the equations of motion, and behind a line that opens them the ones that are integrated."""
    explained = portrait.get("explain", {})
    formulas = [f"$$\n{tex}\n$$" for tex in portrait.get("tex", ())]
    built = "\n".join(explained.get("equations") or record.get("equations", ()))
    because = "; ".join((explained.get("cost") or {}).get("because", ())) or "in this form"
    fold = _folded(f"As they are integrated: {because}", _block("text", built)) if built else ""
    return [*formulas, fold] if formulas else []


def _orbit(portrait: Document) -> list[str]:
    """Return sentences and a table on the elements of the orbit; an empty list without any."""
    rows = portrait.get("analytic")
    if not rows:
        return []
    cells = [
        [code(str(row["name"])), code(str(row["value"])), prose(str(row["meaning"] or ""))]
        for row in rows
    ]
    sentences = portrait.get("explain", {}).get("sentences", ())
    return [*map(prose, sentences), table(["quantity", "value", "meaning"], cells)]


def _gates(verdicts: Sequence[Verdict]) -> str:
    """Return a table with the arithmetic of each bound, and a list of what its terms mean."""
    names = list(dict.fromkeys(verdict.quantity for verdict in verdicts))
    rows: list[list[str]] = []
    meanings: dict[str, dict[str, None]] = {}
    for verdict in sorted(verdicts, key=lambda verdict: names.index(verdict.quantity)):
        arithmetic, meaning = _bound(verdict)
        rows.append([code(verdict.quantity), verdict.rung, prose(arithmetic)])
        if meaning:
            meanings.setdefault(meaning, {})[code(verdict.quantity)] = None
    notes = [
        f"{', '.join(quantities)}: {prose(meaning)}." for meaning, quantities in meanings.items()
    ]
    return "\n\n".join([table(["quantity", "rung", "bound"], rows), bullets(notes)])


def _bound(verdict: Verdict) -> tuple[str, str]:
    """Return the arithmetic of a bound, and the meaning of its terms, which may be empty."""
    floor = verdict.reason.floor
    arithmetic, meaning = floor.parts() if floor else ("", "")
    parts = (conclusion(verdict), verdict.reason.rule, arithmetic)
    return "; ".join(filter(None, parts)), meaning


def _block(language: str, text: str, name: str = "") -> str:
    """Return a block of text for copying; ``name`` is its anchor on the page."""
    option = f":name: {name}\n" if name else ""
    # The fence must be longer than any in the text, which would end the block.
    fence = "`" * max(3, 1 + max(map(len, re.findall("`+", text)), default=0))
    return f"{fence}{{code-block}} {language}\n{option}\n{text}\n{fence}"


def _folded(summary: str, contents: str) -> str:
    """Return Markdown that is hidden behind the line ``summary`` until a reader opens it."""
    return f"<details>\n<summary>{escape(summary)}</summary>\n\n{contents}\n\n</details>"


def _values(document: Document) -> list[str]:
    """Return the exact motion at ten instants as a trajectory file, every number with all its digits."""
    rows = document.get("rows")
    if not rows:
        return []
    radii = [float(row["radius"]) for row in rows if row.get("radius")]
    error = f"; no row is off by more than {figure(max(radii))} of itself" if radii else ""
    what = (
        f"{document['digits']} digits, {WAYS[document['route']]}{error}. The columns are those that "
        "`taylor-verify check` reads."
    )
    return [what, _block("text", _trajectory(rows), "exact")]


def _trajectory(rows: Sequence[Document]) -> str:
    """Return exact states as a trajectory file, with aligned columns."""
    listed = [[name, *cells] for name, cells in columns(rows, COLUMNS).items()]
    padded = [[cell.rjust(max(map(len, column))) for cell in column] for column in listed]
    return "\n".join(map(", ".join, zip(*padded, strict=True)))


def _commands(scene: str, rungs: Sequence[str], portrait: Document) -> str:
    """Return the commands that reproduce the numbers of the page, a line each."""
    values = portrait.get("values") or {}
    times = ",".join(str(row["t"]) for row in values.get("rows", ()))
    at = f"--at={times}" if times.startswith("-") else f"--at {times}"
    digits = f" --digits {values['digits']}" if values else ""
    route = " --route taylor" if values.get("route") == "taylor" else ""
    lines = [
        f"taylor-verify run {scene} --rung {' '.join(rungs)}",
        f"taylor-verify explain {scene}",
        *([f"taylor-verify exact {scene} {at}{digits}{route}"] if times else []),
        f"taylor-verify check my_run.csv --scene {scene}",
    ]
    return "\n".join(lines)
