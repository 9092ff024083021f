"""The pages of the site, one after another: where each stands, its template, and what fills it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from markupsafe import Markup

from taylor_verify.publish.cells import NOTHING, error, figure, instant, judged, ratio, word
from taylor_verify.publish.markdown import Column, code, prose, table
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.quantities import STATES
from taylor_verify.records.runs import Run, gravest
from taylor_verify.records.verdict import summary
from taylor_verify.studies.reach import picture as digits_map
from taylor_verify.studies.site import errors, work
from taylor_verify.studies.site.figure import Figure
from taylor_verify.studies.site.links import Links, title_of
from taylor_verify.studies.site.looks import Palette
from taylor_verify.studies.site.prose import Prose, sections, without_title
from taylor_verify.studies.site.scene_page import ScenePage
from taylor_verify.studies.site.source import Report

NAVIGATION: Final = (
    {"page": "scenes.html", "name": "Scenes"},
    {"page": "solvers.html", "name": "Solvers"},
    {"page": "extremes.html", "name": "Extremes"},
    {"page": "controls.html", "name": "Controls"},
    {"page": "errata.html", "name": "Errata"},
    {"page": "method.html", "name": "Method"},
    {"page": "tables/index.html", "name": "Tables"},
)
_CARDS: Final = (
    ("scenes.html", "Scenes", "every motion: equations, exact values, errors, pictures"),
    ("solvers.html", "Solvers", "work against precision, every solver, measured"),
    ("extremes.html", "Extremes", "how far each precision carries, and where it ends"),
    ("controls.html", "Controls", "solvers broken on purpose, and which gate sees them"),
    ("errata.html", "Errata", "what two classic texts got wrong, with counterexamples"),
    ("method.html", "Method", "how the truth was checked, and what is not tested"),
)
_COMMANDS: Final = """\
taylor-verify run euler/generic --rung f32 f64 f80 f128 mp237
taylor-verify exact euler/generic --at 0,10,1e9 --digits 40
taylor-verify check my_run.csv --scene euler/with-attitude
taylor-verify run euler/generic --solver "process:./my_simulator\""""
# The gates have a page that is made of the verdicts: their reasons stand with each scene.
_NOT_PROSE: Final = ("README.md", "tables/gates.md")
_TRUTH: Final = ("Errata", "True on a condition", "Neither true nor false")


@dataclass(frozen=True)
class Page:
    """One page: ``section`` is the entry of the navigation that it belongs to."""

    place: str
    template: str
    context: dict[str, Any]
    section: str = ""


def pages(report: Report, prose: Prose, links: Links, palette: Palette) -> Iterator[Page]:
    """Every page of the site."""
    make = _Pages(report, prose, links, palette)
    yield make.front()
    yield make.scenes()
    scene = ScenePage(report, prose, links, palette)
    for name, place in links.scenes.items():
        yield Page(place, "scene.html", scene.context(name), "scenes.html")
    yield make.solvers()
    yield make.extremes()
    yield make.controls()
    yield make.errata()
    yield make.method()
    yield make.gates()
    yield from make.prose_pages()


