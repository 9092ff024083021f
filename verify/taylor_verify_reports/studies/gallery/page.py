"""Gallery: pictures of some motions and of their errors, made from stored data alone.

Its data are data/portraits (the motion) and data/records (the errors of a run). The page is
figures/README.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Final

from taylor_verify.draw import axis_path, centre_path, file_errors, polhode
from taylor_verify.plotting.picture import Picture
from taylor_verify.records import store
from taylor_verify.words.markdown import code, prose
from taylor_verify.words.page import whole
from taylor_verify_reports.studies.portraits.study import PORTRAITS
from taylor_verify_reports.studies.source import Document, Report

_SOLVER: Final = "taylor"

_WHAT: Final = (
    "Every picture is drawn from the data beside this folder, by `taylor-verify publish gallery`, as "
    "SVG and as PDF. Portraits, records and the PDF are made and not committed: `taylor-verify publish "
    "--missing` makes the data, `--paper` the PDF. Lengths, times and impulses are in the scene's own "
    "units. The motions are exact, to more digits than any picture shows; an error is that of the Taylor "
    "driver of this suite, against the exact motion of the same rounded data."
)
_ELSEWHERE: Final = (
    "Other pictures of this folder stand beside their numbers: speed against accuracy in "
    "[tradeoff](../tables/tradeoff.md), and the digits that each precision leaves in "
    "[hard scenes](../tables/hard.md)."
)


@dataclass(frozen=True)
class Shown:
    """A picture with its heading, its caption, and the files that it is made from, below the report."""

    heading: str
    picture: Picture
    caption: str
    sources: tuple[str, ...]

    def block(self) -> str:
        """Return the picture with its caption and its data, in Markdown."""
        sources = ", ".join(map(_named, self.sources))
        stem, alt = self.picture.stem, prose(self.picture.alt)
        return f"![{alt}]({stem}.svg)\n\n{self.caption} Data: {sources}."


def _named(source: str) -> str:
    """Return a link to a file of data, or its name if the repository does not hold it."""
    is_made = source.startswith((PORTRAITS.folder, f"{store.FOLDER}/{store.RECORDS}"))
    return code(source) if is_made else f"[{Path(source).name}](../{source})"


def record_name(scene: str, rung: str) -> str:
    """Return the path of the record of a run, below the report folder."""
    return f"{store.FOLDER}/{store.record_name(scene, _SOLVER, rung)}"


def gallery(folder: Path) -> list[Shown]:
    """Return every picture of the gallery.

    Raises FileNotFoundError for missing files, and ValueError for files that hold something else.
    """
    with store.expecting("data of the gallery", folder / store.FOLDER):
        return list(shown(Report(folder)))


def shown(report: Report) -> Iterator[Shown]:
    """Yield every picture of the gallery, scene by scene."""
    for scene, kinds in _SCENES:
        portrait = _portrait(report, scene)
        for kind in kinds:
            yield Shown(f"{scene}: {prose(portrait['title'])}", *kind(report, portrait))


def _portrait(report: Report, scene: str) -> Document:
    portrait = report.portrait(scene)
    if portrait is None:
        raise FileNotFoundError(2, "no such file", report.folder / PORTRAITS.name(scene))
    return portrait


def page(pictures: Sequence[Shown]) -> str:
    """Return the page of all pictures below their headings."""
    blocks = []
    for heading, group in groupby(pictures, key=lambda entry: entry.heading):
        blocks += [f"## {heading}", *(entry.block() for entry in group)]
    title = "Pictures of motions and of their errors"
    return whole(title, _WHAT, *blocks, "## Elsewhere", _ELSEWHERE)


# The kinds of pictures.

# A picture, its caption, and the files that it is made from.
Made = tuple[Picture, str, tuple[str, ...]]


def _polhode(report: Report, portrait: Document) -> Made:
    caption = (
        f"{code(portrait['scene'])}: the angular velocity on its ellipsoid of inertia, from light to dark "
        "with time; dashed the separatrices."
    )
    return polhode.picture(portrait), caption, (PORTRAITS.name(portrait["scene"]),)


def _axis(report: Report, portrait: Document) -> Made:
    path = axis_path.surface(portrait)
    still = "".join(f"; the cross is the direction of its {mark.name}" for mark in path.marks)
    caption = (
        f"{code(portrait['scene'])}: where {path.name} points in space, from light to dark with "
        f"time, on the unit sphere{still}."
    )
    return axis_path.picture(portrait), caption, (PORTRAITS.name(portrait["scene"]),)


def _path(report: Report, portrait: Document) -> Made:
    body = "the solid itself" if portrait["semi_axes"] else "the axes of the body"
    caption = (
        f"{code(portrait['scene'])}: the path of the body's origin through the fluid, with its projections "
        f"on three walls, and {body} at equal intervals of time."
    )
    return centre_path.picture(portrait), caption, (PORTRAITS.name(portrait["scene"]),)


def _errors(report: Report, portrait: Document) -> Made:
    scene = portrait["scene"]
    records = report.records(scene)
    if not records:
        raise FileNotFoundError(2, "no such file", report.folder / record_name(scene, "f64"))
    caption = (
        f"{code(scene)}: the errors of {_SOLVER} on {', '.join(records)}, in units of the rung's own "
        "roundoff u, beside the error that perfect rounding would leave."
    )
    picture = file_errors.picture(portrait, records, in_roundoffs=True)
    return picture, caption, tuple(record_name(scene, rung) for rung in records)


_SCENES: Final[tuple[tuple[str, tuple[Callable[[Report, Document], Made], ...]], ...]] = (
    ("euler/generic", (_polhode, _errors)),
    ("euler/separatrix", (_polhode, _errors)),
    ("kirchhoff/whole-motion", (_axis,)),
    ("kirchhoff/through-the-pole", (_path, _errors)),
    ("kirchhoff/falling-away", (_path,)),
    ("manufactured/kirchhoff-path", (_path,)),
    ("manufactured/euler-resonance", (_errors,)),
)


def scenes() -> tuple[str, ...]:
    """Return the scenes of the gallery."""
    return tuple(scene for scene, _ in _SCENES)
