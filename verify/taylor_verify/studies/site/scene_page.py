"""The page of one scene: what it asks, what is exact about it, and how each rung answered."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any, Final

from markupsafe import Markup

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
from taylor_verify.publish.mathml import mathml
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.records.runs import Run, gravest
from taylor_verify.records.verdict import Verdict
from taylor_verify.studies.site import errors, motion
from taylor_verify.studies.site.figure import Figure
from taylor_verify.studies.site.links import Links
from taylor_verify.studies.site.looks import Palette
from taylor_verify.studies.site.prose import Prose
from taylor_verify.studies.site.source import Document, Report
from taylor_verify.studies.tradeoff.stored import TimedPoint, Trade

# The rung whose errors colour the curves in space.
_SHOWN: Final = "f64"
# What the published drawing of each picture is called.
_DRAWN: Final = {
    "error": "errors",
    "polhode": "polhode",
    "axis": "axis",
    "path": "centre",
    "potential": "potential",
}


@dataclass(frozen=True)
class ScenePage:
    """What the template ``scene.html`` is filled with, and where the page stands."""

    report: Report
    prose: Prose
    links: Links
    palette: Palette

    def context(self, scene: str) -> dict[str, Any]:
        page = self.links.scenes[scene]
        runs = self.report.runs_of(scene)
        portrait = self.report.portrait(scene) or {}
        records = self.report.records(scene)
        record = next(iter(records.values()), {})
        explained = portrait.get("explain", {})

        def html(markdown: str) -> Markup:
            return self.prose.html(markdown, page, page)

        found = {
            "scene": scene,
            "title": portrait.get("title") or record.get("title") or scene,
            "chips": list(_chips(runs, portrait, record)),
            "why": _paragraphs(portrait.get("why", ())),
            "warnings": portrait.get("warnings", ()),
            "formulas": [mathml(tex, display=True) for tex in portrait.get("tex", ())],
            "built": "\n".join(explained.get("equations") or record.get("equations", ())),
            "built_by": "; ".join((explained.get("cost") or {}).get("because", ()))
            or "in this form",
            "sentences": explained.get("sentences", ()),
            "orbit": html(_analytic(portrait["analytic"])) if portrait.get("analytic") else "",
            "toml": portrait.get("toml", "").strip(),
            "accuracy": html(_accuracy(runs)),
            "solvers": html(_solvers(trade)) if (trade := self.report.trade(scene)) else "",
            "pictures": self._pictures(scene, portrait, records),
            "condition": (explained.get("condition") or {}).get("sentence", ""),
            "gates": html(_gates(runs)),
            "values": _values(portrait["values"]) if portrait.get("values") else "",
            "values_are": _values_are(portrait.get("values") or {}),
            "reproduce": _commands(scene, self.report.rungs, portrait),
            "reference": self._reference(scene, page),
            "sha256": portrait.get("sha256") or _digest(runs),
        }
        return {**found, "parts": _parts(found)}

    def _pictures(
        self, scene: str, portrait: Document, records: Mapping[str, Document]
    ) -> list[Figure]:
        shown = records.get(_SHOWN)
        found = [errors.against_time(records, self.palette)]
        if portrait.get("course"):
            found += [
                motion.polhode(portrait, shown),
                motion.axis_in_space(portrait, shown),
                motion.path(portrait, shown),
                motion.potential(portrait),
            ]
        return [
            replace(one, fallback=self.links.drawing(f"{of_scene(scene)}-{_DRAWN[one.name]}"))
            for one in found
            if one is not None
        ]

    def _reference(self, scene: str, page: str) -> list[dict[str, str]]:
        """The archive of the exact trajectory, as CSV and JSON."""
        files = (f"reference/{of_scene(scene)}{ending}" for ending in (".csv", ".json"))
        found = dict.fromkeys(link for file in files if (link := self.links.file(file, page)))
        return [{"name": link.rpartition("/")[2], "link": link} for link in found]


def _chips(runs: Sequence[Run], portrait: Document, record: Document) -> Iterable[dict[str, str]]:
    verdicts = [verdict for run in runs for verdict in run.verdicts]
    found = {
        "verdict": gravest(verdicts).value,
        "model": portrait.get("model") or (runs[0].model.lower() if runs else ""),
        "regime": portrait.get("regime") or record.get("regime", ""),
        "period": next(
            (figure_of(one) for one in portrait.get("analytic", ()) if _is_period(one)), ""
        ),
        "compared": ", ".join(dict.fromkeys(v.quantity for run in runs for v in run.state)),
        "truth": portrait.get("route") or record.get("route", ""),
        "source": portrait.get("source") or "",
    }
    return ({"name": name, "value": value} for name, value in found.items() if value)


def _is_period(one: Document) -> bool:
    return bool(one["name"] == "period")


def figure_of(one: Document) -> str:
    """An analytic quantity to the digits that a line has room for."""
    text = str(one["value"])
    try:
        return f"{float(text):.6g}"
    except ValueError:
        return text


def _paragraphs(lines: Iterable[str]) -> list[str]:
    """Comment lines run together; an empty one parts two paragraphs."""
    groups = groupby((line.strip() for line in lines), key=bool)
    told = (" ".join(group).removeprefix("Why: ") for filled, group in groups if filled)
    return [f"{text[0].upper()}{text[1:]}" for text in told]


def _analytic(rows: Iterable[Document]) -> str:
    columns = [Column("quantity"), Column("value"), Column("meaning")]
    return table(
        columns,
        (
            [code(str(r["name"])), code(str(r["value"])), prose(str(r["meaning"] or ""))]
            for r in rows
        ),
    )


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


def _solvers(trade: Trade) -> str:
    """Return the most accurate sound setting of each family, with its time over that of the yardstick."""
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
    return f"{what}\n\n{table(columns, lines)}"


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


def _values(document: Document) -> str:
    """Ten instants as the columns of a trajectory file, each number with all of its digits."""
    rows = document["rows"]
    if not rows:
        return ""
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


def _values_are(document: Document) -> str:
    if not document.get("rows"):
        return ""
    radii = [float(row["radius"]) for row in document["rows"] if row.get("radius")]
    route = {"arb": "ball arithmetic", "mpmath": "the second closed form"}.get(
        document.get("route", ""), "Taylor series in ball arithmetic"
    )
    error = f"; no row is off by more than {figure(max(radii))} of itself" if radii else ""
    return (
        f"{document['digits']} digits by {route}{error}. The columns are those that "
        "taylor-verify check reads."
    )


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


def _parts(found: Mapping[str, Any]) -> list[dict[str, str]]:
    """The sections that the page has, in their order."""
    names = {
        "equations": ("Equations", found["formulas"]),
        "orbit": ("Orbit", found["orbit"]),
        "data": ("Data", found["toml"]),
        "accuracy": ("Accuracy", True),
        "pictures": ("Pictures", True),
        "gates": ("Gates", True),
        "values": ("Exact values", found["values"]),
        "reproduce": ("Reproduce", True),
    }
    return [{"anchor": key, "name": name} for key, (name, there) in names.items() if there]
