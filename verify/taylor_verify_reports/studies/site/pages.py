"""Pages that only the site has: the front, the list of scenes, each scene, and all gates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import nullcontext, suppress
from pathlib import Path
from typing import Final

from taylor_verify.batch.pickling import dumps
from taylor_verify.batch.pool import LocalPool, available_cores
from taylor_verify.draw import file_errors
from taylor_verify.draw.caption import NotDrawn
from taylor_verify.draw.moving import moving, page
from taylor_verify.plotting.picture import Picture, content
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.runs import gravest
from taylor_verify.words.cells import NOTHING, judged, main_error, ratio, verdict_table, worst
from taylor_verify.words.markdown import code, prose, table
from taylor_verify_reports.studies.finished_parts import Parts
from taylor_verify_reports.studies.site.extension import SCENES
from taylor_verify_reports.studies.site.scene_page import motion_place, scene_page
from taylor_verify_reports.studies.site.stage import (
    DOCS,
    FRONT,
    README,
    REPORTS,
    Stage,
    docs_beside,
    smaller,
)
from taylor_verify_reports.studies.source import Document, Report

_GATES: Final = f"{REPORTS}/tables/gates.md"
_RESULTS: Final = f"{DOCS}/results.md"
# Fewer pictures are drawn in this process, because to start others takes as long as some drawings.
_MANY: Final = 20
_SCENES: Final = (
    "A scene is one motion, given in exact numbers. A number is the largest error of the main quantity, "
    "relative to its size: the angular velocity of a rigid body, the impulse of a solid in a fluid. *Over "
    "attainable* is the largest of all state quantities and rungs; near 1, a solver does all that its "
    "arithmetic allows. [Gates](tables/gates.md) has every quantity with its bound."
)
_WHAT: Final = (
    "Every quantity that was compared, and its bound. The reason of each bound is on the page of its "
    "scene."
)
_COLUMNS: Final = (
    "scene",
    "rung",
    "quantity",
    "max:",
    "at t:",
    "bound:",
    "over attainable:",
    "verdict",
)


def staged(folder: Path, stored: Parts) -> Stage:
    """Return a stage with every page of the site and the files that pages link to.

    Drawings that are ``stored`` are not made again.
    Raises OSError for files that cannot be read, and ValueError for files that hold something else.
    """
    report, stage = Report(folder), Stage(folder, docs_beside(folder))
    pictures = {
        scene: _pictures_of(report.portrait(scene), report.records(scene))
        for scene in report.scenes
    }
    drawings = _drawn([picture for drawn in pictures.values() for picture in drawn], stored)
    stage.files |= {f"{SCENES}/{name}": svg for name, svg in drawings.items()}
    motions = dict(_motions(report))
    stage.motions |= {f"{REPORTS}/{motion_place(scene)}": text for scene, text in motions.items()}
    stage.add_pages(
        {
            f"{SCENES}.md": _scenes(report),
            _GATES: _gates(report),
            **{
                f"{SCENES}/{of_scene(scene)}.md": scene_page(scene, report, drawn, scene in motions)
                for scene, drawn in pictures.items()
            },
            **front(stage),
        }
    )
    return stage


def _motions(report: Report) -> Iterator[tuple[str, str]]:
    """Yield each scene that moves, with the page on which it does."""
    for scene in report.scenes:
        with suppress(NotDrawn):
            if portrait := report.portrait(scene):
                yield scene, page(moving(portrait))


def _pictures_of(portrait: Document | None, records: Mapping[str, Document]) -> list[Picture]:
    """Return the picture of the errors over time of a scene whose motion is stored; none without errors."""
    with suppress(NotDrawn):
        return [file_errors.picture(portrait, records, in_roundoffs=True)] if portrait else []
    return []


def _drawn(pictures: Sequence[Picture], stored: Parts) -> dict[str, str]:
    """Return the SVG of each picture by the name of its file; many are drawn on all cores."""
    drawn = {picture.stem: stored.find(dumps(picture)) for picture in pictures}
    lacking = [picture for picture in pictures if drawn[picture.stem] is None]
    with LocalPool(available_cores()) if len(lacking) >= _MANY else nullcontext() as pool:
        made = map(_svg, lacking) if pool is None else pool.map(_svg, lacking)
        for picture, svg in zip(lacking, made, strict=True):
            stored.keep(dumps(picture), svg)
            drawn[picture.stem] = svg
    return {f"{stem}.svg": svg for stem, svg in drawn.items() if svg is not None}


def _svg(picture: Picture) -> str:
    """Return a picture as SVG; a function of the module, so that other processes can be sent it."""
    return smaller(content(picture, "svg").decode())


def front(stage: Stage) -> dict[str, str]:
    """Return the front page, made of the README, and the page of results, which lists the report."""
    made = {SCENES, _GATES.removesuffix(".md")}
    pages = sorted({*made, *stage.report_pages}, key=_reading_order)
    listed = "\n".join(["```{toctree}", ":hidden:", "", *(f"/{page}" for page in pages), "```"])
    front, results = f"{stage.text(README)}\n{stage.toctrees()}\n", stage.text(_RESULTS)
    if results:
        return {FRONT: front, _RESULTS: f"{results}\n{listed}\n"}
    return {FRONT: f"{front}\n{listed}\n"}


def _reading_order(page: str) -> tuple[int, str]:
    """Return the key by which pages are sorted: the front page, the scenes, then by depth and name."""
    first = (f"{REPORTS}/README", SCENES)
    return (first.index(page) if page in first else 2 + page.count("/"), page)


def _scenes(report: Report) -> str:
    rungs = (f"{rung}:" for rung in report.rungs)
    columns = ["scene", "verdict", "what it is", "regime", *rungs, "over attainable:"]
    rows = [_scene_row(report, scene) for scene in report.scenes]
    return f"# Scenes\n\n{_SCENES}\n\n{table(columns, rows)}\n"


def _scene_row(report: Report, scene: str) -> list[str]:
    """Return the row of a scene in the list of scenes."""
    runs = {run.rung: run for run in report.main_runs_of(scene)}
    about = report.portrait(scene) or next(iter(report.records(scene).values()), {})
    most = worst(verdict for run in runs.values() for verdict in run.state)
    return [
        code(scene),
        judged(gravest(v for run in runs.values() for v in run.verdicts)),
        *(prose(str(about.get(key, ""))) for key in ("title", "regime")),
        *(main_error(runs.get(rung)) for rung in report.rungs),
        ratio(most) if most else NOTHING,
    ]


def _gates(report: Report) -> str:
    """Return the page with all verdicts in one searchable table."""
    verdicts = [verdict for run in report.runs for verdict in run.verdicts]
    return f"# Gates\n\n{_WHAT}\n\n{verdict_table(_COLUMNS, verdicts)}\n"
