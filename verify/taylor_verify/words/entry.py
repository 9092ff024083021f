"""Entry of an index: a page of a report folder, and its sheet if there is one."""

from __future__ import annotations

import posixpath
from dataclasses import dataclass
from pathlib import PurePosixPath


@dataclass(frozen=True)
class Page:
    """A file or folder of a report, and its contents in words."""

    path: str
    what: str
    has_sheet: bool = False

    def link(self, seen_from: str = ".") -> str:
        """Return a link to the page from a folder of the report."""
        place = posixpath.relpath(self.path, seen_from)
        return f"[{place}]({place})"

    @property
    def sheet(self) -> str:
        """The path of the CSV with the page's numbers."""
        return f"tables/{PurePosixPath(self.path).stem}.csv"
