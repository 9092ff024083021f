"""The page of one scene as Markdown: its question, its exact motion, and each rung's answer."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import groupby
from typing import Any, Final

from taylor_verify.publish.cells import (
    conclusion,
    figure,
    in_roundoffs,
    instant,
    judged,
    ratio,
    word,
)
from taylor_verify.publish.markdown import Column, bullets, code, prose, table
from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.quantities import COLUMNS, GATE_FACTOR
from taylor_verify.records.runs import Run, gravest
from taylor_verify.records.verdict import Verdict
from taylor_verify.studies import figures
from taylor_verify.studies.site.motion import motions_of
from taylor_verify.studies.site.source import Document, Report
from taylor_verify.studies.tradeoff.stored import TimedPoint, Trade

# The rung whose errors colour the curves in space.
_SHOWN: Final = "f64"
# The table of scenes leads here: hundreds of lines would be no navigation.
_ORPHAN: Final = "---\norphan: true\n---"


@dataclass(frozen=True)
class ScenePage:
    """What is stored of one scene, and the pictures of it that stand still."""

    scene: str
    report: Report
    pictures: Sequence[Picture]

    def markdown(self) -> str:
        """The whole page; a section without contents is left out."""
        runs = self.report.runs_of(self.scene)
        portrait = self.report.portrait(self.scene) or {}
        records = self.report.records(self.scene)
        record = next(iter(records.values()), {})
        explained = portrait.get("explain", {})
        title = portrait.get("title") or record.get("title") or self.scene
        sections = {
            "": [
                f"[Scenes](../scenes.md) / {code(self.scene)}",
                _facts(runs, portrait, record),
                *_words(portrait),
            ],
            "Equations of motion": _equations(portrait, record),
            "The orbit in numbers": _orbit(portrait),
            "Initial data": _data(portrait),
            "Accuracy": [_accuracy(runs)],
            "Other solvers": _solvers(self.report.trade(self.scene)),
            "Pictures": [*self._drawings(), *self._motions(portrait, records)],
            "The arithmetic of the gates": [
                prose((explained.get("condition") or {}).get("sentence", "")),
                _folded("Every bound with its terms", _gates(runs)),
            ],
            "Exact values": _values(portrait.get("values") or {}),
            "How to reproduce this": [
                _block("text", _commands(self.scene, self.report.rungs, portrait), "commands"),
                self._reference(),
                f"SHA-256 of the scene: {code(portrait.get('sha256') or _digest(runs))}. "
                f"{made_with(self.report)}",
            ],
        }
        blocks = [_ORPHAN, f"# {prose(title)}"]
        for heading, parts in sections.items():
            filled = [part for part in parts if part]
            blocks += [f"## {heading}"] if heading and filled else []
            blocks += filled
        return "\n\n".join(blocks) + "\n"

    def _drawings(self) -> Iterator[str]:
        for picture in self.pictures:
            yield shown(self.report, picture, "..")
            if picture.stem.endswith("-errors"):
                yield (
                    f"A gate allows {GATE_FACTOR} times what perfect rounding of every step would leave "
                    "on this orbit; the table above has both."
                )

    def _motions(self, portrait: Document, records: Mapping[str, Document]) -> list[str]:
        found = [one.html() for one in motions_of(portrait, records.get(_SHOWN))]
        return ['<div class="motions">', *found, "</div>"] if found else []

    def _reference(self) -> str:
        """Links to the exact trajectory, as CSV and as JSON."""
        names = (f"{of_scene(self.scene)}{ending}" for ending in (".csv", ".json"))
        links = [
            f"[{name}](../reference/{name})"
            for name in names
            if self.report.has(f"reference/{name}")
        ]
        if not links:
            return ""
        return (
            f"Exact trajectory with 32 digits and proven radii: {', '.join(links)}. "
            "[What the columns mean](../reference/README.md)."
        )


def drawing_of(picture: Picture) -> str:
    """The place in the report where a picture may have been published already."""
    return f"{figures.FOLDER}/{picture.stem}.svg"


def shown(report: Report, picture: Picture, top: str) -> str:
    """A picture with what it shows in words; ``top`` is the way to the report's folder."""
    drawing = drawing_of(picture)
    place = drawing if report.has(drawing) else f"scenes/{picture.stem}.svg"
    return f"![{prose(picture.alt)}]({top}/{place})"


