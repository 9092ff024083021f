"""The study of the gallery: pictures of motions and errors, made from other studies' data."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.picture import plotting
from taylor_verify_reports.studies.figures import FOLDER
from taylor_verify_reports.studies.portraits.study import PORTRAITS
from taylor_verify_reports.studies.study import Measured, NotMeasured, Progress, Study

if TYPE_CHECKING:
    from taylor_verify_reports.studies.gallery.page import Shown

# Functions import `page` when they are called: it needs NumPy, which other pages do not need.


def _measure(folder: Path, progress: Progress) -> Measured:
    """Check that all data are stored; nothing is measured."""
    from taylor_verify_reports.studies.gallery.page import gallery

    del progress
    try:
        gallery(folder)
        with plotting():
            return Measured()
    except FileNotFoundError as error:
        raise NotMeasured(
            "expected what `run --out`, `publish controls` and `publish portraits` write, "
            f"got no such file @ {error.filename}"
        ) from error
    except (ImportError, ValueError) as error:
        raise NotMeasured(str(error)) from error


def _find(folder: Path) -> list[Shown] | None:
    """Return every picture of the gallery; None if some of its data are missing."""
    if not (folder / PORTRAITS.folder).exists():
        return None
    from taylor_verify_reports.studies.gallery.page import gallery

    try:
        return gallery(folder)
    except FileNotFoundError:
        return None


def _page(pictures: list[Shown], folder: Path) -> str:
    """Return the page of those pictures that are drawn already; empty if there are none."""
    from taylor_verify_reports.studies.gallery.page import page

    drawn = {file.stem for file in (folder / FOLDER).glob("*.svg")}
    shown = [entry for entry in pictures if entry.picture.stem in drawn]
    return page(shown) if shown else ""


STUDY: Final = Study(
    name="gallery",
    title="pictures of some motions, and of their errors",
    duration="seconds",
    measure=_measure,
    find=_find,
    page=_page,
    place=f"{FOLDER}/README.md",
    draw=lambda pictures: [entry.picture for entry in pictures],
    needs_heyoka=False,
)