@dataclass(frozen=True)
class _Pages:
    report: Report
    prose: Prose
    links: Links
    palette: Palette

    def front(self) -> Page:
        runs = self.report.runs
        blocks = sections(self._read("README.md")).get("In short", "").split("\n\n")
        by_rung = next((block for block in blocks if block.startswith("| rung")), "")
        told = next((block for block in blocks if block.startswith("Largest error")), "")
        factor = next((sight.factor for sight in self.report.sights), 10.0)
        context = {
            "title": "How accurate it is",
            "counts": _counts(runs),
            "by_rung": self._html(by_rung, "README.md", "index.html"),
            "in_short": self._html(told, "README.md", "index.html"),
            "cloud": errors.over_attainable(runs, self.report.sights, factor, self.palette),
            "blind": self._blind(),
            "cards": [{"page": page, "name": name, "what": what} for page, name, what in _CARDS],
            "commands": _COMMANDS,
        }
        return Page("index.html", "index.html", context)

    def scenes(self) -> Page:
        rows = [self._scene_row(scene) for scene in self.report.scenes]
        columns = [
            *(Column("scene"), Column("what it is"), Column("regime")),
            *(Column(rung, to_right=True) for rung in self.report.rungs),
            *(Column("over attainable", to_right=True), Column("verdict")),
        ]
        text = table(columns, rows)
        context = {"title": "Scenes", "table": self._html(text, "scenes.md", "scenes.html")}
        return Page("scenes.html", "scenes.html", context, "scenes.html")

    def _scene_row(self, scene: str) -> list[str]:
        runs = {run.rung: run for run in self.report.runs_of(scene) if run.solver == "taylor"}
        portrait = self.report.portrait(scene)
        found = portrait or next(iter(self.report.records(scene).values()), {})
        state = [v for run in runs.values() for v in run.state if v.is_compared]
        worst = max(state, key=lambda v: float("inf") if v.ratio is None else v.ratio, default=None)
        return [
            code(scene),
            prose(str(found.get("title", ""))),
            prose(str(found.get("regime", ""))),
            *(_main_error(runs.get(rung)) for rung in self.report.rungs),
            ratio(worst) if worst else NOTHING,
            judged(gravest(v for run in runs.values() for v in run.verdicts)),
        ]

    def solvers(self) -> Page:
        page = "solvers.html"
        found = self.report.trades
        trades = found.trades if found else ()
        pictures = [
            work.precision(t, self.palette, self.links.drawing(f"{of_scene(t.scene)}-time"))
            for t in trades
        ]
        body = self._html(self._template("solvers.md"), "solvers.md", page)
        after = self._section("tables/tradeoff.md", "What so many digits cost", page)
        return Page(page, "prose.html", _prose("Solvers", body, pictures, after), page)

    def extremes(self) -> Page:
        page = "extremes.html"
        pictures: list[Figure] = []
        reach, growth = self.report.reach, self.report.growth
        for one in reach.families if reach else ():
            rows = [row for row in reach.rows if row.family == one.name] if reach else []
            drawn = self.links.drawing(digits_map.stem_of(one))
            found = work.digits_map(one, rows, drawn) if len(one.values) > 1 else None
            pictures += [found] if found else []
        if growth:
            drawn = self.links.drawing("ensembles-of-starts-growth")
            found = work.growth(growth.runs, self.palette, drawn)
            pictures += [found] if found else []
        body = self._html(self._template("extremes.md"), "extremes.md", page)
        worst = self._read("tables/worst.md")
        after = self._html(_lowered(worst), "tables/worst.md", page) if worst else Markup()
        return Page(page, "prose.html", _prose("Extremes", body, pictures, after), page)

    def controls(self) -> Page:
        page, source = "controls.html", "tables/controls.md"
        text = self._read(source)
        shown = errors.shifts(self.report.sights, self.links.drawing("controls-shifts"))
        first, *others = sections(without_title(text)).items() if text else [("", "")]
        lead = self._html("".join([first[1], *(part for _, part in others[:1])]), source, page)
        rest = self._html("".join(part for _, part in others[1:]), source, page)
        context = _prose(title_of(text) if text else "Controls", lead, _there(shown), rest)
        return Page(page, "prose.html", context, page)

    def errata(self) -> Page:
        page, source = "errata.html", "claims.md"
        text = self._read(source)
        found = sections(without_title(text))
        parts = [found.get("", ""), *(found.get(name, "") for name in _TRUTH)]
        body = self._html("".join(parts), source, page)
        after = self._html(self._template("errata.md"), "errata.md", page)
        return Page(page, "prose.html", _prose(title_of(text), body, (), after), page)

    def method(self) -> Page:
        body = self._html(self._template("method.md"), "method.md", "method.html")
        return Page("method.html", "prose.html", _prose("Method", body), "method.html")

    def gates(self) -> Page:
        """Every verdict in one table, to be searched."""
        page = "tables/gates.html"
        numbers = ("max", "at t", "bound", "over attainable")
        columns = [
            *(Column("scene"), Column("rung"), Column("quantity")),
            *(Column(name, to_right=True) for name in numbers),
            Column("verdict"),
        ]
        rows = [
            [
                *(code(run.scene), run.rung, code(verdict.quantity)),
                word(verdict) if verdict.max is None else figure(verdict.max),
                *(instant(verdict.at), figure(verdict.bound), ratio(verdict)),
                judged(verdict.verdict),
            ]
            for run in self.report.runs
            for verdict in run.verdicts
        ]
        what = "Every quantity that was compared, and the bound it was held against. The reason of "
        text = f"{what}each bound stands on the page of its scene.\n\n{table(columns, rows)}"
        body = self._html(text, "tables/gates.md", page)
        return Page(page, "prose.html", _prose("Gates", body), "tables/index.html")

    def prose_pages(self) -> Iterator[Page]:
        """The published Markdown, as it is."""
        for source, place in self.links.pages.items():
            if source not in _NOT_PROSE:
                text = self._read(source)
                body = self._html(without_title(text), source, place)
                context = _prose(title_of(text), body)
                yield Page(place, "prose.html", context, "tables/index.html")

    # What they share.

    def _html(self, markdown: str, source: str, page: str) -> Markup:
        return self.prose.html(markdown, source, page)

    def _section(self, source: str, heading: str, page: str) -> Markup:
        """One section of a published file; nothing where it is not there."""
        return self._html(sections(self._read(source)).get(heading, ""), source, page)

    def _read(self, source: str) -> str:
        file = self.report.folder / source
        return file.read_text(encoding="utf-8") if file.exists() else ""

    def _template(self, name: str) -> str:
        return (Path(__file__).parent / "templates" / name).read_text(encoding="utf-8")

    def _blind(self) -> str:
        """How many broken solvers the conserved quantities do not see."""
        finished = [s for s in self.report.sights if s.is_finished and s.seen_by]
        unseen = [s for s in finished if not any(s.is_seen_by(name) for name in s.conserved)]
        energy = [s for s in finished if s.is_missed_by("T")]
        if not finished:
            return "Only a comparison with the exact motion does."
        return (
            f"Of {len(finished)} solvers that were broken on purpose and ran to their end, "
            f"{len(energy)} pass the gate of the energy and {len(unseen)} pass that of every "
            "conserved quantity their scene has. The comparison with the exact motion sees them all."
        )