def made_with(report: Report) -> str:
    """The versions and machines that the numbers were made with, in a sentence."""
    packages = ", ".join(f"{name} {version}" for name, version in report.versions.items())
    machines = "; ".join(
        f"{prose(machine.get('processor', 'an unnamed processor'))}, {code(machine.get('command', ''))}"
        for machine in report.machines
    )
    return f"Made with {'; '.join(filter(None, (packages or 'unknown versions', machines)))}."


def _facts(runs: Sequence[Run], portrait: Document, record: Document) -> str:
    verdicts = [verdict for run in runs for verdict in run.verdicts]
    facts = {
        "verdict": gravest(verdicts).value,
        "model": portrait.get("model") or (runs[0].model.lower() if runs else ""),
        "regime": portrait.get("regime") or record.get("regime", ""),
        "period": next(map(_rounded, filter(_is_period, portrait.get("analytic", ()))), ""),
        "compared": ", ".join(dict.fromkeys(v.quantity for run in runs for v in run.state)),
        "truth": portrait.get("route") or record.get("route", ""),
        "source": portrait.get("source") or "",
    }
    return "\n".join(f":{name}: {prose(value)}" for name, value in facts.items() if value)


def _is_period(quantity: Document) -> bool:
    return bool(quantity["name"] == "period")


def _rounded(quantity: Document) -> str:
    """An analytic quantity to the digits that a line has room for."""
    text = str(quantity["value"])
    try:
        return f"{float(text):.6g}"
    except ValueError:
        return text


def _words(portrait: Document) -> Iterator[str]:
    """Why there is this scene, and what it warns of."""
    # Comment lines run together; an empty one parts two paragraphs.
    groups = groupby((line.strip() for line in portrait.get("why", ())), key=bool)
    for filled, lines in groups:
        text = " ".join(lines).removeprefix("Why: ")
        if filled:
            yield prose(f"{text[0].upper()}{text[1:]}")
    for warning in portrait.get("warnings", ()):
        yield f"```{{warning}}\n{prose(warning)}\n```"


def _equations(portrait: Document, record: Document) -> list[str]:
    explained = portrait.get("explain", {})
    formulas = [f"$$\n{tex}\n$$" for tex in portrait.get("tex", ())]
    built = "\n".join(explained.get("equations") or record.get("equations", ()))
    because = "; ".join((explained.get("cost") or {}).get("because", ())) or "in this form"
    fold = _folded(f"As they are integrated: {because}", _block("text", built)) if built else ""
    return [*formulas, fold] if formulas else []


def _orbit(portrait: Document) -> list[str]:
    rows = portrait.get("analytic")
    if not rows:
        return []
    columns = [Column("quantity"), Column("value"), Column("meaning")]
    cells = [
        [code(str(row["name"])), code(str(row["value"])), prose(str(row["meaning"] or ""))]
        for row in rows
    ]
    return [*map(prose, portrait.get("explain", {}).get("sentences", ())), table(columns, cells)]


def _data(portrait: Document) -> list[str]:
    text = portrait.get("toml", "").strip()
    return ["The whole scene, in exact numbers:", _block("toml", text, "scene")] if text else []


def _block(language: str, text: str, name: str = "") -> str:
    """Text to be copied; ``name`` is its anchor on the page."""
    option = f":name: {name}\n" if name else ""
    # Longer than any in the text, which could end the block.
    fence = "`" * max(3, 1 + max(map(len, re.findall("`+", text)), default=0))
    return f"{fence}{{code-block}} {language}\n{option}\n{text}\n{fence}"


def _folded(summary: str, contents: str) -> str:
    """Markdown behind a line that opens it."""
    return f"<details>\n<summary>{escape(summary)}</summary>\n\n{contents}\n\n</details>"


# Tables.


def _accuracy(runs: Iterable[Run]) -> str:
    """A line for every quantity of every rung."""
    headings = ("max", "mean", "max, u", "at t", "attainable", "bound", "over attainable", "steps")
    columns = [
        *(Column("rung"), Column("quantity")),
        *(Column(heading, to_right=True) for heading in headings),
        Column("verdict"),
    ]
    rows = [_accuracy_row(run, verdict) for run in runs for verdict in run.verdicts]
    return table(columns, rows)


