"""List of all studies, in the order of the indexes."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final

from taylor_verify.plotting.picture import Picture
from taylor_verify_reports.studies.accuracy.standard_runs import STUDY as ACCURACY
from taylor_verify_reports.studies.causes.causes_study import STUDY as CAUSES
from taylor_verify_reports.studies.claims_page import STUDY as CLAIMS
from taylor_verify_reports.studies.controls.controls_page import STUDY as CONTROLS
from taylor_verify_reports.studies.enclosure_width import STUDY as ENCLOSURE
from taylor_verify_reports.studies.engines.board_studies import SATELLITE, UNDERWATER
from taylor_verify_reports.studies.engines.board_studies import STUDY as ENGINES
from taylor_verify_reports.studies.growth.growth_page import STUDY as GROWTH
from taylor_verify_reports.studies.hard.hard_page import STUDY as HARD
from taylor_verify_reports.studies.portraits.stored_portraits import STUDY as PORTRAITS
from taylor_verify_reports.studies.reference.reference_page import STUDY as REFERENCE
from taylor_verify_reports.studies.study import Study
from taylor_verify_reports.studies.tradeoff.tradeoff_page import STUDY as TRADEOFF
from taylor_verify_reports.studies.vectors.vectors_file import STUDY as VECTORS

STUDIES: Final[list[Study[Any]]] = [
    ACCURACY,
    CONTROLS,
    TRADEOFF,
    ENGINES,
    SATELLITE,
    UNDERWATER,
    HARD,
    GROWTH,
    CLAIMS,
    ENCLOSURE,
    PORTRAITS,
    REFERENCE,
    CAUSES,
    VECTORS,
]


class UnknownStudy(ValueError):  # noqa: N818 (it names what was asked for)
    """Some names are no studies; the text has a line for each."""


def find(names: Iterable[str]) -> list[Study[Any]]:
    """Return the studies of these names, each once, in the order of the names. Raises UnknownStudy."""
    known = {study.name: study for study in STUDIES}
    asked = list(dict.fromkeys(names))
    if faults := [_fault(name, list(known)) for name in asked if name not in known]:
        raise UnknownStudy("\n".join(faults))
    return [known[name] for name in asked]


def _fault(name: str, known: list[str]) -> str:
    # A study is a word after `publish`, and no option of it.
    if (word := name.removeprefix("--")) in known:
        return f"expected `publish {word}`, got {name}"
    return f"expected a study, got {name!r}; {hint(name, known)}"


def hint(word: str, known: list[str]) -> str:
    """Return the nearest known word as a question; all known words if none is near."""
    close = get_close_matches(word, known, n=1)
    return f"did you mean {close[0]}?" if close else f"known: {', '.join(known)}"


def others() -> list[Study[Any]]:
    """Return the studies that have a page, except accuracy, whose pages are the report itself."""
    return [study for study in STUDIES if study.path and study is not ACCURACY]


def pictures(folder: Path) -> list[Picture]:
    """Return every picture of a report folder whose data are stored.

    Raises OSError for files that cannot be read and ValueError for files that hold something else.
    """
    return [picture for study in STUDIES for picture in study.pictures(folder)]