def _prose(
    title: str, body: Markup, figures: Sequence[Figure] = (), after: str = ""
) -> dict[str, Any]:
    return {"title": title, "body": body, "figures": list(figures), "after": after}


def _there(shown: Figure | None) -> list[Figure]:
    return [] if shown is None else [shown]


def _lowered(text: str) -> str:
    """A file as a section of a page: its title is a second heading there, and so on."""
    return text.replace("\n## ", "\n### ").replace("\n# ", "\n## ")


def _counts(runs: Sequence[Run]) -> list[dict[str, Any]]:
    """What the front page says in large figures; verdicts other than pass only where there are some."""
    verdicts = [verdict for run in runs for verdict in run.verdicts]
    found = {
        "scenes": len({run.scene for run in runs}),
        "runs": len(runs),
        "verdicts": len(verdicts),
        **{name: n for name, n in summary(verdicts).items() if n or name in ("pass", "fail")},
    }
    return [{"name": name, "number": number} for name, number in found.items()]


def _main_error(run: Run | None) -> str:
    """The largest error of omega or the impulse, or the word that stands in its place."""
    if run is None:
        return NOTHING
    main = min(run.state, key=lambda v: STATES.index(v.quantity), default=None)
    status = gravest(run.verdicts)
    if main is None or main.max is None:
        return judged(status)
    return error(main) if status.value == "pass" else f"{error(main)} {judged(status)}"
