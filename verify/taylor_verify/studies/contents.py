"""What lies in a report folder beside the tables that every run makes, named where it is there."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from typing import Final

from taylor_verify.publish.entry import Page
from taylor_verify.studies.registry import others as studies_beside

# Pages that no study makes.
_BESIDES: Final = (
    Page("tables/traps.md", "a plain heyoka call against the driver of this suite"),
    Page("upstream/README.md", "what to report to heyoka's authors, each in a few lines that run"),
)


def others(folder: Path, made: Collection[str] = ()) -> list[Page]:
    """Those that are there, or are among the files that are about to be."""

    def is_there(path: str) -> bool:
        return path in made or (folder / path).exists()

    pages = (*(Page(study.path, study.title) for study in studies_beside()), *_BESIDES)
    return [replace(page, has_sheet=is_there(page.sheet)) for page in pages if is_there(page.path)]