def _accuracy_row(run: Run, verdict: Verdict) -> list[str]:
    size = in_roundoffs(verdict, verdict.max)
    return [
        run.rung,
        code(verdict.quantity),
        word(verdict) if verdict.max is None else figure(verdict.max),
        figure(verdict.mean),
        figure(size),
        instant(verdict.at),
        figure(verdict.attainable),
        figure(verdict.bound),
        ratio(verdict),
        str(verdict.steps),
        judged(verdict.verdict),
    ]


def _solvers(trade: Trade | None) -> list[str]:
    """Return the most accurate sound setting of each family, with its time over that of the yardstick."""
    if trade is None:
        return []
    best: dict[tuple[str, str], TimedPoint] = {}
    for row in trade.sound:
        key = (row.point.family, row.point.rung)
        if key not in best or row.error < best[key].error:
            best[key] = row
    columns = [
        *(Column("solver"), Column("rung")),
        *(Column(name, to_right=True) for name in ("error", "digits", "steps", "time")),
    ]
    rows = sorted(best.values(), key=lambda row: row.error)
    lines = [
        [
            *(code(row.point.solver), row.point.rung, figure(row.error), f"{digits:.1f}"),
            *(str(row.point.steps), figure(row.timing.ratio)),
        ]
        for row in rows
        if (digits := row.point.achieved_digits) is not None
    ]
    what = (
        "The most accurate setting of every family of solvers that was sound on this scene; *time* is "
        "that of a solve over that of taylor on f64."
    )
    return [what, table(columns, lines)]


def _gates(runs: Sequence[Run]) -> str:
    """Each rung's arithmetic by quantity, and once the words behind it."""
    names = dict.fromkeys(v.quantity for run in runs for v in run.verdicts)
    found = [
        (run.rung, v) for name in names for run in runs for v in run.verdicts if v.quantity == name
    ]
    parts = [(rung, v.quantity, *_bound(v)) for rung, v in found]
    rows = [[code(quantity), rung, prose(sum_)] for rung, quantity, sum_, _ in parts]
    said: dict[str, dict[str, None]] = {}
    for _, quantity, _, words in parts:
        if words:
            said.setdefault(words, {})[code(quantity)] = None
    notes = [f"{', '.join(names)}: {prose(words)}." for words, names in said.items()]
    arithmetic = table([Column("quantity"), Column("rung"), Column("bound")], rows)
    return "\n\n".join([arithmetic, bullets(notes)])


def _bound(verdict: Verdict) -> tuple[str, str]:
    """Return the arithmetic of the bound, and the meaning of its terms; empty where there is none."""
    floor = verdict.reason.floor
    arithmetic, meaning = floor.parts() if floor else ("", "")
    parts = (conclusion(verdict), verdict.reason.rule, arithmetic)
    return "; ".join(filter(None, parts)), meaning


# Text to copy.


def _values(document: Document) -> list[str]:
    """Ten instants as the columns of a trajectory file, each number with all of its digits."""
    rows = document.get("rows")
    if not rows:
        return []
    radii = [float(row["radius"]) for row in rows if row.get("radius")]
    route = {"arb": "ball arithmetic", "mpmath": "the second closed form"}.get(
        document.get("route", ""), "Taylor series in ball arithmetic"
    )
    error = f"; no row is off by more than {figure(max(radii))} of itself" if radii else ""
    what = (
        f"{document['digits']} digits by {route}{error}. The columns are those that "
        "`taylor-verify check` reads."
    )
    return [what, _block("text", trajectory_text(rows), "exact")]


def trajectory_text(rows: Sequence[Document]) -> str:
    """Exact states as a trajectory file, its columns one below the other."""
    keys = [key for key in COLUMNS if key in rows[0]]
    heading = ["t", *(name for key in keys for name in COLUMNS[key])]
    lines = [heading, *([str(r["t"]), *(n for key in keys for n in _flat(r[key]))] for r in rows)]
    widths = [max(len(line[i]) for line in lines) for i in range(len(heading))]
    return "\n".join(
        ", ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True))
        for line in lines
    )


def _flat(value: Sequence[Any]) -> list[str]:
    return [n for row in value for n in (row if isinstance(row, list) else [row])]


def _commands(scene: str, rungs: Sequence[str], portrait: Document) -> str:
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


def _digest(runs: Sequence[Run]) -> str:
    return next((str(v.provenance.get("scene", "")) for run in runs for v in run.verdicts), "")
