"""What lies in a report folder beside the tables that every run makes, named where it is there."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Final

from taylor_verify.publish.cells import NOTHING
from taylor_verify.studies.registry import others as studies_beside


@dataclass(frozen=True)
class Page:
    """A file or folder below the report's own, and what it has."""

    path: str
    what: str
    has_sheet: bool = False

    def row(self, seen_from: str = "") -> list[str]:
        """A link, from the folder ``seen_from`` of the report, and what it leads to."""
        place = PurePosixPath(self.path)
        if seen_from and place.is_relative_to(seen_from):
            place = place.relative_to(seen_from)
        elif seen_from:
            place = PurePosixPath("..", place)
        return [f"[{place}]({place})", self.what]

    @property
    def sheet(self) -> str:
        """Where the page's own numbers are with every digit; those of a page at the top too."""
        return f"tables/{PurePosixPath(self.path).stem}.csv"

    def row_with_sheet(self) -> list[str]:
        """The row as ``tables`` shows it, with a link to the sheet where there is one."""
        link, what = self.row("tables")
        name = PurePosixPath(self.sheet).name
        return [link, f"[csv]({name})" if self.has_sheet else NOTHING, what]


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
