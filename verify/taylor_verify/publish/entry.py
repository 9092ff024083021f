"""An entry of an index: a page of a report folder, with its sheet where there is one."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePosixPath

from taylor_verify.publish.cells import NOTHING


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
        """The place of the page's own numbers with every digit; those of a page at the top too."""
        return f"tables/{PurePosixPath(self.path).stem}.csv"

    def row_with_sheet(self) -> list[str]:
        """The row as ``tables`` shows it, with a link to the sheet where there is one."""
        link, what = self.row("tables")
        name = PurePosixPath(self.sheet).name
        return [link, f"[csv]({name})" if self.has_sheet else NOTHING, what]
